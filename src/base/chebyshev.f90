!> Chebyshev series on [-1, 1]: the series through given values, and the value, the slope and the
!> integral of a series.
module chebyshev
  use kinds, only: wp, pi
  implicit none
  private
  public :: chebyshev_points, chebyshev_series, series_value, series_slope, series_integral, &
    power_series, power_value

contains

  !> The n + 1 extrema of the polynomial of degree n, from -1 to 1.
  pure function chebyshev_points(n) result(point)
    integer, intent(in) :: n
    real(wp) :: point(0:n)
    integer :: j

    point = [(-cos(pi*j/n), j=0, n)]
  end function chebyshev_points

  !> Coefficients of the polynomial through `value` at `chebyshev_points`.
  pure function chebyshev_series(value) result(coefficient)
    real(wp), intent(in) :: value(0:)
    real(wp) :: coefficient(0:ubound(value, 1)), weighted(0:ubound(value, 1))
    real(wp) :: cosine(0:2*ubound(value, 1))
    integer :: n, j, k

    n = ubound(value, 1)
    weighted = value
    weighted([0, n]) = value([0, n])/2
    cosine = [(cos(pi*j/n), j=0, 2*n)]
    do k = 0, n
      coefficient(k) = (-1)**k*2.0_wp/n*sum(weighted*cosine([(mod(j*k, 2*n), j=0, n)]))
    end do
    coefficient([0, n]) = coefficient([0, n])/2
  end function chebyshev_series

  !> The series at x, by Clenshaw's recurrence.
  pure real(wp) function series_value(coefficient, x) result(value)
    real(wp), intent(in) :: coefficient(0:), x
    real(wp) :: before, last
    integer :: k

    value = 0
    before = 0
    do k = ubound(coefficient, 1), 1, -1
      last = before
      before = value
      value = 2*x*before - last + coefficient(k)
    end do
    value = x*value - before + coefficient(0)
  end function series_value

  !> The derivative of the series, as a series.
  pure function series_slope(coefficient) result(slope)
    real(wp), intent(in) :: coefficient(0:)
    real(wp) :: slope(0:ubound(coefficient, 1))
    integer :: n, k

    n = ubound(coefficient, 1)
    slope = 0
    do k = n - 1, 0, -1
      slope(k) = 2*(k + 1)*coefficient(k + 1)
      if (k + 2 <= n) slope(k) = slope(k) + slope(k + 2)
    end do
    slope(0) = slope(0)/2
  end function series_slope

  !> The integral of the series from -1 to x, as a series of one degree more.
  pure function series_integral(coefficient) result(integral)
    real(wp), intent(in) :: coefficient(0:)
    real(wp) :: integral(0:ubound(coefficient, 1) + 1), padded(0:ubound(coefficient, 1) + 2)
    integer :: k

    padded = 0
    padded(:ubound(coefficient, 1)) = coefficient
    padded(0) = 2*padded(0)
    integral(0) = 0
    do k = 1, ubound(integral, 1)
      integral(k) = (padded(k - 1) - padded(k + 1))/(2*k)
    end do
    do k = 1, ubound(integral, 1)
      integral(0) = integral(0) - (-1)**k*integral(k)
    end do
  end function series_integral

  !> The coefficients of the powers of x in a series.
  pure function power_series(coefficient) result(power)
    real(wp), intent(in) :: coefficient(0:)
    real(wp), dimension(0:ubound(coefficient, 1)) :: power, before, now, next
    integer :: n, k

    n = ubound(coefficient, 1)
    before = 0
    now = 0
    now(0) = 1
    power = coefficient(0)*now
    do k = 1, n
      ! T_1 = x, T_k = 2 x T_(k-1) - T_(k-2).
      next = -before
      next(1:) = next(1:) + merge(1, 2, k == 1)*now(:n - 1)
      before = now
      now = next
      power = power + coefficient(k)*now
    end do
  end function power_series

  !> A series of powers at x. Even and odd orders are summed separately, since the processor can
  !> work on both sums at once.
  pure real(wp) function power_value(power, x) result(value)
    real(wp), intent(in) :: power(0:), x
    real(wp) :: square, odd
    integer :: k

    square = x**2
    value = 0
    odd = 0
    do k = ubound(power, 1)/2, 0, -1
      value = value*square + power(2*k)
    end do
    do k = (ubound(power, 1) - 1)/2, 0, -1
      odd = odd*square + power(2*k + 1)
    end do
    value = value + x*odd
  end function power_value

end module chebyshev
