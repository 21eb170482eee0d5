!> Straight lines, and parabolas, through samples by least squares.
module sample_lines
  use kinds, only: wp
  implicit none
  private
  public :: sample_line_t, line_through, off_line

  !> A straight line. middle: the means of the positions and of the signals of its samples. squares:
  !> the sum of the squared distances of the positions from their mean.
  type :: sample_line_t
    real(wp) :: middle(2) = 0, squares = 0, slope = 0
  contains
    procedure :: off
  end type sample_line_t

contains

  !> The line through the samples in `mask`. It has no slope if all of them have one position.
  pure type(sample_line_t) function line_through(z, signal, mask) result(line)
    real(wp), intent(in) :: z(:), signal(:)
    logical, intent(in) :: mask(:)

    line%middle = [sum(z, mask), sum(signal, mask)]/max(1, count(mask))
    associate (middle => line%middle)
      line%squares = max(sum((z - middle(1))**2, mask), tiny(1.0_wp))
      line%slope = sum((z - middle(1))*(signal - middle(2)), mask)/line%squares
    end associate
  end function line_through

  !> The distance of a signal at a position from the line.
  elemental real(wp) function off(self, z, signal)
    class(sample_line_t), intent(in) :: self
    real(wp), intent(in) :: z, signal

    off = signal - self%middle(2) - self%slope*(z - self%middle(1))
  end function off

  !> The samples in `mask` minus the polynomial of degree 1 or 2 through them.
  pure function off_line(z, signal, mask, degree) result(r)
    real(wp), intent(in) :: z(:), signal(:)
    logical, intent(in) :: mask(:)
    integer, intent(in) :: degree
    real(wp) :: r(size(z)), x(size(z)), power(size(z))

    x = (z - sum(z, mask)/max(1, count(mask)))
    x = x/max(maxval(abs(x), mask), tiny(1.0_wp))
    r = signal - sum(signal, mask)/max(1, count(mask))
    r = r - x*sum(x*r, mask)/max(sum(x**2, mask), tiny(1.0_wp))
    if (degree < 2) return
    power = x**2 - sum(x**2, mask)/count(mask)
    power = power - x*sum(x*power, mask)/max(sum(x**2, mask), tiny(1.0_wp))
    r = r - power*sum(power*r, mask)/max(sum(power**2, mask), tiny(1.0_wp))
  end function off_line

end module sample_lines
