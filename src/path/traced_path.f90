!> The equilibrium path: its points in order from large separations inward, among them every fold in
!> h0 and every extremum of the load, and the number of unstable modes between one point and the
!> next. Each point is on one mesh; where the path passes to the next mesh, two states are points on
!> both meshes. Before the first traced point the points are those of undeformed bodies.
module traced_path
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use interpolation, only: hermite_t, hermite_through, most_hermite_nodes, find_nodes_about
  use undeformed, only: load_undeformed, load_slope_undeformed
  use path_point, only: path_point_t, no_mesh
  use arc, only: arc_t
  use ending, only: ending_t
  implicit none
  private
  public :: traced_path_t, tracing_t, undeformed_at

  type :: traced_path_t
    integer :: held = 0
    type(path_point_t), allocatable :: point(:)
    !> The number of leading points that are of undeformed bodies; and the last point in use: the
    !> end of the last stable piece.
    integer :: undeformed = 0, last = 0
  contains
    procedure :: insert
    procedure :: begin_undeformed
    procedure :: modes_at
    procedure :: comes_from_before
    procedure :: add_to
    procedure :: curve_between
    procedure :: fitted_between
    procedure, private :: find_nearby
  end type traced_path_t

  !> A traced path, its ending, and whether it ends in a collapse of the bodies; left_out: the
  !> largest part of the load that the nodes miss, except in a collapse.
  type :: tracing_t
    type(traced_path_t) :: path
    type(ending_t) :: ending
    logical :: fallen = .false.
    real(wp) :: left_out = 0
  end type tracing_t

  !> Ratio of h0 between points of undeformed bodies.
  real(wp), parameter :: outer_ratio = 1.12_wp
  !> Number of points on either side of an interval for the polynomial in it. One would not do: a
  !> fold or an extremum may be too close to its neighbour to add information.
  integer, parameter :: either_side = 2

contains

  !> Inserts a point at the given place; later points move up.
  pure subroutine insert(path, place, point)
    class(traced_path_t), intent(inout) :: path
    integer, intent(in) :: place
    type(path_point_t), intent(in) :: point
    type(path_point_t), allocatable :: longer(:)
    integer :: j

    if (.not. allocated(path%point)) allocate (path%point(64))
    if (path%held == size(path%point)) then
      allocate (longer(2*path%held))
      longer(:path%held) = path%point
      call move_alloc(longer, path%point)
    end if
    do j = path%held, place, -1
      path%point(j + 1) = path%point(j)
    end do
    path%held = path%held + 1
    path%point(place) = point
  end subroutine insert

  !> Inserts undeformed bodies from h0 = `farthest` inward before the first point, if that point is
  !> nearer.
  subroutine begin_undeformed(self, problem, farthest)
    class(traced_path_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: farthest
    type(path_point_t), allocatable :: all_points(:)
    integer :: i, n

    if (self%held == 0) return
    associate (h0 => self%point(1)%state%h0)
      if (.not. farthest > h0) return
      n = ceiling(log(farthest/h0)/log(outer_ratio))
      allocate (all_points(n + 1 + self%held))
      all_points(n + 2:) = self%point(:self%held)
      do i = 0, n
        associate (point => all_points(i + 1))
          point = undeformed_at(problem, h0*(farthest/h0)**(1 - real(i, wp)/n))
          point%leads_on = i < n
        end associate
      end do
    end associate
    call move_alloc(all_points, self%point)
    self%undeformed = n + 1
    self%held = self%held + self%undeformed
  end subroutine begin_undeformed

  !> The point of the path for undeformed bodies at h0.
  pure type(path_point_t) function undeformed_at(problem, h0) result(point)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0

    point%mesh = no_mesh
    point%coordinate = -log(h0)
    point%state%h0 = h0
    point%state%axis_gap = h0
    point%state%load = load_undeformed(problem, h0)
    point%tangent%h0 = -h0
    point%tangent%load = -h0*load_slope_undeformed(problem, h0)
  end function undeformed_at

  !> Number of unstable modes of the i-th point; at a fold, of its more unstable side.
  pure integer function modes_at(self, i)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i

    modes_at = self%point(i)%modes
    if (self%point(i)%fold .and. i > 1) modes_at = max(modes_at, self%point(i - 1)%modes)
  end function modes_at

  !> Whether the path continues from the previous point to point i.
  pure logical function comes_from_before(self, i)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i

    comes_from_before = i > 1
    if (comes_from_before) comes_from_before = self%point(i - 1)%leads_on
  end function comes_from_before

  !> The points `from` to `to` for the polynomial between point i and the next.
  pure subroutine find_nearby(self, i, from, to)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i
    integer, intent(out) :: from, to

    do from = i, max(2, i - either_side + 1), -1
      if (self%point(from - 1)%mesh /= self%point(i)%mesh) exit
    end do
    do to = i, min(self%held, i + 1 + either_side) - 1
      if (self%point(to + 1)%mesh /= self%point(i)%mesh) exit
    end do
  end subroutine find_nearby

  !> Adds to an arc the points for the polynomial between point i and the next.
  pure subroutine add_to(self, i, arc)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i
    class(arc_t), intent(inout) :: arc
    integer :: j, from, to

    arc%mesh = self%point(i)%mesh
    call self%find_nearby(i, from, to)
    do j = from, to
      call arc%add(self%point(j))
    end do
  end subroutine add_to

  !> The points through which the polynomial between point i and the next passes.
  pure function fitted_between(self, i) result(fitted)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i
    integer, allocatable :: fitted(:)
    integer :: nodes(most_hermite_nodes), n, from, to

    call self%find_nearby(i, from, to)
    to = min(to, max(self%last, i + 1))
    call find_nodes_about(self%point(from:to)%coordinate, i + 1 - from, nodes, n)
    fitted = nodes(:n) + from - 1
  end function fitted_between

  !> The polynomial for weights(1) h0 + weights(2) load between point i and the next, and the
  !> coordinates of these two.
  pure subroutine curve_between(self, i, weights, curve, ends)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    type(hermite_t), intent(out) :: curve
    real(wp), intent(out) :: ends(2)
    integer :: j

    ends = self%point(i:i + 1)%coordinate
    associate (nodes => self%fitted_between(i))
      curve = hermite_through(self%point(nodes)%coordinate, &
        weights(1)*self%point(nodes)%state%h0 + weights(2)*self%point(nodes)%state%load, &
        [(self%point(nodes(j))%tangent%of(weights), j=1, size(nodes))])
    end associate
  end subroutine curve_between

end module traced_path
