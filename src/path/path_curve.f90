!> The path as numbers, for tables and for derivatives: a node for each point and each mesh that knows
!> it.
module path_curve
  use kinds, only: wp
  use dimensionless_problem, only: contact_level_of
  use contact_state, only: radius_of_gap
  use solver, only: solver_t
  use arc, only: arc_t
  use traced_path, only: traced_path_t, no_mesh
  implicit none
  private
  public :: curve_node_t, nodes_of

  !> An equilibrium of the path, the point of this number. x is the path's coordinate on the mesh
  !> (`traced_path`); slopes are by x.
  type :: curve_node_t
    integer :: point = 0, mesh = no_mesh
    real(wp) :: x = 0, h0 = 0, load = 0, h0_slope = 0, load_slope = 0
    !> Up to where bodies are in contact, lateral units; gap on the axis.
    real(wp) :: radius = 0, axis_gap = 0
    !> Modes that are unstable at fixed h0 on its more unstable side.
    integer :: modes = 0
    !> Whether it stands for its point: the path goes on from it.
    logical :: shown = .false.
  end type curve_node_t

contains

  !> The nodes of a path up to the end of its last stable piece, in order along it.
  pure function nodes_of(solver, path) result(nodes)
    class(solver_t), intent(in) :: solver
    type(traced_path_t), intent(in) :: path
    type(curve_node_t), allocatable :: nodes(:)
    type(curve_node_t) :: node
    type(arc_t) :: alone
    integer :: i, mesh

    allocate (nodes(0))
    do i = 1, path%last
      do mesh = path%point(i)%mesh, path%point(i)%mesh + 1
        alone%held = 0
        alone%mesh = mesh
        call path%add_to(i, alone)
        if (alone%held == 0) cycle
        associate (state => alone%state(1), tangent => alone%tangent(1))
          node = curve_node_t(i, mesh, alone%coordinate(1), state%h0, state%load, tangent%h0, &
            tangent%load, 0.0_wp, state%axis_gap, path%modes_at(i))
          if (mesh /= no_mesh) node%radius = radius_of_gap(solver%problem%shape, &
            contact_level_of(solver%problem), solver%meshes%grid(mesh), state)
        end associate
        if (i < path%last) then
          node%shown = path%joins(i) .and. mesh == path%mesh_between(i)
        else
          node%shown = mesh == path%mesh_between(i - 1)
        end if
        nodes = [nodes, node]
      end do
    end do
  end function nodes_of

end module path_curve
