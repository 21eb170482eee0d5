!> The fluid between the bodies during a step in time (`drainage`): the rate of the gaps, computed
!> from the last two instants, and the energy that the fluid dissipates. The memory of the bodies is
!> that of `remembering`.
module draining
  use kinds, only: wp, pi
  use besides, only: rise_at
  use drainage, only: earlier_t, rate_weights
  use time_instant, only: instant_t
  use remembering, only: remembering_t
  implicit none
  private
  public :: draining_t

  type, extends(remembering_t) :: draining_t
    !> The instant before the present instant.
    type(instant_t) :: before
    !> The weight of the present gaps in the rate, 1/s, for which the Jacobian was computed.
    real(wp) :: made_for = 1
  contains
    procedure :: prepare
    procedure :: place_rise
    procedure :: remember
    procedure, private :: prepare_fluid
    procedure, private :: remember_fluid
  end type draining_t

  !> Number of steps after a turn in which gaps change linearly with time.
  integer, parameter :: calming = 4
  !> Logarithm of the ratio of two steps above which they need different Jacobians.
  real(wp), parameter :: other_length = 0.5_wp

contains

  !> Makes the equations of a step from an instant to a time.
  subroutine prepare(self, from, time)
    class(draining_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time

    if (allocated(self%drainage)) call self%prepare_fluid(from, time)
    call self%prepare_memory(from, time)
  end subroutine prepare

  !> Computes the memories, and the data of the fluid, of the instant at the end of a step.
  subroutine remember(self, from, to)
    class(draining_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    type(instant_t), intent(inout) :: to

    call self%remember_pressure(from, to)
    if (allocated(self%drainage)) call self%remember_fluid(from, to)
  end subroutine remember

  !> Interpolates the rise of the gap due to the memory, and the earlier gaps of the fluid, at the
  !> nodes of a mesh whose scale is about `scale`.
  subroutine place_rise(self, mesh, scale)
    class(draining_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: scale

    if (allocated(self%drainage)) call self%drainage%place(self%meshes%grid, mesh, scale)
    if (size(self%creep%share) > 0) self%besides = rise_at(self%material%discretisation_t, &
      self%risen, self%meshes%grid(mesh), scale)
  end subroutine place_rise

  !> The weights of present and earlier gaps in the rate of the gaps: the slope of a parabola in
  !> time through the gaps of the last two instants and the present gaps, or of a line if there is
  !> one earlier instant.
  subroutine prepare_fluid(self, from, time)
    class(draining_t), intent(inout) :: self
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time
    real(wp) :: weights(3)

    ! The rate jumps where the drive turns. The response of stiff bodies to this jump decays in a
    ! time that may be shorter than a step: a parabola would overshoot.
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

  !> The suction and power of the fluid at the end of a step, and the energy dissipated in the step.
  subroutine remember_fluid(self, from, to)
    class(draining_t), intent(in) :: self
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

end module draining
