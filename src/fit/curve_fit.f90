!> The fit of a model to a measured curve: the values of the unknowns that leave least of it, their
!> errors, and what the data cannot tell apart.
module curve_fit
  use kinds, only: wp
  use linear_algebra, only: singular_values
  use fit_request, only: unknown_t, of_contact_point
  use least_squares, only: minimise
  use unknowns, only: free_of, value_by_fitted
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  use curve_residuals, only: curve_residuals_t
  use contact_starts, only: find_starts
  implicit none
  private
  public :: fitted_t, fit_curve

  !> Starts that are tried, and by how much the sum of squares there may exceed the least.
  integer, parameter :: most_starts = 3
  real(wp), parameter :: worse = 4

  !> What a fit found. value and its standard deviation in the unit of each key; the same of the
  !> fitted number (`unknowns`), of which the errors are symmetric; correlation of these.
  !> identifiable: the least singular value of their Jacobian with columns of length 1: 1 where the
  !> data tell all apart, 0 where they do not tell some. effect: by how many standard deviations of
  !> all data together a change of the fitted number by 1 is seen.
  type :: fitted_t
    logical :: found = .false., has_curve = .false.
    real(wp), allocatable :: value(:), deviation(:), fitted_deviation(:), correlation(:, :), &
      effect(:)
    real(wp) :: identifiable = 0
    !> Sum of the squares of the residuals in standard deviations, and what it is expected to be.
    real(wp) :: chi_squared = 0
    integer :: freedom = 0
    !> Of all samples: model with baseline, and what is left.
    real(wp), allocatable :: model(:), residual(:), baseline(:)
    !> Where the base is when the model jumps in and out; NaN where it does not.
    real(wp) :: jump_z(2) = 0
  contains
    procedure :: end_of
  end type fitted_t

contains

  !> Fits the model from the deck's values, and from several contact points where that is unknown.
  subroutine fit_curve(curve, model, start, fitted)
    type(modelled_curve_t), intent(in) :: curve
    class(force_model_t), intent(inout), target :: model
    real(wp), intent(in) :: start(:)
    type(fitted_t), intent(out) :: fitted
    type(curve_residuals_t) :: residuals
    real(wp), allocatable :: starts(:), x(:), residual(:)
    real(wp) :: value(size(start)), least
    logical :: found
    integer :: i, role

    residuals%curve = curve
    residuals%curve%model => model
    role = findloc(residuals%curve%unknown%role, of_contact_point, 1)
    if (role > 0) then
      call find_starts(residuals, start, most_starts, worse, starts, fitted%has_curve)
    else
      allocate (residual(residuals%rows()))
      call residuals%residuals_of(start, residual, fitted%has_curve)
      starts = [0.0_wp]
    end if
    if (.not. fitted%has_curve) return
    allocate (x(size(start)))
    residual = [(0.0_wp, i=1, residuals%rows())]
    least = huge(least)
    do i = 1, size(starts)
      value = start
      if (role > 0) value(role) = starts(i)
      if (role > 0) residuals%curve%unknown(role)%origin = starts(i)
      x = free_of(residuals%curve%unknown, value)
      call minimise(residuals, x, residual, found)
      if (.not. sum(residual**2) < least) cycle
      least = sum(residual**2)
      fitted%value = residuals%values(x)
      fitted%found = found
    end do
    if (.not. allocated(fitted%value)) return
    call judge(residuals, fitted)
  end subroutine fit_curve

  !> Errors and correlations of the values, and what is left of the curve.
  subroutine judge(residuals, fitted)
    type(curve_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp) :: jacobian(residuals%rows(), size(fitted%value)), residual(residuals%rows())
    real(wp), dimension(size(fitted%value), size(fitted%value)) :: right, covariance
    real(wp), dimension(size(fitted%value)) :: length, singular
    logical :: found
    integer :: i, j, n

    n = size(fitted%value)
    call residuals%residuals_of(fitted%value, residual, found)
    if (found) call residuals%jacobian_of(fitted%value, jacobian, found)
    fitted%found = fitted%found .and. found
    if (.not. found) return
    fitted%chi_squared = sum(residual**2)
    fitted%freedom = size(residual) - n - residuals%curve%data%baseline%unknowns()
    do j = 1, n
      jacobian(:, j) = jacobian(:, j)*value_by_fitted(residuals%curve%unknown(j), fitted%value(j))
    end do
    length = norm2(jacobian, 1)
    fitted%effect = length
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
    fitted%fitted_deviation = [(sqrt(covariance(j, j))/length(j), j=1, n)]
    fitted%deviation = fitted%fitted_deviation* &
      abs([(value_by_fitted(residuals%curve%unknown(j), fitted%value(j)), j=1, n)])
    allocate (fitted%correlation(n, n))
    do j = 1, n
      fitted%correlation(:, j) = &
        [(covariance(i, j)/sqrt(covariance(i, i)*covariance(j, j)), i=1, n)]
    end do
    call residuals%curve%split(fitted%value, fitted%model, fitted%baseline)
    fitted%residual = residuals%curve%data%measured%signal - fitted%model
    fitted%jump_z = [(residuals%curve%jump_of(fitted%value, i), i=1, 2)]
  end subroutine judge

  !> The end of the interval of `sign` standard deviations about unknown i; that of what is positive
  !> is even in the logarithm.
  pure real(wp) function end_of(self, i, unknown, sign) result(value)
    class(fitted_t), intent(in) :: self
    integer, intent(in) :: i
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: sign
    real(wp), parameter :: largest = 100

    value = self%value(i) + sign*self%deviation(i)
    if (unknown%in_log) value = self%value(i)* &
      exp(sign*min(self%fitted_deviation(i), largest))
  end function end_of

end module curve_fit
