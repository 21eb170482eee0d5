!> Piecewise cubic polynomials through points.
module cubic
  use kinds, only: wp
  use linear_algebra, only: solve_tridiagonal
  implicit none
  private
  public :: spline, monotone

contains

  !> The spline with continuous curvature through (x, y), x ascending, at least four points. Each
  !> column holds the coefficients of 1, t, t^2, t^3 in one piece, where t is the distance from its
  !> left end. The slope is 0 at the right end; at the left end the first two pieces are one cubic.
  function spline(x, y) result(coefficient)
    real(wp), intent(in) :: x(:), y(:)
    real(wp) :: coefficient(0:3, size(x) - 1), width(size(x) - 1), chord(size(x) - 1)
    real(wp) :: below(size(x) - 1), middle(size(x)), above(size(x) - 1), slope(size(x))
    integer :: n, i

    n = size(x)
    width = x(2:) - x(:n - 1)
    chord = (y(2:) - y(:n - 1))/width
    middle(1) = width(2)
    above(1) = width(1) + width(2)
    slope(1) = ((3*width(1) + 2*width(2))*width(2)*chord(1) + width(1)**2*chord(2))/above(1)
    do i = 2, n - 1
      below(i - 1) = width(i)
      middle(i) = 2*(width(i - 1) + width(i))
      above(i) = width(i - 1)
      slope(i) = 3*(width(i)*chord(i - 1) + width(i - 1)*chord(i))
    end do
    below(n - 1) = 0
    middle(n) = 1
    slope(n) = 0
    call solve_tridiagonal(below, middle, above, slope)
    coefficient = with_slopes(y, slope, width)
  end function spline

  !> The same for slopes that make no extremum between points (Fritsch and Butland, SIAM J. Sci.
  !> Stat. Comput. 5, 300, 1984).
  pure function monotone(x, y) result(coefficient)
    real(wp), intent(in) :: x(:), y(:)
    real(wp) :: coefficient(0:3, size(x) - 1)
    real(wp) :: width(size(x) - 1), chord(size(x) - 1), slope(size(x)), before, after
    integer :: n, i

    n = size(x)
    width = x(2:) - x(:n - 1)
    chord = (y(2:) - y(:n - 1))/width
    slope = 0
    do i = 2, n - 1
      if (.not. chord(i - 1)*chord(i) > 0) cycle
      before = 2*width(i) + width(i - 1)
      after = width(i) + 2*width(i - 1)
      slope(i) = (before + after)/(before/chord(i - 1) + after/chord(i))
    end do
    slope(1) = chord(1) + (chord(1) - slope(2))/2
    if (.not. slope(1)*chord(1) > 0) slope(1) = 0
    if (abs(slope(1)) > 3*abs(chord(1))) slope(1) = 3*chord(1)
    coefficient = with_slopes(y, slope, width)
  end function monotone

  !> The cubics of given values and slopes at the points.
  pure function with_slopes(y, slope, width) result(coefficient)
    real(wp), intent(in) :: y(:), slope(:), width(:)
    real(wp) :: coefficient(0:3, size(width)), chord(size(width))
    integer :: n

    n = size(y)
    chord = (y(2:) - y(:n - 1))/width
    coefficient(0, :) = y(:n - 1)
    coefficient(1, :) = slope(:n - 1)
    coefficient(2, :) = (3*chord - 2*slope(:n - 1) - slope(2:))/width
    coefficient(3, :) = (slope(:n - 1) + slope(2:) - 2*chord)/width**2
  end function with_slopes

end module cubic
