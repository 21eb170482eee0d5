!> Moves bodies in equilibrium from one h0 to another on a mesh fixed in space. They follow a
!> branch, relax from its end to another branch, and so on. The end of a branch depends neither on
!> the steps of the experiment nor on the iteration (`branch_end`).
module fixed_motion
  use kinds, only: wp, nan
  use dimensionless_problem, only: over_neck => spacing_over_neck
  use contact_state, only: state_t, radius_of_gap
  use contact_scales, only: largest_radius, lost_in_rounding
  use controls, only: control_t
  use fixed_branch, only: expected_at, is_expected, is_pinned, change
  use branch_tangent, only: branch_tangent_t, tangent_at, has_factors_at, joins
  use branch_end, only: follow, arrived, at_fold
  use ending, only: beyond_rounding, no_equilibrium
  use potential_energy, only: energy_of
  use reported_place, only: place_t, of_h0, of_load
  use relaxation, only: relax
  use solver_options, only: solver_options_t
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember, move_to
  implicit none
  private
  public :: advance, has_fallen, known_tangent, is_joined

  !> Distance beyond a fold at which the relaxation begins, in the law's lengths.
  real(wp), parameter :: beyond_fold = 1.0e-3_wp
  !> A change of the deformation below this cannot contain a jump: near a pair of folds the
  !> deformation changes by a fifth of the law's length while h0 changes by a hundredth of it.
  real(wp), parameter :: unnoticed = 0.02_wp
  !> A contact edge that is pinned between nodes slips many times from node to node; in steps longer
  !> than this (in the law's lengths) these slips are not located individually.
  real(wp), parameter :: short_step = 0.11_wp
  !> If the spacing exceeds this fraction of the width of the cohesive zone, slips are located
  !> individually in all steps: each slip then changes the load noticeably, and the slips are few.
  real(wp), parameter :: fine_enough = 0.4_wp

contains

  !> Moves the position, whose state is an equilibrium, to h0. event%converged: the state at h0 is
  !> an equilibrium too.
  subroutine advance(self, options, h0, position, event)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    logical :: resting

    resting = .true.
    do while (resting)
      call advance_to_jump(self, options, h0, position, event, resting)
    end do
  end subroutine advance

  !> Moves to h0 or, resting = .true., to the state in which the bodies come to rest after a jump
  !> before h0.
  subroutine advance_to_jump(self, options, h0, position, event, resting)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    logical, intent(out) :: resting
    type(branch_tangent_t) :: tangent
    type(state_t) :: expected, state, last, nearest
    type(place_t) :: fold
    integer :: outcome
    logical :: solved, stayed

    resting = .false.
    call known_tangent(self, position%state, tangent)
    expected = expected_at(self, h0, position)
    state = expected
    ! A single state is not enough for an extrapolation.
    if (position%held == 1) state = position%state
    call self%correct(control_t(value=h0), state, solved, options)
    event%converged = solved
    if (solved) then
      if (continues()) then
        call remember(position, state, 1, .false.)
        return
      end if
    end if
    associate (mesh => self%meshes%grid(1), law => self%problem%law)
      ! No contact is larger than the mesh.
      if (law%adhesion > 0 .and. lost_in_rounding(self%problem, &
        min(largest_radius(self%problem, h0, 0.0_wp), mesh%end))) then
        event%ending%cause = beyond_rounding
        return
      end if
      ! Many slips of the edge in one step are not located individually.
      if (is_pinned(self) .and. abs(h0 - position%state%h0) > short_step .and. &
        position%state%axis_gap < law%edge_gap .and. &
        over_neck(self%problem, mesh%spacing) < fine_enough) then
        call relax_at(self, options, h0, position%state, state, event%converged)
        stayed = .false.
        if (event%converged) stayed = stays(self, position%state, state)
        if (stayed) then
          event%jagged = .true.
          position%lost = nan
          call remember(position, state, 1, .false.)
          return
        end if
      end if
    end associate
    call follow(self, options, h0, position, outcome, last, fold, nearest)
    ! These factors are of another coordinate than h0.
    call self%frozen%forget()
    select case (outcome)
    case (arrived)
      event%converged = .true.
      call remember(position, last, 1, .false.)
    case (at_fold)
      call leave(self, options, h0, last, fold, nearest, position, event, resting)
    case default
      event%unsure = .true.
      event%unsure_from = position%state%h0
      position%lost = nan
      call relax_at(self, options, h0, position%state, state, event%converged)
      call land(self, state, event%converged, position, event)
    end select

  contains

    logical function continues()
      continues = is_joined(self, tangent, position%state, state)
      if (continues .and. is_pinned(self)) then
        continues = is_expected(position%state, expected, state)
        if (position%held == 1) continues = change(expected, state) <= abs(h0 - position%state%h0)
      end if
    end function continues

  end subroutine advance_to_jump

  !> Jumps from a fold before h0, and rests beyond it or at h0. last: the last state before the
  !> fold; nearest: the state nearest to it.
  subroutine leave(self, options, h0, last, fold, nearest, position, event, resting)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: last, nearest
    type(place_t), intent(in) :: fold
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    logical, intent(out) :: resting
    type(state_t) :: landed
    real(wp) :: beyond
    logical :: slips

    associate (way => h0 - fold%at(of_h0))
      beyond = fold%at(of_h0) + sign(min(beyond_fold, abs(way)), way)
    end associate
    call relax_at(self, options, beyond, last, landed, event%converged)
    if (.not. (event%converged .or. has_fallen(self, landed))) then
      beyond = h0
      call relax_at(self, options, beyond, last, landed, event%converged)
    end if
    slips = event%converged .and. is_pinned(self)
    if (slips) slips = stays(self, last, landed)
    event%slipped = event%slipped .or. slips
    if (fold%at(of_load) < event%before%at(of_load)) event%before = fold
    if (.not. (slips .or. event%jumped)) then
      event%jumped = .true.
      event%jump = fold
    end if
    call lose_energy(self, options, fold, nearest, landed, position)
    call land(self, landed, event%converged, position, event)
    resting = event%converged .and. abs(beyond - h0) > 0
  end subroutine leave

  !> Adds the energy that bodies lose in a jump from a fold: the difference between the energies of
  !> both states at the h0 of the fold. This energy is not known if the branch after the jump does
  !> not extend back to this h0.
  subroutine lose_energy(self, options, fold, nearest, landed, position)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    type(place_t), intent(in) :: fold
    type(state_t), intent(in) :: nearest, landed
    type(branch_point_t), intent(inout) :: position
    type(state_t) :: after
    real(wp) :: energy(2), error(2)
    logical :: good

    after = landed
    call self%correct(control_t(value=fold%at(of_h0)), after, good, options)
    if (good) good = change(landed, after) <= 2*unnoticed
    call self%frozen%forget()
    if (.not. good) then
      position%lost = nan
      return
    end if
    call energy_of(self%equations_t, 1, nearest, energy(1), error(1))
    call energy_of(self%equations_t, 1, after, energy(2), error(2))
    position%lost = position%lost + energy(1) - energy(2)
    position%lost_error = position%lost_error + sum(error) + &
      fold%left(of_h0)*abs(fold%at(of_load) - after%load)
  end subroutine lose_energy

  !> Makes the result of a relaxation the state of the position.
  subroutine land(self, landed, converged, position, event)
    class(stepper_t), intent(in) :: self
    type(state_t), intent(in) :: landed
    logical, intent(in) :: converged
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event

    if (converged) then
      call remember(position, landed, 1, .true.)
      return
    end if
    ! Bodies collapse where nothing repels them.
    if (has_fallen(self, landed)) event%ending%cause = no_equilibrium
    position%held = 0
    call move_to(position, landed)
  end subroutine land

  !> The tangent at a state, if there are factors of its Jacobian; otherwise tangent%regular is
  !> .false.
  subroutine known_tangent(self, state, tangent)
    class(stepper_t), intent(inout) :: self
    type(state_t), intent(in) :: state
    type(branch_tangent_t), intent(out) :: tangent

    if (has_factors_at(self%frozen, control_t(value=state%h0), state)) &
      call tangent_at(self, control_t(value=state%h0), state, tangent)
  end subroutine known_tangent

  !> Whether a state is on the same stable branch as the one before it. tangent: of the previous
  !> state; it is not used if it is not regular.
  logical function is_joined(self, tangent, before, state) result(joined)
    class(stepper_t), intent(inout) :: self
    type(branch_tangent_t), intent(inout) :: tangent
    type(state_t), intent(in) :: before, state
    type(branch_tangent_t) :: ahead

    joined = change(before, state) <= unnoticed
    if (joined) return
    if (.not. tangent%regular) call tangent_at(self, control_t(value=before%h0), before, tangent)
    call tangent_at(self, control_t(value=state%h0), state, ahead)
    if (.not. (tangent%regular .and. ahead%regular)) return
    joined = tangent%stable .and. ahead%stable
    if (joined) joined = joins(before, tangent, state, ahead)
  end function is_joined

  !> Relaxes bodies at h0 from a state.
  subroutine relax_at(self, options, h0, from, state, converged)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: from
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged

    state = from
    call relax(self%equations_t, options, control_t(value=h0), state, converged)
    call self%frozen%forget()
  end subroutine relax_at

  !> Whether bodies have fallen onto each other.
  pure logical function has_fallen(self, state)
    class(stepper_t), intent(in) :: self
    type(state_t), intent(in) :: state

    has_fallen = self%problem%law%falls_below > 0 .and. &
      any(state%gap < self%problem%law%falls_below)
  end function has_fallen

  !> Whether bodies stayed in contact during a relaxation from one state to another; on a mesh that
  !> pins the edge, the edge then slipped from node to node.
  logical function stays(self, before, after)
    class(stepper_t), intent(in) :: self
    type(state_t), intent(in) :: before, after
    real(wp) :: from, to

    stays = .false.
    associate (problem => self%problem, mesh => self%meshes%grid(1))
      if (.not. problem%law%edge_gap > 0) return
      from = radius_of_gap(problem%shape, problem%law%edge_gap, mesh, before)
      to = radius_of_gap(problem%shape, problem%law%edge_gap, mesh, after)
    end associate
    stays = min(from, to) > 0.5_wp*max(from, to)
  end function stays

end module fixed_motion
