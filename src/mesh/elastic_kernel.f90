!> The axisymmetric kernel of the elastic half-space, (15) of the paper with its missing 1/pi:
!>
!>     k(r, t) = 4/(pi max(r, t)) K(m),  m = (min(r, t)/max(r, t))**2 .
!>
!> By Gauss's transformation this is 2/agm(r + t, |r - t|), with agm the arithmetic-geometric
!> mean: one expression on both sides of t = r, without the cancellation of 1 - m, provided
!> that the caller forms |r - t| without cancellation too. It is therefore the argument.
module elastic_kernel
  use kinds, only: wp, pi
  implicit none
  private
  public :: kernel, kernel_log_coefficient

contains

  !> k as a function of the sums r + t and the distances |r - t|, both positive, in units of
  !> one over that of the arguments. Integrable (logarithmic) singularity at distance 0.
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

  !> Arithmetic-geometric means of 1 and x, 0 < x <= 1, to rounding. The number of steps is fixed,
  !> and steps are taken for all at once, so that the loops vectorise: seven reach double precision
  !> from x = 1e-14 upward.
  pure function agm(x) result(mean)
    real(wp), intent(in) :: x(:)
    real(wp), dimension(size(x)) :: mean, g, next
    integer :: step

    mean = 1
    g = x
    do step = 1, 7
      next = 0.5_wp*(mean + g)
      g = sqrt(mean*g)
      mean = next
    end do
    mean = 0.5_wp*(mean + g)
  end function agm

end module elastic_kernel
