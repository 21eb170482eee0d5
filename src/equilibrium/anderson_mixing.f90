!> The paper's mixing with Anderson acceleration, by products with the elastic operator alone. The
!> accelerated step minimises the residual over the last iterations (`acceleration`); then follows a
!> step of mixing, whose ratio changes as in `mixing`.
!>
!> In a stiff contact the pressure is far from linear in a step, and an accelerated step may lead
!> away from equilibrium. Therefore a state whose residual has grown much is rejected: the iteration
!> returns to the best state, forgets its history and continues with a smaller ratio. A gap may
!> close by a fraction of itself in one step (`largest_step`). After many rejections without
!> progress the iteration ends.
!>
!> If there is no equilibrium nearby, the residual must first grow on the path to the next one. Then
!> `relax_by_mixing` moves the bodies by plain mixing, which is a relaxation, until the accelerated
!> iteration converges to a stable state.
module anderson_mixing
  use kinds, only: wp
  use acceleration, only: history_t, accelerate
  use contact_state, only: state_t
  use controls, only: control_t, at_h0
  use equilibrium, only: equations_t, residual, largest_step, holds
  use mixing, only: solve_mixing, lowered, raised
  use solver_options, only: solver_options_t
  use stability_by_products, only: is_stable
  implicit none
  private
  public :: solve_anderson_mixing

  !> A state is rejected if its residual exceeds that of the best state by this factor. Residuals
  !> grow several times on the way to equilibrium, since accelerated steps are not monotonic.
  real(wp), parameter :: growth = 10
  !> The iteration ends after this number of rejections since the least residual was last halved,
  !> and after this number of iterations.
  integer, parameter :: most_rejections = 15, most_accelerated = 1000
  !> Plain iterations before the first attempt of the accelerated ones; before the next attempts
  !> their number is doubled, so that the attempts cost at most a few times the plain iterations.
  integer, parameter :: first_relaxation = 50

contains

  !> Iterates from `state` to the equilibrium at a prescribed H0 (control kind at_h0), by relaxation
  !> if the accelerated iteration ends before. On return `state` is the equilibrium or the last
  !> state, and state%residual is the residual of its equations; converged: it is at most the
  !> tolerance, or the floor due to rounding.
  subroutine solve_anderson_mixing(equations, options, control, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(state_t) :: trial

    converged = .false.
    if (control%kind /= at_h0) return
    trial = state
    call iterate(equations, options, control, options%most_iterations, trial, converged)
    if (converged .or. trial%iterations >= options%most_iterations .or. &
      .not. trial%residual < huge(1.0_wp)) then
      state = trial
    else
      call relax_by_mixing(equations, options, control, state, converged, trial%iterations)
    end if
  end subroutine solve_anderson_mixing

  !> Relaxes `state` to a stable equilibrium at a prescribed H0 (control kind at_h0): plain mixing,
  !> interrupted by attempts of the accelerated iteration. The results are those of
  !> `solve_anderson_mixing`. spent: iterations for this state so far.
  subroutine relax_by_mixing(equations, options, control, state, converged, spent)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    integer, intent(in) :: spent
    type(solver_options_t) :: plain
    type(state_t) :: trial
    integer :: mixed, iterations

    converged = .false.
    iterations = spent
    mixed = 0
    plain = options
    plain%mixing_depth = 0
    do while (iterations < options%most_iterations)
      plain%most_iterations = min(max(first_relaxation, mixed), &
        options%most_iterations - iterations)
      call solve_mixing(equations, plain, control, state, converged)
      mixed = mixed + state%iterations
      iterations = iterations + state%iterations
      if (converged .or. .not. state%residual < huge(1.0_wp)) exit
      if (iterations >= options%most_iterations) exit
      trial = state
      call iterate(equations, options, control, options%most_iterations - iterations, trial, &
        converged)
      iterations = iterations + trial%iterations
      if (converged) converged = is_stable(equations, control, trial)
      if (converged) then
        state = trial
        exit
      end if
    end do
    state%iterations = iterations
  end subroutine relax_by_mixing

  !> At most `allowed` accelerated iterations from `state`; on return `state` is the equilibrium or
  !> the state with the least residual.
  subroutine iterate(equations, options, control, allowed, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(control_t), intent(in) :: control
    integer, intent(in) :: allowed
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(history_t) :: history
    real(wp), dimension(size(state%gap)) :: z, g, step, z_best, g_best
    real(wp) :: ratio, least, halved
    integer :: iteration, rejections

    converged = .false.
    z = state%gap
    ratio = options%mixing_limit
    least = huge(1.0_wp)/growth
    halved = least
    rejections = 0
    do iteration = 1, min(allowed, most_accelerated)
      call residual(equations, control, z, g, state)
      equations%cost%iterations = equations%cost%iterations + 1
      state%iterations = iteration
      converged = holds(equations%problem, options%tolerance, state)
      if (converged .or. (iteration == 1 .and. .not. state%residual < huge(1.0_wp))) return
      if (iteration == 1 .or. state%residual <= growth*least) then
        if (iteration > 1) ratio = raised(ratio, options%mixing_limit)
        if (iteration == 1 .or. state%residual <= least) then
          least = state%residual
          z_best = z
          g_best = g
        end if
        if (least <= 0.5_wp*halved) then
          halved = least
          rejections = 0
        end if
      else
        equations%cost%rejected_steps = equations%cost%rejected_steps + 1
        rejections = rejections + 1
        if (rejections > most_rejections) exit
        ratio = lowered(ratio)
        call history%forget()
        z = z_best
        g = g_best
      end if
      call accelerate(history, options%mixing_depth, ratio, z, g, step)
      z = z + largest_step(equations%problem, control, z, step)*step
    end do
    if (state%residual > least) call residual(equations, control, z_best, g, state)
  end subroutine iterate

end module anderson_mixing
