!> The residuals of a measured curve under a model (`modelled_curve`), in standard deviations. The
!> samples are whitened. Baselines and slope enter linearly and are then removed by projection
!> (variable projection; Golub and Pereyra, 1973; `fit_samples`). The position of a jump gives one
!> more residual, and so does a prior of an unknown. Samples taken during a jump do not count.
module curve_residuals
  use kinds, only: wp
  use fit_request, only: unknown_t, value_by_fitted, fitted_of, is_beyond
  use fit_residuals, only: fit_residuals_t
  use modelled_curve, only: modelled_curve_t
  implicit none
  private
  public :: curve_residuals_t

  !> Residual of a measured jump that the model does not have, in standard deviations.
  real(wp), parameter :: missed = 10

  type, extends(fit_residuals_t) :: curve_residuals_t
    type(modelled_curve_t) :: curve
  contains
    procedure :: unknowns
    procedure :: rows
    procedure :: removed
    procedure :: residuals_of
    procedure :: jacobian_of
    procedure, private :: jump_residual
  end type curve_residuals_t

contains

  pure function unknowns(self) result(unknown)
    class(curve_residuals_t), intent(in) :: self
    type(unknown_t), allocatable :: unknown(:)

    unknown = self%curve%unknown
  end function unknowns

  !> Number of residuals: samples, measured jumps, unknowns with a prior.
  pure integer function rows(self)
    class(curve_residuals_t), intent(in) :: self

    associate (data => self%curve%data)
      rows = size(data%sample) + count(data%jump%before > 0) + count(self%curve%unknown%prior > 0)
    end associate
  end function rows

  !> Number of amplitudes of the baseline.
  pure integer function removed(self)
    class(curve_residuals_t), intent(in) :: self

    removed = self%curve%data%baseline_numbers()
  end function removed

  !> The residuals at these values of the unknowns.
  subroutine residuals_of(self, value, residual, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: residual(:)
    logical, intent(out) :: found
    real(wp) :: left(size(self%curve%data%sample), 1)
    integer :: i, n

    found = .not. any(is_beyond(self%curve%unknown, value, 0.0_wp))
    if (found) call self%curve%ask(value, .false., found)
    if (.not. found) return
    associate (s => self%curve%data%sample)
      left(:, 1) = self%curve%data%measured%signal(s) - self%curve%signal_of(value, s)
    end associate
    n = size(self%curve%data%sample)
    call self%curve%data%clean(left)
    residual(:n) = left(:, 1)
    do i = 1, 2
      if (self%curve%data%jump(i)%before == 0) cycle
      n = n + 1
      residual(n) = self%jump_residual(value, i)
    end do
    do i = 1, size(value)
      associate (unknown => self%curve%unknown(i))
        if (.not. unknown%prior > 0) cycle
        n = n + 1
        residual(n) = (fitted_of(unknown, value(i)) - fitted_of(unknown, unknown%value))/ &
          prior_of(unknown)
      end associate
    end do
  end subroutine residuals_of

  !> Derivatives of the residuals by the values of the unknowns.
  subroutine jacobian_of(self, value, jacobian, found)
    class(curve_residuals_t), intent(inout) :: self
    real(wp), intent(in) :: value(:)
    real(wp), intent(out) :: jacobian(:, :)
    logical, intent(out) :: found
    real(wp) :: by(size(self%curve%data%sample), size(value))
    integer :: i, n

    call self%curve%ask(value, .true., found)
    if (.not. found) return
    by = -self%curve%signal_rates(value)
    n = size(self%curve%data%sample)
    call self%curve%data%clean(by)
    jacobian(:n, :) = by
    associate (data => self%curve%data, unknown => self%curve%unknown)
      do i = 1, 2
        if (data%jump(i)%before == 0) cycle
        n = n + 1
        jacobian(n, :) = data%measured%facing*self%curve%jump_rates(value, i)/ &
          data%jump(i)%uncertainty
      end do
      do i = 1, size(value)
        if (.not. unknown(i)%prior > 0) cycle
        n = n + 1
        jacobian(n, :) = 0
        jacobian(n, i) = 1/(prior_of(unknown(i))*value_by_fitted(unknown(i), value(i)))
      end do
    end associate
  end subroutine jacobian_of

  !> The prior standard deviation of the fitted number of an unknown.
  pure real(wp) function prior_of(unknown) result(deviation)
    type(unknown_t), intent(in) :: unknown

    deviation = unknown%prior/value_by_fitted(unknown, unknown%value)
  end function prior_of

  !> The start of the model's jump minus the start of the measured jump, divided by the uncertainty.
  real(wp) function jump_residual(self, value, way) result(residual)
    class(curve_residuals_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: way

    residual = 0
    if (.not. self%curve%response%way(way)%predicted) return
    residual = missed
    if (self%curve%response%way(way)%main == 0) return
    residual = self%curve%data%measured%facing*(self%curve%jump_of(value, way) - &
      self%curve%data%jump(way)%z)/self%curve%data%jump(way)%uncertainty
  end function jump_residual

end module curve_residuals
