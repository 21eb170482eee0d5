!> The coordinate s of the equilibrium path, in which the path has no folds and which increases
!> inward. Before contact s is minus the logarithm of the gap on the axis, less nine tenths of the
!> gap at rest; in contact s is the logarithm of the contact radius (`edge_locked`).
module path_coordinate
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use equilibrium, only: control_t, at_axis_gap, at_edge_radius
  use edge_locked, only: approach
  implicit none
  private
  public :: path_control, coordinate_of

contains

  !> The control that prescribes the coordinate s on a mesh.
  pure type(control_t) function path_control(problem, mesh, s) result(control)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s

    control%mesh = mesh
    if (mesh == approach) then
      control%kind = at_axis_gap
      control%value = exp(-s) + 0.9_wp*problem%law%rest_gap
    else
      control%kind = at_edge_radius
      control%value = exp(s)
    end if
  end function path_control

  !> The coordinate of a state; the inverse of `path_control`.
  pure real(wp) function coordinate_of(problem, mesh, state) result(s)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    if (mesh == approach) then
      ! The coordinate of a nearer state, which is not on this mesh, may also be requested.
      s = -log(max(state%axis_gap - 0.9_wp*problem%law%rest_gap, tiny(1.0_wp)))
    else
      s = log(state%scale)
    end if
  end function coordinate_of

end module path_coordinate
