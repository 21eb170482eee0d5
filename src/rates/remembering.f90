!> The memory of viscoelastic bodies. A step in time is an elastic problem (`creep`): pressures
!> change linearly during the step, the present pressures act on half-spaces that are softer than
!> instantaneously, and earlier pressures have left a deformation. The memory belongs to the
!> material and is stored on a mesh fixed in space. Pressures are interpolated to this mesh; the
!> deformation due to the memory, which is smoother, is interpolated from it.
module remembering
  use kinds, only: wp, pi
  use discretisation, only: first_node
  use potential_energy, only: energy_of_surface
  use creep, only: creep_t
  use material, only: material_t
  use solver, only: solver_t
  use time_instant, only: instant_t
  implicit none
  private
  public :: remembering_t

  !> instant: coupling of the bodies without delayed deformation. compliance: that of the spring of
  !> the drive, 0 without a spring.
  type, extends(solver_t) :: remembering_t
    type(creep_t) :: creep
    real(wp) :: instant = 0, compliance = 0
    !> The mesh fixed in space, of scale 1; it is not set for bodies without memory.
    type(material_t) :: material
    !> Of a step: the memories without the part of the present pressure, and the rise due to each;
    !> the coefficients of the present pressure in the memories; the rise of the gap due to `left`.
    real(wp), allocatable :: left(:, :), left_rise(:, :), present(:), risen(:)
  contains
    procedure :: prepare_memory
    procedure :: remember_pressure
    procedure :: set_memory
    procedure :: energy
    procedure, private :: note_pressure
  end type remembering_t

contains

  !> Makes the equations of a step from an instant to a time.
  subroutine prepare_memory(self, from, time)
    class(remembering_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time
    real(wp), dimension(size(self%creep%time)) :: kept, past
    real(wp) :: softer
    integer :: k

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
  end subroutine prepare_memory

  !> Computes the memories of the instant at the end of a step, and the energy dissipated in it.
  subroutine remember_pressure(self, from, to)
    class(remembering_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    type(instant_t), intent(inout) :: to
    integer :: k

    call self%note_pressure(to)
    to%memory = from%memory
    to%memory_rise = from%memory_rise
    to%dissipated = 0
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
  end subroutine remember_pressure

  !> Sets the memories of an instant to those of relaxed bodies under the present pressure.
  subroutine set_memory(self, at)
    class(remembering_t), intent(in) :: self
    type(instant_t), intent(inout) :: at

    call self%note_pressure(at)
    at%memory = spread(at%pressure, 2, size(self%creep%time))
    at%memory_rise = spread(at%pressure_rise, 2, size(self%creep%time))
  end subroutine set_memory

  !> Stores the pressure of an instant at the nodes of the material's mesh, and the rise due to this
  !> pressure; both are empty for bodies without memory.
  subroutine note_pressure(self, at)
    class(remembering_t), intent(in) :: self
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
    class(remembering_t), intent(inout) :: self
    type(instant_t), intent(in) :: at
    real(wp), allocatable :: rise(:)
    integer :: k

    associate (grid => self%meshes%grid(at%mesh), p => at%state%pressure, c => at%state%scale)
      allocate (rise(size(grid%kernel, 1)))
      ! Without the memory, at the coupling of the present step.
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

end module remembering
