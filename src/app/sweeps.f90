!> The cases of a sweep, spread over the cores: each is one row, its keys' values and its numbers.
module sweeps
  use, intrinsic :: iso_c_binding, only: c_bool
  use kinds, only: wp
  use text, only: first_line
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use experiment_result, only: experiment_result_t
  use experiment, only: run_experiment
  use scene_problem, only: problem_of
  use equilibrium, only: cost_t
  use records, only: silent_observer_t
  use progress, only: progress_t
  use summarise, only: summary_of
  use summary, only: summary_t
  use case_columns, only: columns_of, numbers_of, column_width
  use journal, only: journal_t
  use mesh_store, only: mesh_store_t
  use byte_record, only: byte_record_t
  use state_records, only: put_cost, take_cost
  use results, only: results_t
  implicit none
  private
  public :: run_sweep

  !> Characters of what is said of a case that failed.
  integer, parameter :: failure_width = 160

  !> What is kept of one case until its row is written.
  type :: case_t
    !> Its number; 0: none.
    integer :: number = 0
    logical :: converged = .false.
    !> See `numbers_of`.
    real(wp), allocatable :: numbers(:)
    !> Why it failed; not of deferred length: compiler note 4.
    character(len=failure_width) :: failure = ''
    type(cost_t) :: cost
  end type case_t

  !> The cases that have ended before others whose rows come first; how many rows are written, how
  !> many cases have ended and failed, and what all took. A case is in `waiting` at its number, all
  !> numbers modulo the size.
  type :: queue_t
    type(case_t), allocatable :: waiting(:)
    integer :: written = 0, ended = 0, failed = 0
    type(cost_t) :: cost
  contains
    procedure :: add
  end type queue_t

  !> Says what a case is at, beside the others; takes no records.
  type, extends(silent_observer_t) :: case_observer_t
    integer :: case = 0
    type(progress_t), pointer :: progress => null()
  contains
    procedure :: hear
  end type case_observer_t

contains

  !> Computes every case of scene%sweep and hands its row to `results`, in the order of the cases.
  !> Cases that results%journal has are complete, whatever their order; the others join them as they
  !> end. A case that fails is a row that says why. Once results cannot be written no case begins.
  !> failed: how many; cost: of all together.
  subroutine run_sweep(scene, results, failed, cost)
    type(scene_t), intent(in) :: scene
    type(results_t), intent(inout), target :: results
    integer, intent(out) :: failed
    type(cost_t), intent(out) :: cost
    type(queue_t) :: queue
    type(mesh_store_t) :: store
    character(len=column_width), allocatable :: columns(:)
    logical(c_bool), allocatable :: done(:)
    integer :: i

    allocate (done(scene%sweep%cases()))
    columns = columns_of(scene)
    done = .false.
    call recall_cases(scene, columns, done, queue, results)
    ! Each case has a thread of its own: its kernels and its linear algebra use no more.
    !$omp parallel do schedule(dynamic, 1)
    do i = 1, size(done)
      if (.not. done(i)) call complete(scene, i, columns, queue, results, store)
    end do
    !$omp end parallel do
    failed = queue%failed
    cost = queue%cost
  end subroutine run_sweep

  !> Computes case i and enters it, unless results can no longer be written.
  subroutine complete(scene, i, columns, queue, results, store)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: i
    character(len=*), intent(in) :: columns(:)
    type(queue_t), intent(inout) :: queue
    type(results_t), intent(inout), target :: results
    type(mesh_store_t), intent(inout) :: store
    type(case_t) :: fresh
    type(case_observer_t) :: observer
    logical :: stopped

    !$omp critical (one_at_a_time)
    stopped = allocated(results%trouble) .or. allocated(results%journal%trouble)
    !$omp end critical (one_at_a_time)
    if (stopped) return
    observer%case = i
    observer%progress => results%progress
    call run_case(scene, i, observer, store, fresh)
    !$omp critical (one_at_a_time)
    call keep_case(results%journal, fresh)
    call queue%add(scene, columns, fresh, results)
    call results%progress%step(counted(queue%failed))
    !$omp end critical (one_at_a_time)
  end subroutine complete

  !> 'case', with how many have failed so far.
  function counted(failed) result(label)
    integer, intent(in) :: failed
    character(len=32) :: label

    label = 'case'
    if (failed > 0) write (label, '(a, i0, a)') 'case, ', failed, ' failed'
  end function counted

  !> Takes the cases that an interrupted run has completed.
  subroutine recall_cases(scene, columns, done, queue, results)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: columns(:)
    logical(c_bool), intent(inout) :: done(:)
    type(queue_t), intent(inout) :: queue
    type(results_t), intent(inout) :: results
    type(byte_record_t) :: record
    type(case_t) :: case
    character(len=:), allocatable :: failure
    logical :: found

    do
      call results%journal%next(record, found)
      if (.not. found) exit
      call record%take(case%number)
      call record%take(case%converged)
      call record%take(case%numbers)
      call record%take(failure)
      call take_cost(record, case%cost)
      case%failure = failure
      done(case%number) = .true.
      call queue%add(scene, columns, case, results)
      call results%progress%skip(counted(queue%failed))
    end do
  end subroutine recall_cases

  !> Adds a case to the journal, as `recall_cases` finds it there.
  subroutine keep_case(journal, case)
    type(journal_t), intent(inout) :: journal
    type(case_t), intent(in) :: case
    type(byte_record_t) :: record

    call record%put(case%number)
    call record%put(case%converged)
    call record%put(case%numbers)
    call record%put(trim(case%failure))
    call put_cost(record, case%cost)
    call journal%append(record)
  end subroutine keep_case

  !> Adds a case that has ended, and writes the rows whose turn it is.
  subroutine add(self, scene, columns, case, results)
    class(queue_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: columns(:)
    type(case_t), intent(in) :: case
    type(results_t), intent(inout) :: results

    self%ended = self%ended + 1
    if (.not. case%converged) self%failed = self%failed + 1
    self%cost = sum_of(self%cost, case%cost)
    if (.not. allocated(self%waiting)) allocate (self%waiting(0:15))
    call make_room(self%waiting, case%number - self%written)
    self%waiting(mod(case%number, size(self%waiting))) = case
    do
      associate (next => self%waiting(mod(self%written + 1, size(self%waiting))))
        if (next%number /= self%written + 1) exit
        call results%take_case(scene%sweep%names, scene%sweep%words, &
          scene%sweep%values(next%number), columns, next%numbers, next%failure)
        next%number = 0
        deallocate (next%numbers)
      end associate
      self%written = self%written + 1
    end do
  end subroutine add

  !> Lets a case wait that comes so many after the last one written.
  subroutine make_room(waiting, ahead)
    type(case_t), allocatable, intent(inout) :: waiting(:)
    integer, intent(in) :: ahead
    type(case_t), allocatable :: larger(:)
    integer :: size_needed, i

    if (ahead <= size(waiting)) return
    size_needed = size(waiting)
    do while (size_needed < ahead)
      size_needed = 2*size_needed
    end do
    allocate (larger(0:size_needed - 1))
    do i = 0, size(waiting) - 1
      if (waiting(i)%number > 0) larger(mod(waiting(i)%number, size_needed)) = waiting(i)
    end do
    call move_alloc(larger, waiting)
  end subroutine make_room

  !> Case i of the scene's sweep, on meshes that the cases share.
  subroutine run_case(scene, i, observer, store, case)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: i
    type(case_observer_t), intent(inout) :: observer
    type(mesh_store_t), intent(inout) :: store
    type(case_t), intent(out) :: case
    type(scene_t) :: variant
    type(problem_t) :: problem
    type(experiment_result_t) :: outcome
    type(summary_t) :: summary
    type(failure_t), allocatable :: error

    ! What makes strings is done by one thread at a time: compiler note 4.
    !$omp critical (one_at_a_time)
    call swept_scene(scene, scene%sweep%values(i), variant, error)
    !$omp end critical (one_at_a_time)
    call summary%set('converged', .false.)
    if (.not. allocated(error)) then
      problem = problem_of(variant)
      call run_experiment(variant, problem, observer, outcome, store=store)
    end if
    !$omp critical (one_at_a_time)
    if (.not. allocated(error)) summary = summary_of(variant, problem, outcome)
    case%number = i
    case%numbers = numbers_of(summary, scene)
    case%converged = summary%is_true('converged')
    if (allocated(error)) then
      case%failure = first_line(error%message)
    else if (.not. case%converged) then
      case%failure = 'not converged'
      if (allocated(summary%warnings)) case%failure = summary%warnings(1)%text
    end if
    !$omp end critical (one_at_a_time)
    case%cost = outcome%cost
  end subroutine run_case

  !> Into a variable, since threads share strings that are put together: compiler note 4.
  subroutine hear(self, what)
    class(case_observer_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    character(len=80) :: label

    write (label, '(a, i0, 2a)') 'case ', self%case, ': ', what
    call self%progress%detail(label)
  end subroutine hear

  !> What two cases took together.
  pure function sum_of(a, b) result(total)
    type(cost_t), intent(in) :: a, b
    type(cost_t) :: total

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

end module sweeps
