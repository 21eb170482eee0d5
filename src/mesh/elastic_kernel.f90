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

  !> Steps of the mean that reach double precision from the first of these ratios upward; one more
  !> step from the next ratio upward, and so on; four more steps are enough from 1e-14.
  integer, parameter :: fewest_steps = 3
  real(wp), parameter :: one_more(4) = [0.45_wp, 0.06_wp, 9.0e-4_wp, 2.0e-7_wp]
  !> Number of means that are computed together.
  integer, parameter :: at_once = 16

contains

  !> The kernel k as a function of the sums r + t and the distances |r - t|, both positive; its unit
  !> is the inverse of that of the arguments. Integrable (logarithmic) singularity at distance 0.
  pure function kernel(total, distance) result(k)
    real(wp), intent(in) :: total(:), distance(:)
    real(wp) :: k(size(total))

    k = 2/(total*agm(distance/total))
  end function kernel

  !> The coefficient a in k = -a ln(|r - t|) + smooth; a is analytic at t = r.
  pure function kernel_log_coefficient(total, distance) result(a)
    real(wp), intent(in) :: total(:), distance(:)
    real(wp), dimension(size(total)) :: a, x

    x = distance/total
    a = 4/(pi*total*agm(sqrt((1 - x)*(1 + x))))
  end function kernel_log_coefficient

  !> Arithmetic-geometric means of 1 and x, 0 < x <= 1, to rounding. A fixed number of values is
  !> iterated together, with the number of steps that the smallest of them needs, so that the loops
  !> vectorise. (Consecutive points usually have similar values.)
  pure function agm(x) result(mean)
    real(wp), intent(in) :: x(:)
    real(wp) :: mean(size(x))
    real(wp), dimension(at_once) :: a, b, next
    integer :: step, first, last

    do first = 1, size(x), at_once
      last = min(first + at_once - 1, size(x))
      b(:last - first + 1) = x(first:last)
      b(last - first + 2:) = 1
      a = 1
      do step = 1, fewest_steps + count(minval(b) < one_more)
        next = 0.5_wp*(a + b)
        b = sqrt(a*b)
        a = next
      end do
      a = 0.5_wp*(a + b)
      mean(first:last) = a(:last - first + 1)
    end do
  end function agm

end module elastic_kernel
