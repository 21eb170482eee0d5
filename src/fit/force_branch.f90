!> The load on bodies driven through a spring along one stable piece, as a function of the drive's
!> position, with derivatives by the unknowns of a model. SI units.
!>
!> On each panel h0 and load are cubics of a parameter t. Newton's method finds the t of a given
!> position h0 - load/stiffness.
module force_branch
  use kinds, only: wp
  use interpolation, only: interval_of
  use root_finding, only: bracket_t
  implicit none
  private
  public :: branch_t, load_at_t

  !> Error of a position at which the search ends, over the length of its panel.
  real(wp), parameter :: found_at = 1.0e-13_wp
  integer, parameter :: most_steps = 60

  !> Panels, ordered from large to small h0. h0(:, i), load(:, i): values at begin and end of panel
  !> i, and derivatives there by t, which goes from 0 to 1. h0_rate, load_rate(unknown, end, panel):
  !> derivatives by the unknowns at fixed t. turns: the piece ends at a turn of the position, not at
  !> an end of the path.
  type :: branch_t
    real(wp), allocatable :: h0(:, :), load(:, :), h0_rate(:, :, :), load_rate(:, :, :)
    logical :: turns_first = .false., turns_last = .false.
    !> 1/stiffness of the spring.
    real(wp) :: compliance = 0
    !> Positions at the begins of the panels, and at the end of the last; and their negatives, which
    !> ascend.
    real(wp), allocatable :: position(:)
    real(wp), allocatable, private :: ascending(:)
  contains
    procedure :: close
    procedure :: at
    procedure :: end_of
  end type branch_t

  !> The load at a position, and its derivatives by the position and by the unknowns at that
  !> position.
  type :: load_at_t
    real(wp) :: load = 0, slope = 0
    real(wp), allocatable :: rate(:)
  end type load_at_t

contains

  !> Sets the spring, once the panels are set.
  pure subroutine close(self, stiffness)
    class(branch_t), intent(inout) :: self
    real(wp), intent(in) :: stiffness
    integer :: n

    self%compliance = 1/stiffness
    n = size(self%h0, 2)
    self%position = [self%h0(1, :) - self%compliance*self%load(1, :), &
      self%h0(2, n) - self%compliance*self%load(2, n)]
    self%ascending = -self%position
  end subroutine close

  !> The load at a position. Beyond a turn the load stays constant. Beyond an end of the path it
  !> continues along a straight line inward, and stays constant outward.
  pure type(load_at_t) function at(self, position) result(found)
    class(branch_t), intent(in) :: self
    real(wp), intent(in) :: position
    real(wp) :: t
    integer :: i, n

    n = size(self%h0, 2)
    if (position >= self%position(1)) then
      found = self%end_of(.false.)
    else if (position <= self%position(n + 1)) then
      found = self%end_of(.true.)
      if (self%turns_last) return
      found = on_panel(self, n, 1.0_wp)
      found%load = found%load + found%slope*(position - self%position(n + 1))
    else
      i = interval_of(self%ascending(:n), -position)
      t = place_on(self, i, position)
      found = on_panel(self, i, t)
    end if
  end function at

  !> t of a position on panel i, over which the position falls.
  pure real(wp) function place_on(self, i, position) result(t)
    class(branch_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: position
    type(bracket_t) :: bracket
    real(wp) :: c(4), missing, width
    integer :: step

    c = cubic_of(self%h0(:, i) - self%compliance*self%load(:, i))
    width = abs(self%position(i) - self%position(i + 1))
    bracket = bracket_t(0.0_wp, 1.0_wp)
    t = (self%position(i) - position)/max(width, tiny(1.0_wp))
    do step = 1, most_steps
      missing = value_of(c, t) - position
      if (abs(missing) <= found_at*width) exit
      call bracket%narrow(missing > 0, t)
      if (abs(slope_of(c, t)) > 0) t = t - missing/slope_of(c, t)
      if (.not. (t > bracket%low .and. t < bracket%high)) t = bracket%middle()
    end do
  end function place_on

  !> Load and derivatives at t on panel i, where the position does not turn.
  pure type(load_at_t) function on_panel(self, i, t) result(found)
    class(branch_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: t
    real(wp) :: load(4), h0(4), load_slope, slope

    load = cubic_of(self%load(:, i))
    h0 = cubic_of(self%h0(:, i))
    load_slope = slope_of(load, t)
    slope = slope_of(h0, t) - self%compliance*load_slope
    found%load = value_of(load, t)
    found%slope = load_slope/slope
    found%rate = linear(self%load_rate(:, :, i), t)
    found%rate = found%rate - found%slope*(linear(self%h0_rate(:, :, i), t) - &
      self%compliance*found%rate)
  end function on_panel

  !> Load and derivatives at an end. A turn is where the derivative of the position by t vanishes,
  !> and moves with the unknowns.
  pure type(load_at_t) function end_of(self, inner) result(found)
    class(branch_t), intent(in) :: self
    logical, intent(in) :: inner
    real(wp), allocatable :: shift(:)
    real(wp) :: c(4), bend
    integer :: i, side

    i = merge(size(self%h0, 2), 1, inner)
    side = merge(2, 1, inner)
    found%load = self%load(side, i)
    found%rate = self%load_rate(:, side, i)
    if (.not. merge(self%turns_last, self%turns_first, inner)) return
    c = cubic_of(self%h0(:, i) - self%compliance*self%load(:, i))
    bend = 2*c(3) + 6*c(4)*merge(1, 0, inner)
    shift = self%h0_rate(:, 2, i) - self%h0_rate(:, 1, i) - &
      self%compliance*(self%load_rate(:, 2, i) - self%load_rate(:, 1, i))
    if (abs(bend) > 0) found%rate = found%rate - shift/bend*self%load(2 + side, i)
  end function end_of

  !> The coefficients of the cubic on [0, 1] with these values and slopes at its ends.
  pure function cubic_of(ends) result(c)
    real(wp), intent(in) :: ends(4)
    real(wp) :: c(4)

    associate (rise => ends(2) - ends(1))
      c = [ends(1), ends(3), 3*rise - 2*ends(3) - ends(4), ends(3) + ends(4) - 2*rise]
    end associate
  end function cubic_of

  pure real(wp) function value_of(c, t)
    real(wp), intent(in) :: c(4), t

    value_of = c(1) + t*(c(2) + t*(c(3) + t*c(4)))
  end function value_of

  pure real(wp) function slope_of(c, t)
    real(wp), intent(in) :: c(4), t

    slope_of = c(2) + t*(2*c(3) + 3*t*c(4))
  end function slope_of

  !> Linear interpolation between both ends of a panel.
  pure function linear(ends, t) result(value)
    real(wp), intent(in) :: ends(:, :), t
    real(wp) :: value(size(ends, 1))

    value = (1 - t)*ends(:, 1) + t*ends(:, 2)
  end function linear

end module force_branch
