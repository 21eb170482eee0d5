!> LU factors, with partial pivoting, of matrices with tens to a few hundred rows, for which
!> LAPACK's bookkeeping takes as long as its arithmetic. The factors have the form of DGETRF.
module small_lu
  use kinds, only: wp
  use lapack, only: idamax, dgemm
  implicit none
  private
  public :: lu_factorise, lu_solve, most_rows

  !> The largest number of rows for which this is faster than LAPACK.
  integer, parameter :: most_rows = 320
  !> Number of columns that are eliminated before one product updates the rest; number of columns
  !> that are substituted at a time.
  integer, parameter :: panel = 8, group = 4

contains

  !> Overwrites a square matrix with its factors. pivot(k): the row that row k was exchanged with.
  !> regular = .false. if a pivot has no inverse; the factors are then undefined.
  subroutine lu_factorise(n, a, pivot, regular)
    integer, intent(in) :: n
    real(wp), intent(inout) :: a(n, n)
    integer, intent(out) :: pivot(n)
    logical, intent(out) :: regular
    real(wp) :: row(n), lower(panel, panel), upper(panel)
    integer :: first, last, j, k

    regular = .true.
    do first = 1, n, panel
      last = min(first + panel - 1, n)
      do k = first, last
        pivot(k) = k - 1 + idamax(n - k + 1, a(k, k), 1)
        if (pivot(k) /= k) then
          row = a(k, :)
          a(k, :) = a(pivot(k), :)
          a(pivot(k), :) = row
        end if
        regular = abs(a(k, k)) > tiny(1.0_wp)
        if (.not. regular) return
        a(k + 1:, k) = a(k + 1:, k)*(1/a(k, k))
        do j = k + 1, last
          a(k + 1:, j) = a(k + 1:, j) - a(k, j)*a(k + 1:, k)
        end do
      end do
      if (last == n) return
      ! With a full square, zeros included, the compiler needs no loops.
      lower = 0
      do k = 1, panel - 1
        lower(k + 1:, k) = a(first + k:last, first + k - 1)
      end do
      do j = last + 1, n
        upper = a(first:last, j)
        do k = 1, panel - 1
          upper = upper - upper(k)*lower(:, k)
        end do
        a(first:last, j) = upper
      end do
      call dgemm('n', 'n', n - last, n - last, panel, -1.0_wp, a(last + 1, first), n, &
        a(first, last + 1), n, 1.0_wp, a(last + 1, last + 1), n)
    end do
  end subroutine lu_factorise

  !> Overwrites b with the solution for the factors of a matrix.
  pure subroutine lu_solve(n, lu, pivot, b)
    integer, intent(in) :: n, pivot(n)
    real(wp), intent(in) :: lu(n, n)
    real(wp), intent(inout) :: b(n)
    real(wp) :: x(group)
    integer :: j

    do j = 1, n
      x(1) = b(pivot(j))
      b(pivot(j)) = b(j)
      b(j) = x(1)
    end do
    do j = 1, n - group + 1, group
      x(1) = b(j)
      x(2) = b(j + 1) - x(1)*lu(j + 1, j)
      x(3) = b(j + 2) - x(1)*lu(j + 2, j) - x(2)*lu(j + 2, j + 1)
      x(4) = b(j + 3) - x(1)*lu(j + 3, j) - x(2)*lu(j + 3, j + 1) - x(3)*lu(j + 3, j + 2)
      b(j:j + 3) = x
      b(j + 4:) = b(j + 4:) - x(1)*lu(j + 4:, j) - x(2)*lu(j + 4:, j + 1) - &
        x(3)*lu(j + 4:, j + 2) - x(4)*lu(j + 4:, j + 3)
    end do
    do j = n - mod(n, group) + 1, n - 1
      b(j + 1:) = b(j + 1:) - b(j)*lu(j + 1:, j)
    end do
    do j = n - group + 1, 1, -group
      x(4) = b(j + 3)/lu(j + 3, j + 3)
      x(3) = (b(j + 2) - x(4)*lu(j + 2, j + 3))/lu(j + 2, j + 2)
      x(2) = (b(j + 1) - x(4)*lu(j + 1, j + 3) - x(3)*lu(j + 1, j + 2))/lu(j + 1, j + 1)
      x(1) = (b(j) - x(4)*lu(j, j + 3) - x(3)*lu(j, j + 2) - x(2)*lu(j, j + 1))/lu(j, j)
      b(j:j + 3) = x
      b(:j - 1) = b(:j - 1) - x(1)*lu(:j - 1, j) - x(2)*lu(:j - 1, j + 1) - &
        x(3)*lu(:j - 1, j + 2) - x(4)*lu(:j - 1, j + 3)
    end do
    do j = mod(n, group), 1, -1
      b(j) = b(j)/lu(j, j)
      b(:j - 1) = b(:j - 1) - b(j)*lu(:j - 1, j)
    end do
  end subroutine lu_solve

end module small_lu
