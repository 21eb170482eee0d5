!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes; if their spacing is not small relative to the cohesive zone, the edge is pinned
!> between nodes.
!>
!> The deck's iteration solves the rows. A jump is a fold between two rows that converged
!> (`fixed_motion`); rows that did not converge show neither a jump nor the end of a branch.
module fixed_stepper
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: calm_gap
  use contact_state, only: state_t, undeformed_state
  use controls, only: control_t
  use fixed_branch, only: change, same_state, expected_at
  use h0_step, only: step_h0
  use fixed_motion, only: advance, has_fallen, known_tangent, is_joined
  use branch_tangent, only: branch_tangent_t
  use reported_place, only: place_without_state, of_h0
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember, move_to
  use solver_options, only: solver_options_t, usual_tolerance
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
  !> With the paper's stopping rule states are not accurate enough for a search for folds. Then a
  !> change of deformation above the law's length, and above this many times the change of h0,
  !> counts as a jump.
  real(wp), parameter :: paper_jump = 5

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
    call take(position, state, event%converged)
    steps = ceiling(min((far - h0)/approach_step, real(most_approach, wp)))
    lost = 0
    do i = 1, steps
      call self%step_to(merge(h0, far - (far - h0)*i/steps, lost > most_lost), position, event)
      if (event%ending%early() .or. lost > most_lost) exit
      lost = merge(0, lost + 1, event%converged)
    end do
    ! An experiment that begins in contact has lost energy before.
    if (.not. ieee_is_nan(position%lost)) then
      if (abs(position%lost) > 0) position%lost = nan
    end if
    event%jumped = .false.
    event%unsure = .false.
  end subroutine approach_to

  subroutine step_to(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event

    ! After a turn of the experiment, states before the rows that did not converge are no longer
    ! relevant.
    if (position%held > 0 .and. .not. is_equilibrium(position)) then
      associate (last => position%state%h0, known => position%h0(position%held))
        if ((last - known)*(h0 - last) <= 0) position%held = 0
      end associate
    end if
    if (self%options%stop_on_change) then
      call paper_step(self, h0, position, event)
    else if (self%options%mixing) then
      call mixing_step(self, h0, position, event)
    else
      call move(self, h0, position, event)
    end if
  end subroutine step_to

  !> A step of the paper: h0 changes at constant separation, and the iteration continues until the
  !> paper's rule is met. A jump is located only to within the step.
  subroutine paper_step(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(state_t) :: state

    call step_h0(self, position%state, h0, state, event%converged)
    associate (before => position%state)
      event%jumped = event%converged .and. change(before, state) > max(1.0_wp, &
        paper_jump*abs(h0 - before%h0))
      event%jump = place_without_state(0.5_wp*(before%h0 + h0), before%load)
      event%jump%left(of_h0) = 0.5_wp*abs(h0 - before%h0)
      if (event%jumped) event%before = event%jump
      position%lost = nan
    end associate
    call remember(position, state, 1, event%jumped)
  end subroutine paper_step

  !> A step by mixing. If it converges, the bodies are also moved from the last row that converged,
  !> since mixing does not distinguish a jump from a branch that continues. Plain mixing begins at
  !> constant separation and is itself a relaxation, which gives the state after a jump; accelerated
  !> mixing is no relaxation.
  subroutine mixing_step(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(branch_point_t) :: moved
    type(branch_tangent_t) :: tangent
    type(state_t) :: state
    logical :: joined

    if (position%held > 1) then
      call step_h0(self, position%state, h0, state, event%converged, expected_at(self, h0, &
        position))
    else
      call step_h0(self, position%state, h0, state, event%converged)
    end if
    if (position%held == 0 .or. .not. (event%converged .or. has_fallen(self, state))) then
      event%unsure = event%converged
      event%unsure_from = position%state%h0
      if (event%unsure) position%lost = nan
      call take(position, state, event%converged)
      return
    end if
    joined = event%converged .and. is_equilibrium(position)
    if (joined) then
      call known_tangent(self, position%state, tangent)
      joined = is_joined(self, tangent, position%state, state)
    end if
    if (.not. joined) then
      moved = position
      call move(self, h0, moved, event)
      if (event%ending%early()) return
      ! If the branch continues, the state is on it; if it ends, mixing gives the state after the
      ! jump.
      joined = .not. event%jumped .and. .not. event%unsure
      position%lost = moved%lost
      position%lost_error = moved%lost_error
      if (change(state, moved%state) > same_state) position%lost = nan
      if (joined .or. .not. (self%options%is_plain_mixing() .or. event%unsure)) state = moved%state
      event%converged = .true.
    end if
    call remember(position, state, 1, .not. joined)
  end subroutine mixing_step

  !> Moves to h0 from the last row that converged, by way of the rows that did not.
  subroutine move(self, h0, position, event)
    class(fixed_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(solver_options_t) :: options
    type(state_t) :: state
    real(wp) :: by_way_of

    options = self%options
    if (options%mixing) options = solver_options_t()
    options%tolerance = min(usual_tolerance, self%options%tolerance)
    if (position%held > 0 .and. .not. is_equilibrium(position)) then
      by_way_of = position%state%h0
      position%state = position%past(position%held)
      call advance(self, options, by_way_of, position, event)
      if (event%ending%early()) return
    end if
    if (position%held > 0) then
      call advance(self, options, h0, position, event)
      return
    end if
    state = position%state
    event%unsure_from = state%h0
    call self%solve(control_t(value=h0), state, event%converged)
    event%unsure = event%converged
    if (event%unsure) position%lost = nan
    call take(position, state, event%converged)
  end subroutine move

  !> Makes a state without predecessor the state of the position.
  subroutine take(position, state, converged)
    type(branch_point_t), intent(inout) :: position
    type(state_t), intent(in) :: state
    logical, intent(in) :: converged

    if (converged) then
      call remember(position, state, 1, .false.)
    else
      call move_to(position, state)
    end if
  end subroutine take

  !> Whether the state of a position is the last one that converged.
  pure logical function is_equilibrium(position)
    type(branch_point_t), intent(in) :: position

    is_equilibrium = position%held > 0
    if (is_equilibrium) is_equilibrium = position%past_number(position%held) == position%number
  end function is_equilibrium

end module fixed_stepper
