!> The polynomial through a few scattered values: weights, value, slope, maximum; and Hermite's
!> polynomial, which has given slopes there too.
module interpolation
  use kinds, only: wp
  use root_finding, only: bracket_t
  implicit none
  private
  public :: polynomial_weights, polynomial_slope, interpolated_maximum, interval_of
  public :: hermite_t, hermite_through, hermite_weights, most_hermite_nodes, find_nodes_about

  integer, parameter :: most_hermite_nodes = 4

  !> The polynomial of least degree with given values and slopes, in Newton's form: nodes, each
  !> twice, and divided differences.
  type :: hermite_t
    integer, private :: terms = 0
    real(wp), private :: node(2*most_hermite_nodes) = 0, difference(2*most_hermite_nodes) = 0
  contains
    procedure :: value => hermite_value
    procedure :: slope => hermite_slope
    procedure :: evaluate => hermite_evaluate
  end type hermite_t

contains

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

  !> The polynomial through (at, value) at x.
  pure real(wp) function polynomial_value(at, value, x)
    real(wp), intent(in) :: at(:), value(:), x

    polynomial_value = dot_product(polynomial_weights(at, x), value)
  end function polynomial_value

  !> Its derivative at x.
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

  !> The abscissa in [low, high] at which the polynomial through (at, value) is largest, by golden
  !> section.
  pure real(wp) function interpolated_maximum(at, value, low, high) result(x)
    real(wp), intent(in) :: at(:), value(:), low, high
    type(bracket_t) :: bracket
    integer :: step

    bracket = bracket_t(low, high)
    do step = 1, 60
      associate (points => bracket%golden_points())
        call bracket%keep_larger([polynomial_value(at, value, points(1)), &
          polynomial_value(at, value, points(2))])
      end associate
    end do
    x = bracket%middle()
  end function interpolated_maximum

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

    !> The first two nodes from node j to one side, each well apart from the one before it.
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

end module interpolation
