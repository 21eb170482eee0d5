!> The cases of a sweep, spread over the cores: one value of a key a case, one row of its summary.
module sweeps
  use kinds, only: wp
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

  !> What is kept of one case.
  type :: case_t
    logical :: done = .false., converged = .false.
    !> See `numbers_of`.
    real(wp), allocatable :: numbers(:)
    type(cost_t) :: cost
  end type case_t

  !> Says what a case is at, beside the others; takes no records.
  type, extends(silent_observer_t) :: case_observer_t
    integer :: case = 0
    type(progress_t), pointer :: progress => null()
  contains
    procedure :: hear
  end type case_observer_t

contains

  !> Computes every case of scene%sweep and hands its row to `results`, in the order of the values.
  !> Cases that results%journal has are complete, whatever their order; the others join them as they
  !> end. A case that fails is a row that says so. Once results cannot be written no case begins.
  !> failed: how many; cost: of all together.
  subroutine run_sweep(scene, results, failed, cost)
    type(scene_t), intent(in) :: scene
    type(results_t), intent(inout), target :: results
    integer, intent(out) :: failed
    type(cost_t), intent(out) :: cost
    type(case_t), allocatable :: cases(:)
    type(mesh_store_t) :: store
    character(len=column_width), allocatable :: columns(:)
    integer :: i, written

    allocate (cases(size(scene%sweep%values)))
    columns = columns_of(scene)
    written = 0
    call recall_cases(scene, columns, cases, written, results)
    ! Each case has a thread of its own: its kernels and its linear algebra use no more.
    !$omp parallel do schedule(dynamic, 1)
    do i = 1, size(cases)
      if (.not. cases(i)%done) call complete(scene, i, columns, cases, written, results, store)
    end do
    !$omp end parallel do
    failed = count(cases%done .and. .not. cases%converged)
    do i = 1, size(cases)
      cost = sum_of(cost, cases(i)%cost)
    end do
  end subroutine run_sweep

  !> Computes case i and enters it, unless results can no longer be written.
  subroutine complete(scene, i, columns, cases, written, results, store)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: columns(:)
    integer, intent(in) :: i
    type(case_t), intent(inout) :: cases(:)
    integer, intent(inout) :: written
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
    call run_case(scene, scene%sweep%values(i), observer, store, fresh)
    !$omp critical (one_at_a_time)
    call keep_case(results%journal, i, fresh)
    cases(i) = fresh
    call results%progress%step('case')
    call write_rows(scene, columns, cases, written, results)
    !$omp end critical (one_at_a_time)
  end subroutine complete

  !> Takes the cases that an interrupted run has completed.
  subroutine recall_cases(scene, columns, cases, written, results)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: columns(:)
    type(case_t), intent(inout) :: cases(:)
    integer, intent(inout) :: written
    type(results_t), intent(inout) :: results
    type(byte_record_t) :: record
    logical :: found
    integer :: i

    do
      call results%journal%next(record, found)
      if (.not. found) exit
      call record%take(i)
      cases(i)%done = .true.
      call record%take(cases(i)%converged)
      call record%take(cases(i)%numbers)
      call take_cost(record, cases(i)%cost)
      call results%progress%skip('case')
      call write_rows(scene, columns, cases, written, results)
    end do
  end subroutine recall_cases

  !> Adds a case to the journal, as `recall_cases` finds it there.
  subroutine keep_case(journal, i, case)
    type(journal_t), intent(inout) :: journal
    integer, intent(in) :: i
    type(case_t), intent(in) :: case
    type(byte_record_t) :: record

    call record%put(i)
    call record%put(case%converged)
    call record%put(case%numbers)
    call put_cost(record, case%cost)
    call journal%append(record)
  end subroutine keep_case

  !> Writes the rows whose turn it is, after the first `written`.
  subroutine write_rows(scene, columns, cases, written, results)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: columns(:)
    type(case_t), intent(in) :: cases(:)
    integer, intent(inout) :: written
    type(results_t), intent(inout) :: results

    do while (written < size(cases))
      if (.not. cases(written + 1)%done) exit
      written = written + 1
      call results%take_case(scene%sweep%key, scene%sweep%values(written), columns, &
        cases(written)%numbers)
    end do
  end subroutine write_rows

  !> The case of the scene with the swept key at a value, on meshes that the cases share.
  subroutine run_case(scene, value, observer, store, case)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: value
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
    call swept_scene(scene, value, variant, error)
    !$omp end critical (one_at_a_time)
    call summary%set('converged', .false.)
    if (.not. allocated(error)) then
      problem = problem_of(variant)
      call run_experiment(variant, problem, observer, outcome, store=store)
    end if
    !$omp critical (one_at_a_time)
    if (.not. allocated(error)) summary = summary_of(variant, problem, outcome)
    case%numbers = numbers_of(summary, scene)
    !$omp end critical (one_at_a_time)
    case%done = .true.
    case%converged = summary%is_true('converged')
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
