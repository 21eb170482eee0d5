!> Thin wrappers over the products of BLAS.
module matrix_products
  use kinds, only: wp
  use lapack, only: dgemv, dgemm
  implicit none
  private
  public :: multiply, multiply_left, multiply_transposed, add_by_transposed

contains

  !> y = a(:size(y), :columns) x(:columns).
  pure subroutine multiply(a, columns, x, y)
    real(wp), intent(in), contiguous :: a(:, :)
    integer, intent(in) :: columns
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: y(:)

    if (columns > 0) then
      call dgemv('n', size(y), columns, 1.0_wp, a, size(a, 1), x, 1, 0.0_wp, y, 1)
    else
      y = 0
    end if
  end subroutine multiply

  !> y = x a(:size(x), :size(y)).
  pure subroutine multiply_left(x, a, y)
    real(wp), intent(in), contiguous :: a(:, :)
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: y(:)

    if (size(x) > 0) then
      call dgemv('t', size(x), size(y), 1.0_wp, a, size(a, 1), x, 1, 0.0_wp, y, 1)
    else
      ! Without rows DGEMV would leave y as it is.
      y = 0
    end if
  end subroutine multiply_left

  !> c = matmul(transpose(a), b).
  subroutine multiply_transposed(a, b, c)
    real(wp), intent(in), contiguous :: a(:, :), b(:, :)
    real(wp), intent(out) :: c(:, :)

    call dgemm('t', 'n', size(a, 2), size(b, 2), size(a, 1), 1.0_wp, a, size(a, 1), b, size(b, 1), &
      0.0_wp, c, size(c, 1))
  end subroutine multiply_transposed

  !> Adds matmul(a, transpose(b)) to the first rows of c.
  subroutine add_by_transposed(a, b, c)
    real(wp), intent(in), contiguous :: a(:, :), b(:, :)
    real(wp), intent(inout), contiguous :: c(:, :)

    call dgemm('n', 't', size(a, 1), size(b, 1), size(a, 2), 1.0_wp, a, size(a, 1), b, size(b, 1), &
      1.0_wp, c, size(c, 1))
  end subroutine add_by_transposed

end module matrix_products
