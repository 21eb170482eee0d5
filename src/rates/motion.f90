!> The motion of a drive: an approach at constant velocity, a dwell, and a retreat.
module motion
  use kinds, only: wp
  implicit none
  private
  public :: motion_t, new_motion, names_of_ways

  !> The ways of a motion, in order.
  character(len=*), parameter :: names_of_ways(3) = [character(len=8) :: 'approach', 'dwell', &
    'retreat']

  !> Times [s] at which the ways begin and the last way ends, and positions at these times (law's
  !> lengths).
  type :: motion_t
    real(wp) :: time(0:3) = 0, position(0:3) = 0
  contains
    procedure :: at
  end type motion_t

contains

  !> The motion from `start` to `turn`, a dwell [s], and the motion to `finish`. velocity: the law's
  !> lengths per second.
  pure type(motion_t) function new_motion(velocity, start, turn, dwell, finish) result(motion)
    real(wp), intent(in) :: velocity, start, turn, dwell, finish

    motion%position = [start, turn, turn, finish]
    motion%time(1) = abs(turn - start)/velocity
    motion%time(2) = motion%time(1) + dwell
    motion%time(3) = motion%time(2) + abs(finish - turn)/velocity
  end function new_motion

  !> The position of the drive on a way at a time.
  pure real(wp) function at(self, way, time) result(position)
    class(motion_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(in) :: time

    associate (from => self%time(way - 1), to => self%time(way))
      position = self%position(way)
      if (to > from) position = self%position(way) + &
        (self%position(way - 1) - self%position(way))*(to - time)/(to - from)
    end associate
  end function at

end module motion
