!> Whether there is a contact in a measured curve at all: a departure from a straight line.
module contact_check
  use kinds, only: wp
  use text, only: counted, rounded
  use significance, only: stands_out, surely
  use sample_lines, only: sample_line_t, line_through
  use measured_curve, only: measured_curve_t
  use noise, only: noise_t, white_noise, rough_deviation
  use residual_analysis, only: lack_t, lack_in
  implicit none
  private
  public :: check_contact, steep

  !> The least slope of samples in contact, in units of that of the spring.
  real(wp), parameter :: steep = 0.2_wp

contains

  !> Sets `trouble` if straight lines describe approach and retract. Compares single samples, means
  !> over neighbours, and the samples nearest to the other body with these lines. left: the signal
  !> minus the baseline.
  subroutine check_contact(measured, left, noise, stiffness, trouble)
    type(measured_curve_t), intent(in) :: measured
    real(wp), intent(in) :: left(:), stiffness
    type(noise_t), intent(in) :: noise
    character(len=:), allocatable, intent(inout) :: trouble
    type(noise_t) :: white
    type(lack_t) :: lack
    integer, allocatable :: way(:)
    type(sample_line_t) :: line
    real(wp), allocatable :: off_line(:)
    real(wp) :: slope
    integer :: k

    if (maxval(abs(left), measured%usable) > stands_out*noise%deviation) return
    ! With the larger deviation, the bend of a long-range contact would count as noise.
    white = white_noise(min(noise%deviation, rough_deviation(pack(measured%signal, &
      measured%usable))))
    off_line = measured%signal
    slope = 0
    do k = 1, 2
      associate (mine => measured%usable .and. (measured%inward .eqv. k == 1), z => measured%z)
        if (count(mine) < 2) cycle
        line = line_through(z, measured%signal, mine)
        where (mine) off_line = line%off(z, measured%signal)
        if (abs(line%slope) > abs(slope)) slope = line%slope
      end associate
    end do
    way = pack(merge(1, 2, measured%inward), measured%usable)
    lack = lack_in(pack(off_line, measured%usable)/white%deviation, way, size(way) - 4, white)
    if (.not. lack%is_noise()) return
    if (any([(end_off_line(measured, k == 1, white%deviation), k=1, 2)] > surely)) return
    if (-measured%facing*slope > steep*stiffness) then
      trouble = 'no baseline in the data: all samples lie on a straight line with ' // &
        rounded(100*abs(slope)/stiffness) // ' % of the slope of the spring, and none is far ' // &
        'from contact; the signal differs from a straight line by no more than the noise of ' // &
        rounded(white%deviation)
    else
      trouble = 'no contact in the data: the signal differs from a straight line by no more ' // &
        'than the noise of ' // rounded(white%deviation) // ' (means over ' // &
        counted(lack%width, 'sample') // ' are ' // &
        rounded(lack%times) // ' times those of noise); data must reach from outside ' // &
        'contact into the forces; check that columns names the signal'
    end if
  end subroutine check_contact

  !> By how many standard errors the mean of the nearest samples of a segment exceeds a straight
  !> line through the others: the maximum over the means of 2, 4, 8 and more samples. This test is
  !> the most sensitive one for a short, weak contact.
  pure real(wp) function end_off_line(measured, inward, deviation) result(off)
    type(measured_curve_t), intent(in) :: measured
    logical, intent(in) :: inward
    real(wp), intent(in) :: deviation
    integer, allocatable :: at(:)
    real(wp), allocatable :: x(:), y(:)
    type(sample_line_t) :: line
    real(wp) :: ahead
    integer :: i, m, n

    off = 0
    at = pack([(i, i=1, size(measured%z))], measured%usable .and. (measured%inward .eqv. inward))
    ! Order the samples from the nearest one to the farthest.
    if (inward) at = at(size(at):1:-1)
    n = size(at)
    x = measured%facing*measured%z(at)
    y = measured%signal(at)
    m = 2
    do while (m <= n/3)
      line = line_through(x, y, [(i > m, i=1, n)])
      ahead = sum(x(:m))/m - line%middle(1)
      off = max(off, line%off(sum(x(:m))/m, sum(y(:m))/m)/ &
        (deviation*sqrt(1.0_wp/m + 1.0_wp/(n - m) + ahead**2/line%squares)))
      m = 2*m
    end do
  end function end_off_line

end module contact_check
