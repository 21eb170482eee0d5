!> A problem with one of its parameters varied, and the rule for derivatives from values at the
!> varied problems: differences, so that laws, shapes and bodies need no derivatives by parameters.
!> Reported derivatives are of sixth order; second order suffices for a search.
module variation
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use interpolation, only: polynomial_slope
  use problem_family, only: problem_family_t, parameter_t
  implicit none
  private
  public :: variation_t, vary, along_path, to_report, to_search

  !> Number of problems on either side of the present one; and for each number the step between two,
  !> as a part of the parameter's scale. The error of differences of sixth order, for h^-n about
  !> n^7/140 step^6, is below their rounding error, about 1e-16/step; those of second order have an
  !> error of n^3/6 step^2, which leaves six digits.
  integer, parameter :: to_report = 3, to_search = 1
  real(wp), parameter :: step(to_report) = [1.0e-4_wp, 1.0e-3_wp, 1.0e-3_wp]

  type :: variation_t
    type(parameter_t) :: parameter
    !> Difference of the parameter in each problem, SI units.
    real(wp), allocatable :: offset(:)
    !> dQ/dp = sum(weight*Q); and the same without the outermost points; the difference of the two
    !> shows the error.
    real(wp), allocatable, dimension(:) :: weight, coarser
    !> Allocatable: compiler note 11.
    type(problem_t), allocatable :: problem(:)
    !> Difference of the coordinate on the path (`continuation`), if the coordinate is varied.
    real(wp), allocatable :: shift(:)
  end type variation_t

contains

  !> Varies parameter i by `aside` problems on either side, `to_report` or `to_search`. If the range
  !> of the parameter ends nearby, all problems are on one side. Fails if neither side is allowed.
  subroutine vary(family, i, aside, varied, error)
    class(problem_family_t), intent(in) :: family
    integer, intent(in) :: i, aside
    type(variation_t), intent(out) :: varied
    type(failure_t), allocatable, intent(out) :: error
    real(wp) :: value(size(family%parameter))
    integer :: shift, k

    varied%parameter = family%parameter(i)
    allocate (varied%problem(0))
    do shift = 0, 2
      varied%offset = [(real(k + aside*merge(-1, shift, shift == 2), wp), k=-aside, aside)]
      ! With two sides the present problem has no weight.
      if (shift == 0) varied%offset = pack(varied%offset, abs(varied%offset) > 0)
      varied%offset = step(aside)*varied%parameter%scale*varied%offset
      deallocate (varied%problem)
      allocate (varied%problem(size(varied%offset)))
      do k = 1, size(varied%offset)
        value = family%parameter%value
        value(i) = value(i) + varied%offset(k)
        call family%pose(value, varied%problem(k), error)
        if (allocated(error)) exit
      end do
      if (.not. allocated(error)) exit
    end do
    if (allocated(error)) return
    varied%shift = 0*varied%offset
    call find_rule(varied)
  end subroutine vary

  !> Varies the path's coordinate, with the same problem.
  type(variation_t) function along_path(problem) result(varied)
    type(problem_t), intent(in) :: problem
    integer :: k

    varied%parameter%name = 'coordinate'
    varied%offset = step(to_report)*[(k, k=-to_report, to_report)]
    varied%shift = varied%offset
    varied%problem = [(problem, k=1, size(varied%offset))]
    call find_rule(varied)
  end function along_path

  !> Sets the weights for the offsets.
  subroutine find_rule(varied)
    type(variation_t), intent(inout) :: varied
    real(wp) :: one(size(varied%offset))
    integer :: k

    allocate (varied%weight(size(one)), varied%coarser(size(one)), source=0.0_wp)
    do k = 1, size(one)
      one = 0
      one(k) = 1
      varied%weight(k) = polynomial_slope(varied%offset, one, 0.0_wp)
      if (size(one) > 3 .and. k > 1 .and. k < size(one)) varied%coarser(k) = &
        polynomial_slope(varied%offset(2:size(one) - 1), one(2:size(one) - 1), 0.0_wp)
    end do
  end subroutine find_rule

end module variation
