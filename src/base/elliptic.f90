!> Elliptic integrals by Carlson's duplication (Numer. Algorithms 10, 13, 1995).
module elliptic
  use kinds, only: wp
  implicit none
  private
  public :: carlson_rf

contains

  !> R_F(x, y, z), half the integral of 1/sqrt((t + x)(t + y)(t + z)) over t from 0 to infinity; no
  !> argument is negative, and at most one is 0. Duplication does not change R_F and brings the
  !> arguments together, until five terms of its series give all digits.
  elemental real(wp) function carlson_rf(x, y, z) result(rf)
    real(wp), intent(in) :: x, y, z
    real(wp), parameter :: near = (3*epsilon(1.0_wp))**(1.0_wp/6)
    integer, parameter :: most = 600
    real(wp) :: a(3), root(3), mean, e2, e3
    integer :: i

    a = [x, y, z]
    do i = 1, most
      mean = sum(a)/3
      if (.not. maxval(abs(a - mean)) > near*mean) exit
      root = sqrt(a)
      a = 0.25_wp*(a + (root(1)*root(2) + root(1)*root(3) + root(2)*root(3)))
    end do
    a = 1 - a/mean
    e2 = a(1)*a(2) - a(3)**2
    e3 = product(a)
    rf = (1 - e2/10 + e3/14 + e2**2/24 - 3*e2*e3/44)/sqrt(mean)
  end function carlson_rf

end module elliptic
