!> A sweep: its cases (`case_queue`) are distributed over the cores, or over the processes of a
!> crew.
module sweeps
  use kinds, only: wp
  use failure, only: failure_t, fail, file_trouble
  use clock, only: clock_now => seconds
  use linear_algebra, only: claim_buffers
  use scene_groups, only: scene_t
  use sweep_case, only: case_t, sweep_tally_t, pass_case, pass_task, run_case
  use case_fit, only: run_fit_case, fit_together
  use joint_fit, only: joint_fit_t
  use case_queue, only: case_queue_t
  use progress, only: progress_t
  use case_columns, only: columns_of
  use cost_columns, only: cost_columns_of
  use mesh_store, only: mesh_store_t
  use byte_record, only: byte_record_t
  use curve_index, only: curve_index_t
  use forks, only: forked_team_t, can_fork
  use results, only: results_t
  use machine, only: thread_count
  use ranks, only: crew_t
  use dispatch, only: worker_t, hand_out, work_through
  implicit none
  private
  public :: run_sweep, work_on_sweeps

  !> Computes cases of the sweeps of several scenes; the number of a job is the index of its scene.
  type, extends(worker_t) :: sweep_worker_t
    type(scene_t), pointer :: scenes(:) => null()
    integer :: job = 0
    !> The meshes of the present job, and the index of the curves in its file.
    type(mesh_store_t), allocatable :: store
    type(curve_index_t) :: index
  contains
    procedure :: work
  end type sweep_worker_t

contains

  !> Computes all cases of scene%sweep and writes their rows to `results`, in the order of the
  !> cases. If the crew has workers, these compute the cases; `job` is the number of the scene for
  !> them. Cases in the journal of the results are complete, in any order; further cases are
  !> appended when they are complete. The row of a failed case gives the reason of the failure.
  !> After an error in writing no further case is begun. joint: the fit of curves that are fitted
  !> together.
  subroutine run_sweep(scene, crew, job, results, tally, joint)
    type(scene_t), intent(in), target :: scene
    type(crew_t), intent(inout) :: crew
    integer, intent(in) :: job
    type(results_t), intent(inout), target :: results
    type(sweep_tally_t), intent(out) :: tally
    type(joint_fit_t), intent(out) :: joint
    type(case_queue_t) :: queue
    type(mesh_store_t) :: store
    type(failure_t), allocatable :: error
    logical :: is_joint

    is_joint = .false.
    if (allocated(scene%fit)) is_joint = scene%fit%is_joint()
    queue%scene => scene
    queue%results => results
    queue%columns = columns_of(scene)
    if (scene%sweep%costs) queue%cost_columns = cost_columns_of(scene)
    call queue%begin()
    if (allocated(scene%sweep%file)) call queue%rows%open(scene%sweep%file%path, scene%deck, error)
    if (allocated(error)) then
      call move_alloc(error, results%trouble)
    else if (is_joint) then
      call complete_together(queue, joint)
    else if (crew%workers > 0) then
      ! A process fits one curve at a time.
      call hand_out(crew, job, queue, merge(1, thread_count(), allocated(scene%fit)))
    else if (allocated(scene%fit) .and. min(thread_count(), scene%sweep%cases()) > 1 .and. &
      can_fork()) then
      call fit_in_processes(scene, queue, results%trouble)
    else if (allocated(scene%fit)) then
      call complete_cases(queue, store)
    else
      ! Each case has one thread, which also computes its kernels and its linear algebra.
      !$omp parallel
      call complete_cases(queue, store)
      !$omp end parallel
    end if
    tally = queue%tally
  end subroutine run_sweep

  !> Fits curves in as many processes as there would be threads. Threads would not do, since only
  !> one at a time may make strings.
  subroutine fit_in_processes(scene, queue, trouble)
    type(scene_t), intent(in) :: scene
    type(case_queue_t), intent(inout) :: queue
    type(failure_t), allocatable, intent(inout) :: trouble
    type(forked_team_t) :: team
    type(sweep_worker_t) :: worker
    type(failure_t), allocatable :: error
    type(scene_t), allocatable, target :: scenes(:)
    logical :: lost

    allocate (scenes(1))
    scenes(1) = scene
    call team%fork(min(thread_count(), scene%sweep%cases()), error)
    if (team%rank > 0) then
      worker%scenes => scenes
      call work_through(team, worker)
      call team%leave()
    end if
    lost = .false.
    if (.not. allocated(error)) call hand_out(team, 1, queue, 1, lost=lost)
    call team%leave()
    if (lost) call fail(error, file_trouble, 'a process that fitted curves has been ended')
    if (allocated(error) .and. .not. allocated(trouble)) call move_alloc(error, trouble)
  end subroutine fit_in_processes

  !> Fits the curves of all cases together, in this process.
  subroutine complete_together(queue, joint)
    type(case_queue_t), intent(inout) :: queue
    type(joint_fit_t), intent(out) :: joint
    type(case_t), allocatable :: case(:)
    type(case_t) :: further
    logical :: found
    integer :: i

    allocate (case(queue%scene%sweep%cases()))
    do i = 1, size(case)
      call queue%next(case(i), found)
      if (.not. found) return
    end do
    ! If the file has further rows, it has changed.
    call queue%next(further, found)
    if (allocated(queue%results%trouble)) return
    call fit_together(queue%scene, queue%results%progress, case, joint)
    do i = 1, size(case)
      call queue%enter(case(i))
    end do
  end subroutine complete_together

  !> Computes cases until there are no more. Several threads execute this at the same time.
  subroutine complete_cases(queue, store)
    type(case_queue_t), intent(inout) :: queue
    type(mesh_store_t), intent(inout) :: store
    type(case_t) :: case
    type(curve_index_t) :: index
    logical :: found

    if (allocated(queue%scene%fit)) index = queue%scene%sweep%index
    do
      !$omp critical (one_at_a_time)
      call queue%next(case, found)
      !$omp end critical (one_at_a_time)
      if (.not. found) exit
      if (allocated(queue%scene%fit)) then
        call run_fit_case(queue%scene, queue%results%progress, index, case)
      else
        call run_case(queue%scene, queue%results%progress, store, case)
      end if
      !$omp critical (one_at_a_time)
      call queue%enter(case)
      !$omp end critical (one_at_a_time)
    end do
  end subroutine complete_cases

  !> Computes the batches of cases of `scenes` that the crew's first process hands out.
  subroutine work_on_sweeps(crew, scenes)
    type(crew_t), intent(inout) :: crew
    type(scene_t), intent(in), target :: scenes(:)
    type(sweep_worker_t) :: worker

    call claim_buffers()
    worker%scenes => scenes
    call work_through(crew, worker)
  end subroutine work_on_sweeps

  !> Computes a batch with all threads.
  subroutine work(self, job, cases, batch, answers, seconds)
    class(sweep_worker_t), intent(inout) :: self
    integer, intent(in) :: job, cases
    type(byte_record_t), intent(inout) :: batch, answers
    real(wp), intent(out) :: seconds
    type(case_t), allocatable :: of_batch(:)
    type(progress_t) :: unseen
    integer :: i

    if (job /= self%job .and. allocated(self%store)) deallocate (self%store)
    if (.not. allocated(self%store)) then
      allocate (self%store)
      self%index = self%scenes(job)%sweep%index
    end if
    self%job = job
    allocate (of_batch(cases))
    do i = 1, cases
      call pass_task(batch, of_batch(i))
    end do
    seconds = clock_now()
    !$omp parallel do schedule(dynamic, 1) if(.not. allocated(self%scenes(job)%fit))
    do i = 1, cases
      if (allocated(self%scenes(job)%fit)) then
        call run_fit_case(self%scenes(job), unseen, self%index, of_batch(i))
      else
        call run_case(self%scenes(job), unseen, self%store, of_batch(i))
      end if
    end do
    !$omp end parallel do
    seconds = clock_now() - seconds
    do i = 1, cases
      call pass_case(answers, of_batch(i))
    end do
  end subroutine work

end module sweeps
