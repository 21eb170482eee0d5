!> Neighbouring points of the equilibrium path on one mesh. Between and beyond them the gap at each
!> node is a Hermite polynomial of the path's coordinate.
module arc
  use kinds, only: wp, pi
  use interpolation, only: polynomial_weights, hermite_weights, hermite_t, hermite_through, &
    most_hermite_nodes, find_nodes_about
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t, too_near
  use solver, only: solver_t
  use solver_options, only: tightened
  use mesh_plan, only: approach
  use path_coordinate, only: path_control
  use path_point, only: path_point_t
  use path_tangent, only: tangent_along
  use edge_predictor, only: moved_outside, move_with_edge
  implicit none
  private
  public :: arc_t, between, most_points

  integer, parameter :: most_points = 8

  !> Some points of the path on one mesh, in the order of the coordinate s.
  type :: arc_t
    integer :: mesh = approach, held = 0
    !> Whether guesses are made at constant distance from the contact edge. On a mesh locked to the
    !> edge this concerns the gaps outside it, on a mesh about the axis the gaps on both sides.
    logical :: moved = .false.
    !> Number of points from which a state beyond an end is extrapolated.
    integer :: extrapolated_from = 3
    !> Allocated with most_points elements: compiler note 11.
    type(path_point_t), allocatable :: point(:)
  contains
    procedure :: add
    procedure :: drop_first
    procedure :: guess
    procedure :: guess_from
    procedure, private :: has_moving_parts
    procedure :: curve
    procedure :: slope
    procedure :: curvature
    procedure :: solve_at
    procedure :: support
  end type arc_t

  !> Step of s for a difference quotient that gives a second derivative.
  real(wp), parameter :: nearby = 1.0e-5_wp

contains

  !> The equilibrium at the coordinate s. The guess from the arc is corrected to rounding or, if
  !> rounding is not reached, to the tolerance of the options. If that fails, the other kind of
  !> guess is tried (see `moved`). slope_error: the permitted relative error of the tangent; if
  !> present, the options' tolerance is enough for the state. miss: differences between state and
  !> guess, relative or in the law's lengths. They are the largest one of a gap; the same for the
  !> other kind of guess (huge if there is none); and the larger one of h0 and load.
  subroutine solve_at(self, solver, s, point, converged, slope_error, miss)
    class(arc_t), intent(in) :: self
    class(solver_t), intent(inout) :: solver
    real(wp), intent(in) :: s
    type(path_point_t), intent(out) :: point
    logical, intent(out) :: converged
    real(wp), intent(in), optional :: slope_error
    real(wp), intent(out), optional :: miss(3)
    type(state_t) :: tried(2)
    type(hermite_t) :: load
    integer :: k, guesses

    guesses = 1
    if (self%has_moving_parts(solver)) guesses = 2
    point%mesh = self%mesh
    point%coordinate = s
    converged = .false.
    associate (problem => solver%problem, grid => solver%meshes%grid(self%mesh), &
      state => point%state, control => path_control(solver%problem, solver%meshes, self%mesh, s))
      do k = 1, guesses
        if (converged .and. .not. present(miss)) exit
        tried(k) = self%guess(problem, grid, s, self%moved .neqv. k == 2)
        if (converged) cycle
        state = tried(k)
        if (present(slope_error)) then
          call solver%correct(control, state, converged)
        else
          call solver%correct(control, state, converged, tightened(solver%options))
          converged = converged .or. state%residual <= solver%options%tolerance
        end if
      end do
      if (present(miss)) then
        miss = huge(miss)
        miss(:guesses) = [(distance(state, tried(k)), k=1, guesses)]
        load = self%curve([0.0_wp, 1.0_wp], s)
        miss(3) = max(abs(state%h0 - tried(1)%h0)/(1 + abs(tried(1)%h0)), &
          abs(state%load - load%value(s))/(abs(state%load) + pi*problem%law%adhesion))
      end if
    end associate
    if (converged) call tangent_along(solver, point, converged, slope_error)
  end subroutine solve_at

  !> Whether the gaps change mainly because the edge moves. On meshes about the axis this is so if
  !> there is a contact. On meshes locked to the edge, the rings of an oscillating pressure and the
  !> step of a pressure move with the edge, except around a small contact.
  pure logical function has_moving_parts(self, solver)
    class(arc_t), intent(in) :: self
    class(solver_t), intent(in) :: solver

    associate (law => solver%problem%law)
      if (solver%meshes%is_about_axis(self%mesh)) then
        has_moving_parts = law%edge_gap > 0
        if (has_moving_parts) has_moving_parts = &
          maxval(self%point(:self%held)%state%axis_gap) < law%edge_gap
      else
        has_moving_parts = max(law%period, law%step_width) > 0
      end if
    end associate
  end function has_moving_parts

  !> The largest |H - H_guess|/(1 + |H_guess|) over the nodes, in the law's lengths.
  pure real(wp) function distance(state, guess)
    type(state_t), intent(in) :: state, guess

    distance = maxval(abs(state%gap - guess%gap)/(1 + abs(guess%gap)))
  end function distance

  !> Inserts a point in the order of s. The arc stays as it is if it is full or has a point at s.
  pure subroutine add(self, point)
    class(arc_t), intent(inout) :: self
    type(path_point_t), intent(in) :: point
    integer :: j, place

    if (.not. allocated(self%point)) allocate (self%point(most_points))
    associate (x => self%point(:self%held)%coordinate)
      if (self%held == most_points .or. any(abs(x - point%coordinate) <= 0)) return
      place = count(x < point%coordinate) + 1
    end associate
    do j = self%held, place, -1
      call self%point(j + 1)%become(self%point(j))
    end do
    self%held = self%held + 1
    call self%point(place)%become(point)
  end subroutine add

  !> Removes the first point.
  pure subroutine drop_first(self)
    class(arc_t), intent(inout) :: self
    integer :: j

    self%held = self%held - 1
    do j = 1, self%held
      call self%point(j)%become(self%point(j + 1))
    end do
  end subroutine drop_first

  !> The points of the polynomial about s: the ends of the interval that contains s, and on either
  !> side the nearest point that is not too close to this end. Beyond an end of the arc they are the
  !> `extrapolated_from` points nearest to this end.
  pure subroutine support(self, s, nodes, n)
    class(arc_t), intent(in) :: self
    real(wp), intent(in) :: s
    integer, intent(out) :: nodes(most_hermite_nodes), n
    integer :: i, j

    associate (x => self%point(:self%held)%coordinate, last => self%held)
      do i = 1, last - 1
        if ((x(i) - s)*(x(i + 1) - s) <= 0) exit
      end do
      if (i >= last) then
        i = 1
        if (abs(x(1) - s) > abs(x(last) - s)) i = max(1, last + 1 - self%extrapolated_from)
        n = min(last, i - 1 + self%extrapolated_from) + 1 - i
        nodes(:n) = [(j, j=i, i - 1 + n)]
        return
      end if
      call find_nodes_about(x, i, nodes, n)
    end associate
  end subroutine support

  !> The state at s by the polynomial of the arc; grid: the arc's mesh; moved: see `guess_from`.
  pure type(state_t) function guess(self, problem, grid, s, moved) result(expected)
    class(arc_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: s
    logical, intent(in), optional :: moved
    integer :: nodes(most_hermite_nodes), n

    call self%support(s, nodes, n)
    call self%guess_from(problem, grid, nodes(:n), s, expected, moved)
  end function guess

  !> The state at s by the polynomial through the points `nodes` of the arc; it is written into the
  !> allocated arrays of `expected`. The gaps are interpolated. Outside the edge the heights of the
  !> shape at the nodes are interpolated too: their exact values are known, and the error of the
  !> interpolated heights is subtracted from the guess. Near an end of the bodies or a kink of their
  !> profile this error is most of the error of the guess. Inside the edge the gap is smooth even
  !> where the shape is not. A parabola's heights are proportional to the square of the scale and
  !> need no such correction. moved (.false. if absent): the gaps outside the edge are those of
  !> `moved_outside`; on a mesh about the axis, the gaps near the edge are those of
  !> `move_with_edge`.
  pure subroutine guess_from(self, problem, grid, nodes, s, expected, moved)
    class(arc_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: nodes(:)
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: expected
    logical, intent(in), optional :: moved
    real(wp), dimension(most_hermite_nodes) :: at, of_value, of_slope
    real(wp) :: h0, scale
    integer :: j, n, from

    from = count(grid%x <= grid%centre) + 1
    n = size(nodes)
    at(:n) = self%point(nodes)%coordinate
    call hermite_weights(at(:n), s, of_value(:n), of_slope(:n))
    call expected%become(self%point(nodes(minloc(abs(at(:n) - s), 1)))%state)
    expected%pressure = 0
    h0 = 0
    scale = 0
    associate (shape => problem%shape)
      do j = 1, n
        associate (state => self%point(nodes(j))%state, tangent => self%point(nodes(j))%tangent)
          expected%pressure = expected%pressure + of_value(j)*state%gap + of_slope(j)*tangent%gap
          h0 = h0 + of_value(j)*state%h0 + of_slope(j)*tangent%h0
          scale = scale + of_value(j)*state%scale + of_slope(j)*tangent%scale
          if (shape%parabolic .or. .not. grid%centre > 0) cycle
          expected%pressure(from:) = expected%pressure(from:) - &
            of_value(j)*shape%height(state%scale*grid%x(from:)) - &
            of_slope(j)*tangent%scale*grid%x(from:)*shape%slope(state%scale*grid%x(from:))
        end associate
      end do
      if (grid%centre > 0 .and. .not. shape%parabolic) &
        expected%pressure(from:) = expected%pressure(from:) + shape%height(scale*grid%x(from:))
    end associate
    if (present(moved)) then
      associate (gap => expected%pressure)
        if (moved .and. grid%centre > 0) then
          gap(from:) = moved_outside(problem%shape, grid, self%point, nodes, of_value(:n), &
            of_slope(:n), scale)
        else if (moved) then
          call move_with_edge(problem, grid, self%point, nodes, of_value(:n), of_slope(:n), gap)
        end if
      end associate
    end if
    call take_if_sound(h0, scale, expected)
  end subroutine guess_from

  !> The polynomial through states at the given values of a coordinate, evaluated at s.
  pure type(state_t) function between(coordinate, states, s) result(expected)
    real(wp), intent(in) :: coordinate(:), s
    type(state_t), intent(in) :: states(:)
    real(wp) :: weight(size(states)), h0, scale
    integer :: j

    expected = states(minloc(abs(coordinate - s), 1))
    expected%pressure = 0
    h0 = 0
    scale = 0
    weight = polynomial_weights(coordinate, s)
    do j = 1, size(states)
      expected%pressure = expected%pressure + weight(j)*states(j)%gap
      h0 = h0 + weight(j)*states(j)%h0
      scale = scale + weight(j)*states(j)%scale
    end do
    call take_if_sound(h0, scale, expected)
  end function between

  !> Gives an expected state its extrapolated gaps, H0 and scale. So far it has those of the nearest
  !> known state, and keeps them if the extrapolated gaps are `too_near`. The extrapolated gaps are
  !> passed in the array of the pressures, which are computed later.
  pure subroutine take_if_sound(h0, scale, expected)
    real(wp), intent(in) :: h0, scale
    type(state_t), intent(inout) :: expected

    if (.not. too_near(expected%pressure, expected%gap)) then
      expected%gap = expected%pressure
      expected%h0 = h0
      if (scale > 0.5_wp*expected%scale) expected%scale = scale
    end if
    expected%pressure = 0
  end subroutine take_if_sound

  !> The polynomial for weights(1) h0 + weights(2) load about s.
  pure type(hermite_t) function curve(self, weights, s)
    class(arc_t), intent(in) :: self
    real(wp), intent(in) :: weights(2), s
    real(wp), dimension(most_hermite_nodes) :: at, value, slope
    integer :: nodes(most_hermite_nodes), n, j

    call self%support(s, nodes, n)
    do j = 1, n
      associate (point => self%point(nodes(j)))
        at(j) = point%coordinate
        value(j) = point%state%of(weights)
        slope(j) = point%tangent%of(weights)
      end associate
    end do
    curve = hermite_through(at(:n), value(:n), slope(:n))
  end function curve

  !> The derivative of weights(1) h0 + weights(2) load by s.
  pure real(wp) function slope(self, weights, s)
    class(arc_t), intent(in) :: self
    real(wp), intent(in) :: weights(2), s
    type(hermite_t) :: about

    about = self%curve(weights, s)
    slope = about%slope(s)
  end function slope

  !> The second derivative of weights(1) h0 + weights(2) load by s, from slopes on either side of s.
  !> At a point of the arc the polynomial changes, and the result is the mean over both sides.
  pure real(wp) function curvature(self, weights, s)
    class(arc_t), intent(in) :: self
    real(wp), intent(in) :: weights(2), s

    curvature = (self%slope(weights, s + nearby) - self%slope(weights, s - nearby))/(2*nearby)
  end function curvature

end module arc
