!> The result of a fit, and the errors of the fitted values from the derivatives of the residuals.
module fit_errors
  use kinds, only: wp
  use linear_algebra, only: singular_values
  use fit_request, only: unknown_t, value_by_fitted
  use fit_residuals, only: fit_residuals_t
  use curve_residuals, only: curve_residuals_t
  use significance, only: negligible
  use residual_analysis, only: lack_t, lack_in
  implicit none
  private
  public :: fitted_t, judge, find_errors, examine_curve, set_deviations, bounded, within_95

  !> Half-width of a 95 % interval in standard deviations.
  real(wp), parameter :: within_95 = 1.959964_wp

  !> The result of a fit. value, deviation: each unknown and its standard deviation, in the unit of
  !> its key. fitted_deviation, correlation: standard deviations and correlations of the fitted
  !> numbers (`fit_request`), whose errors are symmetric. identifiable: the smallest singular value
  !> of the Jacobian of the fitted numbers with columns of length 1; it is 1 if the columns are
  !> orthogonal, and 0 if the data do not determine all unknowns. effect: the change of the curve,
  !> in standard deviations of all data together, if the fitted number changes by 1; an unknown of
  !> which it is negligible has no effect. side(:, i): standard deviations of fitted number i
  !> downward and upward, of which fitted_deviation(i) is the larger one. has_path: the model has a
  !> path for some start. has_curve: for some start the model describes the samples better if the
  !> curve includes the contact than if it does not.
  type :: fitted_t
    logical :: found = .false., has_curve = .false., has_path = .false.
    real(wp), allocatable :: value(:), deviation(:), fitted_deviation(:), correlation(:, :), &
      effect(:), side(:, :)
    real(wp) :: identifiable = 0
    !> Sum of the squared residuals in standard deviations, and its expected value.
    real(wp) :: chi_squared = 0
    integer :: freedom = 0
    !> Standard deviation of a whitened residual, in the unit of the signal.
    real(wp) :: scale = 1
    type(lack_t) :: lack = lack_t()
    !> At all samples: the model with its baseline, the residual, the baseline.
    real(wp), allocatable :: model(:), residual(:), baseline(:)
    !> Positions of the base at which the model has its snap-in and snap-off; NaN without a jump.
    real(wp) :: jump_z(2) = 0
    !> Derivatives of the residuals by the fitted numbers, and the covariance of these.
    real(wp), allocatable :: by_fitted(:, :), covariance(:, :)
  contains
    procedure :: end_of
    procedure :: is_better_than
    procedure :: part_of
  end type fitted_t

contains

  !> Whether a fit has errors, all its unknowns have an effect, and it is more likely than another
  !> fit. The likelihood of each fit uses the noise found by this fit.
  pure logical function is_better_than(self, other)
    class(fitted_t), intent(in) :: self
    type(fitted_t), intent(in) :: other

    is_better_than = allocated(self%effect)
    if (is_better_than) is_better_than = all(self%effect > negligible)
    if (is_better_than .and. allocated(other%effect)) is_better_than = surprise(self) < &
      surprise(other)

  contains

    !> Minus twice the logarithm of the likelihood of a sample.
    pure real(wp) function surprise(fitted)
      class(fitted_t), intent(in) :: fitted

      surprise = fitted%chi_squared/fitted%freedom + 2*log(fitted%scale)
    end function surprise

  end function is_better_than

  !> Finds errors and correlations of the values, and the residuals of the curve.
  subroutine judge(residuals, fitted)
    type(curve_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp) :: residual(residuals%rows())
    logical :: found

    call find_errors(residuals, fitted, residual, found)
    if (found) call examine_curve(residuals, residual, fitted)
  end subroutine judge

  !> Finds errors and correlations of the values. residual: the residuals at the values.
  subroutine find_errors(residuals, fitted, residual, found)
    class(fit_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found
    real(wp) :: jacobian(size(residual), size(fitted%value))
    real(wp), dimension(size(fitted%value), size(fitted%value)) :: right, covariance
    real(wp), dimension(size(fitted%value)) :: length, singular
    type(unknown_t), allocatable :: unknown(:)
    integer :: i, j, n

    n = size(fitted%value)
    unknown = residuals%unknowns()
    call residuals%residuals_of(fitted%value, residual, found)
    if (found) call residuals%jacobian_of(fitted%value, jacobian, found)
    fitted%found = fitted%found .and. found
    if (.not. found) return
    fitted%chi_squared = sum(residual**2)
    fitted%freedom = size(residual) - n - residuals%removed()
    do j = 1, n
      jacobian(:, j) = jacobian(:, j)*value_by_fitted(unknown(j), fitted%value(j))
    end do
    length = norm2(jacobian, 1)
    fitted%effect = length
    fitted%by_fitted = jacobian
    do j = 1, n
      jacobian(:, j) = jacobian(:, j)/max(length(j), tiny(1.0_wp))
    end do
    call singular_values(jacobian, singular, right)
    fitted%identifiable = minval(singular)
    do i = 1, n
      do j = 1, n
        covariance(i, j) = sum(right(:, i)*right(:, j)/max(singular, epsilon(1.0_wp))**2)
      end do
    end do
    length = max(length, tiny(1.0_wp)**0.25_wp)
    fitted%side = spread([(sqrt(covariance(j, j))/length(j), j=1, n)], 1, 2)
    call set_deviations(fitted, unknown)
    fitted%correlation = covariance
    do j = 1, n
      fitted%correlation(:, j) = &
        [(covariance(i, j)/sqrt(covariance(i, i)*covariance(j, j)), i=1, n)]
    end do
    fitted%covariance = covariance/spread(length, 1, n)/spread(length, 2, n)
  end subroutine find_errors

  !> Finds the misfit of a curve from the residuals at the values of the fit.
  subroutine examine_curve(residuals, residual, fitted)
    type(curve_residuals_t), intent(in) :: residuals
    real(wp), intent(in) :: residual(:)
    type(fitted_t), intent(inout) :: fitted
    integer :: i

    associate (data => residuals%curve%data)
      fitted%scale = data%noise%left(data%noise%order)
      fitted%lack = lack_in(residual(:size(data%sample)), 3*data%way(data%sample) + &
        data%side(data%sample), size(data%sample) + fitted%freedom - size(residual), data%noise)
    end associate
    call residuals%curve%split(fitted%value, fitted%model, fitted%baseline)
    fitted%residual = residuals%curve%data%measured%signal - fitted%model
    fitted%jump_z = [(residuals%curve%jump_of(fitted%value, i), i=1, 2)]
  end subroutine examine_curve

  !> The part of a fit of several curves that belongs to one curve. place: the positions of its
  !> unknowns among all. residual: its residuals, which follow `before` residuals of other curves;
  !> removed: the number of amplitudes of its baseline. The degrees of freedom are the expected sum
  !> of its squared residuals. Their sum over all curves equals that of the whole fit, except for
  !> rounding to integers.
  pure type(fitted_t) function part_of(self, place, residual, before, removed) result(part)
    class(fitted_t), intent(in) :: self
    integer, intent(in) :: place(:), before, removed
    real(wp), intent(in) :: residual(:)

    part%found = self%found
    part%has_path = .true.
    part%has_curve = .true.
    part%value = self%value(place)
    part%deviation = self%deviation(place)
    part%fitted_deviation = self%fitted_deviation(place)
    part%correlation = self%correlation(place, place)
    part%covariance = self%covariance(place, place)
    part%effect = self%effect(place)
    part%side = self%side(:, place)
    part%identifiable = self%identifiable
    part%by_fitted = self%by_fitted(before + 1:before + size(residual), place)
    part%chi_squared = sum(residual**2)
    part%freedom = size(residual) - removed - &
      nint(sum(part%by_fitted*matmul(part%by_fitted, part%covariance)))
  end function part_of

  !> Sets the standard errors from those of the two sides.
  pure subroutine set_deviations(fitted, unknown)
    type(fitted_t), intent(inout) :: fitted
    type(unknown_t), intent(in) :: unknown(:)
    integer :: j

    fitted%fitted_deviation = maxval(fitted%side, 1)
    fitted%deviation = fitted%fitted_deviation* &
      abs([(value_by_fitted(unknown(j), fitted%value(j)), j=1, size(unknown))])
  end subroutine set_deviations

  !> A value, moved to the nearest bound of its unknown if it is beyond the bounds.
  elemental real(wp) function bounded(unknown, value)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    bounded = value
    if (allocated(unknown%lower)) bounded = max(bounded, unknown%lower)
    if (allocated(unknown%upper)) bounded = min(bounded, unknown%upper)
  end function bounded

  !> The end of the interval of `sign` standard deviations about unknown i, limited by its bounds.
  !> For a positive unknown the standard deviations are those of the logarithm.
  pure real(wp) function end_of(self, i, unknown, sign) result(value)
    class(fitted_t), intent(in) :: self
    integer, intent(in) :: i
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: sign
    real(wp), parameter :: largest = 100
    real(wp) :: deviation

    deviation = self%side(merge(2, 1, sign > 0), i)
    value = self%value(i) + sign*deviation*unknown%scale
    if (unknown%in_log) value = self%value(i)*exp(sign*min(deviation, largest))
    value = bounded(unknown, value)
  end function end_of

end module fit_errors
