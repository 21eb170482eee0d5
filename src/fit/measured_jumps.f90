!> Jumps of a measured curve between branches, and the samples far from contact with their noise. In
!> a snap-in the force falls, and in a snap-off it rises, over less travel of the base than the
!> spring alone would need.
!>
!> Before a model is known, the mean of some samples before a place is compared with the mean of as
!> many samples after it. Few samples are used if the difference exceeds the noise, otherwise more.
!>
!> Once both branches are known, each place between two samples has a likelihood that the samples
!> before it lie on one branch and those after it on the other. Samples taken during the jump lie on
!> neither.
module measured_jumps
  use kinds, only: wp
  use measured_curve, only: measured_curve_t
  use significance, only: stands_out, surely, differs
  use sample_lines, only: sample_line_t, line_through
  use noise, only: noise_t, noise_of, white_noise, rough_deviation
  use outliers, only: stand_apart
  implicit none
  private
  public :: measured_jump_t, find_jump, likely_jump, find_far, off_baseline, fewest_far

  !> A jump between the samples `before` and `after`; both are 0 without a jump. z, uncertainty: the
  !> position of the base and its uncertainty. change: the change of the signal.
  type :: measured_jump_t
    integer :: before = 0, after = 0
    real(wp) :: z = 0, uncertainty = 0, change = 0
  end type measured_jump_t

  !> A jump, or a spike, changes the signal by more than `steep` times the change that the spring
  !> alone causes over the same z; the rest stands out from the noise. most_steps: largest number of
  !> steps of a jump that an amplifier has smoothed.
  real(wp), parameter :: steep = 3
  integer, parameter :: most_steps = 6

  !> Largest number of samples within a smoothed jump. A sample is within the jump, or an outlier,
  !> if it differs from both branches, and by more than `off_part` of the jump. For a single sample
  !> both are equally likely; each further neighbour favours the jump by `together`, in squares of
  !> standard deviations.
  integer, parameter :: most_within = 6
  real(wp), parameter :: off_part = 0.2_wp, together = 4
  !> Places of a jump whose cost exceeds the least one by more than `no_chance` do not count. The
  !> chance of a place grows with the distance of its two samples, which counts as at least
  !> `least_step` of the typical distance.
  real(wp), parameter :: no_chance = 200, least_step = 0.1_wp
  !> The side of a sample is known if the other side has a smaller probability than `doubtful` (a
  !> normal number exceeds `normal_end` standard deviations with this probability). The position of
  !> the jump is known if the fraction of doubtful samples is smaller than `known_part`.
  real(wp), parameter :: doubtful = 1.0e-3_wp, known_part = 0.2_wp, normal_end = 3.09_wp

  !> With fewer far samples the noise is found from their differences, and no slope is fitted.
  !> far_part: the fraction of the travel that may be far from contact; it is halved as long as the
  !> noise of the farther half is less than `less` times that of the whole.
  integer, parameter :: fewest_far = 12
  real(wp), parameter :: far_part = 1.0_wp/3, less = 0.6_wp

contains

  !> The largest jump on approach or retract. deviation: standard deviation of the noise. stiffness:
  !> the slope of the spring, in units of signal over z.
  pure type(measured_jump_t) function find_jump(measured, deviation, stiffness, inward) result(jump)
    type(measured_curve_t), intent(in) :: measured
    real(wp), intent(in) :: deviation, stiffness
    logical, intent(in) :: inward
    integer, allocatable :: at(:)
    real(wp), allocatable :: total(:), place(:)
    real(wp) :: change, most, spring
    integer :: width, i, k, n, first, last

    at = pack([(i, i=1, size(measured%z))], (measured%inward .eqv. inward) .and. measured%usable)
    n = size(at)
    if (n < 4) return
    allocate (total(0:n), place(0:n), source=0.0_wp)
    do i = 1, n
      total(i) = total(i - 1) + merge(-1, 1, inward)*measured%signal(at(i))
      place(i) = place(i - 1) + measured%z(at(i))
    end do
    width = 1
    do while (width <= n/4)
      most = 0
      k = 0
      do i = width, n - width
        change = (total(i + width) - 2*total(i) + total(i - width))/width
        spring = steep*stiffness*abs(place(i + width) - 2*place(i) + place(i - width))/width
        if (.not. change - spring > max(most, stands_out*deviation*sqrt(2.0_wp/width))) cycle
        most = change - spring
        k = i
      end do
      if (k > 0) exit
      width = 2*width
    end do
    if (k == 0) return
    ! The jump lies near the middle of the samples that were compared.
    first = k - width/2
    last = k + 1 + width/2
    do while (width == 1 .and. first > 1 .and. last - first < most_steps)
      if (.not. goes_on(first - 1)) exit
      first = first - 1
    end do
    do while (width == 1 .and. last < n .and. last - first < most_steps)
      if (.not. goes_on(last)) exit
      last = last + 1
    end do
    jump%before = at(first)
    jump%after = at(last)
    jump%change = merge(-1, 1, inward)*(total(last) - total(last - 1) - total(first) + &
      total(first - 1))
    associate (z => measured%z)
      k = merge(first + 1, last, width == 1)
      jump%z = 0.5_wp*(z(at(first)) + z(at(k)))
      ! The standard deviation of a uniform distribution between the two samples, or over an average
      ! step if that is larger.
      jump%uncertainty = max(abs(z(at(k)) - z(at(first))), (maxval(z) - minval(z))/n)/sqrt(12.0_wp)
    end associate

  contains

    !> Whether the signal between sample i and the next changes in the direction of the jump by more
    !> than spring and noise explain.
    pure logical function goes_on(i)
      integer, intent(in) :: i

      goes_on = total(i + 1) - 2*total(i) + total(i - 1) > stiffness*abs(place(i + 1) - &
        2*place(i) + place(i - 1)) + differs*deviation
    end function goes_on

  end function find_jump

  !> The most likely jump. before(i), after(i): squared distances of sample i from the branch before
  !> and after the jump, in standard deviations; 0 for samples that do not count. change: the change
  !> of the signal in the jump. noise: the standard deviation of the signal. first: number of the
  !> first sample. There is no jump if its position is not determined, or if all samples are on one
  !> branch.
  pure type(measured_jump_t) function likely_jump(z, before, after, change, noise, first) &
    result(jump)
    real(wp), intent(in) :: z(:), before(:), after(:), change, noise
    integer, intent(in) :: first
    real(wp) :: leaves(size(z)), arrives(size(z)), cost(size(z), 0:most_within)
    real(wp) :: ahead(size(z)), behind(size(z)), middle(size(z)), typical, neither
    real(wp) :: one_side(2), least
    integer :: i, m, n

    n = size(z)
    if (n < 2) return
    neither = max(differs, off_part*abs(change)/noise)**2
    ahead(1) = min(before(1), neither)
    behind(n) = min(after(n), neither)
    do i = 2, n
      ahead(i) = ahead(i - 1) + min(before(i), neither)
      behind(n + 1 - i) = behind(n + 2 - i) + min(after(n + 1 - i), neither)
    end do
    typical = abs(z(n) - z(1))/(n - 1)
    cost = huge(cost)
    do m = 0, most_within
      do i = 1, n - 1 - m
        cost(i, m) = ahead(i) + behind(i + 1 + m) + m*neither - max(0, m - 1)*together
      end do
    end do
    one_side = [ahead(n), behind(1)]
    least = min(minval(cost), minval(one_side))
    cost = cost - least
    one_side = exp(-0.5_wp*min(one_side - least, no_chance))*typical
    leaves = 0
    arrives = 0
    do m = 0, most_within
      do i = 1, n - 1 - m
        if (cost(i, m) > no_chance) cycle
        associate (chance => exp(-0.5_wp*cost(i, m))*max(abs(z(i + 1) - z(i)), least_step*typical))
          leaves(i) = leaves(i) + chance
          arrives(i + 1 + m) = arrives(i + 1 + m) + chance
        end associate
      end do
    end do
    if (sum(leaves) <= doubtful*maxval(one_side)) return
    leaves = leaves/sum(leaves)
    arrives = arrives/sum(arrives)
    middle(:n - 1) = 0.5_wp*(z(2:) + z(:n - 1))
    middle(n) = z(n)
    jump%z = sum(leaves*middle)
    jump%uncertainty = sqrt(sum(leaves*((middle - jump%z)**2 + typical**2/12)))
    jump%before = first_beyond(leaves)
    ! One sample with much noise may give a distant place a small probability, which lies outside a
    ! normal distribution of this width. The uncertainty must include this place.
    i = n + 1 - first_beyond(leaves(n:1:-1))
    jump%uncertainty = max(jump%uncertainty, &
      maxval(abs(z([jump%before, min(n, i + 1)]) - jump%z))/normal_end)
    jump%after = n + 1 - first_beyond(arrives(n:1:-1))
    if (jump%after - jump%before > max(most_within + 2.0_wp, known_part*n)) then
      jump = measured_jump_t()
      return
    end if
    jump%before = jump%before + first - 1
    jump%after = jump%after + first - 1
    jump%change = change
  end function likely_jump

  !> The first index at which the cumulative probability is no longer small.
  pure integer function first_beyond(chance) result(i)
    real(wp), intent(in) :: chance(:)
    real(wp) :: total

    total = 0
    do i = 1, size(chance) - 1
      total = total + chance(i)
      if (total > doubtful) return
    end do
  end function first_beyond

  !> Marks the far samples and finds their noise. stiffness: the slope of the spring, in units of
  !> signal over z.
  subroutine find_far(measured, stiffness, noise)
    type(measured_curve_t), intent(inout) :: measured
    real(wp), intent(in) :: stiffness
    type(noise_t), intent(out) :: noise
    type(noise_t) :: outer_noise
    real(wp), allocatable :: position(:)
    logical, allocatable :: outer(:)
    real(wp) :: rough, limit, farthest
    integer :: way

    position = measured%facing*measured%z
    farthest = maxval(position)
    limit = farthest - far_part*(farthest - minval(position))
    rough = rough_deviation(pack(measured%signal, measured%usable))
    measured%usable = measured%usable .and. .not. stand_apart(measured%signal, merge(1, 2, &
      measured%inward), measured%usable, surely*rough + steep*stiffness*steps_about(measured))
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
      ! If the residuals of the whole are no noise, the samples reach into the contact.
      if (.not. noise%of_differences .and. outer_noise%deviation > less*noise%deviation) exit
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

  !> The step of z at each sample: the mean step of its segment, or half the distance to the second
  !> sample on either side if that is larger.
  pure function steps_about(measured) result(step)
    type(measured_curve_t), intent(in) :: measured
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

  !> The signal minus the straight line through the baseline of its segment.
  pure function off_baseline(measured) result(left)
    type(measured_curve_t), intent(in) :: measured
    real(wp) :: left(size(measured%z))
    logical :: far(size(measured%z))
    type(sample_line_t) :: line
    integer :: way

    left = 0
    do way = 1, 2
      far = measured%far .and. measured%usable .and. (measured%inward .eqv. way == 1)
      if (.not. any(far)) cycle
      line = line_through(measured%z, measured%signal, far)
      if (count(far) < fewest_far) line%slope = 0
      where (measured%inward .eqv. way == 1) left = line%off(measured%z, measured%signal)
    end do
  end function off_baseline

end module measured_jumps
