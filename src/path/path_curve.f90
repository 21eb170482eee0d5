!> h0 and load along the whole equilibrium path as one piecewise smooth curve: through the points of
!> the traced path with their exact slopes, and farther out through undeformed bodies. Between the
!> points it is a polynomial that fits values and slopes of up to four of them; it says where on the
!> path something happens, and the state there is then solved (`curve_states`).
module path_curve
  use kinds, only: wp
  use interpolation, only: hermite_t, hermite_through, most_hermite_nodes, find_nodes_about
  use contact_state, only: radius_of_gap
  use equilibrium, only: equations_t
  use arc, only: arc_t
  use known_path, only: known_path_t
  use undeformed, only: load_undeformed, load_slope_undeformed
  implicit none
  private
  public :: curve_t, curve_node_t, curve_interval_t, new_curve, no_mesh

  !> A node that no mesh knows: the bodies are undeformed.
  integer, parameter :: no_mesh = 0
  !> Ratio of h0 between such nodes.
  real(wp), parameter :: outer_ratio = 1.12_wp

  !> An equilibrium of the path. x is the path's coordinate (`path_coordinate`), for undeformed
  !> bodies -log(h0); slopes are by x.
  type :: curve_node_t
    integer :: mesh = no_mesh
    real(wp) :: x = 0, h0 = 0, load = 0, h0_slope = 0, load_slope = 0
    !> Up to where bodies are in contact, lateral units; gap on the axis.
    real(wp) :: radius = 0, axis_gap = 0
    !> The point of the path that it is; 0 beyond.
    integer :: point = 0
  end type curve_node_t

  !> From node `left` to the next, on one mesh; modes of the bodies that are unstable at fixed h0.
  type :: curve_interval_t
    integer :: left = 0, modes = 0
  end type curve_interval_t

  !> Nodes run by run: undeformed bodies, then mesh by mesh.
  type :: curve_t
    !> Up to which gap bodies are in contact.
    real(wp) :: contact_gap = 0
    type(curve_node_t), allocatable :: node(:)
    type(curve_interval_t), allocatable :: interval(:)
  contains
    procedure :: value
    procedure :: slope
    procedure :: begin_of
    procedure :: end_of
    procedure :: support
    procedure :: polynomial
  end type curve_t

contains

  !> The curve of a path, with undeformed bodies from h0 = `farthest` inward if that is beyond its
  !> first point. found = .false.: of a path of one point there is none.
  subroutine new_curve(equations, known, farthest, contact_gap, curve, found)
    type(equations_t), intent(in) :: equations
    type(known_path_t), intent(in) :: known
    real(wp), intent(in) :: farthest, contact_gap
    type(curve_t), intent(out) :: curve
    logical, intent(out) :: found
    type(curve_node_t) :: node
    integer :: mesh, i, last

    curve%contact_gap = contact_gap
    allocate (curve%node(0), curve%interval(0))
    found = known%path%held > 1
    if (.not. found) return
    call add_undeformed(equations, known%path%point(1)%state%h0, farthest, curve)
    ! What is behind the last stable piece was traced only to find its end.
    last = known%path%held
    if (size(known%piece) > 0) last = maxval(known%piece%last)
    do mesh = 1, size(equations%meshes%grid)
      do i = 1, last
        node = node_of_point(equations, known, i, mesh, contact_gap)
        if (node%point > 0) curve%node = [curve%node, node]
      end do
    end do
    do i = 1, last - 1
      curve%interval = [curve%interval, curve_interval_t(findloc(curve%node%point == i .and. &
        curve%node%mesh == known%path%mesh_between(i), .true., 1), known%path%point(i)%modes)]
    end do
  end subroutine new_curve

  !> Nodes and intervals from `farthest` to h0, if that is nearer.
  subroutine add_undeformed(equations, h0, farthest, curve)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: h0, farthest
    type(curve_t), intent(inout) :: curve
    type(curve_node_t) :: node
    integer :: i, n

    if (.not. farthest > h0) return
    n = ceiling(log(farthest/h0)/log(outer_ratio))
    associate (problem => equations%problem)
      do i = 0, n
        node%h0 = h0*(farthest/h0)**(1 - real(i, wp)/n)
        node%x = -log(node%h0)
        node%axis_gap = node%h0
        node%load = load_undeformed(problem, node%h0)
        node%h0_slope = -node%h0
        node%load_slope = -node%h0*load_slope_undeformed(problem, node%h0)
        curve%node = [curve%node, node]
      end do
    end associate
    curve%interval = [(curve_interval_t(i, 0), i=1, n)]
  end subroutine add_undeformed

  !> The node of point i of the path on a mesh; its `point` is 0 where the path has none there.
  pure function node_of_point(equations, known, i, mesh, contact_gap) result(node)
    type(equations_t), intent(in) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i, mesh
    real(wp), intent(in) :: contact_gap
    type(curve_node_t) :: node
    type(arc_t) :: only

    only%mesh = mesh
    call known%path%add_to(i, only)
    if (only%held == 0) return
    associate (state => only%state(1), tangent => only%tangent(1))
      node = curve_node_t(mesh, only%coordinate(1), state%h0, state%load, &
        tangent%h0, tangent%load, &
        radius_of_gap(equations%problem%shape, contact_gap, equations%meshes%grid(mesh), state), &
        state%axis_gap, i)
    end associate
  end function node_of_point

  !> weights(1) h0 + weights(2) load at x in interval i.
  pure real(wp) function value(self, i, weights, x)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), x
    type(hermite_t) :: polynomial

    polynomial = self%polynomial(i, weights)
    value = polynomial%value(x)
  end function value

  !> Its derivative by x.
  pure real(wp) function slope(self, i, weights, x)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), x
    type(hermite_t) :: polynomial

    polynomial = self%polynomial(i, weights)
    slope = polynomial%slope(x)
  end function slope

  !> weights(1) h0 + weights(2) load in interval i.
  pure type(hermite_t) function polynomial(self, i, weights)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)

    associate (node => self%node(self%support(i)))
      polynomial = hermite_through(node%x, weights(1)*node%h0 + weights(2)*node%load, &
        weights(1)*node%h0_slope + weights(2)*node%load_slope)
    end associate
  end function polynomial

  !> The nodes that the polynomial of interval i fits: its ends and, on the same mesh, the nearest
  !> on either side that is well apart.
  pure function support(self, i) result(nodes)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i
    integer, allocatable :: nodes(:)
    integer :: about(most_hermite_nodes), first, last, n

    associate (left => self%interval(i)%left, mesh => self%node%mesh)
      do first = left, max(2, left - 2), -1
        if (mesh(first - 1) /= mesh(left)) exit
      end do
      do last = left + 1, min(size(mesh), left + 4) - 1
        if (mesh(last + 1) /= mesh(left)) exit
      end do
      call find_nodes_about(self%node(first:last)%x, left + 1 - first, about, n)
    end associate
    nodes = first - 1 + about(:n)
  end function support

  !> The node at which an interval begins, and the one at which it ends.
  pure type(curve_node_t) function begin_of(self, i)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i

    begin_of = self%node(self%interval(i)%left)
  end function begin_of

  pure type(curve_node_t) function end_of(self, i)
    class(curve_t), intent(in) :: self
    integer, intent(in) :: i

    end_of = self%node(self%interval(i)%left + 1)
  end function end_of

end module path_curve
