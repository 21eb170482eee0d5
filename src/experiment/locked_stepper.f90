!> The common parts of quasi-static experiments in edge-locked coordinates: nothing is pinned
!> between nodes, and the equations are not stiff at any adhesion strength. `path_stepper` follows
!> the traced path of a law that attracts; `unique_stepper` is for other laws, under which there is
!> one state for every h0.
module locked_stepper
  use kinds, only: wp
  use dimensionless_problem, only: calm_gap
  use contact_state, only: state_t, undeformed_state
  use mesh_plan, only: approach, contact
  use locked_meshes, only: h0_control, scale_at
  use ending, only: ending_t, nothing_afar
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
  implicit none
  private
  public :: locked_stepper_t

  type, abstract, extends(stepper_t) :: locked_stepper_t
  contains
    procedure :: begin_afar
    procedure :: far_away
    procedure :: attempt
  end type locked_stepper_t

contains

  !> A state at h0 or, if the bodies would be close to each other there, at a separation so large
  !> that they hardly deform.
  subroutine begin_afar(self, h0, position, event)
    class(locked_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: mesh

    mesh = merge(approach, contact, self%meshes%traceable)
    far = max(h0, self%far_away())
    state = undeformed_state(self%problem%shape, self%meshes%grid(mesh), far, &
      scale_at(self%problem%shape, self%meshes, far))
    call self%attempt(far, state, mesh, event)
    if (.not. event%converged) &
      event%ending = ending_t(nothing_afar, state%iterations, state%residual)
    call remember(position, state, mesh, .false.)
  end subroutine begin_afar

  !> An H0 at which the bodies hardly deform, or at which the repulsion is negligible.
  pure real(wp) function far_away(self)
    class(locked_stepper_t), intent(in) :: self

    far_away = max(calm_gap(self%problem), self%meshes%level + 3)
  end function far_away

  !> Solves at h0 from the guess `state`.
  subroutine attempt(self, h0, state, mesh, event)
    class(locked_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(inout) :: state
    integer, intent(in) :: mesh
    type(step_result_t), intent(inout) :: event

    call self%solve(h0_control(self%problem%shape, self%meshes, mesh, h0), state, event%converged)
  end subroutine attempt

end module locked_stepper
