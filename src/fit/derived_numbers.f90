!> Numbers that follow from the fitted values, with errors: the work of adhesion, the reduced
!> modulus, and the Young's modulus of the sample.
module derived_numbers
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t, surface_energy
  use variation, only: problem_family_t
  use fit_request, only: unknown_t, fit_t, of_model, value_by_fitted, fine_change
  use fit_errors, only: fitted_t
  implicit none
  private
  public :: derived_t, derive_numbers

  !> A number with its standard error and unit. poisson: the Poisson's ratio that is assumed, if the
  !> number depends on it. of_deck: whether the deck gives this ratio.
  type :: derived_t
    character(len=:), allocatable :: name, unit
    real(wp) :: value = 0, error = 0
    real(wp), allocatable :: poisson
    logical :: of_deck = .true.
  end type derived_t

  !> The largest Poisson's ratio, of incompressible bodies such as gels.
  real(wp), parameter :: incompressible = 0.5_wp

contains

  !> Derives the numbers of a fit. family: the problems, whose parameters are the unknowns of the
  !> model. The reduced modulus is 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2. For identical bodies E* is
  !> half of the plane-strain modulus E/(1-nu^2); for a sample under a rigid tip E* is E/(1-nu^2)
  !> itself.
  subroutine derive_numbers(family, fit, unknown, fitted, problem, derived)
    class(problem_family_t), intent(in) :: family
    type(fit_t), intent(in) :: fit
    type(unknown_t), intent(in) :: unknown(:)
    type(fitted_t), intent(in) :: fitted
    type(problem_t), intent(in) :: problem
    type(derived_t), allocatable, intent(out) :: derived(:)
    type(derived_t) :: sample
    real(wp) :: by(2, size(unknown))
    integer :: i, body

    allocate (derived(0))
    call find_derivatives()
    if (problem%law%adhesion > 0) call add('work_of_adhesion', 'J/m^2', surface_energy(problem), &
      by(1, :))
    if (problem%rigid .or. .not. problem%body%is_homogeneous()) return
    i = size(derived)
    call add('reduced_modulus', 'Pa', 0.5_wp*problem%stiffness, by(2, :))
    if (size(derived) == i) return
    sample = derived(size(derived))
    sample%name = 'young_of_sample'
    if (allocated(fit%poisson)) then
      ! The sample is the body whose modulus is fitted.
      do i = 1, size(unknown)
        if (index(unknown(i)%name, 'bodies.young') /= 1) cycle
        body = merge(2, 1, index(unknown(i)%name, '(2)') > 0)
        sample%value = fitted%value(i)
        sample%error = fitted%deviation(i)
        sample%poisson = fit%poisson(body)
        derived = [derived, sample]
        return
      end do
    else
      sample%poisson = incompressible
      sample%of_deck = .false.
      sample%value = (1 - incompressible**2)*sample%value
      sample%error = (1 - incompressible**2)*sample%error
      derived = [derived, sample]
    end if

  contains

    !> by: derivatives of the numbers by the fitted numbers (`fit_request`).
    subroutine find_derivatives()
      type(problem_t) :: varied
      type(failure_t), allocatable :: error
      real(wp) :: value(size(unknown)), side(2, 2)
      integer :: k

      by = 0
      do i = 1, size(unknown)
        if (unknown(i)%role /= of_model) cycle
        do k = 1, 2
          value = fitted%value
          value(i) = value(i) + (2*k - 3)*fine_change*value_by_fitted(unknown(i), value(i))
          call family%pose(pack(value, unknown%role == of_model), varied, error)
          if (allocated(error)) exit
          side(:, k) = [surface_energy(varied), 0.5_wp*varied%stiffness]
        end do
        if (.not. allocated(error)) by(:, i) = (side(:, 2) - side(:, 1))/(2*fine_change)
      end do
    end subroutine find_derivatives

    subroutine add(name, unit, value, by)
      character(len=*), intent(in) :: name, unit
      real(wp), intent(in) :: value, by(:)
      type(derived_t) :: new

      new%name = name
      new%unit = unit
      new%value = value
      associate (part => by*fitted%fitted_deviation)
        new%error = sqrt(max(0.0_wp, dot_product(part, matmul(fitted%correlation, part))))
      end associate
      ! A number that does not depend on the unknowns has no error and is not reported.
      if (new%error > 0) derived = [derived, new]
    end subroutine add

  end subroutine derive_numbers

end module derived_numbers
