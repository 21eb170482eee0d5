!> From a trail to the equilibrium at a wanted h0.
module landing
  use kinds, only: wp
  use problem, only: problem_t
  use equilibrium, only: control_t, state_t, cost_t
  use solver_options, only: solver_options_t
  use solver, only: solve_state
  use anderson, only: frozen_t
  use edge_locked, only: mesh_pair_t
  use tracer, only: coordinate_of, move_to_mesh, state_at
  use trail, only: trail_t
  implicit none
  private
  public :: land_between

  !> How near to the wanted h0 (relative, or in the law's lengths) the path is followed before h0
  !> itself is prescribed, and in how many rounds at most.
  real(wp), parameter :: near_enough = 1.0e-4_wp
  integer, parameter :: most_halvings = 40

contains

  !> The state at the h0 that `control` prescribes, between the neighbours upper - 1 and upper of a
  !> trail: by bisection along the path, on which every state converges, then at h0 itself.
  subroutine land_between(this, pair, control, options, frozen, trail, upper, state, converged, &
    cost)
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    type(control_t), intent(in) :: control
    type(solver_options_t), intent(in) :: options
    type(frozen_t), intent(inout) :: frozen
    type(trail_t), intent(in) :: trail
    integer, intent(in) :: upper
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged
    type(cost_t), intent(inout) :: cost
    type(state_t) :: ends(2)
    real(wp) :: s(2), at, fraction, h0
    integer :: mesh, side, round

    h0 = control%value
    mesh = trail%mesh(upper)
    ends = trail%state(upper - 1:upper)
    s = trail%coordinate(upper - 1:upper)
    if (trail%mesh(upper - 1) /= mesh) then
      call move_to_mesh(this, pair, trail%mesh(upper - 1), mesh, options, frozen, ends(1), &
        converged, cost)
      s(1) = coordinate_of(this, mesh, ends(1))
      if (.not. converged) ends(1) = ends(2)
    end if
    do round = 1, most_halvings
      if (minval(abs(ends%h0 - h0)) <= near_enough*max(1.0_wp, abs(h0))) exit
      fraction = (h0 - ends(1)%h0)/(ends(2)%h0 - ends(1)%h0)
      ! Every third time halfway, for regula falsi may approach from one side only.
      if (mod(round, 3) == 0) fraction = 0.5_wp
      at = s(1) + min(max(fraction, 0.05_wp), 0.95_wp)*(s(2) - s(1))
      call state_at(this, pair, mesh, at, s, ends, options, frozen, state, &
        converged, cost)
      if (.not. converged) exit
      side = merge(1, 2, (state%h0 - h0)*(ends(1)%h0 - h0) > 0)
      ends(side) = state
      s(side) = at
    end do
    side = merge(1, 2, abs(ends(1)%h0 - h0) < abs(ends(2)%h0 - h0))
    state = ends(side)
    frozen%factors%valid = .false.
    call solve_state(this, pair%grid(mesh), control, options, &
      frozen, state, converged, cost)
  end subroutine land_between

end module landing
