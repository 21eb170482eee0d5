!> The equilibria between two neighbouring points of the path as one polynomial of the path's
!> coordinate, made once for many of them: gaps, H0 and scale with the values and tangents that up
!> to four points have.
module path_span
  use kinds, only: wp
  use interpolation, only: hermite_t, most_hermite_nodes
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use path_tangent, only: of_h0, of_load
  use state_search, only: neighbours_t, neighbours_of, coordinate_where
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: path_span_t, new_path_span

  type :: path_span_t
    !> The points: this and the next; 0 before there are any. Their mesh, and coordinates there.
    integer :: point = 0, mesh = 1
    real(wp) :: ends(2) = 0
    type(neighbours_t), private :: near
    type(hermite_t), private :: h0, load
    !> Those of the neighbours that the polynomial fits.
    integer, private :: nodes(most_hermite_nodes) = 0, held = 0
  contains
    procedure :: at_h0
    procedure :: guess
    procedure :: h0_and_load
  end type path_span_t

contains

  !> The span from point i of a path to the next.
  pure function new_path_span(path, i) result(span)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(path_span_t) :: span

    span%near = neighbours_of(path, i)
    span%point = i
    span%mesh = span%near%mesh
    span%ends = span%near%ends
    call span%near%support(0.5_wp*sum(span%ends), span%nodes, span%held)
    span%h0 = span%near%curve_there(of_h0)
    span%load = span%near%curve_there(of_load)
  end function new_path_span

  !> Where between the ends H0 has a value; from: a place nearby, if one is known.
  pure real(wp) function at_h0(self, h0, from) result(s)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: h0
    real(wp), intent(in), optional :: from

    s = coordinate_where(self%h0, self%ends, h0, from)
  end function at_h0

  !> The state that is expected at the coordinate s, beyond the ends too; grid: its mesh.
  pure subroutine guess(self, shape, grid, s, state)
    class(path_span_t), intent(in) :: self
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state

    call self%near%guess_from(shape, grid, self%nodes(:self%held), s, state)
  end subroutine guess

  !> H0 and load that are expected at s.
  pure function h0_and_load(self, s) result(values)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: s
    real(wp) :: values(2)

    values = [self%h0%value(s), self%load%value(s)]
  end function h0_and_load

end module path_span
