!> One case of a sweep: its computation, its record, and the tally of all cases.
module sweep_case
  use kinds, only: wp, long, nan
  use clock, only: thread_seconds
  use text, only: first_line
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use experiment_result, only: experiment_result_t
  use experiment, only: run_experiment
  use scene_problem, only: problem_of
  use equilibrium, only: cost_t
  use records, only: observer_t
  use progress, only: progress_t
  use summarise, only: summary_of
  use summary, only: summary_t
  use case_columns, only: numbers_of
  use cost_columns, only: costs_of
  use mesh_store, only: mesh_store_t
  use fit_columns, only: verdicts
  use byte_record, only: byte_record_t
  implicit none
  private
  public :: case_t, case_observer_t, sweep_tally_t, pass_case, pass_task, run_case

  !> Largest number of characters of a warning, or of the reason of a failure.
  integer, parameter :: failure_width = 400
  !> A case whose cost is measured is repeated until all its runs together take this time [s], but
  !> at most `most_runs` times. Repetition is needed because the first run of a case is slower.
  real(wp), parameter :: enough_seconds = 0.1_wp
  integer, parameter :: most_runs = 7

  !> One case, kept until its row is written.
  type :: case_t
    !> Number of the case; 0 without a case.
    integer :: number = 0
    !> Values of the sweep's keys; text of the key that holds a text.
    real(wp), allocatable :: values(:)
    character(len=:), allocatable :: text
    !> For a fit: the values of another curve, from which it starts; empty if there are none. The
    !> verdict on the fit.
    real(wp), allocatable :: like(:)
    integer :: verdict = 0
    logical :: converged = .false.
    !> The numbers of `numbers_of`, followed by those of `numbers_of_fit` if the case is a fit.
    real(wp), allocatable :: numbers(:)
    !> The row of costs.csv, from `costs_of`; empty if costs are not measured.
    real(wp), allocatable :: costs(:)
    !> Reason of a failure; first warning of a case that did not fail. The length is not deferred:
    !> compiler note 4.
    character(len=failure_width) :: failure = '', warning = ''
    type(cost_t) :: cost
  end type case_t

  !> Shows what is computed at present for a case, or for all cases (case 0); ignores records.
  type, extends(observer_t) :: case_observer_t
    integer :: case = 0
    type(progress_t), pointer :: progress => null()
  contains
    procedure :: hear
  end type case_observer_t

  !> The number of cases that failed, and of those with a warning; number and warning of the first
  !> one with a warning; for fits, the number of each verdict; the total cost.
  type :: sweep_tally_t
    integer :: failed = 0, warned = 0, first_warned = 0, verdict(size(verdicts)) = 0
    character(len=failure_width) :: warning = ''
    type(cost_t) :: cost
  contains
    procedure :: add
  end type sweep_tally_t

contains

  !> Computes the case with the given number, values and text of the scene's sweep, on meshes that
  !> all cases share. If costs are measured, the case has meshes of its own, and only one thread
  !> computes at a time.
  subroutine run_case(scene, progress, store, case)
    type(scene_t), intent(in) :: scene
    type(progress_t), intent(in), target :: progress
    type(mesh_store_t), intent(inout) :: store
    type(case_t), intent(inout) :: case

    if (scene%sweep%costs) then
      !$omp critical (one_measured)
      call compute_case(scene, progress, case=case)
      !$omp end critical (one_measured)
    else
      call compute_case(scene, progress, store, case)
    end if
  end subroutine run_case

  !> Computes the case, on meshes of `store` if it is given. The measured time is that of the
  !> experiments, without reading the deck and tabulating layers, which do not depend on the
  !> accuracy.
  subroutine compute_case(scene, progress, store, case)
    type(scene_t), intent(in) :: scene
    type(progress_t), intent(in), target :: progress
    type(mesh_store_t), intent(inout), optional :: store
    type(case_t), intent(inout) :: case
    type(case_observer_t) :: observer
    type(scene_t) :: variant
    type(problem_t) :: problem
    type(experiment_result_t) :: outcome
    type(summary_t) :: summary
    type(failure_t), allocatable :: error
    real(wp) :: took

    observer%case = case%number
    observer%progress => progress
    case%failure = ''
    case%warning = ''
    took = nan
    ! Only one thread at a time makes strings: compiler note 4.
    !$omp critical (one_at_a_time)
    call swept_scene(scene, scene%sweep%names, case%values, variant, error, case%text)
    !$omp end critical (one_at_a_time)
    call summary%set('converged', .false.)
    if (.not. allocated(error)) then
      problem = problem_of(variant)
      call run_timed()
    end if
    !$omp critical (one_at_a_time)
    if (.not. allocated(error)) summary = summary_of(variant, problem, outcome)
    case%numbers = numbers_of(summary, scene)
    case%costs = [real(wp) ::]
    if (scene%sweep%costs) then
      call summary%take_cost(outcome%cost)
      case%costs = costs_of(summary, scene, took)
    end if
    case%converged = summary%is_true('converged')
    if (allocated(error)) then
      case%failure = first_line(error%message)
    else if (.not. case%converged) then
      case%failure = 'not converged'
      if (size(summary%warnings) > 0) case%failure = summary%warnings(1)%text
      if (allocated(summary%failure)) case%failure = summary%failure
    else if (size(summary%warnings) > 0) then
      case%warning = summary%warnings(1)%text
    end if
    !$omp end critical (one_at_a_time)
    case%cost = outcome%cost

  contains

    !> Runs the experiment. If costs are measured, it runs several times, and the shortest time
    !> counts.
    subroutine run_timed()
      type(experiment_result_t) :: again
      real(wp) :: began, total
      integer :: i

      began = thread_seconds()
      call run_experiment(variant, problem, observer, outcome, store=store)
      took = thread_seconds() - began
      if (.not. scene%sweep%costs) return
      total = took
      do i = 2, most_runs
        if (total > enough_seconds) exit
        began = thread_seconds()
        call run_experiment(variant, problem, observer, again)
        began = thread_seconds() - began
        total = total + began
        if (began >= took) cycle
        took = began
        outcome%cost = again%cost
      end do
    end subroutine run_timed

  end subroutine compute_case

  !> The text is written to a variable, since threads share the strings of expressions: compiler
  !> note 4.
  subroutine hear(self, what)
    class(case_observer_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    character(len=80) :: label

    label = what
    if (self%case > 0) write (label, '(a, i0, 2a)') 'case ', self%case, ': ', what
    call self%progress%detail(label)
  end subroutine hear

  !> Writes the input of a case to a record, or reads it from a record.
  subroutine pass_task(record, case)
    type(byte_record_t), intent(inout) :: record
    type(case_t), intent(inout) :: case

    call record%pass(case%number)
    call record%pass(case%values)
    call record%pass(case%text)
    call record%pass(case%like)
  end subroutine pass_task

  !> Writes the results of a case to a record, or reads them from a record.
  subroutine pass_case(record, case)
    type(byte_record_t), intent(inout) :: record
    type(case_t), intent(inout) :: case

    call record%pass(case%number)
    call record%pass(case%converged)
    call record%pass(case%numbers)
    call pass_text(case%failure)
    call pass_text(case%warning)
    call pass_cost(case%cost)
    call record%pass(case%values)
    call record%pass(case%text)
    call record%pass(case%verdict)
    call record%pass(case%costs)

  contains

    subroutine pass_text(text)
      character(len=*), intent(inout) :: text
      character(len=:), allocatable :: passed

      passed = trim(text)
      call record%pass(passed)
      text = passed
    end subroutine pass_text

    !> The cost is passed as words: all its components are numbers of one word.
    subroutine pass_cost(cost)
      type(cost_t), intent(inout) :: cost
      integer(long) :: words(storage_size(cost)/storage_size(0_long))

      words = transfer(cost, words)
      call record%pass(words)
      cost = transfer(words, cost)
    end subroutine pass_cost

  end subroutine pass_case

  !> Adds a case to the tally; cases come in the order of their numbers.
  pure subroutine add(self, case)
    class(sweep_tally_t), intent(inout) :: self
    type(case_t), intent(in) :: case

    self%cost = sum_of(self%cost, case%cost)
    if (.not. case%converged) self%failed = self%failed + 1
    if (case%verdict > 0) self%verdict(case%verdict) = self%verdict(case%verdict) + 1
    if (case%warning == '') return
    self%warned = self%warned + 1
    if (self%warned > 1) return
    self%first_warned = case%number
    self%warning = case%warning
  end subroutine add

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

end module sweep_case
