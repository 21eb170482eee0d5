!> An attraction that is constant up to some separation and ends there: p = -stress erfc((h -
!> range)/s)/2. The smoothing length s avoids a discontinuity of the pressure, at which the
!> equations would have no Jacobian. Dugdale's law, the depletion force and a capillary bridge are
!> of this kind.
module step_attraction
  use kinds, only: wp, pi
  use deck, only: deck_t
  use force_law, only: force_law_t, of_pressure, of_slope, whole_step
  use group_reading, only: accept_law
  implicit none
  private
  public :: new_step, read_step

  !> The law, in units of its range and stress.
  type, extends(force_law_t) :: step_t
    real(wp) :: smoothing = 0
  contains
    procedure :: evaluate
    procedure :: closure
  end type step_t

  !> Default of the ratio of the smoothing length to the range; number of smoothing lengths from the
  !> step beyond which the error function equals its limit.
  real(wp), parameter :: usual = 0.02_wp, farthest = 26
  !> Smallest distance between the step and the breaks on its sides, which must exceed rounding
  !> errors.
  real(wp), parameter :: least = 1.0e-12_wp

contains

  !> Reads the law of a group whose keys `strength_key` [Pa] and `length_key` [m] give stress and
  !> range.
  subroutine read_step(deck, group, strength_key, length_key, law)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, strength_key, length_key
    class(force_law_t), allocatable, intent(out) :: law
    real(wp) :: stress, range

    call deck%get(group, strength_key, stress)
    call deck%get(group, length_key, range)
    call new_step(deck, group, strength_key, length_key, stress, range, law)
  end subroutine read_step

  !> Makes the law with stress [Pa] and range [m], and with the group's key `smoothing`. The other
  !> keys are named in messages.
  subroutine new_step(deck, group, strength_key, length_key, stress, range, law)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, strength_key, length_key
    real(wp), intent(in) :: stress, range
    class(force_law_t), allocatable, intent(out) :: law
    type(step_t) :: this

    call deck%assume(group, 'smoothing', usual*range)
    call deck%get(group, 'smoothing', this%smoothing)
    if (this%smoothing > 0.5_wp*range) call deck%mistake(group, 'smoothing', &
      'is more than half of the range; above that there is no step')
    this%length = range
    this%pressure_unit = stress
    this%smoothing = this%smoothing/range
    this%step_at = 1
    this%step_width = this%smoothing
    this%breaks = 1 + max(whole_step*this%smoothing, least)*[-1.0_wp, 1.0_wp]
    call accept_law(deck, group, strength_key, length_key, this, law)
  end subroutine new_step

  !> The distance of a gap from the step, in smoothing lengths.
  elemental real(wp) function place(self, gap)
    class(step_t), intent(in) :: self
    real(wp), intent(in) :: gap

    place = min((gap - 1)/self%smoothing, farthest)
  end function place

  pure subroutine evaluate(self, quantity, gap, value)
    class(step_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))
    real(wp) :: x(size(gap))

    x = place(self, gap)
    select case (quantity)
    case (of_pressure)
      value = -0.5_wp*erfc(x)
    case (of_slope)
      value = exp(-min(x**2, farthest**2))/(self%smoothing*sqrt(pi))
      where (x <= -farthest) value = 0
    case default
      value = -0.5_wp*self%smoothing*(exp(-min(x**2, farthest**2))/sqrt(pi) - x*erfc(x))
    end select
    where (x >= farthest) value = 0
  end subroutine evaluate

  !> Largest decrease of gaps in one iteration: half the distance to the step, plus the width of the
  !> step.
  pure function closure(self, gap) result(most)
    class(step_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: most(size(gap))

    most = self%smoothing + 0.5_wp*abs(gap - 1)
  end function closure

end module step_attraction
