!> An iteration with a factorised Jacobian that is kept for many states, and Anderson acceleration.
!> The plain step is -B^{-1} G, where B is that Jacobian. Most of the convergence is due to B: the
!> `acceleration` saves a few per cent of the iterations, more where B is kept for long.
!>
!> If B is no longer a good approximation (the residual grows, or convergence is slow), B is renewed
!> at the best state so far and the history is removed. Newton's method is the same iteration with B
!> renewed at every step and without a history.
module anderson
  use kinds, only: wp
  use acceleration, only: history_t, accelerate
  use contact_state, only: state_t
  use controls, only: control_t, unknowns_of, at_h0_with_edge
  use equilibrium, only: equations_t, residual, largest_step, holds
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: solve
  use solver_options, only: solver_options_t
  implicit none
  private
  public :: solve_anderson

  !> The present iterate: the unknowns z, their residual g, f (minus the plain step) and the
  !> accelerated step. The best iterates: the unknowns with the shortest plain step, and those with
  !> the least residual. Then the lengths of the last and of the shortest plain step, and the least
  !> residual.
  type :: iterate_t
    real(wp), allocatable :: z(:), g(:), f(:), step(:), z_best(:), z_least(:)
    real(wp) :: length = huge(1.0_wp), shortest = huge(1.0_wp), least = huge(1.0_wp)
    integer :: since_renewal = 0, rejections = 0
    type(history_t) :: history
  end type iterate_t

  !> Iterations that every state needs. The factorisation is renewed once the further iterations
  !> have cost as much as a new factorisation, which costs one iteration for each
  !> `unknowns_an_iteration` unknowns.
  integer, parameter :: few_iterations = 2, unknowns_an_iteration = 20
  !> A step is rejected if it is more than this many times as long as the last one. Largest number
  !> of rejected steps; after more, the iteration stops.
  real(wp), parameter :: too_long = 10
  integer, parameter :: most_rejections = 4
  !> With a fluid: a plain step shorter than `last_step` tolerances is the last one; so is a step
  !> below `few_roundings` tolerances that is hardly shorter than the one before. The tolerance is
  !> some roundings of a gap; after longer last steps the rates of the gaps would be noise.
  real(wp), parameter :: last_step = 0.1_wp, few_roundings = 10, hardly_shorter = 0.5_wp

contains

  !> Iterates from `state` (gaps, and H0 or c if they are unknowns) to the equilibrium at `control`.
  !> On return state%residual is the residual of the equations; converged: it is at most the
  !> tolerance, or the floor due to rounding.
  subroutine solve_anderson(equations, options, frozen, control, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(iterate_t) :: now
    real(wp) :: before
    integer :: iteration

    now%z = unknowns_of(control, state)
    allocate (now%g(size(now%z)))
    frozen%factors%valid = frozen%serves(control, size(now%z)) .and. options%patience > 1
    converged = .false.
    do iteration = 1, options%most_iterations
      call residual(equations, control, now%z, now%g, state)
      equations%cost%iterations = equations%cost%iterations + 1
      state%iterations = iteration
      converged = holds(equations%problem, options%tolerance, state)
      if (converged .or. .not. state%residual < huge(1.0_wp)) exit
      if (state%residual < now%least) then
        now%least = state%residual
        now%z_least = now%z
      end if
      if (.not. frozen%factors%valid .or. now%since_renewal >= options%patience) &
        call renew(equations, control, state, frozen, now)
      before = now%length
      call take_plain_step(equations, control, state, frozen, now)
      if (.not. frozen%factors%valid .or. now%rejections > most_rejections) exit
      if (allocated(equations%drainage) .and. is_last(options%tolerance, before, now%length)) then
        call finish(equations, control, state, now)
        converged = .true.
        return
      end if
      call advance(equations, options%depth, control, now)
    end do
    if (.not. converged .and. now%least < state%residual) &
      call residual(equations, control, now%z_least, now%g, state)
    ! After slow convergence the next state begins with a new factorisation.
    frozen%excess = frozen%excess + max(0, state%iterations - few_iterations)
    if (unknowns_an_iteration*frozen%excess > size(now%z)) call frozen%forget()
  end subroutine solve_anderson

  !> Whether a plain step is so short that it is the last one. Rates are differences of gaps over
  !> the step of time, so the remaining error of the gaps must be near rounding, where plain steps
  !> become no shorter.
  pure logical function is_last(tolerance, before, length)
    real(wp), intent(in) :: tolerance, before, length

    is_last = length <= last_step*tolerance .or. &
      (length <= few_roundings*tolerance .and. length > hardly_shorter*before)
  end function is_last

  !> Makes the last plain step. In a short step of time a fluid multiplies the rounding of gaps in
  !> the residual but not in the plain step, whose length then counts as the residual.
  subroutine finish(equations, control, state, now)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    type(iterate_t), intent(inout) :: now

    now%z = now%z - now%f
    call residual(equations, control, now%z, now%g, state)
    state%residual = min(state%residual, now%length)
  end subroutine finish

  !> Factorises the Jacobian at the present state and removes the history.
  subroutine renew(equations, control, state, frozen, now)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(iterate_t), intent(inout) :: now

    call freeze(equations, control, state, frozen)
    frozen%excess = 0
    call now%history%forget()
    now%since_renewal = 0
  end subroutine renew

  !> Computes now%f, minus the plain step. If it is much longer than the previous one, the iteration
  !> returns to the best unknowns and renews the factorisation, up to a limited number of times.
  !>
  !> The length of the plain step measures the distance from equilibrium. The residual does not: in
  !> a stiff contact a tiny error of the gap changes the pressure much.
  subroutine take_plain_step(equations, control, state, frozen, now)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(iterate_t), intent(inout) :: now
    real(wp) :: length

    if (.not. frozen%factors%valid) return
    now%f = now%g
    call solve(frozen%factors, now%f)
    length = step_length(now%z, now%f)
    if (length/too_long > now%length .and. now%since_renewal > 0) then
      equations%cost%rejected_steps = equations%cost%rejected_steps + 1
      now%rejections = now%rejections + 1
      if (now%rejections > most_rejections) return
      now%z = now%z_best
      call residual(equations, control, now%z, now%g, state)
      call renew(equations, control, state, frozen, now)
      if (.not. frozen%factors%valid) return
      now%f = now%g
      call solve(frozen%factors, now%f)
      length = step_length(now%z, now%f)
    end if
    if (length < now%shortest) then
      now%shortest = length
      now%z_best = now%z
    end if
    now%length = length
  end subroutine take_plain_step

  !> Moves the unknowns by the accelerated step.
  subroutine advance(equations, depth, control, now)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: depth
    type(control_t), intent(in) :: control
    type(iterate_t), intent(inout) :: now
    real(wp) :: fraction

    if (.not. allocated(now%step)) allocate (now%step(size(now%z)))
    call accelerate(now%history, depth, 1.0_wp, now%z, now%f, now%step)
    fraction = largest_step(equations%problem, control, now%z, now%step)
    now%step = fraction*now%step
    now%z = now%z + now%step
    now%since_renewal = now%since_renewal + 1
    if (control%kind /= at_h0_with_edge) return
    ! The height of the shape is not linear in the scale. The exact nonlinear part of the change,
    ! which is large far out, is added to the step.
    associate (n => size(now%step) - 1, grid => equations%meshes%grid(control%mesh))
      now%z(:n) = now%z(:n) + equations%problem%shape%bend( &
        (now%z(n + 1) - now%step(n + 1))*grid%x(:n), now%step(n + 1)*grid%x(:n))
    end associate
  end subroutine advance

  !> The largest relative change of the unknowns in the step -f.
  pure real(wp) function step_length(z, f)
    real(wp), intent(in) :: z(:), f(:)

    step_length = maxval(abs(f)/(1 + abs(z)))
  end function step_length

end module anderson
