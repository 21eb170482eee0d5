!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes, and where they are not close against the neck it is pinned between them.
module fixed_steps
  use kinds, only: wp
  use problem, only: over_neck => spacing_over_neck
  use discretisation, only: discretisation_t
  use equilibrium, only: control_t, state_t, state_from, factorise_jacobian, &
    control_derivative, radius_of_gap
  use linear_algebra, only: solve, determinant_sign, log_determinant
  use solver, only: solve_state
  use relaxation, only: relax
  use prediction, only: extrapolated, moved_with_edge, towards_fold
  use quasi_static, only: quasi_static_t, position_t, event_t, witness_t, remember
  implicit none
  private
  public :: fixed_steps_t

  type, extends(quasi_static_t) :: fixed_steps_t
    type(discretisation_t) :: mesh
  contains
    procedure :: begin
    procedure :: go
    procedure :: grid
    procedure :: spacing_over_neck
    procedure :: witness
    procedure, private :: follow
    procedure, private :: linearise
    procedure, private :: expected_at
    procedure, private :: creeps
    procedure, private :: continue_to
    procedure, private :: land
    procedure, private :: paper_step
    procedure, private :: solve_at
  end type fixed_steps_t

  !> Steps of the approach from afar, in the law's lengths.
  real(wp), parameter :: approach_step = 0.5_wp
  !> A state continues the branch that was extrapolated to it if it lies no farther from the
  !> extrapolation than half the extrapolated change plus this many of the law's lengths. Where even
  !> the smallest step leads farther the bodies jump.
  real(wp), parameter :: jump = 0.05_wp
  !> With the paper's stopping rule states are not exact enough for that; this many times the
  !> change of h0 then counts as a jump.
  real(wp), parameter :: paper_jump = 5
  !> Where the contact edge is caught between nodes it jumps from one to the next many times; in
  !> steps longer than this (in the law's lengths) these jumps are not located one by one.
  real(wp), parameter :: short_step = 0.11_wp
  !> Spacings that the edge must have crossed for that, and the largest spacing over the width of the
  !> neck: beyond it each jump tells in the load, and there are few.
  real(wp), parameter :: several = 1.5_wp, fine_enough = 0.75_wp
  !> Spacing over the width of the neck up to which the edge is not caught; and the change of the
  !> gaps, in the law's lengths, that asks for a new factorisation.
  real(wp), parameter :: resolved = 0.25_wp, large_change = 0.2_wp
  !> States that the end of a branch is worth: where the edge passes node after node on the way, it
  !> is known to lie within the rest of the step.
  integer, parameter :: most_states = 40
  !> Fraction of a step that is tried first after the whole one has failed.
  real(wp), parameter :: probe = 0.1_wp
  !> Fraction of the distance to a foreseen fold that is left for the next step.
  real(wp), parameter :: left_over = 0.05_wp

contains

  subroutine begin(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(out) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: i, steps

    far = h0
    ! Twice the gap (37) of the jump into contact, in these units: there the bodies hardly deform.
    if (.not. self%problem%rigid) far = max(h0, 5.0_wp, &
      2*(27*self%problem%coupling*self%problem%law%adhesion)**(2.0_wp/7))
    state = state_from(self%mesh%nodes)
    state%h0 = far
    state%axis_gap = far
    state%gap = far + 0.5_wp*self%mesh%x**2
    call self%solve_at(far, state, event)
    call remember(position, state, 1, .false.)
    steps = ceiling((far - h0)/approach_step)
    do i = 1, steps
      call self%go(far - (far - h0)*i/steps, position, event)
    end do
    event%jumped = .false.
  end subroutine begin

  subroutine go(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state, before, landed
    real(wp) :: beyond
    logical :: continues, arrived, has_landed

    if (self%options%stop_on_change) then
      call self%paper_step(h0, position, event)
      return
    end if
    call self%continue_to(h0, position, self%expected_at(h0, position), state, event, continues)
    if (continues) then
      call remember(position, state, 1, .false.)
      return
    end if
    has_landed = self%options%method /= 'mixing' .and. &
      abs(h0 - position%state%h0) > short_step .and. &
      position%state%axis_gap < self%problem%law%edge_gap .and. &
      over_neck(self%problem, self%mesh%spacing) < fine_enough
    if (has_landed) then
      call self%land(h0, position%state, landed, event)
      if (self%creeps(position%state, landed, event)) then
        event%jump_h0 = 0.5_wp*(position%state%h0 + h0)
        event%jump_uncertainty = 0.5_wp*abs(h0 - position%state%h0)
        call remember(position, landed, 1, .false.)
        return
      end if
      has_landed = event%converged
    end if
    call self%follow(h0, position, event, beyond, arrived)
    if (arrived) return

    before = position%state
    ! From the end of the branch the bodies go to where they went from before it.
    event%converged = has_landed
    if (.not. has_landed) call self%land(h0, before, landed, event)
    event%jumped = event%converged .and. change(before, landed) > jump
    if (.not. event%converged .and. self%problem%law%adhesion > 0 .and. &
      .not. self%problem%law%edge_gap > 0) then
      ! Nothing stops the fall of bodies that only attract.
      event%jumped = .true.
      event%reason = 'no stable equilibrium exists beyond this h0'
    end if
    event%jump_h0 = 0.5_wp*(before%h0 + beyond)
    event%jump_load = before%load
    event%jump_uncertainty = 0.5_wp*abs(beyond - before%h0)
    call remember(position, landed, 1, event%jumped)
  end subroutine go

  !> Takes the position along its branch towards h0, which one step did not reach. arrived: there it
  !> is after all; otherwise the branch ends between the position and the h0 handed back as `beyond`.
  !>
  !> A branch ends in a fold, where it moves as the square root of the distance to it: the square of
  !> the Jacobian's determinant falls linearly to zero there, and from two states the fold is known
  !> well enough to go nearly all the way to it, and then just past it, at once. Where that is not
  !> borne out the steps are cut to a third, or grow.
  subroutine follow(self, h0, position, event, beyond, arrived)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(inout) :: event
    real(wp), intent(out) :: beyond
    logical, intent(out) :: arrived
    type(state_t) :: state, expected
    real(wp), allocatable :: rate(:)
    real(wp) :: step, next, distance, distance_before, sense, left, determinant, determinant_before
    logical :: continues, foreseen, trusted, regular
    integer :: states

    sense = sign(1.0_wp, h0 - position%state%h0)
    step = probe*abs(h0 - position%state%h0)
    beyond = h0
    arrived = .false.
    foreseen = .false.
    trusted = .true.
    distance_before = huge(1.0_wp)
    call self%linearise(position%state, rate, determinant, regular)
    states = 0
    do while (step > self%jump_tolerance)
      states = states + 1
      if (states > most_states) then
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
      left = exp(2*(determinant - determinant_before))
      foreseen = foreseen .and. left < 1
      distance = huge(1.0_wp)
      if (foreseen) distance = step*left/(1 - left)
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
    class(fixed_steps_t), intent(inout) :: self
    type(state_t), intent(in) :: state
    real(wp), allocatable, intent(out) :: rate(:)
    real(wp), intent(out) :: determinant
    logical, intent(out) :: regular
    type(control_t) :: control

    determinant = 0
    regular = .false.
    if (self%options%method == 'mixing') return
    control%value = state%h0
    call factorise_jacobian(self%problem, self%mesh, control, state, self%frozen%factors, self%cost)
    self%frozen%control_kind = control%kind
    self%frozen%served = 0
    regular = self%frozen%factors%valid
    if (.not. regular) return
    determinant = log_determinant(self%frozen%factors)
    rate = -control_derivative(self%problem, self%mesh, control, state)
    call solve(self%frozen%factors, rate)
  end subroutine linearise

  !> The state that a step to h0 is expected to lead to.
  function expected_at(self, h0, position) result(expected)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(in) :: position
    type(state_t) :: expected

    if (self%options%method == 'mixing' .or. &
      .not. over_neck(self%problem, self%mesh%spacing) <= resolved) then
      expected = extrapolated(self%mesh, position, h0)
      return
    end if
    expected = moved_with_edge(self%problem%law, self%mesh, position, h0)
    ! A factorisation from before the edge moved across a good part of the neck does not serve.
    if (change(position%state, expected) > large_change) self%frozen%factors%valid = .false.
  end function expected_at

  !> Whether bodies that came from one state to the other by relaxation stayed in contact, its edge
  !> having moved: whatever jump there was on the way was one of the edge, from node to node.
  logical function creeps(self, before, after, event)
    class(fixed_steps_t), intent(in) :: self
    type(state_t), intent(in) :: before, after
    type(event_t), intent(in) :: event
    real(wp) :: from, to

    creeps = .false.
    if (.not. event%converged .or. .not. self%problem%law%edge_gap > 0) return
    from = radius_of_gap(self%problem%law%edge_gap, self%mesh, before)
    to = radius_of_gap(self%problem%law%edge_gap, self%mesh, after)
    creeps = min(from, to) > 0.5_wp*max(from, to) .and. &
      abs(to - from) > several*self%mesh%spacing
  end function creeps

  !> A step as the paper takes it: h0 changes at constant separation, and the iteration goes on
  !> until its own rule is met. A jump is a change of deformation many times that of h0, and is
  !> known only to have happened within the step.
  subroutine paper_step(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state

    state = position%state
    call self%solve_at(h0, state, event)
    associate (before => position%state)
      event%jumped = change(before, state) > max(1.0_wp, paper_jump*abs(h0 - before%h0))
      event%jump_h0 = 0.5_wp*(before%h0 + h0)
      event%jump_load = before%load
      event%jump_uncertainty = 0.5_wp*abs(h0 - before%h0)
    end associate
    call remember(position, state, 1, event%jumped)
  end subroutine paper_step

  !> The state at h0 from the expected one (for mixing, as in the paper, from the last state at
  !> constant separation), and whether it continues the branch of the position.
  subroutine continue_to(self, h0, position, expected, state, event, continues)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(in) :: position
    type(state_t), intent(in) :: expected
    type(state_t), intent(out) :: state
    type(event_t), intent(inout) :: event
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

  !> Where the bodies go from the state `before` when h0 is changed to a value at which its branch
  !> has ended. Mixing relaxes by itself.
  subroutine land(self, h0, before, state, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(inout) :: state
    type(event_t), intent(inout) :: event
    type(control_t) :: control

    state = before
    if (self%options%method == 'mixing') then
      call self%solve_at(h0, state, event)
      return
    end if
    control%value = h0
    call relax(self%problem, self%mesh, control, self%options, state, event%converged, self%cost)
    self%frozen%factors%valid = .false.
  end subroutine land

  !> Solves at h0 from the guess `state`.
  subroutine solve_at(self, h0, state, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(inout) :: state
    type(event_t), intent(inout) :: event
    type(control_t) :: control

    control%value = h0
    call solve_state(self%problem, self%mesh, control, self%options, self%frozen, state, &
      event%converged, self%cost)
  end subroutine solve_at

  !> Largest difference between the deformations of two states.
  pure real(wp) function change(a, b)
    type(state_t), intent(in) :: a, b

    change = maxval(abs((b%gap - b%h0) - (a%gap - a%h0)))
  end function change

  function grid(self, position)
    class(fixed_steps_t), intent(in), target :: self
    type(position_t), intent(in) :: position
    type(discretisation_t), pointer :: grid

    ! One mesh for every position.
    nullify (grid)
    if (position%mesh > 0) grid => self%mesh
  end function grid

  pure real(wp) function spacing_over_neck(self, position)
    class(fixed_steps_t), intent(in) :: self
    type(position_t), intent(in) :: position

    spacing_over_neck = over_neck(self%problem, position%state%scale*self%mesh%spacing)
  end function spacing_over_neck

  pure function witness(self, position)
    class(fixed_steps_t), intent(in) :: self
    type(position_t), intent(in) :: position
    type(witness_t) :: witness

    witness%control%value = position%state%h0
    witness%state = position%state
    witness%displacement = .true.
  end function witness

end module fixed_steps
