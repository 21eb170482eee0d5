!> The axisymmetric kernel of the elastic half-space, (15) of the paper with its missing 1/pi:
!>
!>     k(r, t) = 4/(pi max(r, t)) K(m),  m = (min(r, t)/max(r, t))**2 .
!>
!> By Gauss's transformation this is 2/agm(r + t, |r - t|), with agm the arithmetic-geometric mean:
!> one expression on both sides of t = r, without the cancellation of 1 - m. The distance |r - t| is
!> an argument, so that the caller can compute it without cancellation.
module elastic_kernel
  use kinds, only: wp, pi
  implicit none
  private
  public :: kernel, kernel_log_coefficient

  !> The arithmetic-geometric mean needs one step if a ratio is below the first of these numbers,
  !> one more step if it is below the second one, and so on. After these steps the ratios are so
  !> near to 1 that the series is exact.
  real(wp), parameter :: one_more(6) = [0.82_wp, 0.271_wp, 0.019_wp, 9.1e-5_wp, 2.1e-9_wp, &
    1.2e-18_wp]
  !> Coefficients, after 1, of the series of 1/agm(1 + q, 1 - q) in q**2.
  real(wp), parameter :: series(7) = [1/4.0_wp, 9/64.0_wp, 25/256.0_wp, 1225/16384.0_wp, &
    3969/65536.0_wp, 53361/1048576.0_wp, 184041/4194304.0_wp]
  !> Number of means that are computed together.
  integer, parameter :: at_once = 8

contains

  !> The kernel k as a function of the sums r + t and the distances |r - t|, both positive; its unit
  !> is the inverse of that of the arguments. Integrable (logarithmic) singularity at distance 0.
  pure function kernel(total, distance) result(k)
    real(wp), intent(in), contiguous :: total(:), distance(:)
    real(wp) :: k(size(total))

    k = over_means(2.0_wp, total, distance)
  end function kernel

  !> The coefficient a in k = -a ln(|r - t|) + smooth; a is analytic at t = r.
  pure function kernel_log_coefficient(total, distance) result(a)
    real(wp), intent(in), contiguous :: total(:), distance(:)
    real(wp) :: a(size(total))

    a = over_means(4/pi, total, sqrt((total - distance)*(total + distance)))
  end function kernel_log_coefficient

  !> A factor over the arithmetic-geometric means of x and y, 0 < y <= x, to rounding. If the last
  !> values are fewer than are computed together, values before them are computed again.
  pure function over_means(factor, x, y) result(quotient)
    real(wp), intent(in) :: factor
    real(wp), intent(in), contiguous :: x(:), y(:)
    real(wp) :: quotient(size(x)), few(at_once, 3)
    integer :: first, last, i, n

    n = size(x)
    if (n < at_once) then
      few = 1
      few(:n, 1) = x
      few(:n, 2) = y
      call divide(factor, few(:, 1), few(:, 2), few(:, 3))
      quotient = few(:n, 3)
      return
    end if
    do first = 1, n, at_once
      i = min(first, n + 1 - at_once)
      last = i + at_once - 1
      call divide(factor, x(i:last), y(i:last), quotient(i:last))
    end do
  end function over_means

  !> The same for a fixed number of values, so that the loops vectorise. All values take as many
  !> steps as the value that needs most. (Consecutive points usually have similar ratios.)
  pure subroutine divide(factor, x, y, quotient)
    real(wp), intent(in) :: factor, x(at_once), y(at_once)
    real(wp), intent(out) :: quotient(at_once)
    real(wp), dimension(at_once) :: a, b, next
    integer :: step, k

    a = x
    b = y
    next = b/a
    next(:4) = min(next(:4), next(5:))
    do step = 1, count(minval(next(:4)) < one_more)
      next = 0.5_wp*(a + b)
      b = sqrt(a*b)
      a = next
    end do
    next = 2/(a + b)
    a = (0.5_wp*(a - b)*next)**2
    b = series(size(series))
    do k = size(series) - 1, 1, -1
      b = series(k) + b*a
    end do
    quotient = factor*(next + next*(b*a))
  end subroutine divide

end module elastic_kernel
