!> Thin wrappers over LAPACK: factors, solutions, eigenvalues, singular values.
module linear_algebra
  use kinds, only: wp
  use lapack, only: dgetrf, dgetrs, dgtsv, dgeev, dgesvd
  use single_precision_lu, only: single_precision_lu_t
  implicit none
  private
  public :: factorisation_t, factorise, solve, determinant_sign, claim_buffers, eigenvalues, &
    solve_tridiagonal, singular_values

  !> LU factors of a square matrix, from `factorise`. If the factors are rough, lu is still the
  !> matrix.
  type :: factorisation_t
    real(wp), allocatable :: lu(:, :)
    integer, allocatable :: pivot(:)
    type(single_precision_lu_t) :: rough
    logical :: is_rough = .false.
    !> .false. if there are no factors, or the matrix was singular.
    logical :: valid = .false.
  end type factorisation_t

contains

  !> Makes OpenBLAS allocate its buffers now. If the memory were used up later, OpenBLAS would ask
  !> for them for ever.
  subroutine claim_buffers()
    real(wp) :: a(2, 2)
    integer :: pivot(2), info

    a = reshape([2.0_wp, 1.0_wp, 1.0_wp, 2.0_wp], [2, 2])
    call dgetrf(2, 2, a, 2, pivot, info)
  end subroutine claim_buffers

  !> Factorises the matrix held in factors%lu, in place unless the factors are to be rough. Rough
  !> factors are in single precision, for iterations that correct their errors. A matrix that is
  !> singular in this precision gets exact factors. rough: .false. if absent.
  subroutine factorise(factors, rough)
    type(factorisation_t), intent(inout) :: factors
    logical, intent(in), optional :: rough
    integer :: n, info

    factors%is_rough = .false.
    if (present(rough)) factors%is_rough = rough
    if (factors%is_rough) then
      call factors%rough%factorise(factors%lu, factors%valid)
      if (factors%valid) return
      factors%is_rough = .false.
    end if
    n = size(factors%lu, 1)
    if (allocated(factors%pivot)) then
      if (size(factors%pivot) /= n) deallocate (factors%pivot)
    end if
    if (.not. allocated(factors%pivot)) allocate (factors%pivot(n))
    call dgetrf(n, n, factors%lu, n, factors%pivot, info)
    factors%valid = info == 0
  end subroutine factorise

  !> Overwrites b with the solution; `factors` must be valid.
  subroutine solve(factors, b)
    type(factorisation_t), intent(in) :: factors
    real(wp), intent(inout) :: b(:)
    integer :: info, n

    n = size(b)
    if (factors%is_rough) then
      call factors%rough%solve(b)
    else
      call dgetrs('n', n, 1, factors%lu, n, factors%pivot, b, n, info)
    end if
  end subroutine solve

  !> Overwrites b with the solution of a regular tridiagonal system; destroys the three diagonals.
  subroutine solve_tridiagonal(below, middle, above, b)
    real(wp), intent(inout) :: below(:), middle(:), above(:), b(:)
    integer :: info

    call dgtsv(size(b), 1, below, middle, above, b, size(b), info)
  end subroutine solve_tridiagonal

  !> Singular values of a matrix with at least as many rows as columns, largest first, and the right
  !> singular vectors, one a row. Zeros if the iteration did not converge.
  subroutine singular_values(a, values, right)
    real(wp), intent(in) :: a(:, :)
    real(wp), intent(out) :: values(:), right(:, :)
    real(wp), allocatable :: spent(:, :), work(:)
    real(wp) :: left(1, 1), best(1)
    integer :: info

    spent = a
    associate (m => size(a, 1), n => size(a, 2))
      call dgesvd('n', 'a', m, n, spent, m, values, left, 1, right, n, best, -1, info)
      allocate (work(nint(best(1))))
      call dgesvd('n', 'a', m, n, spent, m, values, left, 1, right, n, work, size(work), info)
    end associate
    if (info == 0) return
    values = 0
    right = 0
  end subroutine singular_values

  !> Sign of the determinant, +1 or -1; for exact factors.
  pure integer function determinant_sign(factors)
    type(factorisation_t), intent(in) :: factors
    integer :: i

    determinant_sign = 1
    do i = 1, size(factors%pivot)
      if (factors%pivot(i) /= i) determinant_sign = -determinant_sign
      if (factors%lu(i, i) < 0) determinant_sign = -determinant_sign
    end do
  end function determinant_sign

  !> Real parts of all eigenvalues of a square matrix, and a bound of their errors. The computed
  !> vectors V and values B belong exactly to the matrix a + E = V B V^-1, with E = (V B - a V)
  !> V^-1. By Bauer and Fike (1960) E moves no eigenvalue by more than |E| |V| |V^-1|. found =
  !> .false. if the iteration did not converge, or V is singular.
  subroutine eigenvalues(a, real_part, error, found)
    real(wp), intent(in) :: a(:, :)
    real(wp), intent(out) :: real_part(:), error
    logical, intent(out) :: found
    real(wp), allocatable :: spent(:, :), vectors(:, :), defect(:, :), work(:)
    real(wp) :: imaginary_part(size(real_part)), left(1, 1), best(1)
    type(factorisation_t) :: factors
    integer :: n, info, j

    n = size(real_part)
    error = huge(1.0_wp)
    spent = a
    allocate (vectors, mold=a)
    call dgeev('n', 'v', n, spent, n, real_part, imaginary_part, left, 1, vectors, n, best, -1, &
      info)
    allocate (work(nint(best(1))))
    call dgeev('n', 'v', n, spent, n, real_part, imaginary_part, left, 1, vectors, n, work, &
      size(work), info)
    found = info == 0
    if (.not. found) return
    ! A pair of complex vectors is stored as its real and its imaginary part. B then has a 2 x 2
    ! block, and is still normal.
    defect = -matmul(a, vectors)
    do j = 1, n
      defect(:, j) = defect(:, j) + real_part(j)*vectors(:, j)
      if (imaginary_part(j) > 0) defect(:, j) = defect(:, j) - imaginary_part(j)*vectors(:, j + 1)
      if (imaginary_part(j) < 0) defect(:, j) = defect(:, j) - imaginary_part(j)*vectors(:, j - 1)
    end do
    factors%lu = vectors
    call factorise(factors)
    found = factors%valid
    if (.not. found) return
    spent = 0
    do j = 1, n
      spent(j, j) = 1
      call solve(factors, spent(:, j))
    end do
    defect = matmul(defect, spent)
    error = norm2(defect)*norm2(vectors)*norm2(spent)
  end subroutine eigenvalues

end module linear_algebra
