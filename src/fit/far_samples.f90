!> Which samples of a measured curve are far from contact, and the noise that they show.
module far_samples
  use kinds, only: wp
  use measured_curve, only: measured_t
  use measured_jumps, only: find_jump
  use noise, only: noise_t, noise_of, white_noise
  implicit none
  private
  public :: find_far, fewest_far

  !> Fewer samples show no noise. The part of the travel that may be far from contact; it is halved
  !> where the half that is farther varies by less than this part of the whole.
  integer, parameter :: fewest_far = 12
  real(wp), parameter :: far_part = 1.0_wp/3, less = 0.6_wp

contains

  !> Marks the far samples, and finds their noise. stiffness: of the spring, units of signal over z.
  subroutine find_far(measured, stiffness, noise)
    type(measured_t), intent(inout) :: measured
    real(wp), intent(in) :: stiffness
    type(noise_t), intent(out) :: noise
    type(noise_t) :: outer_noise, rough
    real(wp), allocatable :: position(:)
    logical, allocatable :: outer(:)
    real(wp) :: limit, farthest
    integer :: way

    position = measured%facing*measured%z
    farthest = maxval(position)
    limit = farthest - far_part*(farthest - minval(position))
    rough = white_noise(rough_deviation(measured%signal))
    do way = 1, 2
      associate (jump => find_jump(measured, rough, stiffness, way == 1))
        if (jump%before > 0) limit = max(limit, 0.5_wp*(measured%facing*jump%z + farthest))
      end associate
    end do
    measured%far = position > limit
    noise = noise_at(measured%far)
    do
      limit = 0.5_wp*(limit + farthest)
      outer = position > limit
      if (count(outer) < 2*fewest_far) exit
      outer_noise = noise_at(outer)
      if (outer_noise%deviation > less*noise%deviation) exit
      measured%far = outer
      noise = outer_noise
    end do

  contains

    type(noise_t) function noise_at(mask)
      logical, intent(in) :: mask(:)

      noise_at = noise_of(pack(measured%z, mask), pack(measured%signal, mask), &
        pack(merge(1, 2, measured%inward), mask))
    end function noise_at

  end subroutine find_far

  !> The deviation of white noise in a signal that otherwise is smooth: from the median of its
  !> second differences.
  pure real(wp) function rough_deviation(signal) result(deviation)
    real(wp), intent(in) :: signal(:)
    !> The median of a normal distribution's magnitude; the sum of the squares of 1, -2, 1.
    real(wp), parameter :: median = 0.6745_wp, squares = 6
    real(wp) :: second(size(signal) - 2), low, high
    integer :: n, step

    n = size(signal)
    second = abs(signal(3:) - 2*signal(2:n - 1) + signal(:n - 2))
    low = 0
    high = maxval(second)
    do step = 1, 60
      deviation = 0.5_wp*(low + high)
      if (2*count(second > deviation) > size(second)) then
        low = deviation
      else
        high = deviation
      end if
    end do
    deviation = deviation/(median*sqrt(squares))
  end function rough_deviation

end module far_samples
