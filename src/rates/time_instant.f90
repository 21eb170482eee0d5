!> The bodies at one instant of time.
module time_instant
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  implicit none
  private
  public :: instant_t, extrapolate

  !> The bodies at a time [s], counted from the beginning of a segment. position: that of the drive,
  !> Q = H0 - compliance*load. memory, pressure: the memories (nodes, terms of `creep`) and the
  !> pressure on the material's mesh. dissipated: the energy dissipated by dashpots and fluid in the
  !> step that ends at this time. power, suction, suction_at: the power dissipated in the fluid
  !> [1/s], the largest suction, and the radius of the latter (lateral units).
  type :: instant_t
    real(wp) :: time = 0, position = 0
    integer :: mesh = 1
    type(state_t) :: state
    real(wp), allocatable :: memory(:, :), pressure(:)
    !> Products of the kernel with memories and pressure. They are kept so that a step computes one
    !> product only.
    real(wp), allocatable :: memory_rise(:, :), pressure_rise(:)
    real(wp) :: dissipated = 0, power = 0, suction = 0, suction_at = 0
    !> Number of steps since the last turn of the drive.
    integer :: since_turn = 0
  end type instant_t

  !> Smallest scale and smallest gap of an extrapolated state, relative to those of the later state.
  real(wp), parameter :: least_scale = 0.5_wp, least_gap = 0.7_wp

contains

  !> Linear extrapolation of a state from two states on one mesh. ahead: the distance beyond the
  !> later state, relative to the distance between the two. The deformations are extrapolated, since
  !> the undeformed shape is known. If the scale or a gap would become much smaller, the result is
  !> the later state.
  pure subroutine extrapolate(shape, grid, before, now, ahead, state)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: before, now
    real(wp), intent(in) :: ahead
    type(state_t), intent(inout) :: state

    state = now
    state%scale = now%scale + ahead*(now%scale - before%scale)
    state%h0 = now%h0 + ahead*(now%h0 - before%h0)
    if (state%scale > least_scale*now%scale) then
      associate (n => grid%nodes, x => grid%x)
        state%gap = (1 + ahead)*(now%gap - shape%height(now%scale*x(:n))) - &
          ahead*(before%gap - shape%height(before%scale*x(:n))) + &
          shape%height(state%scale*x(:n))
      end associate
      if (.not. any(state%gap < least_gap*now%gap)) return
    end if
    state = now
  end subroutine extrapolate

end module time_instant
