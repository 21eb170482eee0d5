!> Oscillatory force of a structured liquid: p = -p0 cos(2 pi h/d + phase) exp(-h/decay_length).
module structural
  use kinds, only: wp, pi
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, group, real_key
  use force_law, only: force_law_t
  use law_reading, only: check_decades
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: structural_t
    !> 2 pi/d in units of 1/length, and the phase.
    real(wp) :: wave_number = 0, phase = 0
  contains
    procedure :: pressure
    procedure :: slope
    procedure :: energy
  end type structural_t

  !> Exponent above which exponentials would underflow or overflow.
  real(wp), parameter :: largest_exponent = 300

contains

  !> The rows of &structural.
  pure function keys() result(rows)
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      group('structural', 'Oscillatory force of a structured liquid, ' // &
            '-p0 cos(2 pi h/d + phase) exp(-h/decay_length).'), &
      real_key('structural', 'amplitude', 'Pa', 'Pressure p0; negative for the opposite sign.', &
               required=.true.), &
      real_key('structural', 'period', 'm', 'Period d, about the size of a molecule.', &
               above=0.0_wp, required=.true.), &
      real_key('structural', 'decay_length', 'm', 'Length over which the oscillation falls by ' &
               // 'a factor of e.', above=0.0_wp, required=.true.), &
      real_key('structural', 'phase', '', 'Phase [rad] at h = 0.', default='0')]
  end function keys

  !> The law, if the deck has its group. A negative amplitude is a positive one with another phase.
  subroutine read_law(deck, law, error)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error
    type(structural_t) :: this
    real(wp) :: amplitude, period

    if (.not. deck%has_group('structural')) return
    call deck%get('structural', 'amplitude', amplitude)
    call deck%get('structural', 'period', period)
    call deck%get('structural', 'decay_length', this%length)
    call deck%get('structural', 'phase', this%phase)
    if (.not. abs(amplitude) > 0) then
      call deck%mistake('structural', 'amplitude', 'is 0; leave the group out', error)
      return
    end if
    call check_decades(deck, 'structural', 'amplitude', log10(abs(amplitude)), 'a pressure', &
      ' Pa', error)
    if (amplitude < 0) this%phase = this%phase + pi
    this%pressure_unit = abs(amplitude)
    this%wave_number = 2*pi*this%length/period
    this%period = period/this%length
    this%closure_length = min(2.0_wp, 0.25_wp*this%period)
    ! Within the first layer there is no liquid, and the formula would oscillate without bounds.
    this%smallest_gap = 0
    this%group = 'structural'
    this%strength_key = 'amplitude'
    this%length_key = 'decay_length'
    allocate (law, source=this)
  end subroutine read_law

  !> exp(-gap), finite at any gap.
  elemental real(wp) function decay(gap)
    real(wp), intent(in) :: gap

    decay = exp(-max(min(gap, 2*largest_exponent), -largest_exponent))
  end function decay

  pure function pressure(self, gap) result(value)
    class(structural_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = -cos(self%wave_number*gap + self%phase)*decay(gap)
  end function pressure

  pure function slope(self, gap) result(value)
    class(structural_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    associate (k => self%wave_number)
      ! cos x + k sin x, as one cosine.
      value = sqrt(1 + k**2)*cos(k*gap + (self%phase - atan(k)))*decay(gap)
    end associate
  end function slope

  pure function energy(self, gap) result(value)
    class(structural_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = (self%wave_number*sin(self%wave_number*gap + self%phase) - &
      cos(self%wave_number*gap + self%phase))*decay(gap)/(1 + self%wave_number**2)
  end function energy

end module structural
