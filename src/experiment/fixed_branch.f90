!> One branch of equilibria on a mesh fixed in space: the next state of the branch, and its end.
module fixed_branch
  use kinds, only: wp
  use dimensionless_problem, only: over_neck => spacing_over_neck
  use contact_state, only: state_t
  use controls, only: control_t
  use control_derivatives, only: control_derivative
  use frozen_jacobian, only: freeze
  use h0_step, only: step_h0
  use stability_by_products, only: is_stable
  use linear_algebra, only: solve, determinant_sign, log_determinant
  use prediction, only: extrapolated, moved_with_edge, towards_fold
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
  implicit none
  private
  public :: continue_to, expected_at, follow, change, jump

  !> Prediction of the end of a branch: dH/dH0 and the logarithm of the Jacobian's determinant, if
  !> the Jacobian is regular, and the logarithm before the last step; distance to a fold, huge if
  !> there is none; whether the fold is near enough for steps towards it; whether earlier
  !> predictions were confirmed.
  type :: outlook_t
    real(wp), allocatable :: rate(:)
    real(wp) :: determinant = 0, before = 0, distance = huge(1.0_wp)
    logical :: regular = .false., foreseen = .false., trusted = .true.
  contains
    procedure :: foresee
    procedure :: forget
  end type outlook_t

  !> A state continues the branch if its distance from the extrapolation is at most half the
  !> extrapolated change plus this many of the law's lengths. If the smallest step leads farther,
  !> the bodies jump.
  real(wp), parameter :: jump = 0.05_wp
  !> Ratio of the spacing to the width of the neck up to which the edge is not pinned between nodes;
  !> and the change of the gaps, in the law's lengths, after which the factorisation is renewed.
  real(wp), parameter :: resolved = 0.25_wp, large_change = 0.2_wp
  !> Number of states that are always allowed for the end of a branch, and the limit of further
  !> ones, in cubes of the number of nodes (about ten seconds): where the edge passes node after
  !> node, there may be hundreds. At the limit the end is known only to lie within the rest of the
  !> step.
  integer, parameter :: few_states = 40
  real(wp), parameter :: most_cubes = 5.0e10_wp
  !> Fraction of a step that is tried first after the whole step has failed.
  real(wp), parameter :: probe = 0.1_wp
  !> Distance of a predicted fold, in tolerances of a jump, at which the branch certainly ends.
  real(wp), parameter :: near_fold = 10
  !> Fraction of the distance to a predicted fold that is left for the next step.
  real(wp), parameter :: left_over = 0.05_wp

contains

  !> Solves the state at h0 from the expected one (for mixing, as in the paper, from the last state
  !> at constant separation). continues: the state is on the branch of the position.
  subroutine continue_to(self, h0, position, expected, state, event, continues)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position
    type(state_t), intent(in) :: expected
    type(state_t), intent(out) :: state
    type(step_result_t), intent(inout) :: event
    logical, intent(out) :: continues

    ! A single state is not enough for an extrapolation.
    if (position%held == 1) then
      call step_h0(self, position%state, h0, state, event%converged)
    else
      call step_h0(self, position%state, h0, state, event%converged, expected)
    end if
    continues = event%converged .and. change(expected, state) <= 0.5_wp*change(position%state, &
      expected) + jump + merge(abs(h0 - position%state%h0), 0.0_wp, position%held == 1)
  end subroutine continue_to

  !> The predicted state of a step to h0.
  type(state_t) function expected_at(self, h0, position) result(expected)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position

    if (self%options%is_plain_mixing() .or. &
      .not. over_neck(self%problem, self%meshes%grid(1)%spacing) <= resolved) then
      expected = extrapolated(position, h0)
      return
    end if
    expected = moved_with_edge(self%problem, self%meshes%grid(1), position, h0)
    ! The factorisation is no longer good after the edge has moved by a good part of the neck.
    if (change(position%state, expected) > large_change) call self%frozen%forget()
  end function expected_at

  !> Moves the position along its branch towards h0 after a single step has failed. arrived: the
  !> position is at h0. Otherwise the branch ends between the position and `beyond`. at_fold: the
  !> determinant confirms the end.
  !>
  !> A branch ends at a fold, near which its change is proportional to the square root of the
  !> distance: the square of the Jacobian's determinant decreases linearly to zero. Two states give
  !> the position of the fold accurately enough for one step nearly to the fold and one step just
  !> beyond it. If the prediction is not confirmed, the steps are reduced to a third, or increased.
  subroutine follow(self, h0, position, event, beyond, arrived, at_fold)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    real(wp), intent(out) :: beyond
    logical, intent(out) :: arrived, at_fold
    type(outlook_t) :: ahead
    type(state_t) :: state
    real(wp) :: step, next, sense
    logical :: continues
    integer :: states, allowed

    sense = sign(1.0_wp, h0 - position%state%h0)
    step = probe*abs(h0 - position%state%h0)
    beyond = h0
    arrived = .false.
    at_fold = .false.
    call linearise(position%state)
    allowed = max(few_states, int(min(most_cubes/real(self%meshes%grid(1)%nodes, wp)**3, 1.0e3_wp)))
    do states = 1, allowed
      if (.not. step > self%jump_tolerance) return
      next = position%state%h0 + sense*step
      if (abs(h0 - position%state%h0) <= 1.1_wp*step) next = h0
      call try_step(next)
      if (.not. continues) then
        beyond = next
        step = step/3
        call ahead%forget()
        cycle
      end if
      step = abs(next - position%state%h0)
      call remember(position, state, 1, .false.)
      arrived = abs(next - h0) <= 0.0_wp
      if (arrived) return
      ! An earlier failure may have been due to a long step.
      if ((beyond - next)*sense <= 0) beyond = h0
      call ahead%foresee(abs(h0 - next), self%jump_tolerance, step)
      at_fold = ahead%distance < near_fold*self%jump_tolerance
    end do
    if (step > self%jump_tolerance) beyond = h0

  contains

    !> Takes a step to h0 from a position, predicted from the fold or by extrapolation.
    subroutine try_step(h0)
      real(wp), intent(in) :: h0
      type(state_t) :: expected

      if (ahead%foreseen) then
        expected = towards_fold(position%state, ahead%rate, h0, ahead%distance)
      else
        expected = expected_at(self, h0, position)
      end if
      call continue_to(self, h0, position, expected, state, event, continues)
      ahead%before = ahead%determinant
      if (continues .and. self%options%mixing .and. .not. self%options%is_plain_mixing()) &
        continues = is_stable(self%equations_t, control_t(value=h0), state)
      if (.not. continues .or. self%options%mixing) return
      ahead%foreseen = ahead%regular
      call linearise(state)
      ahead%foreseen = ahead%foreseen .and. ahead%regular
      ! A state beyond the fold would be on the unstable branch.
      if (ahead%regular) continues = determinant_sign(self%frozen%factors) > 0
    end subroutine try_step

    !> dH/dH0 along the branch at a state, and the logarithm of the Jacobian's determinant, if the
    !> Jacobian is regular; not for mixing, which has no derivatives. The factorisation is kept for
    !> the next solution.
    subroutine linearise(state)
      type(state_t), intent(in) :: state
      type(control_t) :: control

      ahead%determinant = 0
      ahead%regular = .false.
      if (self%options%mixing) return
      control%value = state%h0
      call freeze(self%equations_t, control, state, self%frozen)
      self%frozen%excess = 0
      ahead%regular = self%frozen%factors%valid
      if (.not. ahead%regular) return
      ahead%determinant = log_determinant(self%frozen%factors)
      ahead%rate = -control_derivative(self%equations_t, control, state)
      call solve(self%frozen%factors, ahead%rate)
    end subroutine linearise

  end subroutine follow

  !> Predicts a fold after a step, and chooses the next step; left: the remaining distance to h0.
  pure subroutine foresee(self, left, tolerance, step)
    class(outlook_t), intent(inout) :: self
    real(wp), intent(in) :: left, tolerance
    real(wp), intent(inout) :: step
    real(wp) :: ratio, distance

    ratio = exp(2*(self%determinant - self%before))
    self%foreseen = self%foreseen .and. ratio < 1
    distance = huge(1.0_wp)
    if (self%foreseen) distance = step*ratio/(1 - ratio)
    ! If the distance does not decrease, there is no fold; the edge passes a node.
    self%trusted = self%trusted .and. distance < 0.5_wp*self%distance
    self%distance = distance
    self%foreseen = self%trusted .and. distance < left
    if (.not. self%trusted) then
      step = 2*step
    else if (.not. self%foreseen) then
      step = merge(0.5_wp*min(distance, left), 2*step, ratio < 1)
    else if (distance > 2*tolerance) then
      step = distance - max(left_over*distance, tolerance)
    else
      step = distance + tolerance
    end if
  end subroutine foresee

  !> Removes the prediction after a failed step.
  pure subroutine forget(self)
    class(outlook_t), intent(inout) :: self

    self%foreseen = .false.
    self%trusted = .true.
    self%distance = huge(1.0_wp)
  end subroutine forget

  !> Largest difference between the deformations of two states.
  pure real(wp) function change(a, b)
    type(state_t), intent(in) :: a, b

    change = maxval(abs((b%gap - b%h0) - (a%gap - a%h0)))
  end function change

end module fixed_branch
