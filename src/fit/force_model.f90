!> The prediction of a model for bodies that a spring drives towards each other and back: the load
!> along each stable piece as a function of the drive's position, with derivatives by the unknowns
!> of the model. SI units.
!>
!> On each panel of a branch h0 and load are cubics of a parameter t. Newton's method finds the t of
!> a given position h0 - load/stiffness.
module force_model
  use kinds, only: wp
  use interpolation, only: interval_of
  use root_finding, only: bracket_t
  implicit none
  private
  public :: force_model_t, response_t, way_t, branch_t, load_at_t, inward, outward

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

  !> The two ways.
  integer, parameter :: inward = 1, outward = 2

  !> The branches of a way in order, and the position of the drive at the end of each. The main
  !> jump, that with the largest change of load, starts from the end of branch number `main` of
  !> these; 0: there is none. foretold = .false.: the theory does not predict the jump.
  type :: way_t
    integer, allocatable :: branch(:)
    real(wp), allocatable :: leaves_at(:)
    integer :: main = 0
    logical :: foretold = .true.
  end type way_t

  type :: response_t
    type(branch_t), allocatable :: branch(:)
    type(way_t) :: way(2)
  contains
    procedure :: load_on
    procedure :: jump_from
  end type response_t

  !> A model of the force between the bodies, with unknowns.
  type, abstract :: force_model_t
  contains
    !> The response for values of the unknowns, behind a spring of `stiffness`, from the position
    !> `farthest` [m] to a contact under the load `largest` [N] at least. with_rates: with
    !> derivatives by the unknowns. found = .false.: there is no response.
    procedure(respond_to), deferred :: respond
  end type force_model_t

  abstract interface
    subroutine respond_to(self, value, stiffness, farthest, largest, with_rates, response, found)
      import :: force_model_t, response_t, wp
      class(force_model_t), intent(inout) :: self
      real(wp), intent(in) :: value(:), stiffness, farthest, largest
      logical, intent(in) :: with_rates
      type(response_t), intent(out) :: response
      logical, intent(out) :: found
    end subroutine respond_to
  end interface

contains

  !> The load at a position on a way. side: 1 before the main jump, 2 after it, at any position; 0:
  !> with the jumps of the model.
  pure type(load_at_t) function load_on(self, way, side, position) result(found)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way, side
    real(wp), intent(in) :: position
    integer :: i, first, last

    associate (legs => self%way(way))
      first = 1
      last = size(legs%branch)
      if (legs%main > 0 .and. side == 1) last = legs%main
      if (legs%main > 0 .and. side == 2) first = legs%main + 1
      do i = first, last - 1
        if (way == inward .and. position >= legs%leaves_at(i)) exit
        if (way == outward .and. position <= legs%leaves_at(i)) exit
      end do
      found = self%branch(legs%branch(i))%at(position)
    end associate
  end function load_on

  !> The start of the main jump of a way: position of the drive, its derivatives by the unknowns,
  !> and the load there.
  pure subroutine jump_from(self, way, position, rate, load)
    class(response_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(out) :: position, load
    real(wp), allocatable, intent(out) :: rate(:)
    integer :: i, side

    associate (branch => self%branch(self%way(way)%branch(self%way(way)%main)))
      i = merge(size(branch%h0, 2), 1, way == inward)
      side = merge(2, 1, way == inward)
      position = branch%position(merge(size(branch%position), 1, way == inward))
      load = branch%load(side, i)
      ! At a turn of the position, moving along the branch does not change the position.
      rate = branch%h0_rate(:, side, i) - branch%compliance*branch%load_rate(:, side, i)
    end associate
  end subroutine jump_from

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

end module force_model
