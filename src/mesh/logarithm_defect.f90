!> The error of the Gauss rule for a logarithm.
!>
!> A kernel k = -a ln|u - v| + b, with a and b smooth in u, is integrated on the Gauss-Legendre
!> nodes u_j of [0, 1]. The rule is as exact as the polynomials through the nodes that represent a f
!> and b f:
!>
!>     integral k(u) f(u) du = sum_j (w_j k(u_j) + a(u_j) c_j) f(u_j),
!>
!> Here c_j is the integral of -ln|u - v| L_j(u), with L_j the Lagrange polynomials, minus the
!> rule's value of it, -w_j ln|u_j - v|. The defect c_j depends only on the nodes and v, and
!> decreases to zero far from the panel.
module logarithm_defect
  use kinds, only: wp
  use matrix_products, only: multiply_transposed
  use quadrature, only: legendre_values
  implicit none
  private
  public :: logarithm_defects, feels_logarithm

  !> Beyond the ends, Legendre functions of the second kind decrease with their degree. The
  !> recurrence runs upward from the lowest degree if errors grow by less than `tolerable`;
  !> otherwise it runs downward from a degree at which the function is below `nothing`.
  real(wp), parameter :: tolerable = 1.0e3_wp, nothing = 1.0e-16_wp

contains

  !> The defect c(j, i) for node j and the position at(i), inside or outside the panel. If at(i) is
  !> the node itself, c is the integral, without the logarithm, which the rule cannot evaluate.
  function logarithm_defects(node, weight, at) result(c)
    real(wp), intent(in) :: node(:), weight(:), at(:)
    real(wp) :: c(size(node), size(at))
    real(wp) :: series(size(node), size(at)), degrees(size(node), size(node))
    real(wp) :: distance(size(node))
    integer :: i

    series = transpose(logarithm_series(2*at - 1, size(node)))
    degrees = transpose(legendre_values(node, size(node)))
    call multiply_transposed(degrees, series, c)
    do i = 1, size(at)
      distance = abs(node - at(i))
      where (.not. distance > 0) distance = 1
      c(:, i) = weight*(c(:, i) + log(distance))
    end do
  end function logarithm_defects

  !> Whether the defect matters at a distance from the panel, in units of its length, for an
  !> accuracy of `digits` digits: the Gauss rule is exact for twice as many degrees as it has nodes.
  elemental logical function feels_logarithm(distance, nodes, digits)
    real(wp), intent(in) :: distance, digits
    integer, intent(in) :: nodes

    feels_logarithm = nodes*log10(ellipse(1 + 2*distance)) < digits
  end function feels_logarithm

  !> Coefficients of -ln|s - x|, with s from -1 to 1, in Legendre polynomials of s, on the interval
  !> of length 1: (place, degree + 1). The coefficient of degree l > 0 is Q_(l-1)(x) - Q_(l+1)(x).
  pure function logarithm_series(x, terms) result(series)
    real(wp), intent(in) :: x(:)
    integer, intent(in) :: terms
    real(wp) :: series(size(x), terms)
    logical :: at_end(size(x)), is_near(size(x))
    integer, allocatable :: which(:)
    integer :: i, l

    at_end = abs(abs(x) - 1) <= 2*epsilon(x)
    is_near = 2*terms*log(ellipse(abs(x))) < log(tolerable)
    which = pack([(i, i=1, size(x))], is_near .and. .not. at_end)
    series(which, :) = differences(upward(x(which), terms))
    which = pack([(i, i=1, size(x))], .not. is_near)
    series(which, :) = differences(downward(x(which), terms))
    do l = 1, terms - 1
      where (at_end) series(:, l + 1) = sign(1.0_wp, x)**l*(real(2*l + 1, wp)/(l*(l + 1)))
    end do
    series(:, 1) = 1 + log(2.0_wp) - 0.5_wp*(x_log_x(1 + x) + x_log_x(1 - x))
  end function logarithm_series

  pure function differences(q) result(difference)
    real(wp), intent(in) :: q(:, 0:)
    real(wp) :: difference(size(q, 1), size(q, 2) - 1)

    difference(:, 1) = 0
    difference(:, 2:) = q(:, :ubound(q, 2) - 2) - q(:, 2:)
  end function differences

  !> Q of degrees 0 to `top` by the upward recurrence; exact between the ends.
  pure function upward(x, top) result(q)
    real(wp), intent(in) :: x(:)
    integer, intent(in) :: top
    real(wp) :: q(size(x), 0:top), forward
    integer :: l

    q(:, 0) = lowest(x)
    q(:, 1) = x*q(:, 0) - 1
    do l = 1, top - 1
      forward = (2*l + 1)*(1.0_wp/(l + 1))
      q(:, l + 1) = forward*x*q(:, l) - (forward - 1)*q(:, l - 1)
    end do
  end function upward

  !> Q of degrees 0 to `top` beyond the ends, by the downward recurrence from two arbitrary values
  !> (Miller).
  pure function downward(x, top) result(q)
    real(wp), intent(in) :: x(:)
    integer, intent(in) :: top
    real(wp) :: q(size(x), 0:top)
    real(wp), dimension(size(x)) :: higher, now, lower
    integer :: l

    higher = 0
    now = sqrt(tiny(1.0_wp))
    if (size(x) == 0) return
    do l = top + ceiling(-log(nothing)/(2*log(ellipse(minval(abs(x)))))), 1, -1
      lower = ((2*l + 1)*x*now - (l + 1)*higher)/l
      if (l <= top + 1) q(:, l - 1) = lower
      higher = now
      now = lower
    end do
    do l = top, 0, -1
      q(:, l) = q(:, l)*(lowest(x)/q(:, 0))
    end do
  end function downward

  elemental real(wp) function lowest(x)
    real(wp), intent(in) :: x

    lowest = 0.5_wp*log(abs((1 + x)/(1 - x)))
  end function lowest

  elemental real(wp) function x_log_x(x)
    real(wp), intent(in) :: x

    x_log_x = x*log(max(abs(x), tiny(x)))
  end function x_log_x

  !> Sum of the half axes of the ellipse with foci -1 and 1 through x; 1 between the foci.
  elemental real(wp) function ellipse(x)
    real(wp), intent(in) :: x

    ellipse = x + sqrt(max(x**2 - 1, 0.0_wp))
    if (x < 1) ellipse = 1
  end function ellipse

end module logarithm_defect
