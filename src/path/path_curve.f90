!> The path as numbers, for tables and for derivatives.
module path_curve
  use kinds, only: wp
  use dimensionless_problem, only: contact_level_of
  use contact_state, only: radius_of_gap
  use solver, only: solver_t
  use traced_path, only: traced_path_t, no_mesh
  implicit none
  private
  public :: curve_node_t, nodes_of

  !> The numbers of a point of the path. x is the path's coordinate on the mesh; slopes are by x.
  type :: curve_node_t
    integer :: mesh = no_mesh
    real(wp) :: x = 0, h0 = 0, load = 0, h0_slope = 0, load_slope = 0
    !> Up to where bodies are in contact, lateral units; gap on the axis.
    real(wp) :: radius = 0, axis_gap = 0
    !> Modes that are unstable at fixed h0 on its more unstable side.
    integer :: modes = 0
    !> Whether the path leads on from it or ends there; else it is there again on the next mesh.
    logical :: shown = .false.
  end type curve_node_t

contains

  !> The nodes of the points of a path up to the end of its last stable piece.
  pure function nodes_of(solver, path) result(nodes)
    class(solver_t), intent(in) :: solver
    type(traced_path_t), intent(in) :: path
    type(curve_node_t), allocatable :: nodes(:)
    integer :: i

    allocate (nodes(path%last))
    do i = 1, path%last
      associate (point => path%point(i), state => path%point(i)%state)
        nodes(i) = curve_node_t(point%mesh, point%coordinate, state%h0, state%load, &
          point%tangent%h0, point%tangent%load, 0.0_wp, state%axis_gap, path%modes_at(i), &
          point%leads_on .or. i == path%last)
        if (point%mesh /= no_mesh) nodes(i)%radius = radius_of_gap(solver%problem%shape, &
          contact_level_of(solver%problem), solver%meshes%grid(point%mesh), state)
      end associate
    end do
  end function nodes_of

end module path_curve
