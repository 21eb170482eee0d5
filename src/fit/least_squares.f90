!> Minimisation of a sum of squares by MINPACK's lmder (J. J. More, 1978).
module least_squares
  use, intrinsic :: iso_c_binding, only: c_ptr, c_loc, c_f_pointer
  use kinds, only: wp
  implicit none
  private
  public :: residuals_t, minimise

  !> Residuals to be minimised; an extended type holds the data for them.
  type, abstract :: residuals_t
  contains
    !> The residuals at x; found = .false. if there are none.
    procedure(evaluate_residuals), deferred :: evaluate
    !> Their derivatives, (residual, unknown), at the x of the last evaluation.
    procedure(evaluate_derivatives), deferred :: differentiate
  end type residuals_t

  abstract interface
    subroutine evaluate_residuals(self, x, residual, found)
      import :: residuals_t, wp
      class(residuals_t), intent(inout) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: residual(:)
      logical, intent(out) :: found
    end subroutine evaluate_residuals
    subroutine evaluate_derivatives(self, x, jacobian, found)
      import :: residuals_t, wp
      class(residuals_t), intent(inout) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: jacobian(:, :)
      logical, intent(out) :: found
    end subroutine evaluate_derivatives
  end interface

  !> lmder passes a C pointer to this type to its callback, since it cannot pass a polymorphic
  !> object.
  type :: carrier_t
    class(residuals_t), pointer :: residuals => null()
  end type carrier_t

  interface
    subroutine lmder(fcn, data, m, n, x, fvec, fjac, ldfjac, ftol, xtol, gtol, maxfev, diag, mode, &
      factor, nprint, info, nfev, njev, ipvt, qtf, wa1, wa2, wa3, wa4)
      import :: wp, c_ptr
      external :: fcn
      type(c_ptr), intent(in) :: data
      integer, intent(in) :: m, n, ldfjac, maxfev, mode, nprint
      real(wp), intent(in) :: ftol, xtol, gtol, factor
      real(wp), intent(inout) :: x(n), diag(n)
      real(wp), intent(out) :: fvec(m), fjac(ldfjac, n), qtf(n), wa1(n), wa2(n), wa3(n), wa4(m)
      integer, intent(out) :: info, nfev, njev, ipvt(n)
    end subroutine lmder
  end interface

  !> The search ends if a step lowers the sum of squares by less than a change of x by this fraction
  !> of a standard error would lower it. (A change by one standard error changes the sum by its mean
  !> square.) Along a badly determined combination of x further steps could still go farther.
  real(wp), parameter :: of_error = 1.0e-3_wp
  !> The search also ends at this relative change of x; length of the first step.
  real(wp), parameter :: nearer = 1.0e-10_wp, first_step = 0.3_wp
  !> Largest number of evaluations.
  integer, parameter :: most_evaluations = 80
  !> Value of residuals where they do not exist; lmder then shortens its step.
  real(wp), parameter :: nowhere = 1.0e8_wp

contains

  !> Moves x to the minimum of the sum of squares. x should be scaled such that a change by 1 is
  !> large: the first step is shorter. found = .false.: there are no residuals at the first x, or
  !> the number of evaluations did not suffice.
  subroutine minimise(residuals, x, residual, found)
    class(residuals_t), intent(inout), target :: residuals
    real(wp), intent(inout) :: x(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found
    type(carrier_t), target :: carrier
    real(wp), dimension(size(x)) :: diag, qtf, wa1, wa2, wa3
    real(wp) :: wa4(size(residual)), jacobian(size(residual), size(x))
    integer :: info, evaluations, jacobians, pivot(size(x))

    carrier%residuals => residuals
    diag = 1
    call lmder(evaluate_for_lmder, c_loc(carrier), size(residual), size(x), x, residual, jacobian, &
      size(residual), of_error**2/size(residual), nearer, 0.0_wp, most_evaluations, diag, 2, &
      first_step, 0, info, evaluations, jacobians, pivot, qtf, wa1, wa2, wa3, wa4)
    ! The values 6 to 8 mean that rounding allows no further decrease.
    found = any(info == [1, 2, 3, 4, 6, 7, 8])
  end subroutine minimise

  subroutine evaluate_for_lmder(m, n, x, residual, jacobian, rows, what, data)
    integer, intent(in) :: m, n, rows
    real(wp), intent(in) :: x(n)
    real(wp), intent(inout) :: residual(m), jacobian(rows, n)
    integer, intent(inout) :: what
    type(c_ptr), intent(in) :: data
    type(carrier_t), pointer :: carrier
    logical :: found

    call c_f_pointer(data, carrier)
    if (what == 1) then
      call carrier%residuals%evaluate(x, residual, found)
      if (.not. found) residual = nowhere
    else
      call carrier%residuals%differentiate(x, jacobian, found)
      if (.not. found) what = -1
    end if
  end subroutine evaluate_for_lmder

end module least_squares
