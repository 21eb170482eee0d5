!> Oscillatory force of a structured liquid: p = -p0 cos(2 pi h/d + phase) exp(-h/decay_length).
module structural
  use kinds, only: wp, pi
  use special_functions, only: largest_exponent
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t, of_pressure, of_slope
  use group_reading, only: accept_law
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: structural_t
    !> The wave number 2 pi/d in units of 1/length, and the phase.
    real(wp) :: wave_number = 0, phase = 0
  contains
    procedure :: evaluate
  end type structural_t

  !> The rows of &structural.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('structural', meaning='Oscillatory force of a structured liquid, -p0 cos(2 pi ' // &
      'h/d + phase) exp(-h/decay_length).', &
      choices='&structural amplitude = 2e7, period = 0.8e-9, decay_length = 0.8e-9 /'), &
    key_spec('structural', 'amplitude', real_value, 'Pressure p0; negative for the opposite ' // &
      'sign.', 'Pa', required=.true.), &
    key_spec('structural', 'period', real_value, 'Period d, about the size of a molecule.', 'm', &
      above=0.0_wp, required=.true.), &
    key_spec('structural', 'decay_length', real_value, 'Length over which the oscillation ' // &
      'falls by a factor of e.', 'm', above=0.0_wp, required=.true.), &
    key_spec('structural', 'phase', real_value, 'Phase [rad] at h = 0.', default='0')]

contains

  !> Reads the law from its group. A negative amplitude is replaced by a positive one with another
  !> phase.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(structural_t) :: this
    real(wp) :: amplitude, period

    call deck%get('structural', 'amplitude', amplitude)
    call deck%get('structural', 'period', period)
    call deck%get('structural', 'decay_length', this%length)
    call deck%get('structural', 'phase', this%phase)
    if (.not. abs(amplitude) > 0) then
      call deck%mistake('structural', 'amplitude', 'is 0; leave the group out')
      return
    end if
    if (amplitude < 0) this%phase = this%phase + pi
    this%pressure_unit = abs(amplitude)
    this%wave_number = 2*pi*this%length/period
    this%period = period/this%length
    this%closure_length = min(2.0_wp, 0.25_wp*this%period)
    ! At separations smaller than the first layer there is no liquid, and the formula would
    ! oscillate with unlimited amplitude.
    this%smallest_gap = 0
    call accept_law(deck, 'structural', 'amplitude', 'decay_length', this, law)
  end subroutine read_law

  !> exp(-gap), limited to finite values, and 0 where it is negligible: an oscillation that never
  !> ended could not be integrated numerically.
  elemental real(wp) function decay(gap)
    real(wp), intent(in) :: gap

    decay = 0
    if (gap < 2*largest_exponent) decay = exp(-max(gap, -largest_exponent))
  end function decay

  pure subroutine evaluate(self, quantity, gap, value)
    class(structural_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    associate (k => self%wave_number, phase => self%phase)
      select case (quantity)
      case (of_pressure)
        value = -cos(k*gap + phase)*decay(gap)
      case (of_slope)
        ! The sum cos x + k sin x, written as one cosine.
        value = sqrt(1 + k**2)*cos(k*gap + (phase - atan(k)))*decay(gap)
      case default
        value = (k*sin(k*gap + phase) - cos(k*gap + phase))*decay(gap)/(1 + k**2)
      end select
    end associate
  end subroutine evaluate

end module structural
