!> The end of a branch on a mesh fixed in space, and the jump of the bodies from there.
module fixed_jumps
  use kinds, only: wp
  use contact_state, only: state_t, radius_of_gap
  use equilibrium, only: control_t, holds
  use solver_options, only: rescue_of
  use anderson, only: solve_anderson
  use relaxation, only: relax
  use ending, only: no_equilibrium
  use fixed_branch, only: follow, change, jump
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
  implicit none
  private
  public :: follow_to_end, slip_to, jump_to, land, stays, locate_jump

  !> Largest number of times that Newton's method helps the iteration in one step.
  integer, parameter :: most_rescues = 5

contains

  !> Follows the branch towards h0. arrived: the branch reaches h0. stalled: the branch continues,
  !> but the iteration does not converge. Otherwise the branch ends before `beyond`.
  subroutine follow_to_end(self, h0, position, event, beyond, arrived, stalled)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    real(wp), intent(out) :: beyond
    logical, intent(out) :: arrived, stalled
    type(state_t) :: state
    logical :: at_fold
    integer :: rescues

    do rescues = 0, most_rescues
      call follow(self, h0, position, event, beyond, arrived, at_fold)
      stalled = .false.
      if (.not. (arrived .or. at_fold)) stalled = goes_on(self, beyond, position%state, state)
      if (.not. stalled) return
      ! Near its end a branch turns sharply, and another attempt may succeed.
      call remember(position, state, 1, .false.)
      event%converged = .true.
      arrived = abs(beyond - h0) <= 0.0_wp
      if (arrived) return
    end do
  end subroutine follow_to_end

  !> Relaxes from the end of a branch to a state in which the edge, pinned at the next nodes, may
  !> rest before h0, after which the tension can increase again.
  subroutine slip_to(self, beyond, h0, position, event, slipped)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: beyond, h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    logical, intent(out) :: slipped
    type(state_t) :: landed

    slipped = .false.
    if (.not. position%state%axis_gap < self%problem%law%edge_gap .or. self%options%mixing) return
    call land(self, beyond, position%state, landed, event)
    slipped = stays(self, position%state, landed, event) .and. abs(beyond - h0) > 0.0_wp
    if (.not. slipped) return
    event%jumped = .true.
    call locate_jump(event, position%state, beyond)
    call remember(position, landed, 1, .true.)
  end subroutine slip_to

  !> From the end of a branch, which is before `beyond`, the bodies jump to the state at h0: to
  !> `landed` if has_landed, otherwise to the result of a relaxation.
  subroutine jump_to(self, h0, beyond, has_landed, landed, position, event)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0, beyond
    logical, intent(in) :: has_landed
    type(state_t), intent(inout) :: landed
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event

    event%converged = has_landed
    if (.not. has_landed) call land(self, h0, position%state, landed, event)
    associate (before => position%state, law => self%problem%law)
      ! A jump must start from an equilibrium.
      event%jumped = event%converged .and. change(before, landed) > jump .and. &
        holds(self%problem, self%options%tolerance, before)
      if (.not. event%converged .and. law%falls_below > 0 .and. &
        any(landed%gap < law%falls_below)) then
        ! Bodies collapse where nothing repels them.
        event%jumped = .true.
        event%ending%cause = no_equilibrium
      end if
      call locate_jump(event, before, beyond)
    end associate
    call remember(position, landed, 1, event%jumped)
  end subroutine jump_to

  !> Sets the jump from the branch of `before`, which ends between its h0 and `beyond`.
  pure subroutine locate_jump(event, before, beyond)
    type(step_result_t), intent(inout) :: event
    type(state_t), intent(in) :: before
    real(wp), intent(in) :: beyond

    event%jump_h0 = 0.5_wp*(before%h0 + beyond)
    event%jump_load = before%load
    event%jump_uncertainty = 0.5_wp*abs(beyond - before%h0)
  end subroutine locate_jump

  !> Whether the branch of the state `before` continues to a near h0 at which the iteration did not
  !> converge: by Newton's method, for all choices of the deck. If it does, to `state`, the
  !> iteration has failed; if not, the bodies jump.
  logical function goes_on(self, h0, before, state)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(out) :: state

    goes_on = .false.
    if (self%options%mixing) return
    state = before
    call solve_anderson(self%equations_t, rescue_of(self%options), self%frozen, &
      control_t(value=h0), state, goes_on)
    call self%frozen%forget()
    goes_on = goes_on .and. change(before, state) <= jump
  end function goes_on

  !> The state to which the bodies relax from `before` at an h0 beyond the end of its branch. Mixing
  !> is itself a relaxation.
  subroutine land(self, h0, before, state, event)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(inout) :: state
    type(step_result_t), intent(inout) :: event

    state = before
    if (self%options%mixing) then
      call self%solve(control_t(value=h0), state, event%converged)
      return
    end if
    call relax(self%equations_t, self%options, control_t(value=h0), state, event%converged)
    call self%frozen%forget()
  end subroutine land

  !> Whether bodies stayed in contact during a relaxation from one state to another; then any jump
  !> was one of the edge from node to node.
  logical function stays(self, before, after, event)
    class(stepper_t), intent(in) :: self
    type(state_t), intent(in) :: before, after
    type(step_result_t), intent(in) :: event
    real(wp) :: from, to

    stays = .false.
    if (.not. event%converged .or. .not. self%problem%law%edge_gap > 0) return
    from = radius_of_gap(self%problem%shape, self%problem%law%edge_gap, self%meshes%grid(1), before)
    to = radius_of_gap(self%problem%shape, self%problem%law%edge_gap, self%meshes%grid(1), after)
    stays = min(from, to) > 0.5_wp*max(from, to)
  end function stays

end module fixed_jumps
