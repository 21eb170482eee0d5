!> The error of what is reported: the state that it comes from is solved again on a finer mesh, to
!> rounding, and compared. What is left out is the error of the finer mesh, smaller by a factor that
!> the margin covers. What the iteration has left is added: a residual acts like an h0 that is off
!> by as much.
!>
!> Here for states at a given h0, of which there is one; `path_errors` for those of a path with
!> folds.
module error_estimate
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use regridding, only: regrid
  use equilibrium, only: control_t, state_t, cost_t
  use anderson, only: frozen_jacobian_t, solve_anderson
  use solver_options, only: solver_options_t
  use reported, only: reported_t, error_t
  implicit none
  private
  public :: judge_at_h0, to_rounding, unknown_error, profile_error, nearly_solved, rounding, &
    worst_residual, what_is_left

  !> Rounding of a whole calculation, below which no error is claimed.
  real(wp), parameter :: rounding = 1.0e-13_wp
  !> A residual that leaves no doubt which state it is of; a change of h0 small enough for a
  !> derivative and large against rounding (law's lengths).
  real(wp), parameter :: nearly_solved = 1.0e-6_wp, shift = 1.0e-5_wp
  !> A residual that differs from node to node may move a state by this many times as much as one
  !> that is the same everywhere, which acts like a change of h0.
  real(wp), parameter :: worst_residual = 3

contains

  !> As well as rounding allows: the iteration stops at its own floor.
  pure type(solver_options_t) function to_rounding() result(options)
    options%tolerance = 0
    options%patience = 2
  end function to_rounding

  !> The error of a reported state that has no counterpart on the finer mesh: as large as itself.
  pure type(error_t) function unknown_error(reported) result(error)
    type(reported_t), intent(in) :: reported

    error = error_t(h0=max(abs(reported%h0), 1.0_wp), load=abs(reported%load), &
      displacement=max(abs(reported%displacement), 1.0_wp), profile=1.0_wp)
  end function unknown_error

  !> Errors of a reported state by its witness: on `fine`, of which `nodes` nodes are used, at the
  !> same h0; the difference counts `margin` times.
  subroutine judge_at_h0(problem, mesh, fine, nodes, margin, reported, cost)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: mesh, fine
    integer, intent(in) :: nodes
    real(wp), intent(in) :: margin
    type(reported_t), intent(inout) :: reported
    type(cost_t), intent(inout) :: cost
    type(frozen_jacobian_t) :: frozen
    type(state_t) :: state, shifted
    type(control_t) :: control
    real(wp) :: left
    logical :: converged

    reported%error = unknown_error(reported)
    associate (witness => reported%witness, error => reported%error)
      ! What did not converge has no counterpart.
      if (.not. witness%state%residual < 1) return
      state = regrid(witness%state, mesh, fine, witness%state%scale, nodes)
      call solve_anderson(problem, fine, witness%control, to_rounding(), frozen, state, &
        converged, cost)
      if (.not. (converged .or. state%residual < nearly_solved)) return
      error = error_t(load=margin*abs(state%load - reported%load) + rounding*abs(reported%load), &
        displacement=margin*abs(state%axis_gap - state%h0 - reported%displacement), &
        profile=margin*profile_error(problem, mesh, witness%state, fine, state))
      if (.not. problem%coupling > 0) return
      control = witness%control
      control%value = control%value + shift
      shifted = state
      call solve_anderson(problem, fine, control, to_rounding(), frozen, shifted, converged, cost)
      if (.not. (converged .or. shifted%residual < nearly_solved)) return
      left = what_is_left(witness%state)/shift
      error%load = error%load + left*abs(shifted%load - state%load)
      error%displacement = error%displacement + &
        left*abs((shifted%axis_gap - shifted%h0) - (state%axis_gap - state%h0))
    end associate
  end subroutine judge_at_h0

  !> What the residual of a state amounts to as a change of its h0, at most. The rounding of the
  !> gaps far out, which are large, changes nothing else.
  pure real(wp) function what_is_left(state)
    type(state_t), intent(in) :: state

    what_is_left = rounding + worst_residual* &
      max(state%residual - 4*epsilon(1.0_wp)*maxval(state%gap), 0.0_wp)
  end function what_is_left

  !> The largest difference of gaps, and of pressures over the largest of them, between a state and
  !> one on a finer mesh, on the axis and at its nodes.
  pure real(wp) function profile_error(problem, mesh, state, fine, right) result(largest)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: mesh, fine
    type(state_t), intent(in) :: state, right
    real(wp) :: x, last, strongest
    integer :: j

    last = fine%x(size(right%gap))
    strongest = max(maxval(abs(right%pressure)), tiny(1.0_wp))
    largest = max(abs(right%axis_gap - state%axis_gap), &
      maxval(abs(problem%law%pressure([right%axis_gap]) - &
      problem%law%pressure([state%axis_gap])))/strongest)
    do j = 1, size(state%gap)
      x = state%scale*mesh%x(j)/right%scale
      if (x > last) exit
      largest = max(largest, abs(fine%interpolate(right%gap, x) - state%gap(j)), &
        abs(fine%interpolate(right%pressure, x) - state%pressure(j))/strongest)
    end do
  end function profile_error

end module error_estimate
