!> LU factors, with partial pivoting, in single precision. Iterations and iterative refinement
!> correct the errors of such factors. From a hundred rows on the factorisation takes a third to a
!> half less time than in double precision. It is done here for matrices with up to a few hundred
!> rows, for which LAPACK's bookkeeping takes as long as its arithmetic.
module single_precision_lu
  use kinds, only: wp, sp
  use lapack, only: sgetrf, sgetrs
  implicit none
  private
  public :: single_precision_lu_t

  !> The largest number of rows for which this is faster than LAPACK.
  integer, parameter :: most_rows = 320
  !> Number of columns that are eliminated together. Matrices are filled up with rows and columns of
  !> the unit matrix to a multiple of this number, so that loops are over whole vectors.
  integer, parameter :: panel = 8

  !> The factors of a matrix: lu and pivot have the form of SGETRF. lower, upper: the inverses of
  !> the triangles of each square of `panel` rows on the diagonal.
  type :: single_precision_lu_t
    private
    real(sp), allocatable :: lu(:, :), lower(:, :, :), upper(:, :, :)
    integer, allocatable :: pivot(:)
  contains
    procedure :: factorise
    procedure :: solve
  end type single_precision_lu_t

contains

  !> Makes the factors of a square matrix. regular = .false. if a pivot has no inverse in single
  !> precision, or elements are too large for it; the factors are then undefined.
  subroutine factorise(self, matrix, regular)
    class(single_precision_lu_t), intent(inout) :: self
    real(wp), intent(in) :: matrix(:, :)
    logical, intent(out) :: regular
    integer :: rows, j, info

    associate (n => size(matrix, 1))
      rows = panel*((n + panel - 1)/panel)
      if (allocated(self%lu)) then
        if (size(self%lu, 1) /= rows) deallocate (self%lu, self%lower, self%upper, self%pivot)
      end if
      if (.not. allocated(self%lu)) allocate (self%lu(rows, rows), self%pivot(rows), &
        self%lower(panel, panel, rows/panel), self%upper(panel, panel, rows/panel))
      do j = 1, n
        self%lu(:n, j) = real(matrix(:, j), sp)
        self%lu(n + 1:, j) = 0
      end do
      do j = n + 1, rows
        self%lu(:, j) = 0
        self%lu(j, j) = 1
      end do
      if (n > most_rows) then
        call sgetrf(rows, rows, self%lu, rows, self%pivot, info)
        regular = info == 0 .and. all([(abs(self%lu(j, j)) <= huge(1.0_sp), j=1, n)])
      else
        call eliminate(rows, self%lu, self%lower, self%upper, self%pivot, regular)
      end if
    end associate
  end subroutine factorise

  !> Overwrites a matrix, whose number of rows is a multiple of `panel`, with its factors.
  subroutine eliminate(n, a, lower, upper, pivot, regular)
    integer, intent(in) :: n
    real(sp), intent(inout) :: a(n, n)
    real(sp), intent(out) :: lower(panel, panel, n/panel), upper(panel, panel, n/panel)
    integer, intent(out) :: pivot(n)
    logical, intent(out) :: regular
    real(sp) :: column(n), square(panel, panel), right(panel, n), most
    integer :: first, last, j, k

    regular = .true.
    do first = 1, n, panel
      last = first + panel - 1
      do k = first, last
        most = largest(n - k + 1, a(k, k))
        regular = most > tiny(most) .and. most <= huge(most)
        if (.not. regular) return
        pivot(k) = k
        if (abs(a(k, k)) < most) then
          pivot(k) = k - 1 + maxloc(abs(a(k:, k)), 1)
          column = a(k, :)
          a(k, :) = a(pivot(k), :)
          a(pivot(k), :) = column
        end if
        column(first:) = a(first:, k)*(1/a(k, k))
        column(first:k) = 0
        a(k + 1:, k) = column(k + 1:)
        do j = k + 1, last
          a(first:, j) = a(first:, j) - a(k, j)*column(first:)
        end do
      end do
      square = a(first:last, first:last)
      upper(:, :, last/panel) = inverse(square(panel:1:-1, panel:1:-1))
      upper(:, :, last/panel) = upper(panel:1:-1, panel:1:-1, last/panel)
      do k = 1, panel
        square(k, k) = 1
      end do
      lower(:, :, last/panel) = inverse(square)
      if (last == n) return
      do j = last + 1, n
        call multiply(lower(:, :, last/panel), a(first, j), right(:, j))
      end do
      call subtract(n - last, n - last, n, a(last + 1, first), right(:, last + 1:), &
        a(last + 1, last + 1))
    end do
  end subroutine eliminate

  !> The largest absolute value; compilers make no vector instructions of MAXVAL.
  pure real(sp) function largest(n, x)
    integer, intent(in) :: n
    real(sp), intent(in) :: x(n)
    integer :: i

    largest = 0
    do i = 1, n
      largest = max(largest, abs(x(i)))
    end do
  end function largest

  !> The inverse of the lower triangle of a square.
  pure function inverse(square) result(x)
    real(sp), intent(in) :: square(panel, panel)
    real(sp) :: x(panel, panel), below(panel), row(panel)
    integer :: k, j

    x = 0
    do k = 1, panel
      x(k, k) = 1
      row = x(k, :)/square(k, k)
      below = square(:, k)
      below(:k) = 0
      do j = 1, k
        x(:, j) = x(:, j) - row(j)*below
        x(k, j) = row(j)
      end do
    end do
  end function inverse

  !> y = m x, and overwrites x with it.
  pure subroutine multiply(m, x, y)
    real(sp), intent(in) :: m(panel, panel)
    real(sp), intent(inout) :: x(panel)
    real(sp), intent(out) :: y(panel)
    integer :: i

    do i = 1, panel
      y(i) = m(i, 1)*x(1) + m(i, 2)*x(2) + m(i, 3)*x(3) + m(i, 4)*x(4) + m(i, 5)*x(5) + &
        m(i, 6)*x(6) + m(i, 7)*x(7) + m(i, 8)*x(8)
    end do
    x = y
  end subroutine multiply

  !> Subtracts m x from y; n: number of rows of the matrix that contains m, and of that of y.
  pure subroutine subtract(rows, columns, n, m, x, y)
    integer, intent(in) :: rows, columns, n
    real(sp), intent(in) :: m(n, panel), x(panel, columns)
    real(sp), intent(inout) :: y(n, *)
    integer :: i, j

    do j = 1, columns
      do i = 1, rows
        y(i, j) = y(i, j) - m(i, 1)*x(1, j) - m(i, 2)*x(2, j) - m(i, 3)*x(3, j) - &
          m(i, 4)*x(4, j) - m(i, 5)*x(5, j) - m(i, 6)*x(6, j) - m(i, 7)*x(7, j) - m(i, 8)*x(8, j)
      end do
    end do
  end subroutine subtract

  !> Overwrites b with the solution. Its number of accurate digits is that of single precision, less
  !> the decimal logarithm of the matrix's condition number.
  subroutine solve(self, b)
    class(single_precision_lu_t), intent(in) :: self
    real(wp), intent(inout) :: b(:)
    real(sp) :: x(size(self%lu, 1)), y(panel)
    real(wp) :: unit
    integer :: n, first, k, info

    ! The elements of b / unit neither overflow nor vanish.
    unit = maxval(abs(b))
    if (.not. unit > tiny(unit)) return
    n = size(x)
    x(:size(b)) = real(b*(1/unit), sp)
    x(size(b) + 1:) = 0
    if (size(b) > most_rows) then
      call sgetrs('n', n, 1, self%lu, n, self%pivot, x, n, info)
    else
      do k = 1, n
        if (self%pivot(k) /= k) x([k, self%pivot(k)]) = x([self%pivot(k), k])
      end do
      do first = 1, n, panel
        associate (next => first + panel, square => (first + panel - 1)/panel)
          call multiply(self%lower(:, :, square), x(first), y)
          if (next < n) call subtract(n + 1 - next, 1, n, self%lu(next, first), y, x(next))
        end associate
      end do
      do first = n + 1 - panel, 1, -panel
        call multiply(self%upper(:, :, (first + panel - 1)/panel), x(first), y)
        call subtract(first - 1, 1, n, self%lu(1, first), y, x)
      end do
    end if
    b = unit*x(:size(b))
  end subroutine solve

end module single_precision_lu
