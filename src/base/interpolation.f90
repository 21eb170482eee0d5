!> Interpolation in one variable: the polynomial through a few scattered values; Hermite's
!> polynomial, which has given values and slopes; piecewise cubic polynomials through many points.
!> The module also has a smooth transition from 1 to 0.
module interpolation
  use kinds, only: wp
  use linear_algebra, only: solve_tridiagonal
  implicit none
  private
  public :: polynomial_weights, polynomial_slope, interval_of, hermite_t, &
    hermite_through, hermite_weights, most_hermite_nodes, find_nodes_about, spline, monotone, fading

  integer, parameter :: most_hermite_nodes = 4

  !> The polynomial of least degree with given values and slopes, in Newton's form: nodes, each
  !> twice, and divided differences.
  type :: hermite_t
    integer, private :: terms = 0
    real(wp), private :: node(2*most_hermite_nodes) = 0, difference(2*most_hermite_nodes) = 0
  contains
    procedure :: value => hermite_value
    procedure :: slope => hermite_slope
    procedure :: curvature => hermite_curvature
    procedure :: evaluate => hermite_evaluate
  end type hermite_t

contains

  !> The cubic transition from 1 for x <= 0 to 0 for x >= 1.
  elemental real(wp) function fading(x)
    real(wp), intent(in) :: x
    real(wp) :: left

    left = 1 - max(0.0_wp, min(1.0_wp, x))
    fading = left**2*(3 - 2*left)
  end function fading

  !> Weights of the values at `at` (all different) in their polynomial's value at x.
  pure function polynomial_weights(at, x) result(weight)
    real(wp), intent(in) :: at(:), x
    real(wp) :: weight(size(at))
    integer :: j, k

    weight = 1
    do j = 1, size(at)
      do k = 1, size(at)
        if (k /= j) weight(j) = weight(j)*(x - at(k))/(at(j) - at(k))
      end do
    end do
  end function polynomial_weights

  !> The last index i of the ascending x with x(i) <= at, by bisection; 1 if there is none.
  pure integer function interval_of(x, at) result(low)
    real(wp), intent(in) :: x(:), at
    integer :: high, middle

    low = 1
    high = size(x) + 1
    do while (high - low > 1)
      middle = (low + high)/2
      if (x(middle) <= at) then
        low = middle
      else
        high = middle
      end if
    end do
  end function interval_of

  !> The derivative at x of the polynomial through (at, value).
  pure real(wp) function polynomial_slope(at, value, x) result(slope)
    real(wp), intent(in) :: at(:), value(:), x
    real(wp) :: term
    integer :: j, k, m

    slope = 0
    do j = 1, size(at)
      do m = 1, size(at)
        if (m == j) cycle
        term = value(j)/(at(j) - at(m))
        do k = 1, size(at)
          if (k /= j .and. k /= m) term = term*(x - at(k))/(at(j) - at(k))
        end do
        slope = slope + term
      end do
    end do
  end function polynomial_slope

  !> Weights of values v and slopes s at `at` (all different) in Hermite's polynomial at x. It is
  !> the sum of [v (1 - 2 l'(x_j) (x - x_j)) + s (x - x_j)] l(x)^2 with Lagrange's polynomials l.
  pure subroutine hermite_weights(at, x, of_value, of_slope)
    real(wp), intent(in) :: at(:), x
    real(wp), intent(out) :: of_value(:), of_slope(:)
    real(wp) :: weight, own_slope
    integer :: j, k

    do j = 1, size(at)
      weight = 1
      own_slope = 0
      do k = 1, size(at)
        if (k == j) cycle
        weight = weight*(x - at(k))/(at(j) - at(k))
        own_slope = own_slope + 1/(at(j) - at(k))
      end do
      of_slope(j) = (x - at(j))*weight**2
      of_value(j) = weight**2 - 2*own_slope*of_slope(j)
    end do
  end subroutine hermite_weights

  !> The nodes (rising) for the polynomial on the interval from x(i) to x(i + 1): the two ends and
  !> one node on either side, or two on one side if the other has none. Nodes that are too near to
  !> each other are left out, because they make the polynomial worse.
  pure subroutine find_nodes_about(x, i, nodes, n)
    real(wp), intent(in) :: x(:)
    integer, intent(in) :: i
    integer, intent(out) :: nodes(most_hermite_nodes), n
    integer, dimension(2) :: before, after
    integer :: n_before, n_after

    call find_apart(i, -1, before, n_before)
    call find_apart(i + 1, 1, after, n_after)
    if (n_after > 0) n_before = min(1, n_before)
    if (n_before > 0) n_after = min(1, n_after)
    n = n_before + 2 + n_after
    nodes(:n_before) = before(n_before:1:-1)
    nodes(n_before + 1:n_before + 2) = [i, i + 1]
    nodes(n_before + 3:n) = after(:n_after)

  contains

    !> The first two nodes on one side of node j, each well apart from the one before it.
    pure subroutine find_apart(j, side, found, count)
      integer, intent(in) :: j, side
      integer, intent(out) :: found(2), count
      real(wp), parameter :: well_apart = 0.1_wp
      integer :: k, newest

      count = 0
      newest = j
      k = j + side
      do while (k >= 1 .and. k <= size(x) .and. count < 2)
        if (.not. abs(x(k) - x(newest)) < well_apart*(x(i + 1) - x(i))) then
          count = count + 1
          found(count) = k
          newest = k
        end if
        k = k + side
      end do
    end subroutine find_apart

  end subroutine find_nodes_about

  !> Hermite's polynomial with the given values and slopes at `at` (all different).
  pure type(hermite_t) function hermite_through(at, value, slope) result(polynomial)
    real(wp), intent(in) :: at(:), value(:), slope(:)
    integer :: j, k, n

    n = 2*size(at)
    polynomial%terms = n
    associate (x => polynomial%node, c => polynomial%difference)
      x(1:n:2) = at
      x(2:n:2) = at
      c(1:n:2) = value
      c(2:n:2) = slope
      c(3:n:2) = (value(2:) - value(:size(at) - 1))/(at(2:) - at(:size(at) - 1))
      do k = 2, n - 1
        do j = n, k + 1, -1
          c(j) = (c(j) - c(j - 1))/(x(j) - x(j - k))
        end do
      end do
      c(1) = value(1)
    end associate
  end function hermite_through

  !> The polynomial at x.
  pure real(wp) function hermite_value(self, x) result(y)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    integer :: k

    y = 0
    do k = self%terms, 1, -1
      y = self%difference(k) + (x - self%node(k))*y
    end do
  end function hermite_value

  !> Value and derivative at x.
  pure subroutine hermite_evaluate(self, x, y, slope)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    real(wp), intent(out) :: y, slope
    integer :: k

    y = 0
    slope = 0
    do k = self%terms, 1, -1
      slope = y + (x - self%node(k))*slope
      y = self%difference(k) + (x - self%node(k))*y
    end do
  end subroutine hermite_evaluate

  !> The derivative at x.
  pure real(wp) function hermite_slope(self, x) result(slope)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    real(wp) :: y

    call self%evaluate(x, y, slope)
  end function hermite_slope

  !> The second derivative at x.
  pure real(wp) function hermite_curvature(self, x) result(curvature)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    real(wp) :: y, slope
    integer :: k

    y = 0
    slope = 0
    curvature = 0
    do k = self%terms, 1, -1
      curvature = 2*slope + (x - self%node(k))*curvature
      slope = y + (x - self%node(k))*slope
      y = self%difference(k) + (x - self%node(k))*y
    end do
  end function hermite_curvature

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

  !> The piecewise cubic with slopes that make no extremum between points (Fritsch and Butland, SIAM
  !> J. Sci. Stat. Comput. 5, 300, 1984).
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

end module interpolation
