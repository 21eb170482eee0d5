!> A quasi-static experiment in edge-locked coordinates: nothing is pinned between nodes and
!> nothing is stiff, at any adhesion strength.
!>
!> Usually a step is a few accelerated iterations from the extrapolated state, with one
!> factorisation for many steps. Where that does not arrive on the branch it came from, the
!> equilibrium path is traced from the last state to the next stable state at the wanted h0; a fold
!> on the way is a jump, and known exactly.
module locked_steps
  use kinds, only: wp
  use problem, only: over_neck => spacing_over_neck
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t, state_from, at_edge_radius, at_h0_with_edge, lost_in_rounding
  use solver_options, only: solver_options_t
  use solver, only: solve_state
  use edge_locked, only: mesh_pair_t, approach, contact, largest_radius
  use locked_meshes, only: change_mesh, nodes_to_use, h0_control, scale_at
  use tracer, only: tracer_t, new_tracer, inward, outward, coordinate_of, between, &
    node_count, path_control
  use trail, only: trail_t, extend, collapsed
  use landing, only: land_between
  use quasi_static, only: quasi_static_t, position_t, event_t, witness_t, remember, touching, &
    beyond_rounding
  implicit none
  private
  public :: locked_steps_t, fold_witness

  type, extends(quasi_static_t) :: locked_steps_t
    type(mesh_pair_t) :: pair
  contains
    procedure :: begin
    procedure :: go
    procedure :: grid
    procedure :: spacing_over_neck
    procedure :: witness
    procedure :: mesh_of
    procedure :: begin_afar
    procedure :: far_away
    procedure :: land
    procedure, private :: attempt
    procedure, private :: trace
    procedure, private :: creep
  end type locked_steps_t

  !> Most states that a trace may take before it is given up as going nowhere.
  integer, parameter :: longest_trace = 2000
  !> Largest relative change of the path's coordinate in a step of a trace.
  real(wp), parameter :: path_step = 0.15_wp
  !> Residual, in the law's lengths, of states that only lead the way and are not reported.
  real(wp), parameter :: walking_tolerance = 1.0e-6_wp
  !> Smallest step in h0, in the law's lengths, that is tried.
  real(wp), parameter :: smallest_creep = 1.0e-6_wp

contains

  subroutine begin(self, h0, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(out) :: position
    type(event_t), intent(out) :: event

    call self%begin_afar(h0, position, event)
    if (event%reason == '' .and. position%state%h0 > h0) call self%go(h0, position, event)
    ! What the approach passed before the experiment began is not part of it.
    event%jumped = .false.
  end subroutine begin

  !> A state at h0 or, if the bodies would be near each other there, so far apart that they hardly
  !> deform (rigid bodies: at h0).
  subroutine begin_afar(self, h0, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(out) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: far
    integer :: mesh

    mesh = merge(approach, contact, self%pair%traceable)
    far = max(h0, self%far_away())
    if (self%problem%rigid) then
      far = h0
      if (h0 < self%problem%law%smallest_gap) then
        event%reason = touching
        return
      end if
    end if
    associate (grid => self%pair%grid(mesh))
      state = state_from(node_count(self%pair, mesh, scale_at(self%pair, far)))
      state%h0 = far
      state%axis_gap = far
      state%scale = scale_at(self%pair, far)
      state%gap = far + 0.5_wp*(state%scale*grid%x(:size(state%gap)))**2
    end associate
    call self%attempt(far, state, mesh, position, event)
    if (.not. event%converged) write (event%reason, '(a, i0, a, es7.1)') &
      'no equilibrium was found far from contact: after ', state%iterations, &
      ' iterations the residual was ', state%residual
    call remember(position, state, mesh, .false.)
  end subroutine begin_afar

  !> An H0 at which the bodies hardly deform: twice the gap (37) of the jump into contact, in these
  !> units, or where repulsion hardly acts.
  pure real(wp) function far_away(self)
    class(locked_steps_t), intent(in) :: self

    far_away = max(5.0_wp, 2*(27*self%problem%coupling*self%problem%law%adhesion)**(2.0_wp/7), &
      self%pair%level + 3)
  end function far_away

  subroutine go(self, h0, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state

    if (self%problem%rigid .and. h0 < self%problem%law%smallest_gap) then
      event%reason = touching
      return
    end if
    state = between(self%pair%grid(position%mesh), position%h0(:position%held), &
      position%past(:position%held), h0, nodes_to_use(self%pair, h0, position))
    call self%attempt(h0, state, position%mesh, position, event)
    if (event%converged) then
      call remember(position, state, position%mesh, .false.)
      if (self%pair%traceable) call change_mesh(self%problem, self%pair, self%options, &
        self%frozen, position, self%cost)
    else if (self%pair%traceable) then
      call self%trace(h0, position, event)
    else
      call self%creep(h0, position, event)
    end if
  end subroutine go

  !> Solves from the guess `state` at h0; converged only if the result continues the branch that the
  !> position is on.
  subroutine attempt(self, h0, state, mesh, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(inout) :: state
    integer, intent(in) :: mesh
    type(position_t), intent(in) :: position
    type(event_t), intent(out) :: event
    real(wp) :: expected, moved, before
    logical :: check

    check = self%pair%traceable .and. position%held > 0 .and. .not. self%problem%rigid
    before = 0
    expected = 0
    if (check) then
      before = coordinate_of(self%problem, mesh, position%state)
      state%axis_gap = position%state%axis_gap + state%gap(1) - position%state%gap(1)
      expected = coordinate_of(self%problem, mesh, state) - before
    end if
    call solve_state(self%problem, self%pair%grid(mesh), h0_control(self%pair, mesh, h0), &
      self%options, self%frozen, state, event%converged, self%cost)
    if (.not. (check .and. event%converged)) return
    moved = coordinate_of(self%problem, mesh, state) - before
    ! Along a stable branch the gap on the axis grows and the contact shrinks with h0.
    event%converged = moved*(h0 - position%state%h0)*merge(1, -1, mesh == approach) >= 0 .and. &
      abs(moved - expected) <= 0.5_wp*abs(expected) + 0.02_wp
  end subroutine attempt

  !> Follows the path from the position to the next stable state at h0, noting the first fold that
  !> is passed: that is where the bodies jump.
  subroutine trace(self, h0, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(tracer_t) :: walker
    type(trail_t) :: trail
    type(state_t) :: state
    type(solver_options_t) :: walking
    logical :: lost, found
    integer :: seen, direction

    if (lost_in_rounding(self%problem, largest_radius(self%problem, h0, self%pair%level))) then
      event%reason = beyond_rounding
      return
    end if
    self%frozen%factors%valid = .false.
    direction = merge(inward, outward, h0 < position%state%h0)
    walker = new_tracer(self%problem, position%state, position%mesh, direction, path_step)
    walking = self%options
    walking%tolerance = max(walking%tolerance, walking_tolerance)
    call walker%look_back(self%problem, self%pair, walking, self%cost)
    seen = 1
    found = .false.
    do while (.not. found)
      call extend(trail, walker, self%problem, self%pair, walking, self%options, lost, self%cost)
      if (lost) event%reason = 'the equilibrium path was lost'
      if (trail%held > longest_trace .or. collapsed(self%problem, trail)) &
        event%reason = 'no stable equilibrium exists beyond this h0'
      if (event%reason /= '') return
      ! The last piece of the trail may still turn out to hold a fold.
      do while (seen < trail%held - 1 .and. .not. found)
        if (trail%fold(seen + 1) .and. .not. event%jumped) then
          event%jumped = .true.
          event%jump_h0 = trail%state(seen + 1)%h0
          event%jump_load = trail%state(seen + 1)%load
          event%fold = fold_witness(self, trail, seen + 1)
        end if
        associate (a => trail%state(seen)%h0, b => trail%state(seen + 1)%h0)
          found = trail%unstable(seen + 1) == 0 .or. trail%unstable(seen) == 0
          if (trail%fold(seen + 1)) found = trail%unstable(seen) == 0
          if (trail%fold(seen)) found = trail%unstable(seen + 1) == 0
          found = found .and. (h0 - a)*(h0 - b) <= 0
        end associate
        seen = seen + 1
      end do
    end do
    ! Between states seen - 1 and seen.
    call self%land(h0, trail, seen, state, event%converged)
    if (.not. event%converged) then
      event%reason = 'the state after a jump did not converge'
      position%state = state
      return
    end if
    call remember(position, state, trail%mesh(seen), event%jumped)
    call change_mesh(self%problem, self%pair, self%options, self%frozen, position, self%cost)
  end subroutine trace

  !> See `land_between`.
  subroutine land(self, h0, trail, upper, state, converged)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(trail_t), intent(in) :: trail
    integer, intent(in) :: upper
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged

    call land_between(self%problem, self%pair, h0_control(self%pair, trail%mesh(upper), h0), &
      self%options, self%frozen, trail, upper, state, converged, self%cost)
  end subroutine land

  !> Reaches h0 in shorter steps: for laws without a contact edge, whose states are unique, a step
  !> is only ever too long.
  subroutine creep(self, h0, position, event)
    class(locked_steps_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(position_t), intent(inout) :: position
    type(event_t), intent(out) :: event
    type(state_t) :: state
    real(wp) :: next, step

    step = 0.25_wp*(h0 - position%state%h0)
    do
      next = position%state%h0 + step
      if (abs(h0 - position%state%h0) <= 1.5_wp*abs(step)) next = h0
      state = between(self%pair%grid(contact), position%h0(:position%held), &
        position%past(:position%held), next, nodes_to_use(self%pair, next, position))
      self%frozen%factors%valid = .false.
      call self%attempt(next, state, contact, position, event)
      if (event%converged) then
        call remember(position, state, contact, .false.)
        if (abs(next - h0) <= 0.0_wp) return
        step = 2*step
      else
        step = 0.3_wp*step
        if (abs(step) < smallest_creep) then
          event%reason = 'no step, however small, converged'
          position%state = state
          return
        end if
      end if
    end do
  end subroutine creep

  !> A scale that is prescribed or unknown belongs to the contact, and so does everything where
  !> there is no other mesh.
  pure integer function mesh_of(self, kind)
    class(locked_steps_t), intent(in) :: self
    integer, intent(in) :: kind

    mesh_of = approach
    if (kind == at_h0_with_edge .or. kind == at_edge_radius .or. .not. self%pair%traceable) &
      mesh_of = contact
  end function mesh_of

  !> The witness of a fold on a trail.
  pure function fold_witness(self, trail, i) result(witness)
    class(locked_steps_t), intent(in) :: self
    type(trail_t), intent(in) :: trail
    integer, intent(in) :: i
    type(witness_t) :: witness

    witness%mesh = trail%mesh(i)
    witness%control = path_control(self%problem, trail%mesh(i), trail%coordinate(i))
    witness%state = trail%state(i)
    witness%h0 = .true.
  end function fold_witness

  pure function witness(self, position)
    class(locked_steps_t), intent(in) :: self
    type(position_t), intent(in) :: position
    type(witness_t) :: witness

    witness%mesh = position%mesh
    witness%control = h0_control(self%pair, position%mesh, position%state%h0)
    witness%state = position%state
    witness%displacement = .true.
  end function witness

  function grid(self, position)
    class(locked_steps_t), intent(in), target :: self
    type(position_t), intent(in) :: position
    type(discretisation_t), pointer :: grid

    grid => self%pair%grid(position%mesh)
  end function grid

  pure real(wp) function spacing_over_neck(self, position)
    class(locked_steps_t), intent(in) :: self
    type(position_t), intent(in) :: position

    spacing_over_neck = over_neck(self%problem, &
      position%state%scale*self%pair%grid(position%mesh)%spacing)
  end function spacing_over_neck

end module locked_steps
