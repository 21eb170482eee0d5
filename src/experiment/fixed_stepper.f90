!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes, and where they are not close against the neck it is pinned between them.
module fixed_stepper
  use kinds, only: wp
  use dimensionless_problem, only: calm_gap, over_neck => spacing_over_neck
  use equilibrium, only: control_t, state_t, state_from, holds, radius_of_gap, &
    lost_in_rounding
  use solver_options, only: solver_options_t, newton_of
  use anderson, only: solve_anderson
  use relaxation, only: relax
  use fixed_branch, only: fixed_branch_t, change, jump
  use contact_scales, only: largest_radius
  use ending, only: touching, beyond_rounding, no_equilibrium
  use stepper, only: branch_point_t, step_result_t, remember
  implicit none
  private
  public :: fixed_stepper_t

  type, extends(fixed_branch_t) :: fixed_stepper_t
  contains
    procedure :: approach_to
    procedure :: step_to
    procedure, private :: stays
    procedure, private :: land
    procedure, private :: goes_on
    procedure, private :: paper_step
  end type fixed_stepper_t

  !> Steps of the approach from afar, in the law's lengths, and the most of them: where the way is
  !> long they are longer.
  real(wp), parameter :: approach_step = 0.5_wp
  integer, parameter :: most_approach = 400
  !> Steps of the approach in a row that may fail; after them what is left of the way is one step.
  integer, parameter :: most_lost = 3
  !> Newton's method needs few iterations, or is not going to arrive.
  integer, parameter :: newton_iterations = 12
  !> How often Newton's method may help the iteration on in a step before that is said to fail.
  integer, parameter :: most_rescues = 5
  !> With the paper's stopping rule states are not exact enough for `jump`; this many times the
  !> change of h0 then counts as one.
  real(wp), parameter :: paper_jump = 5
  !> Where the contact edge is caught between nodes it jumps from one to the next many times; in
  !> steps longer than this (in the law's lengths) these jumps are not located one by one.
  real(wp), parameter :: short_step = 0.11_wp
  !> The largest spacing over the width of the neck for that: beyond it each jump tells in the
  !> load, and there are few.
  real(wp), parameter :: fine_enough = 0.4_wp

contains

  subroutine approach_to(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: i, steps, lost

    if (self%problem%rigid .and. h0 < self%problem%law%smallest_gap) then
      event%ending%cause = touching
      return
    end if
    far = h0
    if (.not. self%problem%rigid) far = max(h0, calm_gap(self%problem))
    state = state_from(self%pair%grid(1)%nodes)
    state%h0 = far
    state%axis_gap = far
    state%gap = far + 0.5_wp*self%pair%grid(1)%x**2
    call self%solve_at(far, state, event)
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

  recursive subroutine step_to(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state, before, landed
    real(wp) :: beyond, jump_h0, jump_uncertainty
    logical :: continues, stalled, arrived, at_fold, has_landed
    integer :: rescues

    if (self%problem%rigid .and. h0 < self%problem%law%smallest_gap) then
      event%ending%cause = touching
      return
    end if
    if (self%options%stop_on_change) then
      call self%paper_step(h0, position, event)
      return
    end if
    call self%continue_to(h0, position, self%expected_at(h0, position), state, event, continues)
    if (continues) then
      call remember(position, state, 1, .false.)
      return
    end if
    ! No contact is larger than the mesh.
    if (self%problem%law%adhesion > 0 .and. lost_in_rounding(self%problem, &
      min(largest_radius(self%problem, h0, 0.0_wp), self%pair%grid(1)%end))) then
      event%ending%cause = beyond_rounding
      return
    end if
    has_landed = self%options%method /= 'mixing' .and. &
      abs(h0 - position%state%h0) > short_step .and. &
      position%state%axis_gap < self%problem%law%edge_gap .and. &
      over_neck(self%problem, self%pair%grid(1)%spacing) < fine_enough
    if (has_landed) then
      call self%land(h0, position%state, landed, event)
      if (self%stays(position%state, landed, event)) then
        event%jump_h0 = 0.5_wp*(position%state%h0 + h0)
        event%jump_uncertainty = 0.5_wp*abs(h0 - position%state%h0)
        call remember(position, landed, 1, .false.)
        return
      end if
      has_landed = event%converged
    end if
    do rescues = 0, most_rescues
      call self%follow(h0, position, event, beyond, arrived, at_fold)
      if (arrived) return
      stalled = .false.
      if (.not. at_fold) stalled = self%goes_on(beyond, position%state, state)
      if (.not. stalled) exit
      ! Near its end a branch turns sharply, and is worth another try.
      call remember(position, state, 1, .false.)
      event%converged = .true.
      if (abs(beyond - h0) <= 0.0_wp) return
    end do

    before = position%state
    if (stalled) then
      ! The iteration does not follow the branch, and no jump has been seen: whether what is found
      ! at h0 is on this branch nobody knows.
      call self%land(h0, before, landed, event)
      event%converged = .false.
      call remember(position, landed, 1, .true.)
      return
    end if
    if (.not. has_landed .and. before%axis_gap < self%problem%law%edge_gap .and. &
      self%options%method /= 'mixing') then
      ! Held by the next nodes the edge may come to rest before h0, and the tension grow again.
      call self%land(beyond, before, landed, event)
      if (self%stays(before, landed, event) .and. abs(beyond - h0) > 0.0_wp) then
        jump_h0 = 0.5_wp*(before%h0 + beyond)
        jump_uncertainty = 0.5_wp*abs(beyond - before%h0)
        call remember(position, landed, 1, .true.)
        call self%step_to(h0, position, event)
        if (event%jumped .and. event%jump_load < before%load) return
        event%jumped = .true.
        event%jump_h0 = jump_h0
        event%jump_load = before%load
        event%jump_uncertainty = jump_uncertainty
        return
      end if
    end if
    ! From the end of the branch the bodies go to where they went from before it.
    event%converged = has_landed
    if (.not. has_landed) call self%land(h0, before, landed, event)
    ! From where there was no equilibrium nothing jumps.
    event%jumped = event%converged .and. change(before, landed) > jump .and. &
      holds(self%problem, self%options%tolerance, before)
    if (.not. event%converged .and. self%problem%law%adhesion > 0 .and. &
      .not. self%problem%law%edge_gap > 0) then
      ! Nothing stops the fall of bodies that only attract.
      event%jumped = .true.
      event%ending%cause = no_equilibrium
    end if
    event%jump_h0 = 0.5_wp*(before%h0 + beyond)
    event%jump_load = before%load
    event%jump_uncertainty = 0.5_wp*abs(beyond - before%h0)
    call remember(position, landed, 1, event%jumped)
  end subroutine step_to

  !> Whether the branch of the state `before` goes on to an h0 close by, where the iteration has not
  !> found it: by Newton's method, whatever the deck says of iterations. Where it does, to `state`,
  !> the iteration has failed; where not, the bodies jump.
  logical function goes_on(self, h0, before, state)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(out) :: state
    type(solver_options_t) :: newton

    goes_on = .false.
    if (self%options%method == 'mixing') return
    newton = newton_of(self%options)
    newton%most_iterations = newton_iterations
    state = before
    self%frozen%factors%valid = .false.
    call solve_anderson(self%equations_t, newton, self%frozen, control_t(value=h0), state, goes_on)
    self%frozen%factors%valid = .false.
    goes_on = goes_on .and. change(before, state) <= jump
  end function goes_on

  !> Whether bodies that came from one state to the other by relaxation stayed in contact:
  !> whatever jump there was on the way was one of the edge, from node to node.
  logical function stays(self, before, after, event)
    class(fixed_stepper_t), intent(in) :: self
    type(state_t), intent(in) :: before, after
    type(step_result_t), intent(in) :: event
    real(wp) :: from, to

    stays = .false.
    if (.not. event%converged .or. .not. self%problem%law%edge_gap > 0) return
    from = radius_of_gap(self%problem%law%edge_gap, self%pair%grid(1), before)
    to = radius_of_gap(self%problem%law%edge_gap, self%pair%grid(1), after)
    stays = min(from, to) > 0.5_wp*max(from, to)
  end function stays

  !> A step as the paper takes it: h0 changes at constant separation, and the iteration goes on
  !> until its own rule is met. A jump is a change of deformation many times that of h0, and is
  !> known only to have happened within the step.
  subroutine paper_step(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state

    state = position%state
    call self%solve_at(h0, state, event)
    associate (before => position%state)
      event%jumped = event%converged .and. &
        change(before, state) > max(1.0_wp, paper_jump*abs(h0 - before%h0))
      event%jump_h0 = 0.5_wp*(before%h0 + h0)
      event%jump_load = before%load
      event%jump_uncertainty = 0.5_wp*abs(h0 - before%h0)
    end associate
    call remember(position, state, 1, event%jumped)
  end subroutine paper_step

  !> Where the bodies go from the state `before` when h0 is changed to a value at which its branch
  !> has ended. Mixing relaxes by itself.
  subroutine land(self, h0, before, state, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(inout) :: state
    type(step_result_t), intent(inout) :: event

    state = before
    if (self%options%method == 'mixing') then
      call self%solve_at(h0, state, event)
      return
    end if
    call relax(self%equations_t, self%options, control_t(value=h0), state, event%converged)
    self%frozen%factors%valid = .false.
  end subroutine land

end module fixed_stepper
