!> The equilibria between two neighbouring points of the path, approximated by one polynomial of the
!> path's coordinate. It gives gaps, H0 and scale, and passes through up to four points with their
!> tangents. It is made once for many equilibria.
module path_span
  use kinds, only: wp
  use interpolation, only: hermite_t, most_hermite_nodes
  use contact_state, only: state_t
  use equilibrium, only: holds, residual_floor
  use solver, only: solver_t
  use path_coordinate, only: coordinate_of, h0_control
  use path_point, only: path_point_t, h0_alone, load_alone
  use arc, only: arc_t
  use path_search, only: find_place, place_on
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: path_span_t, new_path_span

  !> The arc of the points about the span. The span lies between the path's point number `interval`
  !> and the next one, at the coordinates `ends`; interval = 0: there is no span yet.
  type, extends(arc_t) :: path_span_t
    integer :: interval = 0
    real(wp) :: ends(2) = 0
    type(hermite_t), private :: h0_curve, load_curve
    !> The states of the arc through which the polynomial passes.
    integer, private :: nodes(most_hermite_nodes) = 0, fitted = 0
  contains
    procedure :: at_h0
    procedure :: expected
    procedure :: h0_and_load
    procedure :: solve_at_h0
  end type path_span_t

  !> Difference of the coordinate within which two states are the same except for rounding.
  real(wp), parameter :: same_place = 1.0e-8_wp

contains

  !> The span from point i of a path to the next.
  pure type(path_span_t) function new_path_span(path, i) result(span)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp) :: middle

    span%interval = i
    span%ends = path%point(i:i + 1)%coordinate
    call path%add_to(i, span)
    middle = 0.5_wp*sum(span%ends)
    call span%support(middle, span%nodes, span%fitted)
    span%h0_curve = span%curve(h0_alone, middle)
    span%load_curve = span%curve(load_alone, middle)
  end function new_path_span

  !> The coordinate between the ends at which the polynomial has the value H0.
  pure real(wp) function at_h0(self, h0) result(s)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: h0

    s = place_on(self%h0_curve, self%ends, h0)
  end function at_h0

  !> The state at the coordinate s by the polynomial, also beyond the ends.
  pure subroutine expected(self, solver, s, state)
    class(path_span_t), intent(in) :: self
    class(solver_t), intent(in) :: solver
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state

    call self%guess_from(solver%problem, solver%meshes%grid(self%mesh), &
      self%nodes(:self%fitted), s, state)
  end subroutine expected

  !> H0 and load at s by the polynomials.
  pure function h0_and_load(self, s) result(values)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: s
    real(wp) :: values(2)

    values = [self%h0_curve%value(s), self%load_curve%value(s)]
  end function h0_and_load

  !> The equilibrium at h0, even near a fold; point%converged: whether it was found.
  subroutine solve_at_h0(self, solver, h0, point)
    class(path_span_t), intent(in) :: self
    class(solver_t), intent(inout) :: solver
    real(wp), intent(in) :: h0
    type(path_point_t), intent(out) :: point
    logical :: found

    call find_place(solver, self%arc_t, self%ends, h0_alone, point, found, h0)
    point%interval = self%interval
    associate (state => point%state)
      if (abs(state%h0 - h0) > max(solver%options%tolerance, &
        residual_floor(solver%problem, state))) &
        call finish_at_h0(solver, self%mesh, h0, point%coordinate, state)
      ! The remaining difference of h0 is rounding; it is also the residual of the equations at h0.
      state%residual = max(state%residual, abs(state%h0 - h0))
      point%converged = holds(solver%problem, solver%options%tolerance, state)
      state%h0 = h0
    end associate
  end subroutine solve_at_h0

  !> Solves at prescribed h0. This is needed for wide contacts far from a fold, where the last digit
  !> of the coordinate changes h0 by more than the tolerance.
  subroutine finish_at_h0(solver, mesh, h0, s, state)
    class(solver_t), intent(inout) :: solver
    integer, intent(in) :: mesh
    real(wp), intent(in) :: h0, s
    type(state_t), intent(inout) :: state
    type(state_t) :: trial
    logical :: arrived

    trial = state
    call solver%correct(h0_control(solver%problem%shape, solver%meshes, mesh, h0), trial, arrived)
    if (.not. arrived) return
    if (abs(coordinate_of(solver%problem, solver%meshes, mesh, trial) - s) < same_place) &
      state = trial
  end subroutine finish_at_h0

end module path_span
