!> The paper's iteration: the new deformation, equation (14), is mixed with the old one. With the
!> gap as the unknown the residual is the difference between the two, up to its sign. The ratio is
!> lowered when the central displacement oscillates or its change grows, and otherwise raised to a
!> limit.
!>
!> In a stiff contact the ratio must fall to about the inverse of the largest eigenvalue of the
!> operator. A small *change* of the displacement then does not show convergence: the iteration may
!> be far from equilibrium. Therefore convergence is judged by the residual; the paper's own rule is
!> an option for the reproduction of the paper.
module mixing
  use kinds, only: wp
  use contact_state, only: state_t
  use controls, only: control_t, at_h0
  use equilibrium, only: equations_t, residual, largest_step, holds
  use solver_options, only: solver_options_t
  implicit none
  private
  public :: solve_mixing, lowered, raised

  !> Factors by which the ratio falls and rises. With a ratio below the smallest, a million
  !> iterations would not relax the softest mode.
  real(wp), parameter :: fall = 0.5_wp, rise = 1.05_wp, smallest_ratio = 1.0e-6_wp
  !> Growth of the change of the central displacement at which the ratio falls. Far from equilibrium
  !> the change may grow slowly for many iterations, the more with a small ratio. If any growth
  !> lowered the ratio, it would reach its smallest value far from equilibrium.
  real(wp), parameter :: growth = 2

contains

  !> Iterates from `state` to the equilibrium at a prescribed H0 (control kind at_h0). On return
  !> state%residual is the residual of the equations; converged: the chosen stopping rule is met.
  subroutine solve_mixing(equations, options, control, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    real(wp), allocatable :: z(:), g(:)
    real(wp) :: ratio, change, change_before, fraction
    integer :: iteration

    converged = .false.
    if (control%kind /= at_h0) return
    z = state%gap
    allocate (g(size(z)))
    ratio = options%mixing_limit
    change = 0
    do iteration = 1, options%most_iterations
      call residual(equations, control, z, g, state)
      equations%cost%iterations = equations%cost%iterations + 1
      state%iterations = iteration
      if (options%stop_on_change) then
        converged = iteration > 1 .and. abs(change) <= options%displacement_tolerance .and. &
          state%residual < huge(1.0_wp)
      else
        converged = holds(equations%problem, options%tolerance, state)
      end if
      if (converged .or. .not. state%residual < huge(1.0_wp)) exit

      ! The first node is on the axis.
      change_before = change
      change = -ratio*g(1)
      if (iteration > 1) then
        if (change*change_before < 0 .or. abs(change) > growth*abs(change_before)) then
          ratio = lowered(ratio)
          equations%cost%rejected_steps = equations%cost%rejected_steps + 1
        else
          ratio = raised(ratio, options%mixing_limit)
        end if
      end if
      change = -ratio*g(1)
      fraction = largest_step(equations%problem, control, z, -ratio*g)
      z = z - fraction*ratio*g
    end do
  end subroutine solve_mixing

  !> The ratio after a step that leads away from equilibrium.
  pure real(wp) function lowered(ratio)
    real(wp), intent(in) :: ratio

    lowered = max(fall*ratio, smallest_ratio)
  end function lowered

  !> The ratio after any other step.
  pure real(wp) function raised(ratio, limit)
    real(wp), intent(in) :: ratio, limit

    raised = min(rise*ratio, limit)
  end function raised

end module mixing
