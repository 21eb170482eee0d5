!> Interfaces of the BLAS and LAPACK routines in use.
module lapack
  use kinds, only: wp, sp
  implicit none
  private
  public :: idamax, dgemv, dgemm, dgetrf, dgetrs, sgetrf, sgetrs, dgtsv, dgeev, dgesvd

  interface
    integer function idamax(n, x, incx)
      import :: wp
      integer, intent(in) :: n, incx
      real(wp), intent(in) :: x(*)
    end function idamax
    pure subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: m, n, lda, incx, incy
      real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
      real(wp), intent(inout) :: y(*)
    end subroutine dgemv
    subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: wp
      character, intent(in) :: transa, transb
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      real(wp), intent(in) :: alpha, beta, a(lda, *), b(ldb, *)
      real(wp), intent(inout) :: c(ldc, *)
    end subroutine dgemm
    subroutine dgetrf(m, n, a, lda, ipiv, info)
      import :: wp
      integer, intent(in) :: m, n, lda
      real(wp), intent(inout) :: a(lda, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine dgetrf
    subroutine sgetrf(m, n, a, lda, ipiv, info)
      import :: sp
      integer, intent(in) :: m, n, lda
      real(sp), intent(inout) :: a(lda, *)
      integer, intent(out) :: ipiv(*), info
    end subroutine sgetrf
    subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
      real(wp), intent(in) :: a(lda, *)
      real(wp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine dgetrs
    subroutine sgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: sp
      character, intent(in) :: trans
      integer, intent(in) :: n, nrhs, lda, ldb, ipiv(*)
      real(sp), intent(in) :: a(lda, *)
      real(sp), intent(inout) :: b(ldb, *)
      integer, intent(out) :: info
    end subroutine sgetrs
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
    subroutine dgesvd(jobu, jobvt, m, n, a, lda, s, u, ldu, vt, ldvt, work, lwork, info)
      import :: wp
      character, intent(in) :: jobu, jobvt
      integer, intent(in) :: m, n, lda, ldu, ldvt, lwork
      real(wp), intent(inout) :: a(lda, *)
      real(wp), intent(out) :: s(*), u(ldu, *), vt(ldvt, *), work(*)
      integer, intent(out) :: info
    end subroutine dgesvd
  end interface

end module lapack
