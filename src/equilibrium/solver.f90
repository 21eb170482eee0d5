!> A problem on its meshes with the iteration that solves its states.
module solver
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use controls, only: control_t
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use mixing, only: solve_mixing
  use anderson, only: solve_anderson
  use anderson_mixing, only: solve_anderson_mixing
  use frozen_jacobian, only: frozen_jacobian_t
  implicit none
  private
  public :: solver_t

  type, extends(equations_t) :: solver_t
    type(solver_options_t) :: options
    !> Factors of a previous state, used for the next one.
    type(frozen_jacobian_t) :: frozen
  contains
    procedure :: set_up
    procedure :: solve
    procedure :: correct
  end type solver_t

contains

  !> Gives the solver its problem and options; meshes follow.
  subroutine set_up(self, problem, options)
    class(solver_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(solver_options_t), intent(in) :: options

    self%problem = problem
    self%options = options
  end subroutine set_up

  !> Solves for the equilibrium at `control`, beginning at `state`. converged: the residual is
  !> within options%tolerance, or for mixing the chosen stopping rule is met.
  subroutine solve(self, control, state, converged)
    class(solver_t), intent(inout) :: self
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged

    if (self%options%is_plain_mixing()) then
      call solve_mixing(self%equations_t, self%options, control, state, converged)
    else if (self%options%mixing) then
      call solve_anderson_mixing(self%equations_t, self%options, control, state, converged)
    else
      call self%correct(control, state, converged)
    end if
  end subroutine solve

  !> Solves for the equilibrium at `control` from a nearby state by the accelerated iteration, also
  !> if the method is mixing. options: replace the solver's own options.
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
