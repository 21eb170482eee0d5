!> The noise of the values in a table. Values of a smooth curve follow a polynomial over a few
!> points, so that their differences of high order nearly vanish; the differences of noise do not.
module table_noise
  use kinds, only: wp
  implicit none
  private
  public :: noise_of, noise_of_integral

  !> Number of points in a difference, which is of eighth order. Number of neighbouring differences
  !> on either side over which the noise at a point is averaged, since a single difference may be
  !> small by chance.
  integer, parameter :: points = 9, beside = 2

contains

  !> The standard deviation of values at ascending places. It includes deviations from a polynomial
  !> over `points` points. It is 0 if there are fewer points.
  pure function noise_of(place, value) result(noise)
    real(wp), intent(in) :: place(:), value(:)
    real(wp) :: noise(size(place)), weight(points), square(size(place))
    integer :: n, i, j, k

    n = size(place) - points + 1
    noise = 0
    if (n < 1) return
    do k = 1, n
      associate (at => place(k:k + points - 1))
        do j = 1, points
          weight(j) = 1/product(pack((at(j) - at)/(at(points) - at(1)), [(i /= j, i=1, points)]))
        end do
      end associate
      square(k) = dot_product(weight, value(k:k + points - 1))**2/dot_product(weight, weight)
    end do
    do i = 1, size(place)
      ! The differences whose centre is near the point.
      k = min(n, max(1, i - points/2))
      associate (first => max(1, k - beside), last => min(n, k + beside))
        noise(i) = sqrt(sum(square(first:last))/(last - first + 1))
      end associate
    end do
  end function noise_of

  !> The standard deviation of the integral of values from each place to the last one, to which
  !> `beyond` times the last value is added. The noise of different points is independent.
  pure function noise_of_integral(place, noise, beyond) result(deviation)
    real(wp), intent(in) :: place(:), noise(:), beyond
    real(wp) :: deviation(size(place)), weight(size(place))
    integer :: n, i

    n = size(place)
    weight = 0
    weight(:n - 1) = (place(2:) - place(:n - 1))/2
    weight(2:) = weight(2:) + (place(2:) - place(:n - 1))/2
    weight(n) = weight(n) + beyond
    do i = 1, n
      deviation(i) = norm2(weight(i:)*noise(i:))
    end do
  end function noise_of_integral

end module table_noise
