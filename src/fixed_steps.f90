!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes, and where they are not close against the neck it is pinned between them.
module fixed_steps
  use kinds, only: wp
  use problem, only: over_neck => spacing_over_neck
  use discretisation, only: discretisation_t
  use equilibrium, only: control_t, state_t, state_from, residual_floor
  use solver_options, only: solver_options_t
  use solver, only: solve_state
  use relaxation, only: relax
  use tracer, only: between
  use quasi_static, only: quasi_static_t, position_t, event_t, witness_t, remember, &
    touching
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
    procedure, private :: continue_to
    procedure, private :: land
    procedure, private :: goes_on
    procedure, private :: paper_step
    procedure, private :: solve_at
  end type fixed_steps_t

  !> Steps of the approach from afar, in the law's lengths, and the most of them: where the way is
  !> long they are longer.
  real(wp), parameter :: approach_step = 0.5_wp
  integer, parameter :: most_approach = 400
  !> Newton's method needs few iterations, or is not going to arrive.
  integer, parameter :: newton_iterations = 12
  !> How often Newton's method may help the iteration on in a step before that is said to fail.
  integer, parameter :: most_rescues = 5
  !> A state continues the branch that was extrapolated to it if it lies no farther from the
  !> extrapolation than half the extrapolated change plus this many of the law's lengths. Where even
  !> the smallest step leads farther the bodies jump.
  real(wp), parameter :: jump = 0.05_wp
  !> With the paper's stopping rule states are not exact enough for that; this many times the
  !> change of h0 then counts as a jump.
  real(wp), parameter :: paper_jump = 5

contains

  subroutine begin(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(out) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: i, steps

    if (self%problem%rigid .and. h0 < self%problem%law%smallest_gap) then
      event%reason = touching
      return
    end if
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
    steps = ceiling(min((far - h0)/approach_step, real(most_approach, wp)))
    do i = 1, steps
      call self%go(far - (far - h0)*i/steps, position, event)
      if (event%reason /= '') exit
    end do
    event%jumped = .false.
  end subroutine begin

  subroutine go(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state, before, landed
    real(wp) :: step, next
    logical :: continues, stalled
    integer :: rescues

    if (self%problem%rigid .and. h0 < self%problem%law%smallest_gap) then
      event%reason = touching
      return
    end if
    if (self%options%stop_on_change) then
      call self%paper_step(h0, position, event)
      return
    end if
    call self%continue_to(h0, position, state, event, continues)
    if (continues) then
      call remember(position, state, 1, .false.)
      return
    end if

    ! The branch ends, or turns sharply, on the way: how far does it go?
    landed = state
    step = 0.5_wp*(h0 - position%state%h0)
    do rescues = 0, most_rescues
      do while (abs(step) > self%jump_tolerance)
        next = position%state%h0 + step
        if (abs(h0 - position%state%h0) <= 1.1_wp*abs(step)) next = h0
        call self%continue_to(next, position, state, event, continues)
        if (continues) then
          call remember(position, state, 1, .false.)
          if (abs(next - h0) <= 0.0_wp) return
          step = 1.5_wp*step
        else
          step = step/3
        end if
      end do
      stalled = self%goes_on(position%state%h0 + 1.5_wp*step, position%state, state)
      if (.not. stalled) exit
      ! Near its end a branch turns sharply, and is worth another try.
      call remember(position, state, 1, .false.)
      step = sign(min(2*self%jump_tolerance, abs(h0 - state%h0)), step)
    end do
    before = position%state
    call self%land(h0, before, landed, event)
    if (stalled) then
      ! The iteration does not follow the branch, and no jump has been seen: whether what is found
      ! at h0 is on this branch nobody knows.
      event%converged = .false.
      call remember(position, landed, 1, .true.)
      return
    end if
    ! From where there was no equilibrium nothing jumps.
    event%jumped = event%converged .and. change(before, landed) > jump .and. &
      before%residual <= max(self%options%tolerance, residual_floor(self%problem, before))
    if (.not. event%converged .and. self%problem%law%adhesion > 0 .and. &
      .not. self%problem%law%edge_gap > 0) then
      ! Nothing stops the fall of bodies that only attract.
      event%jumped = .true.
      event%reason = 'no stable equilibrium exists beyond this h0'
    end if
    event%jump_h0 = before%h0 + 1.5_wp*step
    event%jump_load = before%load
    event%jump_uncertainty = abs(1.5_wp*step)
    call remember(position, landed, 1, event%jumped)
  end subroutine go

  !> Whether the branch of the state `before` goes on to an h0 close by, where the iteration has not
  !> found it: by Newton's method, whatever the deck says of iterations. Where it does, to `state`,
  !> the iteration has failed; where not, the bodies jump.
  logical function goes_on(self, h0, before, state)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: before
    type(state_t), intent(out) :: state
    type(solver_options_t) :: newton
    type(control_t) :: control

    goes_on = .false.
    if (self%options%method == 'mixing') return
    newton = self%options
    newton%method = 'newton'
    newton%most_iterations = newton_iterations
    control%value = h0
    state = before
    call solve_state(self%problem, self%mesh, control, newton, self%frozen, state, goes_on, &
      self%cost)
    self%frozen%factors%valid = .false.
    goes_on = goes_on .and. change(before, state) <= jump
  end function goes_on

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
      event%jumped = event%converged .and. &
        change(before, state) > max(1.0_wp, paper_jump*abs(h0 - before%h0))
      event%jump_h0 = 0.5_wp*(before%h0 + h0)
      event%jump_load = before%load
      event%jump_uncertainty = 0.5_wp*abs(h0 - before%h0)
    end associate
    call remember(position, state, 1, event%jumped)
  end subroutine paper_step

  !> The state at h0 from the extrapolated past (for mixing, as in the paper, from the last state at
  !> constant separation), and whether it continues the branch of the position.
  subroutine continue_to(self, h0, position, state, event, continues)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(in) :: position
    type(state_t), intent(out) :: state
    type(event_t), intent(inout) :: event
    logical, intent(out) :: continues
    type(state_t) :: expected

    expected = between(self%mesh, position%h0(:position%held), position%past(:position%held), h0, &
      self%mesh%nodes)
    if (position%held == 1) expected%gap = expected%gap + (h0 - position%state%h0)
    expected%h0 = h0
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
