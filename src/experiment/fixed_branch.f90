!> One branch of equilibria on a mesh fixed in space: the next state on it, and how far it goes.
module fixed_branch
  use kinds, only: wp
  use dimensionless_problem, only: over_neck => spacing_over_neck
  use equilibrium, only: control_t, state_t
  use jacobian, only: factorise_jacobian, control_derivative
  use linear_algebra, only: solve, determinant_sign, log_determinant
  use prediction, only: extrapolated, moved_with_edge, towards_fold
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember
  implicit none
  private
  public :: fixed_branch_t, change, jump

  type, abstract, extends(stepper_t) :: fixed_branch_t
  contains
    procedure :: continue_to
    procedure :: expected_at
    procedure :: follow
    procedure :: solve_at
    procedure, private :: linearise
  end type fixed_branch_t

  !> A state continues the branch that was extrapolated to it if it lies no farther from the
  !> extrapolation than half the extrapolated change plus this many of the law's lengths. Where even
  !> the smallest step leads farther the bodies jump.
  real(wp), parameter :: jump = 0.05_wp
  !> Spacing over the width of the neck up to which the edge is not caught; and the change of the
  !> gaps, in the law's lengths, that asks for a new factorisation.
  real(wp), parameter :: resolved = 0.25_wp, large_change = 0.2_wp
  !> States that the end of a branch is always worth, and cubes of the number of nodes that more of
  !> them may amount to (some ten seconds): where the edge passes node after node on the way there
  !> may be hundreds. The end is then only known to lie within the rest of the step.
  integer, parameter :: few_states = 40
  real(wp), parameter :: most_cubes = 5.0e10_wp
  !> Fraction of a step that is tried first after the whole one has failed.
  real(wp), parameter :: probe = 0.1_wp
  !> Distance of a foreseen fold, in tolerances of a jump, at which the branch certainly ends.
  real(wp), parameter :: near_fold = 10
  !> Fraction of the distance to a foreseen fold that is left for the next step.
  real(wp), parameter :: left_over = 0.05_wp

contains

  !> The state at h0 from the expected one (for mixing, as in the paper, from the last state at
  !> constant separation), and whether it continues the branch of the position.
  subroutine continue_to(self, h0, position, expected, state, event, continues)
    class(fixed_branch_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position
    type(state_t), intent(in) :: expected
    type(state_t), intent(out) :: state
    type(step_result_t), intent(inout) :: event
    logical, intent(out) :: continues

    state = expected
    ! A single state says too little about where the next is, and mixing starts as in the paper.
    if (self%options%method == 'mixing' .or. position%held == 1) state = position%state
    call self%solve_at(h0, state, event)
    continues = event%converged .and. change(expected, state) <= &
      0.5_wp*change(position%state, expected) + jump + merge(abs(h0 - position%state%h0), 0.0_wp, &
      position%held == 1)
    if (self%problem%rigid) continues = .true.
  end subroutine continue_to

  !> The state that a step to h0 is expected to lead to.
  function expected_at(self, h0, position) result(expected)
    class(fixed_branch_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position
    type(state_t) :: expected

    if (self%options%method == 'mixing' .or. &
      .not. over_neck(self%problem, self%pair%grid(1)%spacing) <= resolved) then
      expected = extrapolated(position, h0)
      return
    end if
    expected = moved_with_edge(self%problem%law, self%pair%grid(1), position, h0)
    ! A factorisation from before the edge moved across a good part of the neck does not serve.
    if (change(position%state, expected) > large_change) self%frozen%factors%valid = .false.
  end function expected_at

  !> Takes the position along its branch towards h0, which one step did not reach. arrived: there
  !> it is after all; otherwise the branch ends between the position and the h0 handed back as
  !> `beyond`. at_fold: the determinant says so too.
  !>
  !> A branch ends in a fold, where it moves as the square root of the distance to it: the square of
  !> the Jacobian's determinant falls linearly to zero there, and from two states the fold is known
  !> well enough to go nearly all the way to it, and then just past it, at once. Where that is not
  !> borne out the steps are cut to a third, or grow.
  subroutine follow(self, h0, position, event, beyond, arrived, at_fold)
    class(fixed_branch_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    real(wp), intent(out) :: beyond
    logical, intent(out) :: arrived, at_fold
    type(state_t) :: state, expected
    real(wp), allocatable :: rate(:)
    real(wp) :: step, next, distance, distance_before, sense, left, determinant, determinant_before
    logical :: continues, foreseen, trusted, regular
    integer :: states, allowed

    sense = sign(1.0_wp, h0 - position%state%h0)
    step = probe*abs(h0 - position%state%h0)
    beyond = h0
    arrived = .false.
    at_fold = .false.
    foreseen = .false.
    trusted = .true.
    distance_before = huge(1.0_wp)
    call self%linearise(position%state, rate, determinant, regular)
    states = 0
    allowed = max(few_states, int(min(most_cubes/real(self%pair%grid(1)%nodes, wp)**3, 1.0e3_wp)))
    do while (step > self%jump_tolerance)
      states = states + 1
      if (states > allowed) then
        beyond = h0
        return
      end if
      next = position%state%h0 + sense*step
      if (abs(h0 - position%state%h0) <= 1.1_wp*step) next = h0
      if (foreseen) then
        expected = towards_fold(position%state, rate, next, distance)
      else
        expected = self%expected_at(next, position)
      end if
      call self%continue_to(next, position, expected, state, event, continues)
      determinant_before = determinant
      if (continues .and. self%options%method /= 'mixing') then
        foreseen = regular
        call self%linearise(state, rate, determinant, regular)
        foreseen = foreseen .and. regular
        ! Not beyond the fold, on the unstable branch.
        if (regular) continues = determinant_sign(self%frozen%factors) > 0
      end if
      if (.not. continues) then
        beyond = next
        step = step/3
        foreseen = .false.
        trusted = .true.
        distance_before = huge(1.0_wp)
        cycle
      end if
      step = abs(next - position%state%h0)
      call remember(position, state, 1, .false.)
      arrived = abs(next - h0) <= 0.0_wp
      if (arrived) return
      ! What failed before may have been too long a step.
      if ((beyond - next)*sense <= 0) beyond = h0
      left = exp(2*(determinant - determinant_before))
      foreseen = foreseen .and. left < 1
      distance = huge(1.0_wp)
      if (foreseen) distance = step*left/(1 - left)
      at_fold = distance < near_fold*self%jump_tolerance
      ! A fold that recedes is none: the edge only passes a node.
      trusted = trusted .and. distance < 0.5_wp*distance_before
      distance_before = merge(distance, huge(1.0_wp), foreseen)
      foreseen = trusted .and. distance < abs(h0 - next)
      if (.not. trusted) then
        step = 2*step
      else if (.not. foreseen) then
        step = merge(0.5_wp*min(distance, abs(h0 - next)), 2*step, left < 1)
      else if (distance > 2*self%jump_tolerance) then
        step = distance - max(left_over*distance, self%jump_tolerance)
      else
        step = distance + self%jump_tolerance
      end if
    end do
  end subroutine follow

  !> dH/dH0 along the branch at a state, and the logarithm of the Jacobian's determinant; regular:
  !> there are such. Mixing, the iteration without derivatives, does without. The factorisation is
  !> left for the next solution.
  subroutine linearise(self, state, rate, determinant, regular)
    class(fixed_branch_t), intent(inout) :: self
    type(state_t), intent(in) :: state
    real(wp), allocatable, intent(out) :: rate(:)
    real(wp), intent(out) :: determinant
    logical, intent(out) :: regular
    type(control_t) :: control

    determinant = 0
    regular = .false.
    if (self%options%method == 'mixing') return
    control%value = state%h0
    call factorise_jacobian(self%equations_t, control, state, self%frozen%factors)
    self%frozen%control_kind = control%kind
    self%frozen%mesh = control%mesh
    self%frozen%served = 0
    regular = self%frozen%factors%valid
    if (.not. regular) return
    determinant = log_determinant(self%frozen%factors)
    rate = -control_derivative(self%equations_t, control, state)
    call solve(self%frozen%factors, rate)
  end subroutine linearise

  !> Solves at h0 from the guess `state`.
  subroutine solve_at(self, h0, state, event)
    class(fixed_branch_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(inout) :: state
    type(step_result_t), intent(inout) :: event

    call self%solve(control_t(value=h0), state, event%converged)
  end subroutine solve_at

  !> Largest difference between the deformations of two states.
  pure real(wp) function change(a, b)
    type(state_t), intent(in) :: a, b

    change = maxval(abs((b%gap - b%h0) - (a%gap - a%h0)))
  end function change

end module fixed_branch
