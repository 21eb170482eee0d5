!> From the numbers that a search moves freely to the values of the unknowns, and back. What is
!> positive goes by its logarithm; bounds, which the search does not know, by a sine or, where there
!> is one, by a hyperbola.
module unknowns
  use kinds, only: wp
  use fit_request, only: unknown_t
  implicit none
  private
  public :: free_of, value_of, fitted_of, value_by_free, value_by_fitted

contains

  !> The fitted number of a value: ln(value/scale), or (value - origin)/scale.
  elemental real(wp) function fitted_of(unknown, value) result(u)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    u = (value - unknown%origin)/unknown%scale
    if (unknown%in_log) u = log(value/unknown%scale)
  end function fitted_of

  !> The free number of a value; of one at its bound or beyond, that of one a little within.
  elemental real(wp) function free_of(unknown, value) result(x)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value
    real(wp), parameter :: within = 1.0e-3_wp
    real(wp) :: u, low, high

    u = fitted_of(unknown, value)
    x = u
    if (allocated(unknown%lower)) low = fitted_of(unknown, unknown%lower)
    if (allocated(unknown%upper)) high = fitted_of(unknown, unknown%upper)
    if (allocated(unknown%lower) .and. allocated(unknown%upper)) then
      x = asin(max(-1 + within, min(1 - within, 2*(u - low)/(high - low) - 1)))
    else if (allocated(unknown%lower)) then
      x = sqrt((max(u - low, within) + 1)**2 - 1)
    else if (allocated(unknown%upper)) then
      x = sqrt((max(high - u, within) + 1)**2 - 1)
    end if
  end function free_of

  !> The value of a free number.
  elemental real(wp) function value_of(unknown, x) result(value)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: x
    real(wp) :: u, low, high

    u = x
    if (allocated(unknown%lower)) low = fitted_of(unknown, unknown%lower)
    if (allocated(unknown%upper)) high = fitted_of(unknown, unknown%upper)
    if (allocated(unknown%lower) .and. allocated(unknown%upper)) then
      u = low + 0.5_wp*(high - low)*(1 + sin(x))
    else if (allocated(unknown%lower)) then
      u = low - 1 + sqrt(x**2 + 1)
    else if (allocated(unknown%upper)) then
      u = high + 1 - sqrt(x**2 + 1)
    end if
    value = unknown%origin + unknown%scale*u
    if (unknown%in_log) value = unknown%scale*exp(u)
  end function value_of

  !> Derivative of the value by its free number.
  elemental real(wp) function value_by_free(unknown, x) result(slope)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: x

    slope = 1
    if (allocated(unknown%lower) .and. allocated(unknown%upper)) then
      slope = 0.5_wp*cos(x)*(fitted_of(unknown, unknown%upper) - fitted_of(unknown, unknown%lower))
    else if (allocated(unknown%lower)) then
      slope = x/sqrt(x**2 + 1)
    else if (allocated(unknown%upper)) then
      slope = -x/sqrt(x**2 + 1)
    end if
    slope = slope*value_by_fitted(unknown, value_of(unknown, x))
  end function value_by_free

  !> Derivative of a value by its fitted number.
  elemental real(wp) function value_by_fitted(unknown, value) result(slope)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    slope = unknown%scale
    if (unknown%in_log) slope = value
  end function value_by_fitted

end module unknowns
