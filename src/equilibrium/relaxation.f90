!> Relaxation of bodies out of equilibrium: dh/dtau = -G at fixed h0, by implicit steps that become
!> longer as the residual decreases; the last steps are Newton steps. After a jump the bodies relax
!> to the state that a quasi-static experiment would reach; they leave unstable equilibria.
module relaxation
  use kinds, only: wp
  use contact_state, only: state_t
  use controls, only: control_t, at_h0
  use equilibrium, only: equations_t, residual, largest_step, holds
  use jacobian, only: factorise_jacobian
  use linear_algebra, only: factorisation_t, solve, determinant_sign
  use solver_options, only: solver_options_t
  implicit none
  private
  public :: relax

  !> Largest number of steps of pseudo-time. Number of factorisations that is always allowed; a
  !> contact edge that moves over a hundred cohesive zones needs about 200. Limit of the further
  !> factorisations, in cubes of the matrix's order (about ten seconds).
  integer, parameter :: most_steps = 2000, few_factorisations = 500
  real(wp), parameter :: most_cubes = 1.0e11_wp
  !> First step of pseudo-time (the stiffest modes relax in less than one unit), its largest growth,
  !> its shortening, and its limits. A growing residual, for example while bodies separate, does not
  !> shorten a step below the usual one; an unstable mode does. Size of the perturbation of an
  !> unstable equilibrium, in the law's lengths.
  real(wp), parameter :: first_step = 1, growth = 3, shortening = 0.1_wp, usual_step = 0.3_wp, &
    shortest_step = 1.0e-3_wp, longest_step = 1.0e12_wp, nudge = 1.0e-4_wp
  !> The residual before the first step is unknown.
  real(wp), parameter :: unknown = 1.0e100_wp
  !> Steps may grow until the gaps change by this much in a step, in the law's lengths, even if the
  !> residual does not decrease.
  real(wp), parameter :: travel = 0.3_wp

contains

  !> Relaxes `state` to a stable equilibrium at the prescribed H0 (control kind at_h0).
  subroutine relax(equations, options, control, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(control_t), intent(in) :: control
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    type(factorisation_t) :: factors
    real(wp), allocatable :: z(:), g(:), dz(:)
    real(wp) :: dtau, before, moved, apart, allowed
    integer :: step, began

    converged = .false.
    if (control%kind /= at_h0) return
    z = state%gap
    apart = minval(z)
    allocate (g(size(z)))
    dtau = first_step
    before = unknown
    moved = unknown
    began = int(equations%cost%factorisations)
    allowed = max(real(few_factorisations, wp), most_cubes/real(size(z), wp)**3)
    do step = 1, most_steps
      if (equations%cost%factorisations - began >= allowed) return
      call residual(equations, control, z, g, state)
      equations%cost%iterations = equations%cost%iterations + 1
      state%iterations = step
      if (.not. state%residual < huge(1.0_wp)) return
      if (minval(z) < equations%problem%law%fallen_below(apart)) return
      if (holds(equations%problem, options%tolerance, state)) then
        call factorise_jacobian(equations, control, state, factors)
        if (.not. factors%valid) return
        converged = determinant_sign(factors) > 0
        if (converged) return
        ! No force drives the bodies from an unstable equilibrium: they are perturbed towards each
        ! other.
        z = z - nudge
        dtau = first_step
        before = unknown
        cycle
      end if
      dtau = dtau*min(growth, max(before/state%residual, travel/moved))
      dtau = min(max(dtau, usual_step), longest_step)
      before = state%residual
      do
        call factorise_jacobian(equations, control, state, factors, 1/dtau)
        if (.not. factors%valid) return
        ! A longer step would climb an unstable mode instead of leaving it.
        if (determinant_sign(factors) > 0 .or. dtau <= shortest_step) exit
        dtau = shortening*dtau
      end do
      dz = -g
      call solve(factors, dz)
      dz = largest_step(equations%problem, control, z, dz)*dz
      z = z + dz
      moved = max(maxval(abs(dz)), tiny(1.0_wp)/epsilon(1.0_wp))
    end do
  end subroutine relax

end module relaxation
