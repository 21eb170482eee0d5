!> A state of an experiment in edge-locked coordinates: how many nodes of its mesh it uses, and how
!> h0 is prescribed there.
module locked_meshes
  use kinds, only: wp
  use shape, only: shape_t
  use equilibrium, only: control_t, at_h0_with_edge
  use edge_locked, only: mesh_pair_t, hertz_scale, contact
  use continuation, only: node_count
  implicit none
  private
  public :: nodes_to_use, h0_control, scale_at

contains

  !> Nodes for the next state on a mesh, at the scale c: as many as the last state on it had while
  !> they reach far enough and not four times too far, so that factorisations keep their size.
  pure integer function nodes_to_use(pair, mesh, c, present) result(n)
    type(mesh_pair_t), intent(in) :: pair
    integer, intent(in) :: mesh, present
    real(wp), intent(in) :: c

    n = present
    if (n < node_count(pair, mesh, c) .or. n > node_count(pair, mesh, 0.25_wp*c)) &
      n = node_count(pair, mesh, 0.5_wp*c)
  end function nodes_to_use

  !> The control that prescribes h0 on a mesh.
  pure function h0_control(shape, pair, mesh, h0) result(control)
    class(shape_t), intent(in) :: shape
    type(mesh_pair_t), intent(in) :: pair
    integer, intent(in) :: mesh
    real(wp), intent(in) :: h0
    type(control_t) :: control

    control%value = h0
    control%scale = scale_at(shape, pair, h0)
    if (mesh == contact .and. pair%traceable) control%kind = at_h0_with_edge
  end function h0_control

  !> The scale of the mesh at h0 where it is not an unknown.
  pure real(wp) function scale_at(shape, pair, h0)
    class(shape_t), intent(in) :: shape
    type(mesh_pair_t), intent(in) :: pair
    real(wp), intent(in) :: h0

    scale_at = 1
    if (.not. pair%traceable) scale_at = hertz_scale(shape, pair%level, h0)
  end function scale_at

end module locked_meshes
