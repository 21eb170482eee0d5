!> An observer that adds the stability of each state to its record and passes it on. Only scenes
!> with &stability have one.
module stability_records
  use kinds, only: wp
  use problem, only: problem_t
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t, cost_t
  use records, only: observer_t, record_t, stable_yes, stable_no
  use journal, only: journal_t
  use packing, only: packed_t
  use packed_states, only: put_cost, take_cost
  use stability, only: smallest_eigenvalue, local_criterion, axis_criterion
  implicit none
  private
  public :: stability_recorder_t

  type, extends(observer_t) :: stability_recorder_t
    !> Whom the completed records go to.
    class(observer_t), pointer :: next => null()
    !> What the eigenvalues took.
    type(cost_t) :: cost
    !> Where they are kept.
    type(journal_t), pointer :: journal => null()
  contains
    procedure :: take
    procedure, private :: find_eigenvalue
  end type stability_recorder_t

  !> What a record of an eigenvalue begins with.
  character(len=*), parameter :: mark = 'eigenvalue'

contains

  subroutine take(self, record, problem, grid, state, profile)
    class(stability_recorder_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
    type(record_t) :: completed
    real(wp) :: eigenvalue

    completed = record
    completed%eigenvalue = 0
    completed%local_criterion = 0
    completed%axis_criterion = 0
    ! What has no residual has no derivatives either.
    if (.not. state%residual < huge(1.0_wp)) then
      call self%next%take(completed, problem, grid, state, profile)
      return
    end if
    call self%find_eigenvalue(problem, grid, state, eigenvalue)
    completed%eigenvalue = eigenvalue
    completed%local_criterion = local_criterion(problem, grid, state)
    completed%axis_criterion = axis_criterion(problem, state)
    if (record%converged) completed%stable = merge(stable_yes, stable_no, eigenvalue > 0)
    call self%next%take(completed, problem, grid, state, profile)
  end subroutine take

  !> The smallest eigenvalue of a state; from the journal, where that has it.
  subroutine find_eigenvalue(self, problem, grid, state, eigenvalue)
    class(stability_recorder_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: eigenvalue
    type(packed_t) :: record
    logical :: known

    call self%journal%next_of(mark, record, known)
    if (known) then
      call record%take(eigenvalue)
      call take_cost(record, self%cost)
      if (record%exhausted) call self%journal%reject()
    else
      call smallest_eigenvalue(problem, grid, state, eigenvalue, self%cost)
      call record%put(mark)
      call record%put(eigenvalue)
      call put_cost(record, self%cost)
      call self%journal%append(record)
    end if
  end subroutine find_eigenvalue

end module stability_records
