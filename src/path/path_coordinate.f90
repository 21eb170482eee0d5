!> The coordinate s of the equilibrium path, in which the path has no folds and which increases
!> inward. On meshes about the axis s is minus the logarithm of the gap on the axis, less nine
!> tenths of the gap at rest; on other meshes it is the logarithm of the radius of the edge or
!> front to which they are locked (`mesh_plan`).
module path_coordinate
  use kinds, only: wp
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use equilibrium, only: control_t, at_axis_gap, at_edge_radius
  use edge_locked, only: mesh_family_t
  implicit none
  private
  public :: path_control, coordinate_of, axis_coordinate

contains

  !> The control that prescribes the coordinate s on a mesh.
  pure type(control_t) function path_control(problem, meshes, mesh, s) result(control)
    type(problem_t), intent(in) :: problem
    type(mesh_family_t), intent(in) :: meshes
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s

    control%mesh = mesh
    if (meshes%is_about_axis(mesh)) then
      control%kind = at_axis_gap
      control%value = exp(-s) + 0.9_wp*problem%law%rest_gap
    else
      control%kind = at_edge_radius
      control%value = exp(s)
    end if
  end function path_control

  !> The coordinate of a state; the inverse of `path_control`.
  pure real(wp) function coordinate_of(problem, meshes, mesh, state) result(s)
    type(problem_t), intent(in) :: problem
    type(mesh_family_t), intent(in) :: meshes
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    if (meshes%is_about_axis(mesh)) then
      s = axis_coordinate(problem%law, state)
    else
      s = log(state%scale)
    end if
  end function coordinate_of

  !> The coordinate of a state on a mesh about the axis. The state may be nearer than those on this
  !> mesh.
  pure real(wp) function axis_coordinate(law, state) result(s)
    class(force_law_t), intent(in) :: law
    type(state_t), intent(in) :: state

    s = -log(max(state%axis_gap - 0.9_wp*law%rest_gap, tiny(1.0_wp)))
  end function axis_coordinate

end module path_coordinate
