!> The polynomial through a few scattered values: weights, value, slope, maximum; and the one that
!> has given slopes there too.
module interpolation
  use kinds, only: wp
  use root_finding, only: bracket_t
  implicit none
  private
  public :: polynomial_weights, polynomial_value, polynomial_slope, interpolated_maximum
  public :: hermite_weights, hermite_value, hermite_slope
  public :: hermite_t, new_hermite

  !> Polynomials that have given values and slopes at the same places, in Newton's form, each place
  !> counted twice.
  type :: hermite_t
    private
    real(wp), allocatable :: at(:), coefficient(:, :)
  contains
    procedure :: evaluate
    procedure :: evaluate_first
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

  !> Where in [low, high] the polynomial through (at, value) is largest, by golden section.
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

  !> Weights of values and of slopes at `at` (all different) in the polynomial of least degree that
  !> has them, at x: it is the sum of [v (1 - 2 l'(x_j) (x - x_j)) + s (x - x_j)] l(x)^2 over
  !> Lagrange's l.
  pure subroutine hermite_weights(at, x, of_value, of_slope)
    real(wp), intent(in) :: at(:), x
    real(wp), intent(out) :: of_value(:), of_slope(:)
    real(wp) :: squares(size(at))

    squares = polynomial_weights(at, x)**2
    of_slope = (x - at)*squares
    of_value = squares - 2*own_slopes(at)*of_slope
  end subroutine hermite_weights

  !> That polynomial at x.
  pure real(wp) function hermite_value(at, value, slope, x) result(y)
    real(wp), intent(in) :: at(:), value(:), slope(:), x
    real(wp), dimension(size(at)) :: of_value, of_slope

    call hermite_weights(at, x, of_value, of_slope)
    y = sum(of_value*value + of_slope*slope)
  end function hermite_value

  !> Its derivative at x.
  pure real(wp) function hermite_slope(at, value, slope, x) result(y)
    real(wp), intent(in) :: at(:), value(:), slope(:), x
    real(wp), dimension(size(at)) :: basis, basis_slope, steepness, one
    integer :: j

    basis = polynomial_weights(at, x)
    do j = 1, size(at)
      one = 0
      one(j) = 1
      basis_slope(j) = polynomial_slope(at, one, x)
    end do
    steepness = slope - 2*own_slopes(at)*value
    y = sum(steepness*basis**2 + 2*(value + steepness*(x - at))*basis*basis_slope)
  end function hermite_slope

  !> Polynomials with the values and slopes (how many, size(at)) at `at`, all different.
  pure function new_hermite(at, values, slopes) result(curve)
    real(wp), intent(in) :: at(:), values(:, :), slopes(:, :)
    type(hermite_t) :: curve
    integer :: j, order, n

    n = 2*size(at)
    allocate (curve%at(n), curve%coefficient(size(values, 1), n))
    curve%at = [(at((j + 1)/2), j=1, n)]
    do j = 1, n
      curve%coefficient(:, j) = values(:, (j + 1)/2)
    end do
    do order = 1, n - 1
      do j = n, order + 1, -1
        if (order == 1 .and. mod(j, 2) == 0) then
          curve%coefficient(:, j) = slopes(:, j/2)
        else
          curve%coefficient(:, j) = (curve%coefficient(:, j) - curve%coefficient(:, j - 1))/ &
            (curve%at(j) - curve%at(j - order))
        end if
      end do
    end do
  end function new_hermite

  !> All of them at x.
  pure subroutine evaluate(self, x, values)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    real(wp), intent(out) :: values(:)
    integer :: j

    values = self%coefficient(:, size(self%at))
    do j = size(self%at) - 1, 1, -1
      values = self%coefficient(:, j) + (x - self%at(j))*values
    end do
  end subroutine evaluate

  !> The first of them at x, and its slope.
  pure subroutine evaluate_first(self, x, value, slope)
    class(hermite_t), intent(in) :: self
    real(wp), intent(in) :: x
    real(wp), intent(out) :: value, slope
    integer :: j

    value = self%coefficient(1, size(self%at))
    slope = 0
    do j = size(self%at) - 1, 1, -1
      slope = value + (x - self%at(j))*slope
      value = self%coefficient(1, j) + (x - self%at(j))*value
    end do
  end subroutine evaluate_first

  !> The slope of each Lagrange polynomial where it is one.
  pure function own_slopes(at) result(slope)
    real(wp), intent(in) :: at(:)
    real(wp) :: slope(size(at))
    integer :: j

    do j = 1, size(at)
      slope(j) = sum(1/pack(at(j) - at, abs(at(j) - at) > 0))
    end do
  end function own_slopes

end module interpolation
