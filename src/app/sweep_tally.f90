!> What the cases of a sweep come to together.
module sweep_tally
  use equilibrium, only: cost_t
  use sweep_case, only: case_t, failure_width
  implicit none
  private
  public :: sweep_tally_t

  !> The number of cases that failed, and of those that gave a warning; number and warning of the
  !> first of these; the total cost.
  type :: sweep_tally_t
    integer :: failed = 0, warned = 0, first_warned = 0
    character(len=failure_width) :: warning = ''
    type(cost_t) :: cost
  contains
    procedure :: add
  end type sweep_tally_t

contains

  !> Adds a case; cases come in the order of their numbers.
  pure subroutine add(self, case)
    class(sweep_tally_t), intent(inout) :: self
    type(case_t), intent(in) :: case

    self%cost = sum_of(self%cost, case%cost)
    if (.not. case%converged) self%failed = self%failed + 1
    if (case%warning == '') return
    self%warned = self%warned + 1
    if (self%warned > 1) return
    self%first_warned = case%number
    self%warning = case%warning
  end subroutine add

  !> The total cost of two cases.
  pure type(cost_t) function sum_of(a, b) result(total)
    type(cost_t), intent(in) :: a, b

    total%operator_products = a%operator_products + b%operator_products
    total%operator_columns = a%operator_columns + b%operator_columns
    total%pressure_evaluations = a%pressure_evaluations + b%pressure_evaluations
    total%factorisations = a%factorisations + b%factorisations
    total%iterations = a%iterations + b%iterations
    total%kernel_entries = a%kernel_entries + b%kernel_entries
    total%states = a%states + b%states
    total%rejected_steps = a%rejected_steps + b%rejected_steps
    total%kernel_seconds = a%kernel_seconds + b%kernel_seconds
    total%solve_seconds = a%solve_seconds + b%solve_seconds
    total%estimate_seconds = a%estimate_seconds + b%estimate_seconds
  end function sum_of

end module sweep_tally
