!> The baseline of a measured curve: a constant for each way, and a slope of both. The unknowns of a
!> model do not change what it is made of, so that the best baseline is taken off residuals and
!> their derivatives by the same projection.
module baseline
  use kinds, only: wp
  use noise, only: noise_t, whiten
  implicit none
  private
  public :: baseline_t, new_baseline

  !> Columns for all samples; for those that count, white, as an orthonormal basis and the triangle
  !> that leads from it to them.
  type :: baseline_t
    real(wp), allocatable, private :: column(:, :), basis(:, :), triangle(:, :)
  contains
    procedure :: unknowns
    procedure :: take_off
    procedure :: of
  end type baseline_t

contains

  !> For samples at z on the way inward or not, of which those with the numbers `sample` count;
  !> `run` as in `whiten`.
  pure function new_baseline(z, inward, sample, run, noise) result(new)
    real(wp), intent(in) :: z(:)
    logical, intent(in) :: inward(:)
    integer, intent(in) :: sample(:), run(:)
    type(noise_t), intent(in) :: noise
    type(baseline_t) :: new
    integer :: n, ways

    n = size(z)
    ways = merge(2, 1, any(inward) .and. .not. all(inward))
    allocate (new%column(n, ways + 1))
    new%column(:, 1) = merge(1.0_wp, 0.0_wp, inward .eqv. inward(1))
    new%column(:, ways) = merge(1.0_wp, 0.0_wp, inward .eqv. inward(n))
    new%column(:, ways + 1) = z - sum(z)/n
    new%column(:, ways + 1) = new%column(:, ways + 1)/maxval(abs(new%column(:, ways + 1)))
    new%basis = new%column(sample, :)
    call whiten(noise, run, new%basis)
    call orthonormalise(new%basis, new%triangle)
  end function new_baseline

  !> Gram and Schmidt, twice, so that rounding does not count: a = q r.
  pure subroutine orthonormalise(q, r)
    real(wp), intent(inout) :: q(:, :)
    real(wp), allocatable, intent(out) :: r(:, :)
    real(wp) :: part
    integer :: i, j, pass

    allocate (r(size(q, 2), size(q, 2)), source=0.0_wp)
    do j = 1, size(q, 2)
      do pass = 1, 2
        do i = 1, j - 1
          part = dot_product(q(:, i), q(:, j))
          q(:, j) = q(:, j) - part*q(:, i)
          r(i, j) = r(i, j) + part
        end do
      end do
      r(j, j) = norm2(q(:, j))
      q(:, j) = q(:, j)/r(j, j)
    end do
  end subroutine orthonormalise

  !> How many numbers it has.
  pure integer function unknowns(self)
    class(baseline_t), intent(in) :: self

    unknowns = size(self%column, 2)
  end function unknowns

  !> Takes the baseline that leaves least off each column of white numbers.
  pure subroutine take_off(self, white)
    class(baseline_t), intent(in) :: self
    real(wp), intent(inout) :: white(:, :)

    white = white - matmul(self%basis, matmul(transpose(self%basis), white))
  end subroutine take_off

  !> The baseline that leaves least of white numbers, at all samples.
  pure function of(self, white) result(signal)
    class(baseline_t), intent(in) :: self
    real(wp), intent(in) :: white(:)
    real(wp) :: signal(size(self%column, 1))
    real(wp) :: part(size(self%column, 2))
    integer :: i

    part = matmul(white, self%basis)
    do i = size(part), 1, -1
      part(i) = (part(i) - dot_product(self%triangle(i, i + 1:), part(i + 1:)))/self%triangle(i, i)
    end do
    signal = matmul(self%column, part)
  end function of

end module baseline
