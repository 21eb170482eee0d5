!> A problem on its meshes with the iteration that solves it, state after state.
module solver
  use contact_state, only: state_t
  use equilibrium, only: control_t, equations_t
  use solver_options, only: solver_options_t
  use mixing, only: solve_mixing
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  implicit none
  private
  public :: solver_t

  type, extends(equations_t) :: solver_t
    type(solver_options_t) :: options
    !> The factors that one state leaves for the next.
    type(frozen_jacobian_t) :: frozen
  contains
    procedure :: solve
    procedure :: correct
  end type solver_t

contains

  !> From `state` to the equilibrium at `control`. converged: the residual is
  !> within options%tolerance, or for mixing the chosen stopping rule is met.
  subroutine solve(self, control, state, converged)
    class(solver_t), intent(inout) :: self
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged

    if (self%options%mixing) then
      call solve_mixing(self%equations_t, self%options, control, state, converged)
    else
      call self%correct(control, state, converged)
    end if
  end subroutine solve

  !> From a state nearby to the equilibrium at `control`, by the accelerated iteration whatever the
  !> method is. options: where they are not its own.
  subroutine correct(self, control, state, converged, options)
    class(solver_t), intent(inout) :: self
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(solver_options_t), intent(in), optional :: options

    if (present(options)) then
      call solve_anderson(self%equations_t, options, self%frozen, control, state, converged)
    else
      call solve_anderson(self%equations_t, self%options, self%frozen, control, state, converged)
    end if
  end subroutine correct

end module solver
