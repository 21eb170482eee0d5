!> The coordinate s of the equilibrium path, in which the path has no folds and which increases
!> inward. On meshes about the axis s = -ln(H_a - 0.9 H_eq), where H_a is the gap on the axis and
!> H_eq the equilibrium separation. At H_a < H_eq, to which flat faces may be pressed, s continues
!> with the same slope and curvature and becomes linear in H_a. On other meshes s is the logarithm
!> of the radius to which they are locked (`mesh_plan`). The module also has the controls that
!> prescribe s or h0 on a mesh, and the state from which bodies approach.
module path_coordinate
  use kinds, only: wp
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t, calm_gap
  use contact_state, only: state_t, undeformed_state
  use shape, only: shape_t
  use controls, only: control_t, at_axis_gap, at_edge_radius, at_h0_with_edge
  use contact_scales, only: hertz_scale
  use mesh_plan, only: approach, contact
  use mesh_family, only: mesh_family_t
  implicit none
  private
  public :: path_control, h0_control, scale_at, far_away, begin_afar, coordinate_of, &
    axis_coordinate, axis_gap_rate

  !> The singular gap of the logarithm, over the equilibrium separation.
  real(wp), parameter :: singular = 0.9_wp
  !> Lengths of the law between the level of a mesh and negligible repulsion.
  integer, parameter :: lengths_apart = 3

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
      control%value = axis_gap_at(problem%law, s)
    else
      control%kind = at_edge_radius
      control%value = exp(s)
    end if
  end function path_control

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

  !> An H0 at which the bodies hardly deform, or at which the repulsion is negligible: a few lengths
  !> of the law beyond the level of meshes without a path.
  pure real(wp) function far_away(problem, meshes)
    type(problem_t), intent(in) :: problem
    type(mesh_family_t), intent(in) :: meshes

    far_away = max(calm_gap(problem), meshes%level + lengths_apart)
  end function far_away

  !> Undeformed bodies at the larger of h0 and `far_away`, and their mesh.
  pure subroutine begin_afar(problem, meshes, h0, mesh, state)
    type(problem_t), intent(in) :: problem
    type(mesh_family_t), intent(in) :: meshes
    real(wp), intent(in) :: h0
    integer, intent(out) :: mesh
    type(state_t), intent(out) :: state

    mesh = merge(approach, contact, meshes%traceable)
    associate (far => max(h0, far_away(problem, meshes)))
      state = undeformed_state(problem%shape, meshes%grid(mesh), far, &
        scale_at(problem%shape, meshes, far))
    end associate
  end subroutine begin_afar

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

  !> The coordinate of a state on a mesh about the axis. The gap on the axis may be smaller than
  !> those of the path on this mesh.
  pure real(wp) function axis_coordinate(law, state) result(s)
    class(force_law_t), intent(in) :: law
    type(state_t), intent(in) :: state

    associate (beyond => state%axis_gap - singular*law%rest_gap, &
      at_rest => (1 - singular)*law%rest_gap)
      if (beyond > at_rest .or. .not. at_rest > 0) then
        s = -log(max(beyond, tiny(1.0_wp)))
      else
        s = (at_rest - beyond)/at_rest
        s = s + 0.5_wp*s**2/(1 + s) - log(at_rest)
      end if
    end associate
  end function axis_coordinate

  !> The gap on the axis at a coordinate.
  pure real(wp) function axis_gap_at(law, s) result(gap)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: s

    associate (at_rest => (1 - singular)*law%rest_gap)
      if (exp(-s) > at_rest) then
        gap = exp(-s) + singular*law%rest_gap
      else
        gap = law%rest_gap - at_rest*within(s + log(at_rest))
      end if
    end associate
  end function axis_gap_at

  !> The derivative of the gap on the axis by the coordinate.
  pure real(wp) function axis_gap_rate(law, s) result(rate)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: s
    real(wp) :: x

    associate (at_rest => (1 - singular)*law%rest_gap)
      rate = -exp(-s)
      if (exp(-s) > at_rest) return
      x = within(s + log(at_rest))
      rate = -at_rest*(1 + x)**2/((1 + x)**2 + x + 0.5_wp*x**2)
    end associate
  end function axis_gap_rate

  !> The solution x of x + x^2/(2 + 2 x) = u.
  pure real(wp) function within(u) result(x)
    real(wp), intent(in) :: u

    x = (u - 1 + sqrt((u - 1)**2 + 6*u))/3
  end function within

end module path_coordinate
