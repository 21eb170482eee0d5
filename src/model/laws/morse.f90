!> Morse law between surfaces: the energy per area is w [exp(-2 (h - z0)/l) - 2 exp(-(h - z0)/l)],
!> with the work of adhesion w and the decay length l. The largest tension is w/(2 l) at z0 + l ln
!> 2. In units of 2 l, which is the range w over largest tension, and of the pressure w/(2 l), the
!> pressure is 4 (q^2 - q), q = exp(-2 (H - 1)).
module morse
  use kinds, only: wp
  use special_functions, only: largest_exponent
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t, of_pressure, of_slope
  use group_reading, only: accept_law
  implicit none
  private
  public :: keys, read_law

  type, extends(force_law_t) :: morse_t
  contains
    procedure :: evaluate
  end type morse_t

  !> The rows of &morse.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('morse', meaning='Morse law: an exponential repulsion within an exponential ' // &
      'attraction of twice its range.', &
      choices='&morse work_of_adhesion = 0.05, z0 = 0.3e-9, decay_length = 0.2e-9 /'), &
    key_spec('morse', 'work_of_adhesion', real_value, 'Work of adhesion: the energy needed to ' // &
      'separate unit area.', 'J/m^2', above=0.0_wp, required=.true., former='surface_energy'), &
    key_spec('morse', 'z0', real_value, 'Separation of zero force.', 'm', required=.true.), &
    key_spec('morse', 'decay_length', real_value, 'Length over which the attraction falls by ' // &
      'a factor of e.', 'm', above=0.0_wp, required=.true.)]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(morse_t) :: this
    real(wp) :: surface_energy, z0, decay_length

    call deck%get('morse', 'work_of_adhesion', surface_energy)
    call deck%get('morse', 'z0', z0)
    call deck%get('morse', 'decay_length', decay_length)
    this%length = 2*decay_length
    this%pressure_unit = surface_energy/this%length
    this%origin = z0 - this%length
    this%repulsion_length = 0.25_wp
    this%closure_length = 0.5_wp
    call accept_law(deck, 'morse', 'work_of_adhesion', 'decay_length', this, law)
  end subroutine read_law

  !> exp(-2 (gap - 1)), limited to finite values, and constant where it would underflow.
  elemental real(wp) function decay(gap)
    real(wp), intent(in) :: gap

    decay = exp(max(min(-2*(gap - 1), largest_exponent), -largest_exponent))
  end function decay

  !> The same as `decay`, but 0 where that is constant, since the derivative of the energy vanishes
  !> there.
  elemental real(wp) function falling(gap)
    real(wp), intent(in) :: gap

    falling = 0
    if (2*(gap - 1) < largest_exponent) falling = decay(gap)
  end function falling

  pure subroutine evaluate(self, quantity, gap, value)
    class(morse_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    select case (quantity)
    case (of_pressure)
      value = 4*falling(gap)*(falling(gap) - 1)
    case (of_slope)
      value = 8*falling(gap)*(1 - 2*falling(gap))
    case default
      value = decay(gap)*(decay(gap) - 2)
    end select
  end subroutine evaluate

end module morse
