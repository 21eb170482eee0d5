!> Problems that differ in the values of parameters, for derivatives by these and for fits.
module problem_family
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  implicit none
  private
  public :: problem_family_t, parameter_t

  !> A parameter: its value in the present problem, SI units, and its scale, which is the value
  !> unless the value is zero. follows: the value is a factor of the parameter's default, which may
  !> follow from other parameters.
  type :: parameter_t
    character(len=:), allocatable :: name
    real(wp) :: value = 0, scale = 1
    logical :: follows = .false.
  end type parameter_t

  type, abstract :: problem_family_t
    type(parameter_t), allocatable :: parameter(:)
  contains
    !> The problem with other values of the parameters; fails if a value is not allowed.
    procedure(pose_problem), deferred :: pose
  end type problem_family_t

  abstract interface
    subroutine pose_problem(self, value, problem, error)
      import :: problem_family_t, problem_t, failure_t, wp
      class(problem_family_t), intent(in) :: self
      real(wp), intent(in) :: value(:)
      type(problem_t), intent(out) :: problem
      type(failure_t), allocatable, intent(out) :: error
    end subroutine pose_problem
  end interface

end module problem_family
