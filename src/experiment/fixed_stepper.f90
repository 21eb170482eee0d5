!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes; if their spacing is not small relative to the neck, the edge is pinned between
!> nodes.
module fixed_stepper
  use kinds, only: wp
  use dimensionless_problem, only: calm_gap, over_neck => spacing_over_neck
  use contact_state, only: state_t, undeformed_state, radius_of_gap
  use contact_scales, only: largest_radius, lost_in_rounding
  use controls, only: control_t
  use equilibrium, only: holds
  use fixed_branch, only: continue_to, expected_at, change, follow, jump
  use h0_step, only: step_h0
  use ending, only: beyond_rounding, no_equilibrium
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
  use solver_options, only: rescue_of
  use anderson, only: solve_anderson
  use anderson_mixing, only: relax_by_mixing
  use relaxation, only: relax
  implicit none
  private
  public :: fixed_stepper_t

  type, extends(stepper_t) :: fixed_stepper_t
  contains
    procedure :: approach_to
    procedure :: step_to
  end type fixed_stepper_t

  !> Steps of the approach from large separation, in the law's lengths, and their largest number;
  !> for a long approach the steps are longer.
  real(wp), parameter :: approach_step = 0.5_wp
  integer, parameter :: most_approach = 400
  !> Number of consecutive failed steps of the approach after which the rest is one step.
  integer, parameter :: most_lost = 3
  !> With the paper's stopping rule states are not accurate enough for `jump`; a change of this many
  !> times the change of h0 then counts as a jump.
  real(wp), parameter :: paper_jump = 5
  !> A contact edge that is pinned between nodes jumps many times from one to the next; in steps
  !> longer than this (in the law's lengths) these jumps are not located individually.
  real(wp), parameter :: short_step = 0.11_wp
  !> The largest ratio of the spacing to the width of the neck for this: with larger spacing each
  !> jump changes the load noticeably, and the jumps are few.
  real(wp), parameter :: fine_enough = 0.4_wp
  !> Largest number of times that Newton's method helps the iteration in one step.
  integer, parameter :: most_rescues = 5

contains

  subroutine approach_to(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: i, steps, lost

    far = max(h0, calm_gap(self%problem))
    state = undeformed_state(self%problem%shape, self%meshes%grid(1), far, 1.0_wp)
    call self%solve(control_t(value=far), state, event%converged)
    call remember(position, state, 1, .false.)
    steps = ceiling(min((far - h0)/approach_step, real(most_approach, wp)))
    lost = 0
    do i = 1, steps
      call self%step_to(merge(h0, far - (far - h0)*i/steps, lost > most_lost), position, event)
      if (event%ending%early() .or. lost > most_lost) exit
      lost = merge(0, lost + 1, event%converged)
    end do
    event%jumped = .false.
  end subroutine approach_to

  !> Moves to h0. If a pinned contact edge jumps several times, the jump of largest tension is
  !> reported.
  subroutine step_to(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(step_result_t) :: slip, nothing
    logical :: slipped

    do
      event = nothing
      call step_until_slip()
      if (.not. slipped) exit
      if (.not. slip%jumped .or. event%jump_load < slip%jump_load) slip = event
    end do
    if (.not. slip%jumped) return
    if (event%jumped .and. event%jump_load < slip%jump_load) return
    event%jumped = .true.
    event%jump_h0 = slip%jump_h0
    event%jump_load = slip%jump_load
    event%jump_uncertainty = slip%jump_uncertainty

  contains

    !> Moves to h0 or, slipped = .true., to the state in which the edge rests before h0.
    subroutine step_until_slip()
      type(state_t) :: state, landed
      real(wp) :: beyond
      logical :: continues, arrived, stalled, has_landed

      slipped = .false.
      if (self%options%stop_on_change) then
        call paper_step()
        return
      end if
      call continue_to(self, h0, position, expected_at(self, h0, position), state, event, continues)
      if (continues) then
        call remember(position, state, 1, .false.)
        return
      end if
      associate (before => position%state, mesh => self%meshes%grid(1), law => self%problem%law)
        ! No contact is larger than the mesh.
        if (law%adhesion > 0 .and. lost_in_rounding(self%problem, &
          min(largest_radius(self%problem, h0, 0.0_wp), mesh%end))) then
          event%ending%cause = beyond_rounding
          return
        end if
        ! Many jumps of the edge in one step are not located individually.
        has_landed = .not. self%options%mixing .and. abs(h0 - before%h0) > short_step .and. &
          before%axis_gap < law%edge_gap .and. over_neck(self%problem, mesh%spacing) < fine_enough
      end associate
      if (has_landed) then
        call land(h0, position%state, landed)
        if (stays(position%state, landed)) then
          call locate_jump(event, position%state, h0)
          call remember(position, landed, 1, .false.)
          return
        end if
        has_landed = event%converged
      end if
      call follow_to_end(beyond, arrived, stalled)
      if (arrived) return
      if (stalled) then
        ! The iteration does not follow the branch, and no jump was found: it is not known whether a
        ! state at h0 is on this branch.
        call land(h0, position%state, landed)
        event%converged = .false.
        call remember(position, landed, 1, .true.)
        return
      end if
      if (.not. has_landed) call slip_to(beyond)
      if (.not. slipped) call jump_to(beyond, has_landed, landed)
    end subroutine step_until_slip

    !> A step of the paper: h0 changes at constant separation, and the iteration continues until the
    !> paper's rule is met. A change of deformation many times that of h0 counts as a jump, which is
    !> located only to within the step.
    subroutine paper_step()
      type(state_t) :: state

      call step_h0(self, position%state, h0, state, event%converged)
      event%jumped = event%converged .and. change(position%state, state) > max(1.0_wp, &
        paper_jump*abs(h0 - position%state%h0))
      call locate_jump(event, position%state, h0)
      call remember(position, state, 1, event%jumped)
    end subroutine paper_step

    !> Follows the branch towards h0. arrived: the branch reaches h0. stalled: the branch continues,
    !> but the iteration does not converge. Otherwise the branch ends before `beyond`.
    subroutine follow_to_end(beyond, arrived, stalled)
      real(wp), intent(out) :: beyond
      logical, intent(out) :: arrived, stalled
      type(state_t) :: state
      logical :: at_fold
      integer :: rescues

      do rescues = 0, most_rescues
        call follow(self, h0, position, event, beyond, arrived, at_fold)
        stalled = .false.
        if (.not. (arrived .or. at_fold)) stalled = goes_on(beyond, position%state, state)
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
    subroutine slip_to(beyond)
      real(wp), intent(in) :: beyond
      type(state_t) :: landed

      slipped = .false.
      if (.not. position%state%axis_gap < self%problem%law%edge_gap .or. self%options%mixing) return
      call land(beyond, position%state, landed)
      slipped = stays(position%state, landed) .and. abs(beyond - h0) > 0.0_wp
      if (.not. slipped) return
      event%jumped = .true.
      call locate_jump(event, position%state, beyond)
      call remember(position, landed, 1, .true.)
    end subroutine slip_to

    !> From the end of a branch, which is before `beyond`, the bodies jump to the state at h0: to
    !> `landed` if has_landed, otherwise to the result of a relaxation.
    subroutine jump_to(beyond, has_landed, landed)
      real(wp), intent(in) :: beyond
      logical, intent(in) :: has_landed
      type(state_t), intent(inout) :: landed

      event%converged = has_landed
      if (.not. has_landed) call land(h0, position%state, landed)
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

    !> Whether the branch of the state `before` continues to a near h0 at which the iteration did
    !> not converge: by Newton's method, for all choices of the deck. If it does, to `state`, the
    !> iteration has failed; if not, the bodies jump.
    logical function goes_on(h0, before, state) result(found)
      real(wp), intent(in) :: h0
      type(state_t), intent(in) :: before
      type(state_t), intent(out) :: state

      found = .false.
      if (self%options%mixing) return
      state = before
      call solve_anderson(self%equations_t, rescue_of(self%options), self%frozen, &
        control_t(value=h0), state, found)
      call self%frozen%forget()
      found = found .and. change(before, state) <= jump
    end function goes_on

    !> The state to which the bodies relax from `before` at an h0 beyond the end of its branch.
    !> Plain mixing is itself a relaxation.
    subroutine land(h0, before, state)
      real(wp), intent(in) :: h0
      type(state_t), intent(in) :: before
      type(state_t), intent(inout) :: state

      state = before
      if (self%options%is_plain_mixing()) then
        call self%solve(control_t(value=h0), state, event%converged)
        return
      else if (self%options%mixing) then
        call relax_by_mixing(self%equations_t, self%options, control_t(value=h0), state, &
          event%converged)
        return
      end if
      call relax(self%equations_t, self%options, control_t(value=h0), state, event%converged)
      call self%frozen%forget()
    end subroutine land

    !> Whether bodies stayed in contact during a relaxation from one state to another; then any jump
    !> was one of the edge from node to node.
    logical function stays(before, after)
      type(state_t), intent(in) :: before, after
      real(wp) :: from, to

      stays = .false.
      if (.not. event%converged .or. .not. self%problem%law%edge_gap > 0) return
      from = radius_of_gap(self%problem%shape, self%problem%law%edge_gap, self%meshes%grid(1), &
        before)
      to = radius_of_gap(self%problem%shape, self%problem%law%edge_gap, self%meshes%grid(1), after)
      stays = min(from, to) > 0.5_wp*max(from, to)
    end function stays

  end subroutine step_to

  !> Sets the jump from the branch of `before`, which ends between its h0 and `beyond`.
  pure subroutine locate_jump(event, before, beyond)
    type(step_result_t), intent(inout) :: event
    type(state_t), intent(in) :: before
    real(wp), intent(in) :: beyond

    event%jump_h0 = 0.5_wp*(before%h0 + beyond)
    event%jump_load = before%load
    event%jump_uncertainty = 0.5_wp*abs(beyond - before%h0)
  end subroutine locate_jump

end module fixed_stepper
