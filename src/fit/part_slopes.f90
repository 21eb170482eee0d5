!> Slopes of a measured curve: the slopes of straight lines through the samples of a segment, each
!> over a part of the travel.
module part_slopes
  use kinds, only: wp
  use sample_lines, only: sample_line_t, line_through
  use measured_curve, only: measured_curve_t
  implicit none
  private
  public :: slopes_of_parts, steepest_slope

  !> Number of parts of the travel, each of which overlaps the next by half; smallest number of
  !> samples in a part.
  integer, parameter :: parts = 10, fewest = 5

contains

  !> The slopes of the parts with enough samples, in units of signal over z. They are positive where
  !> the signal rises towards the other body, as in contact, and negative in a snap-in.
  pure function slopes_of_parts(measured) result(slope)
    type(measured_curve_t), intent(in) :: measured
    real(wp), allocatable :: slope(:)
    type(sample_line_t) :: line
    real(wp) :: low, width
    logical, allocatable :: there(:)
    integer :: i, way

    allocate (slope(0))
    associate (z => measured%z, s => measured%signal)
      low = minval(z)
      width = (maxval(z) - low)/parts
      do way = 1, 2
        do i = 0, 2*parts - 2
          there = measured%usable .and. measured%observed == measured%observed(1) .and. &
            (measured%inward .eqv. way == 1) .and. &
            abs(z - low - (0.5_wp*i + 0.5_wp)*width) <= 0.5_wp*width
          if (count(there) < fewest) cycle
          line = line_through(z, s, there)
          slope = [slope, -measured%facing*line%slope]
        end do
      end do
    end associate
  end function slopes_of_parts

  !> The steepest slope of any part, or that of the whole curve.
  pure real(wp) function steepest_slope(measured) result(slope)
    type(measured_curve_t), intent(in) :: measured

    associate (z => measured%z, s => measured%signal)
      slope = max(maxval(abs(slopes_of_parts(measured))), (maxval(s, measured%usable) - &
        minval(s, measured%usable))/max(maxval(z) - minval(z), tiny(1.0_wp)))
    end associate
  end function steepest_slope

end module part_slopes
