!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes; if their spacing is not small relative to the neck, the edge is pinned between
!> nodes.
module fixed_stepper
  use kinds, only: wp
  use dimensionless_problem, only: calm_gap, over_neck => spacing_over_neck
  use contact_state, only: state_t, undeformed_state
  use contact_scales, only: largest_radius, lost_in_rounding
  use equilibrium, only: control_t
  use fixed_branch, only: continue_to, expected_at, change
  use fixed_jumps, only: follow_to_end, slip_to, jump_to, land, stays, locate_jump
  use ending, only: beyond_rounding
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
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
    type(step_result_t) :: slip
    logical :: slipped

    do
      call step_until_slip(event)
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
    subroutine step_until_slip(event)
      type(step_result_t), intent(out) :: event
      type(state_t) :: state, landed
      real(wp) :: beyond
      logical :: continues, arrived, stalled, has_landed

      slipped = .false.
      if (self%options%stop_on_change) then
        call paper_step(event)
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
        call land(self, h0, position%state, landed, event)
        if (stays(self, position%state, landed, event)) then
          call locate_jump(event, position%state, h0)
          call remember(position, landed, 1, .false.)
          return
        end if
        has_landed = event%converged
      end if
      call follow_to_end(self, h0, position, event, beyond, arrived, stalled)
      if (arrived) return
      if (stalled) then
        ! The iteration does not follow the branch, and no jump was found: it is not known whether a
        ! state at h0 is on this branch.
        call land(self, h0, position%state, landed, event)
        event%converged = .false.
        call remember(position, landed, 1, .true.)
        return
      end if
      if (.not. has_landed) call slip_to(self, beyond, h0, position, event, slipped)
      if (.not. slipped) call jump_to(self, h0, beyond, has_landed, landed, position, event)
    end subroutine step_until_slip

    !> A step of the paper: h0 changes at constant separation, and the iteration continues until the
    !> paper's rule is met. A change of deformation many times that of h0 counts as a jump, which is
    !> located only to within the step.
    subroutine paper_step(event)
      type(step_result_t), intent(out) :: event
      type(state_t) :: state

      state = position%state
      call self%solve(control_t(value=h0), state, event%converged)
      event%jumped = event%converged .and. change(position%state, state) > max(1.0_wp, &
        paper_jump*abs(h0 - position%state%h0))
      call locate_jump(event, position%state, h0)
      call remember(position, state, 1, event%jumped)
    end subroutine paper_step

  end subroutine step_to

end module fixed_stepper
