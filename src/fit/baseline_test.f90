!> Tests whether a fit lacks a part of its baseline: a bow, a slope of its own on each segment, a
!> ripple. Each is a direction in the space of the residuals r. Let g be the unit vector of this
!> direction without the components that the unknowns and the present baseline explain. The part
!> would then lower chi squared by (g.r)^2 and move the unknowns by known amounts. No further fit is
!> needed (as in `fixed_parameter_test`).
module baseline_test
  use kinds, only: wp
  use root_finding, only: bracket_t
  use noise, only: white_noise
  use baseline, only: waves_of, ways_in, scaled
  use fit_samples, only: fit_samples_t, orthonormalise, is_rounding, solve_triangle
  use significance, only: chance_of
  use fit_request, only: settled_within
  use residual_analysis, only: renew_noise
  use curve_residuals, only: curve_residuals_t
  implicit none
  private
  public :: lacking_t, test_baseline, settle_ripple

  !> A part that the baseline does not have. name: the key of &measurement that adds this part.
  !> gain: the decrease of chi squared. chance: the logarithm of the probability that noise alone
  !> decreases chi squared so much. shift: the change of each unknown, in the unit of its key.
  !> hidden: the change of each unknown by a part of one column with an amplitude of `unseen`
  !> standard deviations, which noise can hide. period [m]: the period of a ripple; 0 for other
  !> parts.
  type :: lacking_t
    character(len=:), allocatable :: name
    real(wp) :: gain = 0, period = 0, chance = 0
    real(wp), allocatable :: shift(:), hidden(:)
  end type lacking_t

  !> Amplitude of a part, in standard deviations, that noise alone exceeds in one fit of twenty.
  real(wp), parameter :: unseen = 2

  !> The residuals of a fit, and their derivatives by the unknowns as a product: an orthonormal
  !> basis times a triangular matrix.
  type :: model_tangent_t
    real(wp), allocatable :: residual(:), basis(:, :), triangle(:, :)
  end type model_tangent_t

  !> Ripples have from one to `most_periods` periods over the travel, and at least `fewest_samples`
  !> samples in a period. The search tries `oversampling` values for each number of periods, and
  !> refines the best one by `sections` golden sections. With fewer samples than `enough` there is
  !> no search.
  integer, parameter :: most_periods = 64, fewest_samples = 5, oversampling = 4, sections = 16, &
    enough = 40

contains

  !> Tests whether the baseline of a fit lacks a part. residuals, value: the residuals of the fit
  !> and the values of its unknowns.
  subroutine test_baseline(residuals, value, lacking)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: value(:)
    type(lacking_t), allocatable, intent(out) :: lacking(:)
    type(model_tangent_t) :: tangent
    real(wp), allocatable :: column(:, :)
    logical :: found
    integer :: n

    allocate (lacking(0))
    if (residuals%curve%data%baseline_numbers() == 0) return
    call find_tangent(residuals, value, tangent, found)
    if (.not. found) return
    associate (data => residuals%curve%data%measured)
      n = size(data%z)
      if (data%baseline%degree < 1) then
        column = reshape(scaled(data%z), [n, 1])
        call test('baseline = ''linear''')
      else if (data%baseline%degree < 2) then
        column = reshape(scaled(data%z)**2, [n, 1])
        call test('baseline = ''quadratic''')
      end if
      if (ways_in(data%inward) == 2 .and. data%baseline%degree > 0 .and. &
        .not. data%baseline%slope_each_way) then
        column = reshape(merge(scaled(data%z), 0.0_wp, data%inward), [n, 1])
        call test('slope_each_way = .true.')
      end if
      if (.not. data%baseline%ripple) call test_ripple(residuals, value, lacking)
    end associate

  contains

    subroutine test(name)
      character(len=*), intent(in) :: name
      type(lacking_t) :: new

      new = explained(residuals%curve%data, tangent, column)
      new%name = name
      new%chance = chance_of(new%gain, left_of(tangent, new), 1, 1)
      lacking = [lacking, new]
    end subroutine test

  end subroutine test_baseline

  !> Tests whether the baseline lacks a ripple. A ripple may have been taken for correlated noise;
  !> therefore the noise is estimated again without the ripple.
  subroutine test_ripple(residuals, value, lacking)
    type(curve_residuals_t), intent(in) :: residuals
    real(wp), intent(in) :: value(:)
    type(lacking_t), allocatable, intent(inout) :: lacking(:)
    type(curve_residuals_t) :: trial
    type(model_tangent_t) :: tangent
    type(lacking_t) :: new, best
    real(wp), allocatable :: model(:), line(:), wave(:, :), left(:), amplitude(:)
    real(wp) :: period
    logical :: found
    integer :: pass

    associate (z => residuals%curve%data%measured%z, inward => residuals%curve%data%measured%inward)
      if (size(residuals%curve%data%sample) < enough) return
      best%gain = -1
      do pass = 1, 2
        trial = residuals
        if (pass == 1) trial%curve%data%noise = white_noise(trial%curve%data%noise%deviation)
        call trial%curve%data%take(1)
        call find_tangent(trial, value, tangent, found)
        if (.not. found) return
        call find_period(trial%curve%data, tangent, period, new%gain, amplitude)
        if (.not. period > 0) return
        wave = waves_of(z, inward, period)
        call trial%curve%split(value, model, line)
        left = trial%curve%data%measured%signal - model - matmul(wave, amplitude)
        trial = residuals
        if (.not. trial%curve%data%noise_is_given) call renew_noise(trial%curve, left)
        call trial%curve%data%take(1)
        call find_tangent(trial, value, tangent, found)
        if (.not. found) return
        new = explained(trial%curve%data, tangent, wave)
        new%name = 'ripple = .true.'
        new%period = period
        new%chance = chance_of(new%gain, left_of(tangent, new), size(wave, 2), 2*most_periods)
        if (new%gain > best%gain) best = new
        if (.not. residuals%curve%data%noise%order > 0) exit
      end do
      lacking = [lacking, best]
    end associate
  end subroutine test_ripple

  !> Estimates the period of the ripple of a fit's baseline again. done: becomes .false. if the
  !> number of periods over the travel has not settled.
  subroutine settle_ripple(residuals, value, done)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: value(:)
    logical, intent(inout) :: done
    type(curve_residuals_t) :: bare
    type(model_tangent_t) :: tangent
    real(wp), allocatable :: model(:), line(:), amplitude(:)
    real(wp) :: period, gain, travel
    logical :: found

    associate (baseline => residuals%curve%data%measured%baseline, &
      z => residuals%curve%data%measured%z, inward => residuals%curve%data%measured%inward)
      if (.not. baseline%ripple) return
      bare = residuals
      bare%curve%data%measured%baseline%period = 0
      call bare%curve%data%take(1)
      call find_tangent(bare, value, tangent, found)
      if (.not. found) return
      call find_period(bare%curve%data, tangent, period, gain, amplitude)
      if (.not. period > 0) return
      travel = maxval(z) - minval(z)
      done = done .and. baseline%period > 0
      if (done) done = travel*abs(1/period - 1/baseline%period) < settled_within
      if (allocated(baseline%wave)) deallocate (baseline%wave)
      baseline%period = period
      call residuals%curve%data%take(1)
      call residuals%curve%split(value, model, line)
      amplitude = residuals%curve%data%amplitudes_under(residuals%curve%data%measured%signal - &
        model + line)
      baseline%wave = amplitude(size(amplitude) - 2*ways_in(inward) + 1:)
      call residuals%curve%data%take(1)
    end associate
  end subroutine settle_ripple

  !> The period whose ripple lowers chi squared most; 0 if there are too few samples. amplitude: the
  !> amplitudes of the cosines and sines of this ripple.
  subroutine find_period(data, tangent, period, gain, amplitude)
    type(fit_samples_t), intent(in) :: data
    type(model_tangent_t), intent(in) :: tangent
    real(wp), intent(out) :: period, gain
    real(wp), allocatable, intent(out) :: amplitude(:)
    type(bracket_t) :: bracket
    type(lacking_t) :: there
    real(wp) :: travel, points(2), best
    integer :: samples(2), i, last

    period = 0
    gain = 0
    allocate (amplitude(0))
    associate (z => data%measured%z, inward => data%measured%inward)
      travel = maxval(z) - minval(z)
      samples = [count(inward), count(.not. inward)]
    end associate
    last = min(most_periods, minval(samples, samples > 0)/fewest_samples)
    best = -1
    do i = oversampling, oversampling*last
      gain = gain_at(real(i, wp)/oversampling)
      if (.not. gain > best) cycle
      best = gain
      period = i
    end do
    if (.not. period > 0) return
    bracket = bracket_t((period - 1)/oversampling, (period + 1)/oversampling)
    do i = 1, sections
      points = bracket%golden_points()
      call bracket%keep_larger([gain_at(points(1)), gain_at(points(2))])
    end do
    period = travel/bracket%middle()
    there = explained(data, tangent, waves_of(data%measured%z, data%measured%inward, period), &
      amplitude)
    gain = there%gain

  contains

    real(wp) function gain_at(periods)
      real(wp), intent(in) :: periods
      type(lacking_t) :: there

      there = explained(data, tangent, waves_of(data%measured%z, data%measured%inward, &
        travel/periods))
      gain_at = there%gain
    end function gain_at

  end subroutine find_period

  !> The residuals of a fit and their derivatives.
  subroutine find_tangent(residuals, value, tangent, found)
    type(curve_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: value(:)
    type(model_tangent_t), intent(out) :: tangent
    logical, intent(out) :: found

    allocate (tangent%residual(residuals%rows()), tangent%basis(residuals%rows(), size(value)))
    call residuals%residuals_of(value, tangent%residual, found)
    if (found) call residuals%jacobian_of(value, tangent%basis, found)
    if (found) call orthonormalise(tangent%basis, tangent%triangle)
  end subroutine find_tangent

  !> Chi squared per degree of freedom if the baseline had this further part.
  pure real(wp) function left_of(tangent, lacking)
    type(model_tangent_t), intent(in) :: tangent
    type(lacking_t), intent(in) :: lacking

    left_of = (sum(tangent%residual**2) - lacking%gain)/ &
      max(1, size(tangent%residual) - size(tangent%basis, 2))
  end function left_of

  !> The effect on a fit of further columns of the baseline, which are given at all samples.
  !> amplitude: the best amplitudes of these columns.
  type(lacking_t) function explained(data, tangent, column, amplitude) result(new)
    type(fit_samples_t), intent(in) :: data
    type(model_tangent_t), intent(in) :: tangent
    real(wp), intent(in) :: column(:, :)
    real(wp), allocatable, intent(out), optional :: amplitude(:)
    real(wp) :: cleaned(size(tangent%residual), size(column, 2)), &
      at_samples(size(data%sample), size(column, 2)), rest(size(tangent%residual), size(column, 2))
    real(wp), dimension(size(column, 2)) :: whole, part
    real(wp), allocatable :: triangle(:, :)
    integer :: k

    at_samples = column(data%sample, :)
    do k = 1, size(data%sample)
      if (data%is_beside(data%sample(k))) at_samples(k, :) = 0
    end do
    call data%clean(at_samples)
    cleaned = 0
    cleaned(:size(data%sample), :) = at_samples
    whole = norm2(cleaned, 1)
    rest = cleaned - matmul(tangent%basis, matmul(transpose(tangent%basis), cleaned))
    do k = 1, size(part)
      if (is_rounding(rest(:, k), whole(k))) rest(:, k) = 0
    end do
    call orthonormalise(rest, triangle)
    part = matmul(tangent%residual, rest)
    new%gain = sum(part**2)
    allocate (new%hidden(size(tangent%basis, 2)), source=0.0_wp)
    if (size(part) == 1) then
      if (abs(triangle(1, 1)) > 0) then
        new%hidden = unseen/triangle(1, 1)*matmul(cleaned(:, 1), tangent%basis)
        call solve_triangle(tangent%triangle, new%hidden)
      end if
    end if
    call solve_triangle(triangle, part)
    if (present(amplitude)) amplitude = part
    new%shift = matmul(matmul(cleaned, part) - tangent%residual, tangent%basis)
    call solve_triangle(tangent%triangle, new%shift)
  end function explained

end module baseline_test
