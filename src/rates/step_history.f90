!> The quantities that a step in time takes from earlier instants: the internal variables (memory)
!> of viscoelastic bodies, and the rate of the gaps for the fluid between the bodies (`drainage`).
!>
!> A step in time is an elastic problem (`creep`): pressures change linearly during the step, the
!> present pressures act on half-spaces softer than the instantaneous ones, and earlier pressures
!> have left a deformation. The memory belongs to the material and is stored on a mesh fixed in
!> space. Pressures are interpolated to this mesh; the deformation due to the memory, which is
!> smoother, is interpolated from it.
module step_history
  use kinds, only: wp, pi
  use earlier_deformation, only: rise_at
  use drainage, only: earlier_t, rate_weights
  use discretisation, only: first_node
  use potential_energy, only: energy_of_surface
  use creep, only: creep_t
  use memory_mesh, only: memory_mesh_t
  use solver, only: solver_t
  use time_instant, only: instant_t
  implicit none
  private
  public :: step_history_t

  !> instant: the coupling of the bodies without delayed deformation. compliance: the compliance of
  !> the spring of the drive; 0 without a spring.
  type, extends(solver_t) :: step_history_t
    type(creep_t) :: creep
    real(wp) :: instant = 0, compliance = 0
    !> The mesh fixed in space, of scale 1; it is not set for elastic bodies.
    type(memory_mesh_t) :: material
    !> Quantities of a step. left: the memories without the contribution of the present pressure.
    !> left_rise: the rise of the gap due to each of these memories. present: the coefficients of
    !> the present pressure in the memories. risen: the rise of the gap due to `left`.
    real(wp), allocatable :: left(:, :), left_rise(:, :), present(:), risen(:)
    !> The instant before the one from which the step starts.
    type(instant_t) :: before
    !> The weight of the present gaps in their rate [1/s], for which the Jacobian was computed.
    real(wp) :: made_for = 1
  contains
    procedure :: prepare
    procedure :: place_rise
    procedure :: remember
    procedure :: set_memory
    procedure :: energy
    procedure, private :: prepare_fluid
    procedure, private :: remember_fluid
    procedure, private :: note_pressure
  end type step_history_t

  !> Number of steps after a turn over which gaps are taken to change linearly with time.
  integer, parameter :: calming = 4
  !> Logarithm of the ratio of two time steps above which they need different Jacobians.
  real(wp), parameter :: other_length = 0.5_wp

contains

  !> Makes the equations of a step from an instant to a later time.
  subroutine prepare(self, from, time)
    class(step_history_t), intent(inout) :: self
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

  !> Computes the memories and the data of the fluid at the end of a step, and the energy dissipated
  !> in the step.
  subroutine remember(self, from, to)
    class(step_history_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    type(instant_t), intent(inout) :: to
    integer :: k

    call self%note_pressure(to)
    to%memory = from%memory
    to%memory_rise = from%memory_rise
    to%dissipated = 0
    do k = 1, size(to%memory, 2)
      to%memory(:, k) = self%left(:, k) + self%present(k)*to%pressure
      to%memory_rise(:, k) = self%left_rise(:, k) + self%present(k)*to%pressure_rise
      if (to%time > from%time) to%dissipated = to%dissipated + self%creep%share(k)* &
        self%creep%time(k)/(to%time - from%time)*sum(4*pi*self%instant*self%material%weight* &
        (to%memory(:, k) - from%memory(:, k))* &
        (to%memory_rise(first_node:, k) - from%memory_rise(first_node:, k)))
    end do
    if (allocated(self%drainage)) call self%remember_fluid(from, to)
  end subroutine remember

  !> Interpolates the rise of the gap due to the memory, and the earlier gaps for the fluid, to the
  !> nodes of a mesh whose scale is about `scale`.
  subroutine place_rise(self, mesh, scale)
    class(step_history_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale

    if (allocated(self%drainage)) call self%drainage%place(self%meshes%grid, mesh, scale)
    if (size(self%creep%share) > 0) self%earlier = rise_at(self%material%discretisation_t, &
      self%risen, self%meshes%grid(mesh), scale)
  end subroutine place_rise

  !> The weights of present and earlier gaps in the rate of the gaps. The rate is the slope of a
  !> parabola in time through the present gaps and those of the last two instants; it is the slope
  !> of a line if only one earlier instant exists.
  subroutine prepare_fluid(self, from, time)
    class(step_history_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time
    real(wp) :: weights(3)

    ! The rate jumps where the drive turns. The response of stiff bodies to this jump may decay
    ! within one step; a parabola would then overshoot.
    weights = rate_weights(time - from%time, merge(from%time - self%before%time, 0.0_wp, &
      from%since_turn >= calming))
    ! A Jacobian computed for a different length of the step is not accurate for this step.
    if (abs(log(weights(1)/self%made_for)) > other_length) then
      call self%frozen%forget()
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

  !> Computes the suction and the power of the fluid at the end of a step, and the energy dissipated
  !> in the step.
  subroutine remember_fluid(self, from, to)
    class(step_history_t), intent(in) :: self
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
    to%dissipated = to%dissipated + (to%time - from%time)* &
      merge(0.5_wp*(from%power + to%power), to%power, from%since_turn > 0)
  end subroutine remember_fluid

  !> Sets the internal variables of an instant to the values in relaxed bodies under its pressure.
  subroutine set_memory(self, at)
    class(step_history_t), intent(in) :: self
    type(instant_t), intent(inout) :: at

    call self%note_pressure(at)
    at%memory = spread(at%pressure, 2, size(self%creep%time))
    at%memory_rise = spread(at%pressure_rise, 2, size(self%creep%time))
  end subroutine set_memory

  !> Stores the pressure of an instant at the nodes of the material's mesh, and the rise due to this
  !> pressure. For elastic bodies both are empty.
  subroutine note_pressure(self, at)
    class(step_history_t), intent(in) :: self
    type(instant_t), intent(inout) :: at

    if (size(self%creep%time) == 0) then
      at%pressure = [real(wp) ::]
      at%pressure_rise = at%pressure
    else
      call self%material%take(self%meshes%grid(at%mesh), at%state%scale, at%state%pressure, &
        at%pressure, at%pressure_rise)
    end if
  end subroutine note_pressure

  !> The energy stored in bodies, surface force and spring, in units of load times length.
  real(wp) function energy(self, at)
    class(step_history_t), intent(inout) :: self
    type(instant_t), intent(in) :: at
    real(wp), allocatable :: rise(:)
    integer :: k

    associate (grid => self%meshes%grid(at%mesh), p => at%state%pressure, c => at%state%scale)
      allocate (rise(size(grid%kernel, 1)))
      ! The deformation without delayed parts; the operator uses the coupling of the present step.
      call self%operator%deform(self%problem, grid, c, size(p), p, rise)
      energy = energy_of_surface(self%equations_t, at%mesh, at%state) + &
        0.5_wp*self%compliance*at%state%load**2 + &
        pi*self%instant/self%problem%coupling*c**2*sum(grid%weight(:size(p))*p*rise(first_node:))
    end associate
    do k = 1, size(self%creep%share)
      energy = energy + 2*pi*self%instant*self%creep%share(k)*sum(self%material%weight* &
        at%memory(:, k)*at%memory_rise(first_node:, k))
    end do
  end function energy

end module step_history
