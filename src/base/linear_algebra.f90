!> Thin wrappers over BLAS and LAPACK.
module linear_algebra
  use kinds, only: wp
  implicit none
  private
  public :: multiply, factorisation_t, factorise, solve, determinant_sign, &
    log_determinant, claim_buffers, eigenvalues, positive_definite, positive_eigenvalues, &
    solve_tridiagonal

  !> LU factors of a square matrix, from `factorise`.
  type :: factorisation_t
    real(wp), allocatable :: lu(:, :)
    integer, allocatable :: pivot(:)
    !> .false. where no factors are held or the matrix was singular.
    logical :: valid = .false.
  end type factorisation_t

  interface
    subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: m, n, lda, incx, incy
      real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
      real(wp), intent(inout) :: y(*)
    end subroutine dgemv
    subroutine dgetrf(m, n, a, lda, ipiv, info)
      import :: wp
      integer, intent(in) :: m, n, lda
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine dgetrf
    subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
      real(wp), intent(in) :: a(lda, *)
      real(wp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine dgetrs
    subroutine dgtsv(n, nrhs, dl, d, du, b, ldb, info)
      import :: wp
      integer, intent(in) :: n, nrhs, ldb
      real(wp), intent(inout) :: dl(*), d(*), du(*), b(ldb, *)
      integer, intent(out) :: info
    end subroutine dgtsv
    subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
      import :: wp
      character, intent(in) :: jobvl, jobvr
      integer, intent(in) :: n, lda, ldvl, ldvr, lwork
      real(wp), intent(inout) :: a(lda, *)
      real(wp), intent(out) :: wr(*), wi(*), vl(ldvl, *), vr(ldvr, *), work(*)
      integer, intent(out) :: info
    end subroutine dgeev
    subroutine dpotrf(uplo, n, a, lda, info)
      import :: wp
      character, intent(in) :: uplo
      integer, intent(in) :: n, lda
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: info
    end subroutine dpotrf
    subroutine dsytrf(uplo, n, a, lda, ipiv, work, lwork, info)
      import :: wp
      character, intent(in) :: uplo
      integer, intent(in) :: n, lda, lwork
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: ipiv(*), info
      real(wp), intent(out) :: work(*)
    end subroutine dsytrf
  end interface

contains

  !> Has the library map what it needs for itself while there is room. OpenBLAS would ask for it for
  !> ever in the middle of a run that has used the memory up.
  subroutine claim_buffers()
    real(wp) :: a(2, 2)
    integer :: pivot(2), info

    a = reshape([2.0_wp, 1.0_wp, 1.0_wp, 2.0_wp], [2, 2])
    call dgetrf(2, 2, a, 2, pivot, info)
  end subroutine claim_buffers

  !> y = a(:size(y), :columns) x(:columns).
  subroutine multiply(a, columns, x, y)
    real(wp), intent(in), contiguous :: a(:, :)
    integer, intent(in) :: columns
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: y(:)

    y = 0
    if (columns > 0) &
      call dgemv('n', size(y), columns, 1.0_wp, a, size(a, 1), x, 1, 0.0_wp, y, 1)
  end subroutine multiply

  !> Factorises the matrix held in factors%lu in place.
  subroutine factorise(factors)
    type(factorisation_t), intent(inout) :: factors
    integer :: n, info

    n = size(factors%lu, 1)
    if (allocated(factors%pivot)) then
      if (size(factors%pivot) /= n) deallocate (factors%pivot)
    end if
    if (.not. allocated(factors%pivot)) allocate (factors%pivot(n))
    call dgetrf(n, n, factors%lu, n, factors%pivot, info)
    factors%valid = info == 0
  end subroutine factorise

  !> Overwrites b with the solution; factors must be valid.
  subroutine solve(factors, b)
    type(factorisation_t), intent(in) :: factors
    real(wp), intent(inout) :: b(:)
    integer :: info, n

    n = size(b)
    call dgetrs('n', n, 1, factors%lu, n, factors%pivot, b, n, info)
  end subroutine solve

  !> Overwrites b with the solution of a regular tridiagonal system, and the three diagonals.
  subroutine solve_tridiagonal(below, middle, above, b)
    real(wp), intent(inout) :: below(:), middle(:), above(:), b(:)
    integer :: info

    call dgtsv(size(b), 1, below, middle, above, b, size(b), info)
  end subroutine solve_tridiagonal

  !> Sign of the determinant, +1 or -1.
  pure integer function determinant_sign(factors)
    type(factorisation_t), intent(in) :: factors
    integer :: i

    determinant_sign = 1
    do i = 1, size(factors%pivot)
      if (factors%pivot(i) /= i) determinant_sign = -determinant_sign
      if (factors%lu(i, i) < 0) determinant_sign = -determinant_sign
    end do
  end function determinant_sign

  !> Logarithm of the absolute value of the determinant.
  pure real(wp) function log_determinant(factors)
    type(factorisation_t), intent(in) :: factors
    integer :: i

    log_determinant = 0
    do i = 1, size(factors%pivot)
      log_determinant = log_determinant + log(abs(factors%lu(i, i)))
    end do
  end function log_determinant

  !> The real parts of all eigenvalues of the square matrix a, which is overwritten. found = .false.
  !> where LAPACK has not found them all.
  subroutine eigenvalues(a, real_part, found)
    real(wp), intent(inout), contiguous :: a(:, :)
    real(wp), intent(out) :: real_part(:)
    logical, intent(out) :: found
    real(wp) :: imaginary_part(size(real_part)), left(1, 1), right(1, 1), best(1)
    real(wp), allocatable :: work(:)
    integer :: n, info

    n = size(real_part)
    call dgeev('n', 'n', n, a, n, real_part, imaginary_part, left, 1, right, 1, best, -1, info)
    allocate (work(nint(best(1))))
    call dgeev('n', 'n', n, a, n, real_part, imaginary_part, left, 1, right, 1, work, &
      size(work), info)
    found = info == 0
  end subroutine eigenvalues

  !> Whether the symmetric matrix whose lower triangle is that of a is positive definite. The lower
  !> triangle and the diagonal are overwritten.
  logical function positive_definite(a)
    real(wp), intent(inout), contiguous :: a(:, :)
    integer :: n, info

    n = size(a, 1)
    call dpotrf('l', n, a, n, info)
    positive_definite = info == 0
  end function positive_definite

  !> Number of positive eigenvalues of the symmetric matrix whose upper triangle is that of a, which
  !> is overwritten: by Sylvester's law of inertia that of the pivots of its LDL factors.
  integer function positive_eigenvalues(a) result(positive)
    real(wp), intent(inout), contiguous :: a(:, :)
    real(wp) :: best(1)
    real(wp), allocatable :: work(:)
    integer :: pivot(size(a, 1)), n, i, info

    n = size(a, 1)
    call dsytrf('u', n, a, n, pivot, best, -1, info)
    allocate (work(nint(best(1))))
    call dsytrf('u', n, a, n, pivot, work, size(work), info)
    positive = 0
    i = 1
    do while (i <= n)
      if (pivot(i) > 0) then
        if (a(i, i) > 0) positive = positive + 1
        i = i + 1
      else
        ! A pivot of two rows has an eigenvalue of each sign: Bunch and Kaufman take no other.
        positive = positive + 1
        i = i + 2
      end if
    end do
  end function positive_eigenvalues

end module linear_algebra
