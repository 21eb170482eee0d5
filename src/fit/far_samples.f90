!> Finds the samples of a measured curve that are far from contact, and their noise.
module far_samples
  use kinds, only: wp
  use measured_curve, only: measured_t
  use measured_jumps, only: find_jump
  use noise, only: noise_t, noise_of, white_noise, rough_deviation, stand_apart
  implicit none
  private
  public :: find_far, off_baseline

  !> With fewer far samples the noise comes from their differences, and no slope is found. The part
  !> of the travel that may be far from contact; it is halved while the farther half varies by less
  !> than this part of the whole.
  integer, parameter :: fewest_far = 12
  real(wp), parameter :: far_part = 1.0_wp/3, less = 0.6_wp
  !> A spike differs from its neighbours by this many deviations, plus this many times the change of
  !> signal over a step of z at the spring's own slope.
  real(wp), parameter :: apart = 5, bent = 3

contains

  !> Marks the far samples and finds their noise. stiffness: of the spring, units of signal over z.
  subroutine find_far(measured, stiffness, noise)
    type(measured_t), intent(inout) :: measured
    real(wp), intent(in) :: stiffness
    type(noise_t), intent(out) :: noise
    type(noise_t) :: outer_noise
    real(wp) :: rough
    real(wp), allocatable :: position(:)
    logical, allocatable :: outer(:)
    real(wp) :: limit, farthest
    integer :: way

    position = measured%facing*measured%z
    farthest = maxval(position)
    limit = farthest - far_part*(farthest - minval(position))
    rough = rough_deviation(pack(measured%signal, measured%usable))
    measured%usable = measured%usable .and. .not. stand_apart(measured%signal, &
      merge(1, 2, measured%inward), measured%usable, apart*rough + &
      bent*stiffness*steps_about(measured))
    do way = 1, 2
      associate (jump => find_jump(measured, rough, stiffness, way == 1))
        if (jump%before > 0) limit = max(limit, 0.5_wp*(measured%facing*jump%z + farthest))
      end associate
    end do
    measured%far = position > limit
    noise = white_noise(rough)
    if (count(measured%far .and. measured%usable) < fewest_far) return
    noise = noise_at(measured%far)
    do
      limit = 0.5_wp*(limit + farthest)
      outer = position > limit
      if (count(outer .and. measured%usable) < 2*fewest_far) exit
      outer_noise = noise_at(outer)
      if (outer_noise%deviation > less*noise%deviation) exit
      measured%far = outer
      noise = outer_noise
    end do

  contains

    type(noise_t) function noise_at(mask)
      logical, intent(in) :: mask(:)

      associate (good => mask .and. measured%usable)
        noise_at = noise_of(pack(measured%z, good), pack(measured%signal, good), &
          pack(merge(1, 2, measured%inward), good))
      end associate
    end function noise_at

  end subroutine find_far

  !> The step of z about each sample: the mean over its way, or half the distance to the second
  !> sample on either side if that is larger.
  pure function steps_about(measured) result(step)
    type(measured_t), intent(in) :: measured
    real(wp) :: step(size(measured%z))
    integer, allocatable :: mine(:)
    real(wp) :: travel
    integer :: way, k, n

    travel = maxval(measured%z) - minval(measured%z)
    do way = 1, 2
      mine = pack([(k, k=1, size(step))], measured%inward .eqv. way == 1)
      n = size(mine)
      associate (z => measured%z(mine))
        do k = 1, n
          step(mine(k)) = max(travel/n, &
            0.5_wp*maxval(abs(z(k) - z([max(1, k - 2), min(n, k + 2)]))))
        end do
      end associate
    end do
  end function steps_about

  !> The signal minus the straight line through the baseline of its way.
  pure function off_baseline(measured) result(left)
    type(measured_t), intent(in) :: measured
    real(wp) :: left(size(measured%z))
    logical :: far(size(measured%z))
    real(wp) :: middle(2), slope
    integer :: way

    left = 0
    do way = 1, 2
      far = measured%far .and. measured%usable .and. (measured%inward .eqv. way == 1)
      if (.not. any(far)) cycle
      associate (z => measured%z, s => measured%signal)
        middle = [sum(z, far), sum(s, far)]/count(far)
        slope = sum((z - middle(1))*(s - middle(2)), far)/ &
          max(sum((z - middle(1))**2, far), tiny(1.0_wp))
        if (count(far) < fewest_far) slope = 0
        where (measured%inward .eqv. way == 1) left = s - middle(2) - slope*(z - middle(1))
      end associate
    end do
  end function off_baseline

end module far_samples
