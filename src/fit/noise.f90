!> The noise of a signal, from samples that would lie on a straight line without noise. An
!> instrument's filter correlates neighbouring samples; subtracting a linear prediction from some
!> previous samples then leaves white noise (autoregression; Levinson, 1947, and Durbin, 1960).
!> Residuals of a fit show this correlation too. The next fit uses it as generalised least squares
!> (Aitken, 1935; Cochrane and Orcutt, 1949).
module noise
  use kinds, only: wp
  use order_statistics, only: median_of
  use sample_lines, only: off_line
  implicit none
  private
  public :: noise_t, white_noise, noise_of, noise_of_steps, noise_of_residuals, contradicts, &
    rough_deviation, rounding_of, normal_median, whiten

  !> If the standard deviation of residuals exceeds that from second differences by this factor, the
  !> residuals are not noise: a filter would have to average over 60 samples.
  real(wp), parameter :: smooth = 10
  !> Smallest number of samples for which a parabola is used: ten for each of its unknowns.
  integer, parameter :: many = 30
  !> Largest number of samples that a prediction uses.
  integer, parameter :: longest = 8

  !> Gain n ln(left^2), for any order, that chance hardly ever produces.
  real(wp), parameter :: by_chance = 10
  !> The median of the magnitude of a standard normal number.
  real(wp), parameter :: normal_median = 0.6745_wp

  !> deviation: standard deviation. correlation(k): correlation of samples that are k steps apart.
  !> order: number of previous samples that predict the next one. weight(:k, k): weights of the
  !> prediction from k samples, the nearest first. left(k): standard deviation after subtraction of
  !> this prediction.
  type :: noise_t
    real(wp) :: deviation = 0, correlation(0:longest) = 0
    integer :: order = 0
    !> Number of independent samples from which the deviation was estimated. The source of the
    !> estimate: of_steps: the steps between samples; of_differences: second differences, if the
    !> residuals were no noise; of_residuals: a model's residuals, with their correlation.
    real(wp) :: known_by = huge(1.0_wp)
    logical :: of_steps = .false., of_differences = .false., of_residuals = .false.
    real(wp) :: weight(longest, longest) = 0, left(0:longest) = 1
  contains
    procedure :: long_deviation
  end type noise_t

contains

  !> The deviation of the white noise whose means over many samples scatter as much as those of this
  !> noise.
  pure real(wp) function long_deviation(self) result(deviation)
    class(noise_t), intent(in) :: self

    deviation = self%left(self%order)/abs(1 - sum(self%weight(:self%order, max(1, self%order))))
  end function long_deviation

  !> Uncorrelated noise.
  pure type(noise_t) function white_noise(deviation) result(noise)
    real(wp), intent(in) :: deviation

    noise%deviation = deviation
    noise%correlation(0) = 1
    noise%left = deviation
  end function white_noise

  !> The noise of a signal at equal steps. The signal is assumed to be a straight line in z over
  !> each run or, with many samples, a parabola, since a bow is no noise. Ripples, drifts and the
  !> bend of a contact are no noise either: they change so little from sample to sample that no
  !> filter explains them. If the signal has them, the result is white noise from second
  !> differences. run(i): number of the run of sample i.
  pure type(noise_t) function noise_of(z, signal, run) result(noise)
    real(wp), intent(in) :: z(:), signal(:)
    integer, intent(in) :: run(:)
    real(wp) :: r(size(z))
    integer :: unknowns

    call remove_lines(z, signal, run, r, unknowns)
    noise = noise_in(r, run, unknowns, rounding_of(signal))
  end function noise_of

  !> The noise of the residuals of a model with this number of unknowns.
  pure type(noise_t) function noise_of_residuals(left, run, unknowns) result(noise)
    real(wp), intent(in) :: left(:)
    integer, intent(in) :: run(:), unknowns

    noise = noise_in(left, run, unknowns, 0.0_wp)
    noise%of_residuals = .true.
  end function noise_of_residuals

  !> The noise of residuals r with this number of unknowns, if they are noise. least: the smallest
  !> deviation that second differences may give.
  pure type(noise_t) function noise_in(r, run, unknowns, least) result(noise)
    real(wp), intent(in) :: r(:), least
    integer, intent(in) :: run(:), unknowns
    real(wp) :: covariance(0:longest), rough
    integer :: k, n

    n = size(r)
    do k = 0, longest
      covariance(k) = sum(r(1 + k:)*r(:n - k), run(1 + k:) == run(:n - k))/n
    end do
    noise = white_noise(sqrt(covariance(0)*n/max(1, n - unknowns)))
    noise%known_by = n
    if (.not. covariance(0) > 0) return
    rough = max(rough_deviation(r), least)
    if (noise%deviation > smooth*rough) then
      noise = white_noise(rough)
      noise%known_by = n
      noise%of_differences = .true.
      return
    end if
    noise%correlation = covariance/covariance(0)
    call find_weights(noise, n)
  end function noise_in

  !> The samples minus the straight line, or parabola, of their run. unknowns: number of
  !> coefficients of all these lines.
  pure subroutine remove_lines(z, signal, run, r, unknowns)
    real(wp), intent(in) :: z(:), signal(:)
    integer, intent(in) :: run(:)
    real(wp), intent(out) :: r(:)
    integer, intent(out) :: unknowns
    integer :: i, k

    unknowns = 0
    do i = minval(run), maxval(run)
      k = merge(2, 1, count(run == i) >= many)
      where (run == i) r = off_line(z, signal, run == i, k)
      unknowns = unknowns + k + 1
    end do
  end subroutine remove_lines

  !> Whether samples that would lie on straight lines or parabolas without noise contradict a given
  !> noise. They do if white noise with their own deviation is much more likely (likelihood-ratio
  !> test; Neyman and Pearson, 1933).
  pure logical function contradicts(z, signal, run, noise)
    real(wp), intent(in) :: z(:), signal(:)
    integer, intent(in) :: run(:)
    type(noise_t), intent(in) :: noise
    real(wp) :: r(size(z))
    integer :: unknowns

    call remove_lines(z, signal, run, r, unknowns)
    associate (own => white_noise(sqrt(sum(r**2)/max(1, size(r) - unknowns))))
      contradicts = surprise(noise) - surprise(own) > by_chance
    end associate

  contains

    !> Minus twice the logarithm of the likelihood of r.
    pure real(wp) function surprise(noise)
      type(noise_t), intent(in) :: noise
      real(wp) :: column(size(r), 1)

      column(:, 1) = r
      call whiten(noise, run, column)
      surprise = sum(column**2) + 2*sum(log(noise%left(predicting(noise, run))))
    end function surprise

  end function contradicts

  !> White noise of a smooth signal, estimated from the steps between neighbours of a run. steps:
  !> the number of these steps (von Neumann, 1941).
  pure subroutine noise_of_steps(smooth, run, noise, steps)
    real(wp), intent(in) :: smooth(:)
    integer, intent(in) :: run(:)
    type(noise_t), intent(out) :: noise
    integer, intent(out) :: steps
    logical :: mask(size(run) - 1)

    mask = run(2:) == run(:size(run) - 1)
    steps = count(mask)
    noise = white_noise(sqrt(sum((smooth(2:) - smooth(:size(run) - 1))**2, mask)/ &
      (2*max(1, steps))))
    ! Neighbouring steps share a sample.
    noise%known_by = max(1.0_wp, 2*steps/3.0_wp)
    noise%of_steps = .true.
  end subroutine noise_of_steps

  !> The deviation of white noise in a smooth signal with outliers, from the median of its second
  !> differences; it is at least that of rounding.
  pure real(wp) function rough_deviation(signal) result(deviation)
    real(wp), intent(in) :: signal(:)
    integer :: n

    n = size(signal)
    ! 6 is the sum of the squares of the weights 1, -2, 1.
    deviation = max(epsilon(1.0_wp)*maxval(abs(signal)), median_of(abs(signal(3:) - &
      2*signal(2:n - 1) + signal(:n - 2)))/(normal_median*sqrt(6.0_wp)))
  end function rough_deviation

  !> The standard deviation due to rounding in a signal of few digits, from the smallest step
  !> between neighbours.
  pure real(wp) function rounding_of(signal) result(deviation)
    real(wp), intent(in) :: signal(:)
    !> Smallest step, relative to the largest signal, that differs from zero.
    real(wp), parameter :: none = 1.0e-12_wp
    real(wp) :: step(size(signal) - 1)

    step = abs(signal(2:) - signal(:size(signal) - 1))
    deviation = 0
    if (any(step > none*maxval(abs(signal)))) &
      deviation = minval(step, step > none*maxval(abs(signal)))/sqrt(12.0_wp)
  end function rounding_of

  !> Finds the weights of all orders from the correlations, and the order with the smallest n
  !> ln(left^2) + order ln(n) (Schwarz, 1978). The order is 0 if chance explains the gain over order
  !> 0.
  pure subroutine find_weights(noise, n)
    type(noise_t), intent(inout) :: noise
    integer, intent(in) :: n
    real(wp) :: reflection, left, gain, best, before(longest)
    integer :: k

    left = 1
    best = -by_chance
    before = 0
    do k = 1, longest
      reflection = (noise%correlation(k) - dot_product(before(:k - 1), &
        reversed(noise%correlation(1:k - 1))))/left
      noise%weight(:k - 1, k) = before(:k - 1) - reflection*reversed(before(:k - 1))
      noise%weight(k, k) = reflection
      before = noise%weight(:, k)
      left = left*(1 - reflection**2)
      noise%left(k) = noise%deviation*sqrt(left)
      gain = n*log(left) + k*log(real(n, wp))
      if (gain >= best) cycle
      best = gain
      noise%order = k
    end do
  end subroutine find_weights

  pure function reversed(a)
    real(wp), intent(in) :: a(:)
    real(wp) :: reversed(size(a))

    reversed = a(size(a):1:-1)
  end function reversed

  !> Transforms columns of numbers, one for each sample, so that their noise becomes white with
  !> deviation 1. Samples of different runs are uncorrelated.
  pure subroutine whiten(noise, run, column)
    type(noise_t), intent(in) :: noise
    integer, intent(in) :: run(:)
    real(wp), intent(inout) :: column(:, :)
    integer :: known(size(run)), i, j

    if (noise%order == 0) then
      column = column/noise%left(0)
      return
    end if
    known = predicting(noise, run)
    do j = 1, size(column, 2)
      ! Start with the last sample, so that the samples which predict another one still have their
      ! given values.
      do i = size(run), 1, -1
        associate (k => known(i))
          column(i, j) = (column(i, j) - &
            dot_product(noise%weight(:k, max(1, k)), column(i - 1:i - k:-1, j)))/noise%left(k)
        end associate
      end do
    end do
  end subroutine whiten

  !> For each sample, the number of previous samples of its run that predict it.
  pure function predicting(noise, run) result(known)
    type(noise_t), intent(in) :: noise
    integer, intent(in) :: run(:)
    integer :: known(size(run)), i

    known = 0
    do i = 2, size(run)
      if (run(i) == run(i - 1)) known(i) = min(known(i - 1) + 1, noise%order)
    end do
  end function predicting

end module noise
