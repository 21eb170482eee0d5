!> A stable branch of bodies that a spring moves: load and contact radius are functions of the
!> position of the spring's base, with derivatives by the unknowns of a model. All quantities are in
!> SI units.
!>
!> On each panel of a branch, h0, load and the square of the contact radius are Hermite polynomials
!> of a coordinate x through nodes. The nodes of a computed path are its points. Newton's method
!> finds the x of a given position h0 - load/stiffness, or of a given -load.
module force_branch
  use kinds, only: wp
  use interpolation, only: interval_of, hermite_t, hermite_through, polynomial_weights, &
    polynomial_slope
  use root_finding, only: bracket_t
  implicit none
  private
  public :: force_branch_t, load_at_t, weights_of

  !> The search for a position ends at this error, relative to the length of the panel.
  real(wp), parameter :: found_at = 1.0e-13_wp
  integer, parameter :: most_steps = 60

  !> A panel of a branch. ends: the coordinates x of its beginning and end. x: the coordinates of
  !> the nodes, which may lie beyond the ends. h0, load: values and derivatives by x, (value and
  !> slope, node). h0_rate, load_rate: derivatives by the unknowns at fixed x, (unknown, node).
  !> square, square_rate: the same for the square of the contact radius, if it is wanted.
  type :: panel_t
    real(wp) :: ends(2) = [0.0_wp, 1.0_wp]
    real(wp), allocatable :: x(:), h0(:, :), load(:, :), h0_rate(:, :), load_rate(:, :)
    real(wp), allocatable :: square(:, :), square_rate(:, :)
    type(hermite_t), private :: position_curve, load_curve, square_curve
  end type panel_t

  !> The panels of a branch, ordered from large to small h0. turns_first, turns_last: the branch
  !> ends at a turn of the position, not at an end of the path.
  type :: force_branch_t
    type(panel_t), allocatable :: panel(:)
    logical :: turns_first = .false., turns_last = .false.
    !> The position is the sum of h0 and load with these weights.
    real(wp) :: weights(2) = [1.0_wp, 0.0_wp]
    !> Positions at the beginnings of the panels, and at the end of the last one; and the negatives
    !> of these positions, which ascend.
    real(wp), allocatable :: position(:)
    real(wp), allocatable, private :: ascending(:)
  contains
    procedure :: close
    procedure :: at
    procedure :: value_at
    procedure :: leave
    procedure :: largest_tension
    procedure, private :: end_of, position_rate
  end type force_branch_t

  !> The load at a position, and its derivatives by the position and by the unknowns at that
  !> position; the same for the contact radius.
  type :: load_at_t
    real(wp) :: load = 0, slope = 0, radius = 0, radius_slope = 0
    real(wp), allocatable :: rate(:), radius_rate(:)
  end type load_at_t

contains

  !> The weights of h0 and load in the position of a spring's base; in -load if there is no spring.
  pure function weights_of(stiffness) result(weights)
    real(wp), intent(in) :: stiffness
    real(wp) :: weights(2)

    weights = [0, -1]
    if (stiffness > 0) weights = [1.0_wp, -1/stiffness]
  end function weights_of

  !> Completes a branch for a spring, once the panels are set.
  pure subroutine close(self, stiffness)
    class(force_branch_t), intent(inout) :: self
    real(wp), intent(in) :: stiffness
    integer :: i, n

    self%weights = weights_of(stiffness)
    n = size(self%panel)
    allocate (self%position(n + 1))
    do i = 1, n
      associate (panel => self%panel(i))
        panel%load_curve = hermite_through(panel%x, panel%load(1, :), panel%load(2, :))
        panel%position_curve = hermite_through(panel%x, &
          self%weights(1)*panel%h0(1, :) + self%weights(2)*panel%load(1, :), &
          self%weights(1)*panel%h0(2, :) + self%weights(2)*panel%load(2, :))
        if (allocated(panel%square)) panel%square_curve = hermite_through(panel%x, &
          panel%square(1, :), panel%square(2, :))
        self%position(i:i + 1) = [panel%position_curve%value(panel%ends(1)), &
          panel%position_curve%value(panel%ends(2))]
      end associate
    end do
    self%ascending = -self%position
  end subroutine close

  !> Derivatives of the position by the unknowns at the nodes of panel i, at fixed x.
  pure function position_rate(self, i) result(rate)
    class(force_branch_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), allocatable :: rate(:, :)

    rate = self%weights(1)*self%panel(i)%h0_rate + self%weights(2)*self%panel(i)%load_rate
  end function position_rate

  !> The load at a position. Beyond a turn the load stays constant. Beyond an end of the path it is
  !> continued linearly inward, and stays constant outward.
  pure type(load_at_t) function at(self, position) result(found)
    class(force_branch_t), intent(in) :: self
    real(wp), intent(in) :: position
    integer :: i, n

    n = size(self%panel)
    if (position >= self%position(1)) then
      found = self%end_of(.false.)
    else if (position <= self%position(n + 1)) then
      found = self%end_of(.true.)
      if (self%turns_last) return
      found = on_panel(self, n, self%panel(n)%ends(2))
      found%load = found%load + found%slope*(position - self%position(n + 1))
      found%radius = found%radius + found%radius_slope*(position - self%position(n + 1))
    else
      i = interval_of(self%ascending(:n), -position)
      found = on_panel(self, i, place_on(self, i, position))
    end if
  end function at

  !> The load at a position, as by `at`, but without derivatives.
  pure real(wp) function value_at(self, position) result(load)
    class(force_branch_t), intent(in) :: self
    real(wp), intent(in) :: position
    type(load_at_t) :: there
    integer :: i, n

    n = size(self%panel)
    if (position >= self%position(1)) then
      load = self%panel(1)%load_curve%value(self%panel(1)%ends(1))
    else if (position <= self%position(n + 1)) then
      there = self%at(position)
      load = there%load
    else
      i = interval_of(self%ascending(:n), -position)
      load = self%panel(i)%load_curve%value(place_on(self, i, position))
    end if
  end function value_at

  !> The coordinate of a position on panel i, over which the position falls.
  pure real(wp) function place_on(self, i, position) result(x)
    class(force_branch_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: position
    type(bracket_t) :: bracket
    real(wp) :: value, slope, width
    integer :: step

    width = abs(self%position(i) - self%position(i + 1))
    associate (panel => self%panel(i))
      bracket = bracket_t(panel%ends(1), panel%ends(2))
      x = panel%ends(1) + (panel%ends(2) - panel%ends(1))* &
        (self%position(i) - position)/max(width, tiny(1.0_wp))
      do step = 1, most_steps
        call panel%position_curve%evaluate(x, value, slope)
        if (abs(value - position) <= found_at*width) exit
        call bracket%narrow(value > position, x)
        if (abs(slope) > 0) x = x - (value - position)/slope
        if (.not. (x > bracket%low .and. x < bracket%high)) x = bracket%middle()
      end do
    end associate
  end function place_on

  !> Load and derivatives at x on panel i, where the position does not turn.
  pure type(load_at_t) function on_panel(self, i, x) result(found)
    class(force_branch_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: x
    real(wp) :: load_slope, square, slope

    associate (panel => self%panel(i))
      call panel%load_curve%evaluate(x, found%load, load_slope)
      found%slope = load_slope/panel%position_curve%slope(x)
      associate (weight => polynomial_weights(panel%x, x))
        found%rate = matmul(panel%load_rate - found%slope*self%position_rate(i), weight)
        if (.not. allocated(panel%square)) return
        call panel%square_curve%evaluate(x, square, slope)
        slope = slope/panel%position_curve%slope(x)
        call set_radius(found, square, slope, matmul(panel%square_rate - &
          slope*self%position_rate(i), weight))
      end associate
    end associate
  end function on_panel

  !> Sets the contact radius from its square, with derivatives by the position and by the unknowns.
  !> Without contact the radius is 0.
  pure subroutine set_radius(found, square, slope, rate)
    type(load_at_t), intent(inout) :: found
    real(wp), intent(in) :: square, slope, rate(:)

    found%radius_rate = 0*rate
    if (.not. square > 0) return
    found%radius = sqrt(square)
    found%radius_slope = slope/(2*found%radius)
    found%radius_rate = rate/(2*found%radius)
  end subroutine set_radius

  !> An end of the branch from which the bodies jump: the position, its derivatives by the unknowns,
  !> and the load. At a turn of the position, moving along the branch does not change the position.
  pure subroutine leave(self, inner, position, rate, load)
    class(force_branch_t), intent(in) :: self
    logical, intent(in) :: inner
    real(wp), intent(out) :: position, load
    real(wp), allocatable, intent(out) :: rate(:)
    integer :: i

    i = merge(size(self%panel), 1, inner)
    position = self%position(merge(i + 1, 1, inner))
    associate (panel => self%panel(i))
      associate (x => panel%ends(merge(2, 1, inner)))
        load = panel%load_curve%value(x)
        rate = matmul(self%position_rate(i), polynomial_weights(panel%x, x))
      end associate
    end associate
  end subroutine leave

  !> The largest tension at the ends of the panels.
  pure real(wp) function largest_tension(self) result(tension)
    class(force_branch_t), intent(in) :: self
    integer :: i, side

    tension = -huge(tension)
    do i = 1, size(self%panel)
      associate (panel => self%panel(i))
        do side = 1, 2
          tension = max(tension, -panel%load_curve%value(panel%ends(side)))
        end do
      end associate
    end do
  end function largest_tension

  !> Load and derivatives at an end of the panel. At a turn the derivative of the position by x
  !> vanishes; the turn moves with the unknowns.
  pure type(load_at_t) function end_of(self, inner) result(found)
    class(force_branch_t), intent(in) :: self
    logical, intent(in) :: inner
    real(wp), allocatable :: rate(:, :), moved(:), square_rate(:)
    real(wp) :: bend, x, slope, square, square_slope
    integer :: i, k

    i = merge(size(self%panel), 1, inner)
    associate (panel => self%panel(i))
      x = panel%ends(merge(2, 1, inner))
      call panel%load_curve%evaluate(x, found%load, slope)
      found%rate = matmul(panel%load_rate, polynomial_weights(panel%x, x))
      moved = 0*found%rate
      bend = panel%position_curve%curvature(x)
      if (merge(self%turns_last, self%turns_first, inner) .and. abs(bend) > 0) then
        rate = self%position_rate(i)
        moved = [(-polynomial_slope(panel%x, rate(k, :), x)/bend, k=1, size(moved))]
      end if
      found%rate = found%rate + slope*moved
      if (.not. allocated(panel%square)) return
      call panel%square_curve%evaluate(x, square, square_slope)
      square_rate = matmul(panel%square_rate, polynomial_weights(panel%x, x)) + square_slope*moved
      call set_radius(found, square, 0.0_wp, square_rate)
    end associate
  end function end_of

end module force_branch
