!> The equilibria between two neighbouring points of the path as one polynomial of the path's
!> coordinate, made once for many of them: gaps, H0 and scale with the values and tangents that up
!> to four points have.
module path_span
  use kinds, only: wp
  use root_finding, only: bracket_t
  use interpolation, only: hermite_t, new_hermite
  use equilibrium, only: state_t
  use arc, only: take_if_sound
  use solve_at_h0, only: neighbours_t, neighbours_of
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: path_span_t, new_path_span

  type :: path_span_t
    !> The points: this and the next; 0 before there are any. Their mesh, and coordinates there.
    integer :: point = 0, mesh = 1
    real(wp) :: ends(2) = 0
    !> H0, scale and gaps by the coordinate.
    type(hermite_t), private :: curve
    type(state_t), private :: end_state(2)
  contains
    procedure :: coordinate_at_h0
    procedure :: guess
  end type path_span_t

  !> A change of the coordinate that no guess depends on.
  real(wp), parameter :: close_enough = 1.0e-13_wp

contains

  !> The span from point i of a path to the next.
  pure function new_path_span(path, i) result(span)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(path_span_t) :: span
    type(neighbours_t) :: near
    integer, allocatable :: nodes(:)
    real(wp), allocatable :: values(:, :), slopes(:, :)
    integer :: j

    near = neighbours_of(path, i)
    span%point = i
    span%mesh = near%mesh
    span%ends = near%coordinate(near%lower:near%lower + 1)
    span%end_state = near%state(near%lower:near%lower + 1)
    nodes = near%support(0.5_wp*sum(span%ends))
    allocate (values(2 + size(span%end_state(1)%gap), size(nodes)))
    allocate (slopes, mold=values)
    do j = 1, size(nodes)
      associate (state => near%state(nodes(j)), tangent => near%tangent(nodes(j)))
        values(:, j) = [state%h0, state%scale, state%gap]
        slopes(:, j) = [tangent%h0, tangent%scale, tangent%gap]
      end associate
    end do
    span%curve = new_hermite(near%coordinate(nodes), values, slopes)
  end function new_path_span

  !> Where between the ends H0 has a value: by Newton's method, kept between them by halving.
  pure real(wp) function coordinate_at_h0(self, h0) result(s)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: h0
    type(bracket_t) :: bracket
    real(wp) :: value, slope, before
    logical :: rising

    bracket = bracket_t(minval(self%ends), maxval(self%ends))
    associate (x => self%ends, y => self%end_state%h0)
      rising = (y(2) - y(1))*(x(2) - x(1)) > 0
      s = bracket%within(x(1) + (x(2) - x(1))*(h0 - y(1))/(y(2) - y(1)))
    end associate
    do while (bracket%is_open())
      call self%curve%evaluate_first(s, value, slope)
      call bracket%narrow((h0 > value) .eqv. rising, s)
      before = s
      s = bracket%within(s + (h0 - value)/slope)
      if (abs(s - before) <= close_enough) exit
    end do
  end function coordinate_at_h0

  !> The state that is expected at the coordinate s.
  pure subroutine guess(self, s, state)
    class(path_span_t), intent(in) :: self
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state
    real(wp) :: values(2 + size(self%end_state(1)%gap))

    state = self%end_state(minloc(abs(self%ends - s), 1))
    call self%curve%evaluate(s, values)
    call take_if_sound(values(3:), values(1), values(2), state)
  end subroutine guess

end module path_span
