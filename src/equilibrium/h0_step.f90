!> A step of h0: the method of section II C of the paper, and its alternatives in this program.
!>
!> The paper's algorithm in its order, and the module in which each part is found:
!>
!>     kernel, equation (15)                  elastic_kernel; on a uniform grid: linear_mesh
!>     deformation, equation (14)             elastic_operator, `deform`
!>     separation, equations (17), (18)       equilibrium, `residual`
!>     pressure, equation (16)                equilibrium, `residual`
!>     mixing, with its automatic ratio       mixing
!>     step of h0, u + Delta/2                this module
!>     load, equation (20)                    equilibrium, `residual`
!>
!> The paper keeps the deformation u as the unknown, this program the separation h = h0(r) - 2 u:
!> when h0 changes by Delta at constant separation, u changes by Delta/2 by itself. A cycle begins
!> with bodies at a large separation that are not deformed; then h0 is stepped inward, and from the
!> turning point outward, each step from the deformation of the previous one. So a state depends on
!> the path to it, as in an experiment.
!>
!> There are three ways of stepping:
!>
!> - At constant separation, as above, with plain `mixing`: the paper's method, on meshes that are
!>   fixed in space.
!> - From a predicted state, on the same meshes: `anderson_mixing`, which accelerates the mixing by
!>   products alone, and `anderson`, with a factorised Jacobian. The prediction extrapolates the
!>   last states, or moves the gap with the contact edge. It saves iterations; the equilibrium that
!>   is found is the same.
!> - Along the path of all equilibria, which is traced before (`tracing`): the default. The mesh is
!>   scaled with the contact, whose radius is an unknown. Steps follow the known path: jumps
!>   start at its folds and end on its next stable piece (`path_stepper`).
!>
!> `fixed_stepper` makes the first two. The iteration does not decide what is a jump: between two
!> rows `fixed_motion` looks for a fold of the equations, whatever the method.
module h0_step
  use kinds, only: wp
  use contact_state, only: state_t
  use controls, only: control_t
  use solver, only: solver_t
  implicit none
  private
  public :: step_h0

contains

  !> Steps from the equilibrium `before` to h0 (law's lengths), with the method of the solver.
  !> expected: a predicted state, from which every method but plain mixing starts; without it all
  !> start at constant separation.
  subroutine step_h0(solver, before, h0, state, converged, expected)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: before
    real(wp), intent(in) :: h0
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged
    type(state_t), intent(in), optional :: expected

    state = before
    if (present(expected) .and. .not. solver%options%is_plain_mixing()) state = expected
    call solver%solve(control_t(value=h0), state, converged)
  end subroutine step_h0

end module h0_step
