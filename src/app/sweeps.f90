!> The cases of a sweep, distributed over the cores, or over the processes of a crew. Each case is
!> one row: the values of its keys, and its numbers.
module sweeps
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input, file_trouble
  use clock, only: clock_now => seconds
  use linear_algebra, only: claim_buffers
  use scene_groups, only: scene_t
  use sweep_case, only: case_t, sweep_tally_t, pass_case, run_case
  use case_rows, only: case_rows_t
  use progress, only: progress_t
  use case_columns, only: columns_of, column_width
  use mesh_store, only: mesh_store_t
  use byte_record, only: byte_record_t
  use results, only: results_t
  use machine, only: thread_count
  use ranks, only: crew_t
  use dispatch, only: foreman_t, worker_t, hand_out, work_through
  implicit none
  private
  public :: run_sweep, work_on_sweeps

  !> The cases of a sweep: number of cases handed out, cases that wait for the rows before theirs,
  !> number of rows written, and the tally of these. `waiting` has a case at its number modulo the
  !> array's size.
  type, extends(foreman_t) :: queue_t
    type(scene_t), pointer :: scene => null()
    type(results_t), pointer :: results => null()
    character(len=column_width), allocatable :: columns(:)
    !> The file of the cases, if the sweep has one.
    type(case_rows_t) :: rows
    type(case_t), allocatable :: waiting(:)
    integer :: handed_out = 0, written = 0
    type(sweep_tally_t) :: tally
  contains
    procedure :: next
    procedure :: put_next
    procedure :: take_answer
    procedure :: enter
    procedure :: add
    procedure :: has
    procedure, private :: next_row
  end type queue_t

  !> Computes cases of the sweeps of several scenes; the number of a job is the index of its scene.
  type, extends(worker_t) :: sweep_worker_t
    type(scene_t), pointer :: scenes(:) => null()
    integer :: job = 0
    !> The meshes of the present job.
    type(mesh_store_t), allocatable :: store
  contains
    procedure :: work
  end type sweep_worker_t

contains

  !> Computes all cases of scene%sweep and gives their rows to `results`, in the order of the cases.
  !> The workers of the crew compute them if there are any; `job` is the number of the scene for
  !> them. Cases in results%journal are complete, in any order; further cases are appended when they
  !> end. The row of a failed case says why it failed. After an error of writing no case begins.
  subroutine run_sweep(scene, crew, job, results, tally)
    type(scene_t), intent(in), target :: scene
    type(crew_t), intent(in) :: crew
    integer, intent(in) :: job
    type(results_t), intent(inout), target :: results
    type(sweep_tally_t), intent(out) :: tally
    type(queue_t) :: queue
    type(mesh_store_t) :: store
    type(failure_t), allocatable :: error

    queue%scene => scene
    queue%results => results
    queue%columns = columns_of(scene)
    allocate (queue%waiting(0:15))
    call recall_cases(queue)
    if (allocated(scene%sweep%file)) call queue%rows%open(scene%sweep%file%path, scene%deck, error)
    if (allocated(error)) then
      call move_alloc(error, results%trouble)
    else if (crew%workers > 0) then
      call hand_out(crew, job, queue, thread_count())
    else
      ! Each case has one thread, also for its kernels and its linear algebra.
      !$omp parallel
      call complete_cases(queue, store)
      !$omp end parallel
    end if
    tally = queue%tally
  end subroutine run_sweep

  !> Computes cases until there are no more; several threads do this at once.
  subroutine complete_cases(queue, store)
    type(queue_t), intent(inout) :: queue
    type(mesh_store_t), intent(inout) :: store
    type(case_t) :: case
    logical :: found

    do
      !$omp critical (one_at_a_time)
      call queue%next(case, found)
      !$omp end critical (one_at_a_time)
      if (.not. found) exit
      call run_case(queue%scene, queue%results%progress, store, case)
      !$omp critical (one_at_a_time)
      call queue%enter(case)
      !$omp end critical (one_at_a_time)
    end do
  end subroutine complete_cases

  !> Computes the batches that a crew's first process hands out from the sweeps of `scenes`.
  subroutine work_on_sweeps(crew, scenes)
    type(crew_t), intent(in) :: crew
    type(scene_t), intent(in), target :: scenes(:)
    type(sweep_worker_t) :: worker

    call claim_buffers()
    worker%scenes => scenes
    call work_through(crew, worker)
  end subroutine work_on_sweeps

  !> Computes a batch on all threads.
  subroutine work(self, job, cases, batch, answers, seconds)
    class(sweep_worker_t), intent(inout) :: self
    integer, intent(in) :: job, cases
    type(byte_record_t), intent(inout) :: batch, answers
    real(wp), intent(out) :: seconds
    type(case_t), allocatable :: of_batch(:)
    type(progress_t) :: unseen
    integer :: i

    if (job /= self%job .and. allocated(self%store)) deallocate (self%store)
    if (.not. allocated(self%store)) allocate (self%store)
    self%job = job
    allocate (of_batch(cases))
    do i = 1, cases
      call batch%pass(of_batch(i)%number)
      call batch%pass(of_batch(i)%values)
    end do
    seconds = clock_now()
    !$omp parallel do schedule(dynamic, 1)
    do i = 1, cases
      call run_case(self%scenes(job), unseen, self%store, of_batch(i))
    end do
    !$omp end parallel do
    seconds = clock_now() - seconds
    do i = 1, cases
      call pass_case(answers, of_batch(i))
    end do
  end subroutine work

  !> The next case that is not complete. found = .false. if there is none, if results cannot be
  !> written, or if the file has changed since the deck was read.
  subroutine next(self, case, found)
    class(queue_t), intent(inout) :: self
    type(case_t), intent(inout) :: case
    logical, intent(out) :: found
    type(failure_t), allocatable :: error
    real(wp), allocatable :: rest(:)

    found = .false.
    if (allocated(self%results%trouble) .or. allocated(self%results%journal%trouble)) return
    associate (sweep => self%scene%sweep)
      do while (.not. found .and. self%handed_out < sweep%cases())
        self%handed_out = self%handed_out + 1
        case%number = self%handed_out
        if (allocated(sweep%file)) then
          call self%next_row(case%values, .false., error)
        else
          case%values = sweep%values(case%number)
        end if
        if (allocated(error)) then
          found = .false.
          call move_alloc(error, self%results%trouble)
          return
        end if
        found = .not. self%has(case%number)
      end do
      if (.not. found .and. allocated(sweep%file)) &
        call self%next_row(rest, .true., self%results%trouble)
    end associate
  end subroutine next

  !> Reads the row of the next case from the file, or, if all are `given`, what is after the last.
  !> The file was read before without a mistake, and all of its lines are compared with that
  !> reading: a changed row may be a case too. Nothing shows which cases are still of the deck, so
  !> that no run may go on from them.
  subroutine next_row(self, values, given, error)
    class(queue_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:)
    logical, intent(in) :: given
    type(failure_t), allocatable, intent(out) :: error
    logical :: found

    call self%rows%next(values, found, error)
    associate (file => self%scene%sweep%file)
      if (allocated(error)) then
        if (error%kind == file_trouble) return
      else if (given) then
        if (.not. found .and. self%rows%digest == file%digest) return
      else if (found) then
        return
      end if
      call self%results%journal%discard()
      call fail(error, bad_input, file%path // ' has changed since it was first read; start again')
    end associate
  end subroutine next_row

  subroutine put_next(self, batch, found)
    class(queue_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: batch
    logical, intent(out) :: found
    type(case_t) :: case

    call self%next(case, found)
    if (.not. found) return
    call batch%pass(case%number)
    call batch%pass(case%values)
  end subroutine put_next

  subroutine take_answer(self, answers)
    class(queue_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: answers
    type(case_t) :: case

    call pass_case(answers, case)
    call self%enter(case)
  end subroutine take_answer

  !> Takes a case that has been computed, and appends it to the journal.
  subroutine enter(self, case)
    class(queue_t), intent(inout) :: self
    type(case_t), intent(inout) :: case
    type(byte_record_t) :: record

    call pass_case(record, case)
    call self%results%journal%append(record)
    call self%add(case)
    call self%results%progress%step('case', failed=.not. case%converged)
  end subroutine enter

  !> Takes the completed cases of an interrupted run.
  subroutine recall_cases(queue)
    type(queue_t), intent(inout) :: queue
    type(byte_record_t) :: record
    type(case_t) :: case
    logical :: found

    do
      call queue%results%journal%next(record, found)
      if (.not. found) exit
      call pass_case(record, case)
      call queue%add(case)
      call queue%results%progress%step('case', failed=.not. case%converged, given=.true.)
    end do
  end subroutine recall_cases

  !> Whether a case has ended, in this run or in the interrupted one.
  pure logical function has(self, number)
    class(queue_t), intent(in) :: self
    integer, intent(in) :: number

    has = number <= self%written
    if (.not. has) has = self%waiting(mod(number, size(self%waiting)))%number == number
  end function has

  !> Adds a case that has ended, and writes all rows that are next.
  subroutine add(self, case)
    class(queue_t), intent(inout) :: self
    type(case_t), intent(in) :: case

    call make_room(self%waiting, case%number - self%written)
    self%waiting(mod(case%number, size(self%waiting))) = case
    do
      associate (first => self%waiting(mod(self%written + 1, size(self%waiting))))
        if (first%number /= self%written + 1) exit
        call self%results%take_case(self%columns, self%scene%sweep%words, first%values, &
          first%numbers, first%failure)
        call self%tally%add(first)
        first%number = 0
        deallocate (first%numbers, first%values)
      end associate
      self%written = self%written + 1
    end do
  end subroutine add

  !> Makes room for a case that is `ahead` cases after the last one written.
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

end module sweeps
