!> The residuals of a fit as functions of its unknowns, in standard deviations: those of one curve,
!> or of several curves together.
module fit_residuals
  use kinds, only: wp
  use fit_request, only: unknown_t, value_of, free_of, value_by_free
  use least_squares, only: residuals_t, minimise
  implicit none
  private
  public :: fit_residuals_t

  type, abstract, extends(residuals_t) :: fit_residuals_t
  contains
    procedure(list_unknowns), deferred :: unknowns
    !> Number of residuals; number of amplitudes removed from the residuals by projection.
    procedure(count_numbers), deferred :: rows
    procedure(count_numbers), deferred :: removed
    !> The residuals at values of the unknowns; found = .false. if there are none.
    procedure(find_residuals), deferred :: residuals_of
    !> Derivatives of the residuals by the values, (residual, unknown).
    procedure(find_derivatives), deferred :: jacobian_of
    procedure :: values
    procedure :: evaluate
    procedure :: differentiate
    procedure :: descend
  end type fit_residuals_t

  abstract interface
    pure function list_unknowns(self) result(unknown)
      import :: fit_residuals_t, unknown_t
      class(fit_residuals_t), intent(in) :: self
      type(unknown_t), allocatable :: unknown(:)
    end function list_unknowns
    pure integer function count_numbers(self)
      import :: fit_residuals_t
      class(fit_residuals_t), intent(in) :: self
    end function count_numbers
    subroutine find_residuals(self, value, residual, found)
      import :: fit_residuals_t, wp
      class(fit_residuals_t), intent(inout) :: self
      real(wp), intent(in) :: value(:)
      real(wp), intent(out) :: residual(:)
      logical, intent(out) :: found
    end subroutine find_residuals
    subroutine find_derivatives(self, value, jacobian, found)
      import :: fit_residuals_t, wp
      class(fit_residuals_t), intent(inout) :: self
      real(wp), intent(in) :: value(:)
      real(wp), intent(out) :: jacobian(:, :)
      logical, intent(out) :: found
    end subroutine find_derivatives
  end interface

contains

  !> The values of the unknowns at free numbers.
  pure function values(self, x) result(value)
    class(fit_residuals_t), intent(in) :: self
    real(wp), intent(in) :: x(:)
    real(wp) :: value(size(x))
    type(unknown_t), allocatable :: unknown(:)

    unknown = self%unknowns()
    value = value_of(unknown, x)
  end function values

  subroutine evaluate(self, x, residual, found)
    class(fit_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found

    call self%residuals_of(self%values(x), residual, found)
  end subroutine evaluate

  subroutine differentiate(self, x, jacobian, found)
    class(fit_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: jacobian(:, :)
    logical, intent(out) :: found
    type(unknown_t), allocatable :: unknown(:)
    integer :: i

    call self%jacobian_of(self%values(x), jacobian, found)
    if (.not. found) return
    unknown = self%unknowns()
    do i = 1, size(x)
      jacobian(:, i) = jacobian(:, i)*value_by_free(unknown(i), x(i))
    end do
  end subroutine differentiate

  !> Moves the values to the nearest minimum of the sum of squares. left: the sum of squares there.
  subroutine descend(self, value, left, found)
    class(fit_residuals_t), intent(inout) :: self
    real(wp), intent(inout) :: value(:)
    real(wp), intent(out) :: left
    logical, intent(out) :: found
    real(wp) :: x(size(value)), residual(self%rows())
    type(unknown_t), allocatable :: unknown(:)

    unknown = self%unknowns()
    x = free_of(unknown, value)
    call minimise(self, x, residual, found)
    left = sum(residual**2)
    value = self%values(x)
  end subroutine descend

end module fit_residuals
