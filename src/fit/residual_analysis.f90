!> Analysis of the residuals of a fit. Means over blocks of samples test for systematic misfit.
!> Noise, outliers and snap positions are estimated again, since residuals show them better than the
!> curve itself.
module residual_analysis
  use kinds, only: wp
  use significance, only: hardly_ever, differs, negligible
  use noise, only: noise_t, noise_of, white_noise, noise_of_steps, noise_of_residuals, &
    contradicts, normal_median, whiten
  use outliers, only: stand_apart
  use order_statistics, only: median_of
  use fit_request, only: settled_within
  use measured_jumps, only: measured_jump_t, likely_jump, fewest_far
  use modelled_curve, only: modelled_curve_t
  implicit none
  private
  public :: lack_t, lack_in, renew_noise, look_again

  !> The largest lack of fit. excess: by how many standard deviations the squared means of blocks of
  !> `width` samples exceed their expectation for noise. times: the ratio of the root mean square of
  !> these means to that of noise.
  type :: lack_t
    integer :: width = 1
    real(wp) :: excess = 0, times = 1
  contains
    procedure :: is_noise
  end type lack_t

  !> Smallest number of blocks that is tested.
  integer, parameter :: fewest_blocks = 8

  !> Standard deviations above which a sample is an outlier; one good sample in 150,000 exceeds
  !> this.
  real(wp), parameter :: apart = 4.5_wp
  !> Number of far samples needed to find a correlation of the noise.
  integer, parameter :: enough = 50

contains

  !> Whether noise explains the residuals.
  pure logical function is_noise(self)
    class(lack_t), intent(in) :: self

    is_noise = self%excess <= hardly_ever
  end function is_noise

  !> The largest lack of fit over all widths. white: whitened residuals. run: number of the run of
  !> each sample; samples of different runs are not neighbours. freedom: number of independent
  !> residuals. noise: the noise that they were whitened with.
  pure type(lack_t) function lack_in(white, run, freedom, noise) result(worst)
    real(wp), intent(in) :: white(:)
    type(noise_t), intent(in) :: noise
    integer, intent(in) :: run(:), freedom
    real(wp) :: total, part, excess
    integer :: width, i, k, blocks

    worst%excess = -huge(1.0_wp)
    width = 1
    do
      total = 0
      blocks = 0
      k = 0
      part = 0
      do i = 1, size(white)
        if (run(i) /= run(max(1, i - 1))) k = 0
        if (k == 0) part = 0
        part = part + white(i)
        k = k + 1
        if (k < width) cycle
        k = 0
        blocks = blocks + 1
        total = total + part**2/width
      end do
      if (width == 1) blocks = max(1, freedom)
      if (width > 1 .and. blocks < fewest_blocks) return
      ! The ratio of the variance of all samples to that of their steps has the variance 1/n (von
      ! Neumann, 1941). This is half the variance that the variance of all samples alone has, as if
      ! n were twice as large.
      excess = normal_of(total, blocks, noise%known_by)
      if (width == 1 .and. noise%of_steps) excess = normal_of(2*total, 2*blocks, huge(1.0_wp))
      if (excess > worst%excess) worst = lack_t(width, excess, sqrt(total/blocks))
      width = 2*width
    end do
  end function lack_in

  !> Transforms a sum of n squares of normal numbers to a standard normal number (Wilson and
  !> Hilferty, 1931), if the variance of these numbers was estimated from `known_by` other numbers.
  pure real(wp) function normal_of(total, n, known_by)
    real(wp), intent(in) :: total, known_by
    integer, intent(in) :: n

    normal_of = ((total/n)**(1.0_wp/3) - 1 + 2.0_wp/(9*n))/sqrt(2.0_wp/(9*n) + 2/9.0_wp/known_by)
  end function normal_of

  !> Estimates outliers, jumps and, unless the deck gives it, the noise again. value: the best fit
  !> so far. settled: becomes .false. after a significant change.
  subroutine look_again(curve, value, settled)
    type(modelled_curve_t), intent(inout) :: curve
    real(wp), intent(in) :: value(:)
    logical, intent(out) :: settled
    real(wp), allocatable :: model(:), baseline(:), left(:)
    logical, allocatable :: usable(:), signal(:)
    type(measured_jump_t) :: jump
    real(wp) :: deviation, spread
    integer :: way

    call curve%split(value, model, baseline)
    left = curve%data%measured%signal - model
    associate (data => curve%data)
      ! The model must reach all loads; beyond its range it is continued linearly.
      signal = [(.not. data%is_beside(way), way=1, size(left))]
      settled = .not. curve%needs_more(maxval(data%measured%signal - baseline, &
        data%measured%usable .and. signal))
      usable = data%measured%usable
      deviation = data%noise%deviation
      ! If the model is wrong, residuals are large nearly everywhere.
      spread = max(deviation, median_of(abs(pack(left(data%sample), signal(data%sample))))/ &
        normal_median)
      if (any(.not. signal)) call renew_radii(curve, left, signal)
      ! Near a jump no samples are marked as outliers, since the model may be on the wrong side
      ! there.
      data%measured%usable = merge(usable, .not. (data%measured%skipped .or. &
        stand_apart(left, 3*data%way + data%side + merge(0, 100, signal), &
        .not. data%measured%skipped, apart*merge(spread, 2*data%noise_radius, signal))), &
        data%side < 0)
      settled = settled .and. all(usable .eqv. data%measured%usable)
      if (.not. data%noise_is_given) call renew_noise(curve, left)
      settled = settled .and. abs(data%noise%deviation - deviation) < settled_within*deviation
      do way = 1, 2
        if (curve%response%way(way)%main == 0 .or. .not. any(data%way == way)) cycle
        jump = jump_by_model(curve, value, baseline, left, way)
        settled = settled .and. jump%before == data%jump(way)%before .and. jump%after == &
          data%jump(way)%after .and. abs(jump%z - data%jump(way)%z) <= negligible*jump%uncertainty
        data%jump(way) = jump
      end do
    end associate
    call curve%data%take(1)
  end subroutine look_again

  !> Estimates the noise of contact radii beside a signal, unless the deck gives it, from the
  !> differences between neighbouring residuals.
  subroutine renew_radii(curve, left, signal)
    type(modelled_curve_t), intent(inout) :: curve
    real(wp), intent(in) :: left(:)
    logical, intent(in) :: signal(:)
    type(noise_t) :: noise
    logical :: mine(size(left))
    integer :: steps

    associate (data => curve%data)
      if (data%noise_radius_is_given) return
      mine = .false.
      mine(data%sample) = .not. signal(data%sample)
      call noise_of_steps(pack(left, mine), pack(3*data%way + data%side, mine), noise, steps)
      if (steps >= fewest_far .and. noise%deviation > 0) data%noise_radius = noise%deviation
    end associate
  end subroutine renew_radii

  !> Estimates the noise of the residuals. The samples far from contact show the noise without a
  !> model; residuals there that exceed this noise are misfit. The far samples may be too few to
  !> show a correlation. Therefore the correlation of all residuals is used if it explains them all
  !> and the far samples do not contradict it.
  subroutine renew_noise(curve, left)
    type(modelled_curve_t), intent(inout) :: curve
    real(wp), intent(in) :: left(:)
    type(noise_t) :: far_noise, all_noise, bare, correlated
    logical :: far(size(left))
    integer :: steps, i
    integer, allocatable :: of_signal(:)

    associate (data => curve%data)
      of_signal = pack(data%sample, [(.not. data%is_beside(data%sample(i)), i=1, &
        size(data%sample))])
      far = .false.
      far(data%sample) = data%measured%far(data%sample)
      far = far .and. data%measured%usable
      call noise_of_steps(left(of_signal), data%run(of_signal), all_noise, steps)
      if (steps < enough) return
      if (count(far) >= enough) then
        far_noise = noise_of(pack(data%measured%z, far), pack(left, far), pack(data%way, far))
        bare = noise_of(pack(data%measured%z, far), pack(data%measured%signal, far), &
          pack(data%way, far))
        if (bare%deviation < far_noise%deviation .and. &
          .not. bare%of_differences) far_noise = bare
        if (far_noise%order > 0 .or. abs(log(all_noise%deviation/far_noise%deviation)) > &
          differs*sqrt(0.5_wp/count(far) + 0.75_wp/steps)) all_noise = far_noise
      end if
      correlated = noise_of_residuals(left(of_signal), data%run(of_signal), &
        size(curve%unknown) + data%baseline_numbers())
      if (explains(correlated)) all_noise = correlated
      if (all_noise%deviation > 0) data%noise = all_noise
      if (data%noise%deviation < data%least_noise) data%noise = white_noise(data%least_noise)
    end associate

  contains

    !> Whether a correlated noise explains all residuals, and also those of the far samples alone.
    logical function explains(noise)
      type(noise_t), intent(in) :: noise
      real(wp) :: white(size(of_signal), 1)
      type(lack_t) :: lack

      explains = noise%order > 0 .and. count(far) >= fewest_far
      if (.not. explains) return
      associate (data => curve%data)
        white(:, 1) = left(of_signal)
        call whiten(noise, data%run(of_signal), white)
        lack = lack_in(white(:, 1), 3*data%way(of_signal) + data%side(of_signal), &
          size(white) - size(curve%unknown) - data%baseline_numbers(), noise)
        explains = lack%is_noise() .and. is_even(data%measured%z(of_signal), &
          left(of_signal), noise) .and. .not. contradicts(pack(data%measured%z, far), &
          pack(data%measured%signal, far), pack(data%way, far), noise)
      end associate
    end function explains

    !> Whether residuals have the same variance in each part of the travel (a misfit is largest in
    !> contact). For m samples of correlated noise, the relative variance of their estimated
    !> variance is 2/m times the sum of the squared correlations (Bartlett, 1946).
    pure logical function is_even(z, residual, noise)
      real(wp), intent(in) :: z(:), residual(:)
      type(noise_t), intent(in) :: noise
      integer, parameter :: parts = 4
      logical :: mine(size(z))
      real(wp) :: low, width, squares, ratio
      integer :: k, m

      is_even = .true.
      low = minval(z)
      width = (maxval(z) - low)/parts
      squares = 1 + 2*sum(noise%correlation(1:)**2)
      do k = 1, parts
        mine = min(parts, 1 + int((z - low)/width)) == k
        m = count(mine)
        if (m < fewest_far) cycle
        ratio = sum(residual**2, mine)/m/(sum(residual**2)/size(z))
        if (abs(ratio - 1) > hardly_ever*sqrt(2*squares*(1.0_wp/m - 1.0_wp/size(z)))) &
          is_even = .false.
      end do
    end function is_even

  end subroutine renew_noise

  !> The jump of the curve from one branch of the model to the other, by likelihood.
  type(measured_jump_t) function jump_by_model(curve, value, baseline, left, way) result(jump)
    type(modelled_curve_t), intent(in) :: curve
    real(wp), intent(in) :: value(:), baseline(:), left(:)
    integer, intent(in) :: way
    integer, allocatable :: at(:)
    real(wp), allocatable :: before(:), after(:), bare(:)
    real(wp) :: unit
    integer :: i

    associate (data => curve%data)
      at = pack([(i, i=1, size(left))], data%way == way .and. &
        data%measured%observed == data%measured%observed(1))
      unit = data%noise%long_deviation()**2*max(1.0_wp, sum(left(data%sample)**2)/ &
        size(data%sample)/data%noise%deviation**2)
      bare = data%measured%signal(at) - baseline(at)
      before = curve%signal_of(value, at, side=1)
      after = curve%signal_of(value, at, side=2)
      i = minloc(abs(data%measured%z(at) - curve%jump_of(value, way)), 1)
      if (.not. curve%response%way(way)%predicted) i = size(at)/2
      associate (change => after(i) - before(i))
        before = merge((bare - before)**2/unit, 0.0_wp, .not. data%measured%skipped(at))
        after = merge((bare - after)**2/unit, 0.0_wp, .not. data%measured%skipped(at))
        jump = likely_jump(data%measured%z(at), before, after, change, sqrt(unit), at(1))
      end associate
      if (jump%before > 0) jump%change = data%measured%signal(jump%after) - &
        data%measured%signal(jump%before)
    end associate
  end function jump_by_model

end module residual_analysis
