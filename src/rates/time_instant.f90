!> The bodies at a time, and the motion of a drive: an approach at constant velocity, a dwell, and a
!> retreat.
module time_instant
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  implicit none
  private
  public :: instant_t, extrapolate, motion_t, new_motion, names_of_ways

  !> Bodies at a time [s] since the beginning of a way: the position of the drive, D = H0 -
  !> compliance*load, and the state; on the material's mesh the memories (nodes, terms of `creep`)
  !> and the pressure. dissipated: the energy dissipated by dashpots and the fluid in the step that
  !> ends at this time. Of the fluid: the dissipated power [1/s], the largest suction and its radius
  !> (lateral units).
  type :: instant_t
    real(wp) :: time = 0, position = 0
    integer :: mesh = 1
    type(state_t) :: state
    real(wp), allocatable :: memory(:, :), pressure(:)
    !> Products of the kernel with memories and pressure, so that a step computes one product only.
    real(wp), allocatable :: memory_rise(:, :), pressure_rise(:)
    real(wp) :: dissipated = 0, power = 0, suction = 0, suction_at = 0
    !> Number of steps since the last turn of the drive.
    integer :: since_turn = 0
  end type instant_t

  !> The ways of a motion, in order.
  character(len=*), parameter :: names_of_ways(3) = [character(len=8) :: 'approach', 'dwell', &
    'retreat']

  !> Times [s] at which the ways begin, their durations [s], and the positions between which they
  !> lead (law's lengths). Time is counted from the beginning of a way, so that a long dwell does
  !> not round the steps after it.
  type :: motion_t
    real(wp) :: began(3) = 0, lasts(3) = 0, position(0:3) = 0
  contains
    procedure :: at
    procedure :: length_of
  end type motion_t

contains

  !> Linear extrapolation of a state from two states on one mesh. ahead: distance beyond the later
  !> state over the distance between the two. The deformations are extrapolated; the undeformed
  !> shape is known. If an extrapolated gap is much smaller than the later gap, the result is the
  !> later state.
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
        state%gap = (1 + ahead)*(now%gap - shape%height(now%scale*x(:n))) - ahead*(before%gap - &
          shape%height(before%scale*x(:n))) + shape%height(state%scale*x(:n))
      end associate
      if (.not. any(state%gap < 0.7_wp*now%gap)) return
    end if
    state = now
  end subroutine extrapolate

  !> The motion from `start` to `turn`, a dwell [s], and the motion to `finish`. velocity: the law's
  !> lengths per second.
  pure type(motion_t) function new_motion(velocity, start, turn, dwell, finish) result(motion)
    real(wp), intent(in) :: velocity, start, turn, dwell, finish

    motion%position = [start, turn, turn, finish]
    motion%lasts = [abs(turn - start)/velocity, dwell, abs(finish - turn)/velocity]
    motion%began(2) = motion%lasts(1)
    motion%began(3) = motion%lasts(1) + dwell
  end function new_motion

  !> The position of the drive on a way at a time since its beginning.
  pure real(wp) function at(self, way, time) result(position)
    class(motion_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(in) :: time

    position = self%position(way)
    if (self%lasts(way) > 0) position = position + &
      (self%position(way - 1) - position)*(self%lasts(way) - time)/self%lasts(way)
  end function at

  !> The distance between the ends of a way.
  pure real(wp) function length_of(self, way)
    class(motion_t), intent(in) :: self
    integer, intent(in) :: way

    length_of = abs(self%position(way) - self%position(way - 1))
  end function length_of

end module time_instant
