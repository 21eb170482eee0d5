!> Prescribed h0 in edge-locked coordinates.
module locked_meshes
  use kinds, only: wp
  use shape, only: shape_t
  use controls, only: control_t, at_h0_with_edge
  use mesh_family, only: mesh_family_t
  use contact_scales, only: hertz_scale
  implicit none
  private
  public :: h0_control, scale_at

contains

  !> The control that prescribes h0 on a mesh.
  pure type(control_t) function h0_control(shape, meshes, mesh, h0) result(control)
    class(shape_t), intent(in) :: shape
    type(mesh_family_t), intent(in) :: meshes
    integer, intent(in) :: mesh
    real(wp), intent(in) :: h0

    control%value = h0
    control%mesh = mesh
    control%scale = scale_at(shape, meshes, h0)
    if (meshes%traceable .and. .not. meshes%is_about_axis(mesh)) control%kind = at_h0_with_edge
  end function h0_control

  !> The scale of the mesh at h0, for meshes whose scale is not an unknown.
  pure real(wp) function scale_at(shape, meshes, h0)
    class(shape_t), intent(in) :: shape
    type(mesh_family_t), intent(in) :: meshes
    real(wp), intent(in) :: h0

    scale_at = 1
    if (.not. meshes%traceable) scale_at = hertz_scale(shape, meshes%level, h0)
  end function scale_at

end module locked_meshes
