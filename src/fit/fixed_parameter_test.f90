!> A test whether the data contradict a number that a fit holds fixed. A change of the number
!> changes the residuals r in some direction. The unknowns can compensate a part of this change; g
!> is the unit vector of the remaining part. If the value held fixed is right, g.r is a standard
!> normal number (the score test; Rao, 1948). The test needs no further fit, and detects a small
!> deviation that is common to all samples.
module fixed_parameter_test
  use kinds, only: wp
  use fit_request, only: unknown_t, of_model, of_contact_point, of_sensitivity, of_spring, &
    of_position
  use failure, only: failure_t
  use variation, only: problem_family_t, variation_t, vary, to_search
  use fit_samples, only: is_rounding
  use modelled_curve, only: modelled_curve_t
  use curve_residuals, only: curve_residuals_t
  use force_model, only: force_model_t
  use curve_models, only: curve_models_t
  implicit none
  private
  public :: held_t, test_held

  !> A number that is held fixed, and the change that the data suggest, in standard deviations;
  !> positive if they suggest a larger value.
  type :: held_t
    character(len=:), allocatable :: name
    real(wp) :: asked = 0
  end type held_t

contains

  !> Tests all numbers that are held fixed. curve, value: the fit. wider: the family of the fit with
  !> the deck's other positive numbers as further parameters. Numbers whose effect the unknowns
  !> compensate completely, or that cannot be varied, are left out.
  subroutine test_held(curve, value, wider, held)
    type(modelled_curve_t), intent(in) :: curve
    real(wp), intent(in) :: value(:)
    class(problem_family_t), intent(in) :: wider
    type(held_t), allocatable, intent(out) :: held(:)
    class(problem_family_t), allocatable :: family
    type(curve_models_t), target :: models
    class(force_model_t), pointer :: model
    type(curve_residuals_t) :: residuals
    type(held_t) :: new
    real(wp), allocatable :: jacobian(:, :), residual(:), all_values(:)
    real(wp) :: whole
    logical :: found
    integer :: i, n, pass

    allocate (held(0))
    n = size(value)
    allocate (family, source=wider)
    call keep_variable(pack(value, curve%unknown%role == of_model), family)
    call models%set_wider(family, curve%model, model)
    residuals%curve = curve
    call add_held(family, curve, residuals%curve%unknown)
    all_values = [value, residuals%curve%unknown(n + 1:)%value]
    call residuals%curve%use_model(model)
    allocate (residual(residuals%rows()), jacobian(residuals%rows(), size(all_values)))
    call residuals%residuals_of(all_values, residual, found)
    if (found) call residuals%jacobian_of(all_values, jacobian, found)
    if (.not. found) return
    do i = 1, size(all_values)
      whole = norm2(jacobian(:, i))
      ! The columns of the unknowns are orthonormal already. The projection is applied twice to
      ! reduce rounding errors.
      associate (basis => jacobian(:, :min(i - 1, n)), vector => jacobian(:, i))
        do pass = 1, 2
          vector = vector - matmul(basis, matmul(vector, basis))
        end do
      end associate
      if (is_rounding(jacobian(:, i), whole)) then
        jacobian(:, i) = 0
        cycle
      end if
      jacobian(:, i) = jacobian(:, i)/norm2(jacobian(:, i))
      if (i <= n) cycle
      new%name = residuals%curve%unknown(i)%name
      new%asked = -dot_product(jacobian(:, i), residual)
      held = [held, new]
    end do
  end subroutine test_held

  !> Removes the further parameters that cannot be varied. value: the values of the fit's own
  !> parameters.
  subroutine keep_variable(value, family)
    real(wp), intent(in) :: value(:)
    class(problem_family_t), intent(inout) :: family
    type(variation_t) :: varied
    type(failure_t), allocatable :: error
    logical :: keep(size(family%parameter))
    integer :: i

    family%parameter(:size(value))%value = value
    keep = .true.
    do i = size(value) + 1, size(keep)
      call vary(family, i, to_search, varied, error)
      keep(i) = .not. allocated(error)
    end do
    family%parameter = pack(family%parameter, keep)
  end subroutine keep_variable

  !> Appends the numbers held fixed, of the model and of the measurement, to the unknowns.
  subroutine add_held(family, curve, unknown)
    class(problem_family_t), intent(in) :: family
    type(modelled_curve_t), intent(in) :: curve
    type(unknown_t), allocatable, intent(inout) :: unknown(:)
    integer :: i

    do i = count(unknown%role == of_model) + 1, size(family%parameter)
      call add(family%parameter(i)%name, of_model, family%parameter(i)%value)
    end do
    if (curve%data%measured%has(of_position)) &
      call add('measurement.spring_constant', of_spring, curve%spring)
    if (allocated(curve%data%measured%sensitivity) .and. &
      curve%data%measured%has(of_position)) &
      call add('measurement.sensitivity', of_sensitivity, curve%sensitivity)
    if (.not. curve%data%measured%under_loads()) &
      call add('measurement.contact_point', of_contact_point, curve%contact_point)

  contains

    subroutine add(name, role, value)
      character(len=*), intent(in) :: name
      integer, intent(in) :: role
      real(wp), intent(in) :: value
      type(unknown_t) :: new

      if (role /= of_model .and. any(unknown%role == role)) return
      new%name = name
      new%unit = ''
      new%role = role
      new%in_log = role /= of_contact_point
      new%value = value
      if (new%in_log) new%scale = value
      unknown = [unknown, new]
    end subroutine add

  end subroutine add_held

end module fixed_parameter_test
