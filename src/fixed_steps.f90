!> A quasi-static experiment on a mesh fixed in space: the paper's method. The contact edge moves
!> across the nodes, and where they are not close against the neck it is pinned between them.
module fixed_steps
  use kinds, only: wp
  use problem, only: neck_width
  use discretisation, only: discretisation_t
  use equilibrium, only: control_t, state_t, state_from
  use solver, only: solve_state
  use relaxation, only: relax
  use tracer, only: between
  use quasi_static, only: quasi_static_t, position_t, event_t, remember
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
    procedure, private :: settle
    procedure, private :: locate_jump
  end type fixed_steps_t

  !> Steps of the approach from afar, in the law's lengths.
  real(wp), parameter :: approach_step = 0.5_wp
  !> In a smooth step the deformation changes by little more than h0 does; beyond this many times it is
  !> looked at more closely, and what is left after bisection beyond this many law's lengths is a
  !> jump.
  real(wp), parameter :: suspicious = 1.5_wp, jump = 0.02_wp

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
    position%state = state
    steps = ceiling((far - h0)/approach_step)
    do i = 0, steps
      call self%go(far - (far - h0)*i/max(steps, 1), position, event)
    end do
    event%jumped = .false.
  end subroutine begin

  subroutine go(self, h0, position, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state, from

    from = position%state
    if (position%held > 1 .and. self%options%method /= 'mixing') then
      state = between(self%mesh, position%h0(:position%held), position%past(:position%held), h0, &
        self%mesh%nodes)
    else
      ! As in the paper, h0 changes at constant separation.
      state = from
    end if
    call self%settle(h0, from, state, event)
    if (position%held > 0 .and. change(from, state) > suspicious*abs(h0 - from%h0)) &
      call self%locate_jump(from, state, event)
    call remember(position, state, 1, event%jumped)
  end subroutine go

  !> The equilibrium at h0 from the guess `state`; where that fails or leads far from `from`, the
  !> one to which the bodies relax from there.
  subroutine settle(self, h0, from, state, event)
    class(fixed_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(in) :: from
    type(state_t), intent(inout) :: state
    type(event_t), intent(inout) :: event
    type(state_t) :: relaxed
    type(control_t) :: control
    logical :: converged

    control%value = h0
    call solve_state(self%problem, self%mesh, control, self%options, self%frozen, state, &
      event%converged, self%cost)
    if (self%options%method == 'mixing' .or. self%problem%rigid) return
    if (event%converged .and. change(from, state) <= suspicious*abs(h0 - from%h0)) return
    relaxed = from
    call relax(self%problem, self%mesh, control, self%options, relaxed, converged, self%cost)
    if (.not. converged .and. event%converged) return
    if (converged .or. relaxed%residual < state%residual) state = relaxed
    event%converged = converged
    self%frozen%factors%valid = .false.
  end subroutine settle

  !> Bisects h0 between two states that seem to lie on either side of a jump, in the order of the
  !> experiment.
  subroutine locate_jump(self, before, after, event)
    class(fixed_steps_t), intent(inout) :: self
    type(state_t), intent(in) :: before, after
    type(event_t), intent(inout) :: event
    type(state_t) :: near, far, middle
    type(event_t) :: ignored
    real(wp) :: h0

    near = before
    far = after
    do while (abs(far%h0 - near%h0) > self%jump_tolerance)
      h0 = 0.5_wp*(near%h0 + far%h0)
      middle = near
      call self%settle(h0, near, middle, ignored)
      if (change(near, middle) < change(middle, far)) then
        near = middle
      else
        far = middle
      end if
    end do
    event%jumped = change(near, far) > jump + suspicious*abs(far%h0 - near%h0)
    event%jump_h0 = 0.5_wp*(near%h0 + far%h0)
    event%jump_load = near%load
    event%jump_uncertainty = 0.5_wp*abs(far%h0 - near%h0)
  end subroutine locate_jump

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

    spacing_over_neck = position%state%scale*self%mesh%spacing/neck_width(self%problem)
  end function spacing_over_neck

end module fixed_steps
