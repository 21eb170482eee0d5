!> One calling form for the three iterations.
module solver
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use equilibrium, only: control_t, state_t, cost_t
  use solver_options, only: solver_options_t
  use mixing, only: solve_mixing
  use anderson, only: frozen_jacobian_t, solve_anderson
  implicit none
  private
  public :: solve_state

contains

  !> From `state` to the equilibrium at `control` by options%method. converged: the residual is
  !> within options%tolerance, or for mixing the chosen stopping rule is met.
  subroutine solve_state(problem, grid, control, options, frozen, state, converged, cost)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(control_t), intent(in) :: control
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(cost_t), intent(inout) :: cost
    type(solver_options_t) :: newton

    select case (options%method)
    case ('mixing')
      call solve_mixing(problem, grid, control, options, state, converged, cost)
    case ('newton')
      ! The same iteration with the Jacobian renewed at every step and nothing to accelerate.
      newton = options
      newton%patience = 1
      newton%depth = 0
      frozen%factors%valid = .false.
      call solve_anderson(problem, grid, control, newton, frozen, state, converged, cost)
    case default
      call solve_anderson(problem, grid, control, options, frozen, state, converged, cost)
    end select
  end subroutine solve_state

end module solver
