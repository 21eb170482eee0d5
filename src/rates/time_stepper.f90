!> Steps in time of viscoelastic bodies, or of bodies with a fluid between them. States are solved
!> on meshes that follow the contact edge.
module time_stepper
  use kinds, only: wp
  use contact_state, only: state_t, regrid
  use controls, only: control_t, at_h0_with_edge, at_edge_radius
  use mesh_plan, only: approach
  use contact_scales, only: cohesive_width
  use path_coordinate, only: coordinate_of, h0_control
  use next_mesh, only: radius_for
  use anderson, only: solve_anderson
  use solver_options, only: rescue_of
  use time_instant, only: instant_t, extrapolate
  use step_history, only: step_history_t
  implicit none
  private
  public :: time_stepper_t, expected_scale

  !> Computes the instants of a drive one after the other.
  type, extends(step_history_t) :: time_stepper_t
    !> The largest change of the path's coordinate in a step. A larger change means a jump, or that
    !> shorter steps are needed.
    real(wp) :: farthest = 0.3_wp
  contains
    procedure :: step
    procedure :: move_to_mesh
    procedure :: mesh_for
    procedure :: control_at
    procedure :: finest
    procedure, private :: guess
  end type time_stepper_t

  !> If the contact radius falls below this fraction of the radius at which the mesh was changed,
  !> the state returns to the mesh before the change. Longest extrapolation relative to the previous
  !> step.
  real(wp), parameter :: back = 0.97_wp, longest_guess = 3
  !> If scale and expected scale differ by less than this fraction of `finest`, the memory is linear
  !> in the scale; the second limit is that for the earlier gaps under a fluid. Largest number of
  !> rounds.
  real(wp), parameter :: far_off = 0.1_wp, far_off_fluid = 0.02_wp
  integer, parameter :: most_rounds = 3
  !> Largest relative difference of radius and gap with which a state counts as the same on two
  !> meshes.
  real(wp), parameter :: same_state = 0.05_wp
  !> Largest value of `finest` relative to the contact radius.
  real(wp), parameter :: part_of_contact = 0.3_wp

contains

  !> A step from an instant to a later time and the position of the drive at this time. done =
  !> .false.: there is no solution near the earlier state, because the step is too long or the
  !> bodies jump.
  subroutine step(self, from, time, position, to, done)
    class(time_stepper_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time, position
    type(instant_t), intent(out) :: to
    logical, intent(out) :: done
    type(control_t) :: control
    real(wp) :: expected
    integer :: mesh, round

    call self%prepare(from, time)
    to%time = time
    to%position = position
    to%mesh = from%mesh
    call self%guess(from, time, position, control, to%state)
    do round = 1, most_rounds
      call self%place_rise(to%mesh, expected_scale(control, to%state))
      expected = to%state%scale
      call self%solve(control, to%state, done)
      if (.not. done .and. allocated(self%drainage)) then
        ! The fluid's part of the Jacobian changes considerably where gaps close.
        call self%guess(from, time, position, control, to%state)
        call solve_anderson(self%equations_t, rescue_of(self%options), self%frozen, control, &
          to%state, done)
      end if
      if (done .and. self%meshes%traceable) done = &
        abs(coordinate_of(self%problem, self%meshes, to%mesh, to%state) - &
        coordinate_of(self%problem, self%meshes, from%mesh, from%state)) < self%farthest
      if (.not. done) exit
      if (abs(to%state%scale - expected) <= merge(far_off_fluid, far_off, &
        allocated(self%drainage))*self%finest(expected)) exit
    end do
    if (.not. done) then
      call self%frozen%forget()
      return
    end if
    mesh = self%mesh_for(to%mesh, to%state)
    if (mesh /= to%mesh) call self%move_to_mesh(mesh, position, to)
    call self%remember(from, to)
  end subroutine step

  !> The state expected at a time, and the control for this state. The state is extrapolated from
  !> the last two instants if they are on one mesh.
  subroutine guess(self, from, time, position, control, state)
    class(time_stepper_t), intent(in) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time, position
    type(control_t), intent(out) :: control
    type(state_t), intent(out) :: state
    real(wp) :: ahead

    state = from%state
    associate (before => self%before)
      if (before%mesh == from%mesh .and. from%time > before%time) then
        ahead = min(longest_guess, (time - from%time)/(from%time - before%time))
        call extrapolate(self%problem%shape, self%meshes%grid(from%mesh), before%state, &
          from%state, ahead, state)
      end if
    end associate
    control = self%control_at(position, from%mesh, state)
    if (.not. self%meshes%traceable) state = regrid(self%problem%shape, from%state, &
      self%meshes%grid(from%mesh), self%meshes%grid(from%mesh), control%scale)
  end subroutine guess

  !> The control that prescribes the position of the drive, for states on a mesh. state: a guess of
  !> the state.
  type(control_t) function control_at(self, position, mesh, state) result(control)
    class(time_stepper_t), intent(in) :: self
    real(wp), intent(in) :: position
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    ! With a spring, the position may change considerably while h0 hardly changes.
    control = h0_control(self%problem%shape, self%meshes, mesh, &
      merge(state%h0, position, self%compliance > 0))
    control%value = position
    control%compliance = self%compliance
  end function control_at

  !> The shortest length over which the memory changes near the edge: the width of the cohesive zone
  !> of relaxed bodies, at most a fraction of the contact radius.
  pure real(wp) function finest(self, radius)
    class(time_stepper_t), intent(in) :: self
    real(wp), intent(in) :: radius

    finest = min(cohesive_width(self%problem)*(self%problem%coupling/ &
      (self%instant*self%creep%relaxed())), part_of_contact*radius)
  end function finest

  !> The scale that the state is expected to have with a control.
  pure real(wp) function expected_scale(control, state) result(scale)
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state

    scale = control%scale
    if (control%kind == at_edge_radius) scale = control%value
    if (control%kind == at_h0_with_edge) scale = state%scale
  end function expected_scale

  !> The mesh on which a state of the mesh `mesh` is to be solved, which may be `mesh` itself.
  integer function mesh_for(self, mesh, state)
    class(time_stepper_t), intent(in) :: self
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    mesh_for = mesh
    if (.not. self%problem%law%edge_gap > 0 .or. .not. self%meshes%traceable) return
    associate (meshes => self%meshes)
      if (mesh < size(meshes%grid)) then
        if (radius_for(self%equations_t, mesh, mesh + 1, state) > meshes%passage(mesh)) then
          mesh_for = mesh + 1
          return
        end if
      end if
      if (mesh > approach) then
        if (state%scale < back*meshes%passage(mesh - 1)) mesh_for = mesh - 1
      end if
    end associate
  end function mesh_for

  !> Moves an instant to another mesh, at the same position of the drive. If this fails, the instant
  !> stays on its mesh.
  subroutine move_to_mesh(self, mesh, position, at)
    class(time_stepper_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: position
    type(instant_t), intent(inout) :: at
    type(state_t) :: state
    real(wp) :: scale
    logical :: done

    scale = radius_for(self%equations_t, at%mesh, mesh, at%state)
    if (.not. scale > 0) return
    state = regrid(self%problem%shape, at%state, self%meshes%grid(at%mesh), &
      self%meshes%grid(mesh), scale)
    call self%place_rise(mesh, scale)
    call self%solve(self%control_at(position, mesh, at%state), state, done)
    ! Near a fold there is a second state with the same h0, which must not be taken.
    if (done) done = abs(state%axis_gap - at%state%axis_gap) < &
      same_state*(1 + abs(at%state%axis_gap)) .and. abs(state%scale - scale) < same_state*scale
    if (.not. done) then
      call self%place_rise(at%mesh, at%state%scale)
      return
    end if
    at%state = state
    at%mesh = mesh
  end subroutine move_to_mesh

end module time_stepper
