!> The motion of a drive has three segments: an approach at constant velocity, a dwell, and a
!> retract.
module motion
  use kinds, only: wp
  implicit none
  private
  public :: motion_t, new_motion, names_of_ways

  !> The segments of a motion, in order.
  character(len=*), parameter :: names_of_ways(3) = [character(len=8) :: 'approach', 'dwell', &
    'retreat']

  !> Times [s] at which the segments begin, their durations [s], and the positions at their ends (in
  !> lengths L of the law). Time is counted from the beginning of each segment, so that a long dwell
  !> causes no rounding errors in later steps. least: the time [s] in which the drive moves by
  !> `negligible`.
  type :: motion_t
    real(wp) :: began(3) = 0, lasts(3) = 0, position(0:3) = 0, least = 0
  contains
    procedure :: at
    procedure :: length_of
  end type motion_t

  !> A distance (in lengths L) within the errors of positions. Rates of gaps over a shorter distance
  !> would be rounding errors. A segment that is shorter, in distance or in time, is left out.
  real(wp), parameter :: negligible = 1.0e-9_wp

contains

  !> The motion from `start` to `turn`, a dwell [s], and the motion to `finish`. velocity: lengths L
  !> per second.
  pure type(motion_t) function new_motion(velocity, start, turn, dwell, finish) result(motion)
    real(wp), intent(in) :: velocity, start, turn, dwell, finish

    motion%position = [start, turn, turn, finish]
    motion%lasts = [abs(turn - start)/velocity, dwell, abs(finish - turn)/velocity]
    motion%least = negligible/velocity
    where (motion%lasts < motion%least) motion%lasts = 0
    motion%began(2) = motion%lasts(1)
    motion%began(3) = sum(motion%lasts(:2))
  end function new_motion

  !> The position of the drive on a segment, at a time counted from its beginning.
  pure real(wp) function at(self, way, time) result(position)
    class(motion_t), intent(in) :: self
    integer, intent(in) :: way
    real(wp), intent(in) :: time

    position = self%position(way)
    if (self%lasts(way) > 0) position = position + &
      (self%position(way - 1) - position)*(self%lasts(way) - time)/self%lasts(way)
  end function at

  !> The distance between the ends of a segment.
  pure real(wp) function length_of(self, way)
    class(motion_t), intent(in) :: self
    integer, intent(in) :: way

    length_of = abs(self%position(way) - self%position(way - 1))
  end function length_of

end module motion
