!> Steps in time of bodies that remember. A step is an elastic problem: over it the pressures change
!> linearly, so that the present ones meet half-spaces softer than at once, and earlier ones have
!> left a deformation (`creep`). States are solved on meshes that follow the contact edge. The
!> memory belongs to the material: it is kept on a mesh fixed in space, where pressures are
!> interpolated to, and the deformation that it makes, which is smoother, is interpolated from.
module time_stepper
  use kinds, only: wp, pi
  use discretisation, only: discretisation_t, first_node
  use shape, only: shape_t
  use contact_state, only: state_t
  use equilibrium, only: control_t, at_h0_with_edge
  use edge_locked, only: approach
  use contact_scales, only: cohesive_width
  use locked_meshes, only: h0_control
  use path_coordinate, only: coordinate_of
  use continuation, only: radius_for
  use regridding, only: regrid
  use potential_energy, only: energy_of_surface
  use besides, only: besides_t, rise_at
  use linear_algebra, only: multiply
  use material, only: material_t
  use drainage, only: drainage_t, earlier_t, rate_weights
  use creep, only: creep_t
  use anderson, only: solve_anderson
  use solver_options, only: newton_of
  use solver, only: solver_t
  implicit none
  private
  public :: time_stepper_t, instant_t, extrapolate

  !> Bodies at a time [s]: the position of the drive, D = H0 - compliance*load, the state; on the
  !> material's mesh the memories (nodes, terms of `creep`) and the pressure. dissipated: what
  !> dashpots and the fluid took in the step that led there. Of the fluid: the power [1/s] that it
  !> takes, its largest suction and where that is (lateral units).
  type :: instant_t
    real(wp) :: time = 0, position = 0
    integer :: mesh = 1
    type(state_t) :: state
    real(wp), allocatable :: memory(:, :), pressure(:)
    !> What the kernel makes of them, so that a step has one product with it.
    real(wp), allocatable :: memory_rise(:, :), pressure_rise(:)
    real(wp) :: dissipated = 0, power = 0, suction = 0, suction_at = 0
    !> Steps since the drive turned.
    integer :: since_turn = 0
  end type instant_t

  !> instant: coupling of bodies that have no time to yield more.
  type, extends(solver_t) :: time_stepper_t
    type(creep_t) :: creep
    real(wp) :: instant = 0, compliance = 0
    !> The largest change of the path's coordinate in a step: what changes by more has jumped, or is
    !> to be followed in shorter steps.
    real(wp) :: farthest = 0.3_wp
    !> The weight of the present gaps in the rate, 1/s, that the Jacobian was made for.
    real(wp) :: made_for = 1
    !> Fixed in space, of scale 1; there is none of bodies that do not remember.
    type(material_t) :: material
    !> What came before the present instant, to guess the next from. Of a step: memories that are
    !> left of earlier ones, the parts of the present pressure in them, and the rise that they make.
    type(instant_t) :: before
    real(wp), allocatable :: left(:, :), left_rise(:, :), present(:), risen(:)
  contains
    procedure :: step
    procedure :: prepare
    procedure :: place_rise
    procedure :: move_to_mesh
    procedure :: mesh_for
    procedure :: control_at
    procedure :: remember
    procedure :: energy
    procedure :: finest
    procedure, private :: note_pressure
    procedure :: set_memory
    procedure, private :: prepare_fluid
    procedure, private :: remember_fluid
    procedure, private :: guess
  end type time_stepper_t

  !> Radius over that of a passage at which a mesh is left again; longest extrapolation over the
  !> step before.
  real(wp), parameter :: back = 0.97_wp, longest_guess = 3
  !> What the scale may miss the expected one by, over what is finest, for the memory or
  !> the earlier gaps to be linear in it; rounds.
  real(wp), parameter :: far_off = 0.1_wp, far_off_fluid = 0.02_wp
  integer, parameter :: most_rounds = 3
  !> Parts of radius and gap by which two meshes may differ in what they say of one state.
  real(wp), parameter :: same_state = 0.05_wp
  !> Steps after a turn over which gaps change along lines.
  integer, parameter :: calming = 4
  !> Logarithm of the ratio of steps that have no Jacobian in common.
  real(wp), parameter :: other_length = 0.5_wp
  !> The part of a contact that is as fine as its edge may be.
  real(wp), parameter :: part_of_contact = 0.3_wp

contains

  !> From an instant to a later time and the position there. done = .false.: the bodies are not near
  !> where they were, and the step is too long, or leads over a jump.
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
      call self%place_rise(to%mesh, control_scale(control, to%state))
      expected = to%state%scale
      call self%solve(control, to%state, done)
      if (.not. done .and. allocated(self%drainage)) then
        ! The fluid's part of the Jacobian changes much where gaps close.
        call self%guess(from, time, position, control, to%state)
        self%frozen%factors%valid = .false.
        call solve_anderson(self%equations_t, newton_of(self%options), self%frozen, control, &
          to%state, done)
      end if
      if (done .and. self%meshes%traceable) done = &
        abs(coordinate_of(self%problem, to%mesh, to%state) - &
        coordinate_of(self%problem, from%mesh, from%state)) < self%farthest
      if (.not. done) exit
      if (abs(to%state%scale - expected) <= merge(far_off_fluid, far_off, &
        allocated(self%drainage))*self%finest(expected)) exit
    end do
    if (.not. done) then
      self%frozen%factors%valid = .false.
      return
    end if
    mesh = self%mesh_for(to%mesh, to%state)
    if (mesh /= to%mesh) call self%move_to_mesh(mesh, position, to)
    call self%remember(from, to)
  end subroutine step

  !> Makes the equations those of a step from an instant to a time.
  subroutine prepare(self, from, time)
    class(time_stepper_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time
    real(wp), dimension(size(self%creep%time)) :: kept, past
    real(wp) :: softer
    integer :: k

    if (allocated(self%drainage)) call self%prepare_fluid(from, time)
    if (.not. allocated(self%present)) allocate (self%present(size(kept)))
    call self%creep%over_step(time - from%time, kept, past, self%present)
    softer = 1 + dot_product(self%creep%share, self%present)
    self%problem%coupling = self%instant*softer
    if (size(kept) == 0) return
    self%left = from%memory
    self%left_rise = from%memory_rise
    do k = 1, size(kept)
      self%left(:, k) = kept(k)*from%memory(:, k) + past(k)*from%pressure
      self%left_rise(:, k) = kept(k)*from%memory_rise(:, k) + past(k)*from%pressure_rise
    end do
    self%risen = 2*self%instant*matmul(self%left_rise, self%creep%share)
  end subroutine prepare

  !> The rate at which gaps change over a step: of a parabola through the last two instants, where
  !> these are two.
  subroutine prepare_fluid(self, from, time)
    class(time_stepper_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time
    real(wp) :: weights(3)

    ! Where the drive turns the rate jumps. What bodies that hardly yield make of that dies away in
    ! a time that no step may resolve: a parabola would overshoot.
    weights = rate_weights(time - from%time, merge(from%time - self%before%time, 0.0_wp, &
      from%since_turn >= calming))
    ! A Jacobian made for another length of steps says little of this one.
    if (abs(log(weights(1)/self%made_for)) > other_length) then
      self%frozen%factors%valid = .false.
      self%made_for = weights(1)
    end if
    self%drainage%weight = weights(1)
    self%drainage%earlier(1) = earlier(from, weights(2))
    self%drainage%earlier(2) = earlier(self%before, weights(3))

  contains

    type(earlier_t) function earlier(at, weight)
      type(instant_t), intent(in) :: at
      real(wp), intent(in) :: weight

      earlier%mesh = at%mesh
      earlier%scale = at%state%scale
      earlier%weight = weight
      earlier%raised = self%raised(at%mesh, at%state)
    end function earlier

  end subroutine prepare_fluid

  !> What the fluid does at the end of a step; what it takes in it.
  subroutine remember_fluid(self, from, to)
    class(time_stepper_t), intent(in) :: self
    type(instant_t), intent(in) :: from
    type(instant_t), intent(inout) :: to
    real(wp), dimension(size(to%state%gap)) :: pressure, rate
    integer :: lowest

    associate (grid => self%meshes%grid(to%mesh), c => to%state%scale)
      pressure = self%fluid_pressure(to%mesh, to%state, rate)
      lowest = minloc(pressure, 1)
      to%suction = -pressure(lowest)
      to%suction_at = c*grid%x(lowest)
      to%power = -2*pi*c**2*sum(grid%weight*pressure*rate)
    end associate
    to%since_turn = from%since_turn + 1
    to%dissipated = (to%time - from%time)*to%power
    if (from%since_turn > 0) to%dissipated = &
      (to%time - from%time)*0.5_wp*(from%power + to%power)
  end subroutine remember_fluid

  !> The memories of the instant that a step has led to.
  subroutine remember(self, from, to)
    class(time_stepper_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    type(instant_t), intent(inout) :: to
    integer :: k

    call self%note_pressure(to)
    to%memory = from%memory
    to%memory_rise = from%memory_rise
    to%dissipated = 0
    if (allocated(self%drainage)) call self%remember_fluid(from, to)
    if (size(to%memory, 2) == 0) return
    associate (weight => 4*pi*self%instant*self%material%weight)
      do k = 1, size(to%memory, 2)
        to%memory(:, k) = self%left(:, k) + self%present(k)*to%pressure
        to%memory_rise(:, k) = self%left_rise(:, k) + self%present(k)*to%pressure_rise
        if (to%time > from%time) to%dissipated = to%dissipated + self%creep%share(k)* &
          self%creep%time(k)/(to%time - from%time)* &
          sum(weight*(to%memory(:, k) - from%memory(:, k))* &
          (to%memory_rise(first_node:, k) - from%memory_rise(first_node:, k)))
      end do
    end associate
  end subroutine remember

  !> Lets an instant be one of bodies at rest under their pressure.
  subroutine set_memory(self, at)
    class(time_stepper_t), intent(in) :: self
    type(instant_t), intent(inout) :: at

    call self%note_pressure(at)
    at%memory = spread(at%pressure, 2, size(self%creep%time))
    at%memory_rise = spread(at%pressure_rise, 2, size(self%creep%time))
  end subroutine set_memory

  !> Notes the pressure of an instant on the nodes of the material's mesh, and what the half-space
  !> makes of it; bodies that do not remember have none.
  subroutine note_pressure(self, at)
    class(time_stepper_t), intent(in) :: self
    type(instant_t), intent(inout) :: at

    if (size(self%creep%time) == 0) then
      at%pressure = [real(wp) ::]
      at%pressure_rise = at%pressure
    else
      call self%material%take(self%meshes%grid(at%mesh), at%state%scale, at%state%pressure, &
        at%pressure, at%pressure_rise)
    end if
  end subroutine note_pressure

  !> Brings the rise that the memory makes to the nodes of a mesh at about a scale.
  subroutine place_rise(self, mesh, scale)
    class(time_stepper_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale

    if (allocated(self%drainage)) call self%drainage%place(self%meshes%grid, mesh, scale)
    if (size(self%creep%share) > 0) self%besides = rise_at(self%material%discretisation_t, &
      self%risen, self%meshes%grid(mesh), scale)
  end subroutine place_rise

  !> The state to be expected at a time, from the last two instants where they are on one mesh, and
  !> the control for it.
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

  !> The state that the line through two of a mesh leads to, so far beyond the later one:
  !> deformations are on it, and the shape beneath, which is known, is not. A gap that would shrink
  !> by much is not believed.
  pure subroutine extrapolate(shape, grid, before, now, ahead, state)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: before, now
    real(wp), intent(in) :: ahead
    type(state_t), intent(inout) :: state

    state = now
    state%scale = now%scale + ahead*(now%scale - before%scale)
    state%h0 = now%h0 + ahead*(now%h0 - before%h0)
    if (state%scale > 0.5_wp*now%scale) then
      associate (n => grid%nodes, x => grid%x)
        state%gap = (1 + ahead)*(now%gap - shape%height(now%scale*x(:n))) - &
          ahead*(before%gap - shape%height(before%scale*x(:n))) + &
          shape%height(state%scale*x(:n))
      end associate
      if (.not. any(state%gap < 0.7_wp*now%gap)) return
    end if
    state = now
  end subroutine extrapolate

  !> The control that prescribes the position of the drive on a mesh; state: about what is expected.
  type(control_t) function control_at(self, position, mesh, state) result(control)
    class(time_stepper_t), intent(in) :: self
    real(wp), intent(in) :: position
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    ! Behind a spring the position may move far while h0 hardly does.
    control = h0_control(self%problem%shape, self%meshes, mesh, &
      merge(state%h0, position, self%compliance > 0))
    control%value = position
    control%compliance = self%compliance
  end function control_at

  !> The finest that the memory is about the edge: the neck of relaxed bodies, or a part of the
  !> contact.
  pure real(wp) function finest(self, radius)
    class(time_stepper_t), intent(in) :: self
    real(wp), intent(in) :: radius

    finest = min(cohesive_width(self%problem)*self%problem%coupling/ &
      (self%instant*self%creep%relaxed()), part_of_contact*radius)
  end function finest

  !> The scale that a state is expected to have under a control.
  pure real(wp) function control_scale(control, state)
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state

    control_scale = control%scale
    if (control%kind == at_h0_with_edge) control_scale = state%scale
  end function control_scale

  !> The mesh that a state belongs on, which it may be on already.
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

  !> Moves an instant to another mesh, at the same position; where that fails it stays.
  subroutine move_to_mesh(self, mesh, position, at)
    class(time_stepper_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: position
    type(instant_t), intent(inout) :: at
    type(state_t) :: state
    real(wp) :: scale
    logical :: done

    scale = 1
    if (mesh > approach) scale = radius_for(self%equations_t, at%mesh, mesh, at%state)
    if (.not. scale > 0) return
    state = regrid(self%problem%shape, at%state, self%meshes%grid(at%mesh), &
      self%meshes%grid(mesh), scale)
    call self%place_rise(mesh, scale)
    call self%solve(self%control_at(position, mesh, at%state), state, done)
    ! Beside a fold another state has the same h0.
    if (done) done = abs(state%axis_gap - at%state%axis_gap) < &
      same_state*(1 + abs(at%state%axis_gap)) .and. abs(state%scale - scale) < same_state*scale
    if (.not. done) then
      call self%place_rise(at%mesh, at%state%scale)
      return
    end if
    at%state = state
    at%mesh = mesh
  end subroutine move_to_mesh

  !> The energy that bodies, surface force and spring hold, in units of load times length.
  real(wp) function energy(self, at)
    class(time_stepper_t), intent(inout) :: self
    type(instant_t), intent(in) :: at
    real(wp), allocatable :: rise(:)
    integer :: k

    associate (grid => self%meshes%grid(at%mesh), p => at%state%pressure, c => at%state%scale)
      allocate (rise(size(grid%kernel, 1)))
      call multiply(grid%kernel, size(p), p, rise)
      energy = energy_of_surface(self%equations_t, at%mesh, at%state) + &
        0.5_wp*self%compliance*at%state%load**2 + &
        2*pi*self%instant*c**3*sum(grid%weight(:size(p))*p*rise(first_node:))
    end associate
    do k = 1, size(self%creep%share)
      energy = energy + 2*pi*self%instant*self%creep%share(k)*sum(self%material%weight* &
        at%memory(:, k)*at%memory_rise(first_node:, k))
    end do
  end function energy

end module time_stepper
