!> Anderson's acceleration (1965) of a fixed-point iteration, in the form that Walker and Ni (2011)
!> call type II. Linear least squares give the combination of the last iterates with the least |f|;
!> from there one more plain step is made.
!>
!> The plain step is -ratio f. In `anderson_mixing` f is the residual and the ratio that of the
!> mixing; in `anderson` f is the residual times the inverse of a factorised Jacobian, and the ratio
!> is 1.
module acceleration
  use kinds, only: wp
  implicit none
  private
  public :: history_t, accelerate

  !> Differences of unknowns and of f between iterations, newest last.
  type :: history_t
    integer :: held = 0
    real(wp), allocatable :: dz(:, :), df(:, :), z_before(:), f_before(:)
  contains
    procedure :: forget
  end type history_t

  !> A difference is dropped if its part that is linearly independent of newer ones is below this
  !> fraction of it: the least squares would amplify rounding by the inverse of this fraction.
  real(wp), parameter :: independent = 1.0e-6_wp

contains

  !> Removes all differences: the iteration restarts.
  pure subroutine forget(self)
    class(history_t), intent(inout) :: self

    self%held = 0
    if (allocated(self%f_before)) deallocate (self%f_before)
  end subroutine forget

  !> The accelerated step from the unknowns z with the plain step -ratio f, from at most `depth`
  !> earlier iterations; with depth 0 the plain step. z and f are stored for the next call.
  subroutine accelerate(history, depth, ratio, z, f, step)
    type(history_t), intent(inout) :: history
    integer, intent(in) :: depth
    real(wp), intent(in) :: ratio, z(:), f(:)
    real(wp), intent(out) :: step(:)

    step = -ratio*f
    if (depth == 0) return
    if (allocated(history%f_before)) then
      if (.not. allocated(history%dz)) &
        allocate (history%dz(size(z), depth), history%df(size(z), depth))
      if (history%held == depth) then
        history%dz(:, :depth - 1) = history%dz(:, 2:)
        history%df(:, :depth - 1) = history%df(:, 2:)
      else
        history%held = history%held + 1
      end if
      history%dz(:, history%held) = z - history%z_before
      history%df(:, history%held) = f - history%f_before
    end if
    history%z_before = z
    history%f_before = f
    if (history%held > 0) &
      call combine(history%dz(:, :history%held), history%df(:, :history%held), ratio, f, step)
  end subroutine accelerate

  !> Adds to the step -ratio f the combination of differences that minimises |f|, and the same
  !> combination of plain steps. The method is modified Gram-Schmidt, with the newest difference
  !> first. A difference that is nearly a combination of newer ones is dropped.
  pure subroutine combine(dz, df, ratio, f, step)
    real(wp), intent(in), contiguous :: dz(:, :), df(:, :)
    real(wp), intent(in) :: ratio, f(:)
    real(wp), intent(inout) :: step(:)
    ! q: orthonormal directions of df; p: the same combinations of dz.
    real(wp) :: q(size(f), size(df, 2)), p(size(f), size(df, 2)), r(size(f))
    real(wp) :: norm, norm_before, along
    integer :: j, k, used

    used = 0
    r = f
    do k = size(df, 2), 1, -1
      used = used + 1
      q(:, used) = df(:, k)
      p(:, used) = dz(:, k)
      norm_before = norm2(q(:, used))
      do j = 1, used - 1
        along = dot_product(q(:, j), q(:, used))
        q(:, used) = q(:, used) - along*q(:, j)
        p(:, used) = p(:, used) - along*p(:, j)
      end do
      norm = norm2(q(:, used))
      if (.not. norm > independent*norm_before) then
        used = used - 1
        cycle
      end if
      q(:, used) = q(:, used)/norm
      p(:, used) = p(:, used)/norm
      along = dot_product(q(:, used), r)
      r = r - along*q(:, used)
      step = step - along*(p(:, used) - ratio*q(:, used))
    end do
  end subroutine combine

end module acceleration
