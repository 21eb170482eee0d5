!> The residuals of several curves under one model: shared unknowns have one value for all curves,
!> the others have one value for each curve.
module joint_residuals
  use kinds, only: wp
  use fit_request, only: unknown_t
  use fit_residuals, only: fit_residuals_t
  use curve_residuals, only: curve_residuals_t
  implicit none
  private
  public :: joint_residuals_t, join

  !> unknown: all unknowns, the shared ones first, then those of each curve. place: the positions of
  !> a curve's unknowns among all, (unknown of the curve, curve). before: for each curve, the number
  !> of residuals of the curves before it. start: the values of each curve fitted alone, (unknown of
  !> the curve, curve).
  type, extends(fit_residuals_t) :: joint_residuals_t
    type(curve_residuals_t), allocatable :: part(:)
    type(unknown_t), allocatable :: unknown(:)
    integer, allocatable :: place(:, :), before(:)
    real(wp), allocatable :: start(:, :)
  contains
    procedure :: unknowns
    procedure :: rows
    procedure :: removed
    procedure :: residuals_of
    procedure :: jacobian_of
  end type joint_residuals_t

contains

  !> Joins the residuals of curves, whose unknowns have the same names. The limits of a shared
  !> unknown include those of every curve, and its prior counts once. start: the values of the
  !> unknowns of each curve fitted alone, (unknown, curve).
  subroutine join(part, start, joint)
    type(curve_residuals_t), intent(in) :: part(:)
    real(wp), intent(in) :: start(:, :)
    type(joint_residuals_t), intent(out) :: joint
    type(unknown_t) :: new
    integer :: i, k, n

    joint%part = part
    joint%start = start
    n = size(part(1)%curve%unknown)
    allocate (joint%unknown(0), joint%place(n, size(part)), joint%before(size(part)))
    do i = 1, n
      if (.not. part(1)%curve%unknown(i)%shared) cycle
      new = part(1)%curve%unknown(i)
      do k = 2, size(part)
        new%farthest = max(new%farthest, part(k)%curve%unknown(i)%farthest)
      end do
      joint%unknown = [joint%unknown, new]
      joint%place(i, :) = size(joint%unknown)
      do k = 1, size(part)
        joint%part(k)%curve%unknown(i) = new
        if (k > 1) joint%part(k)%curve%unknown(i)%prior = 0
      end do
    end do
    do k = 1, size(part)
      do i = 1, n
        if (part(k)%curve%unknown(i)%shared) cycle
        joint%unknown = [joint%unknown, part(k)%curve%unknown(i)]
        joint%place(i, k) = size(joint%unknown)
      end do
      joint%before(k) = sum([(joint%part(i)%rows(), i=1, k - 1)])
    end do
  end subroutine join

  pure function unknowns(self) result(unknown)
    class(joint_residuals_t), intent(in) :: self
    type(unknown_t), allocatable :: unknown(:)

    unknown = self%unknown
  end function unknowns

  pure integer function rows(self)
    class(joint_residuals_t), intent(in) :: self
    integer :: i

    rows = sum([(self%part(i)%rows(), i=1, size(self%part))])
  end function rows

  pure integer function removed(self)
    class(joint_residuals_t), intent(in) :: self
    integer :: i

    removed = sum([(self%part(i)%removed(), i=1, size(self%part))])
  end function removed

  subroutine residuals_of(self, value, residual, found)
    class(joint_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found
    integer :: i, from

    do i = 1, size(self%part)
      from = self%before(i)
      call self%part(i)%residuals_of(value(self%place(:, i)), &
        residual(from + 1:from + self%part(i)%rows()), found)
      if (.not. found) return
    end do
  end subroutine residuals_of

  subroutine jacobian_of(self, value, jacobian, found)
    class(joint_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: jacobian(:, :)
    logical, intent(out) :: found
    real(wp), allocatable :: by(:, :)
    integer :: i, from

    jacobian = 0
    do i = 1, size(self%part)
      from = self%before(i)
      allocate (by(self%part(i)%rows(), size(self%place, 1)))
      call self%part(i)%jacobian_of(value(self%place(:, i)), by, found)
      if (.not. found) return
      jacobian(from + 1:from + size(by, 1), self%place(:, i)) = by
      deallocate (by)
    end do
  end subroutine jacobian_of

end module joint_residuals
