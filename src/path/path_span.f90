!> The equilibria between two neighbouring points of the path as one polynomial of the path's
!> coordinate, made once for many of them: gaps, H0 and scale with the values and tangents that up
!> to four points have.
module path_span
  use kinds, only: wp
  use interpolation, only: hermite_t, most_hermite_nodes
  use contact_state, only: state_t
  use arc, only: of_h0, of_load
  use solve_at_h0, only: neighbours_t, neighbours_of, coordinate_at_h0
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: path_span_t, new_path_span

  !> Expected states that are kept: more than are asked for at once.
  integer, parameter :: most_recalled = 8

  type :: path_span_t
    !> The points: this and the next; 0 before there are any. Their mesh, and coordinates there.
    integer :: point = 0, mesh = 1
    real(wp) :: ends(2) = 0
    type(neighbours_t), private :: near
    type(hermite_t), private :: h0, load
    !> Those of the neighbours that the polynomial fits.
    integer, private :: nodes(most_hermite_nodes) = 0, held = 0
    !> States that were recalled, and where.
    type(state_t) :: recalled(most_recalled)
    real(wp), private :: recalled_at(most_recalled) = huge(1.0_wp)
  contains
    procedure :: at_h0
    procedure :: recall
    procedure :: guess
    procedure :: h0_and_load
  end type path_span_t

contains

  !> The span from point i of a path to the next.
  pure function new_path_span(path, i) result(span)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(path_span_t) :: span
    real(wp) :: middle

    span%near = neighbours_of(path, i)
    span%point = i
    span%mesh = span%near%mesh
    span%ends = span%near%coordinate(span%near%lower:span%near%lower + 1)
    middle = 0.5_wp*sum(span%ends)
    call span%near%support(middle, span%nodes, span%held)
    span%h0 = span%near%curve(of_h0, middle)
    span%load = span%near%curve(of_load, middle)
  end function new_path_span

  !> Where between the ends H0 has a value.
  pure real(wp) function at_h0(self, h0) result(s)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: h0

    s = coordinate_at_h0(self%near, self%h0, h0)
  end function at_h0

  !> The state that is expected at the coordinate s, beyond the ends too.
  pure function guess(self, s) result(state)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: s
    type(state_t) :: state

    state = self%near%guess_from(self%nodes(:self%held), s)
  end function guess

  !> Lets recalled(slot(k)) be the state that is expected at s(k), made anew only where it is not
  !> among those kept: what a step asks about its past the steps before have asked.
  pure subroutine recall(self, s, slot)
    class(path_span_t), intent(inout) :: self
    real(wp), intent(in) :: s(:)
    integer, intent(out) :: slot(:)
    integer :: j, k

    do k = 1, size(s)
      slot(k) = findloc(self%recalled_at, s(k), 1)
    end do
    do k = 1, size(s)
      if (slot(k) > 0) cycle
      do j = 1, most_recalled - 1
        if (.not. any(slot == j)) exit
      end do
      slot(k) = j
      self%recalled_at(j) = s(k)
      self%recalled(j) = self%guess(s(k))
    end do
  end subroutine recall

  !> H0 and load that are expected at s.
  pure function h0_and_load(self, s) result(values)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: s
    real(wp) :: values(2)

    values = [self%h0%value(s), self%load%value(s)]
  end function h0_and_load

end module path_span
