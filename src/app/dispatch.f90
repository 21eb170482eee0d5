!> Distributes the cases of a sweep over processes. A batch of cases takes about `batch_seconds`, so
!> that there are few messages even if cases are short.
module dispatch
  use kinds, only: wp
  use byte_record, only: byte_record_t
  use teams, only: team_t
  implicit none
  private
  public :: foreman_t, worker_t, hand_out, work_through, dismiss

  !> Provides the cases and takes the answers to them.
  type, abstract :: foreman_t
  contains
    procedure(put_case), deferred :: put_next
    procedure(take_case), deferred :: take_answer
  end type foreman_t

  !> Computes the cases of a batch.
  type, abstract :: worker_t
  contains
    procedure(work), deferred :: work
  end type worker_t

  abstract interface
    !> Adds the next case to a batch. found = .false. if there are no more.
    subroutine put_case(self, batch, found)
      import :: foreman_t, byte_record_t
      class(foreman_t), intent(inout) :: self
      type(byte_record_t), intent(inout) :: batch
      logical, intent(out) :: found
    end subroutine put_case

    !> Takes the answer of one case.
    subroutine take_case(self, answers)
      import :: foreman_t, byte_record_t
      class(foreman_t), intent(inout) :: self
      type(byte_record_t), intent(inout) :: answers
    end subroutine take_case

    !> Takes `cases` cases of the given job from a batch, computes them, and adds the answer of each
    !> to `answers`. seconds: the time that this took.
    subroutine work(self, job, cases, batch, answers, seconds)
      import :: worker_t, byte_record_t, wp
      class(worker_t), intent(inout) :: self
      integer, intent(in) :: job, cases
      type(byte_record_t), intent(inout) :: batch, answers
      real(wp), intent(out) :: seconds
    end subroutine work
  end interface

  !> Computing time of a batch [s]; largest number of cases in a batch.
  real(wp), parameter :: batch_seconds = 0.05_wp
  integer, parameter :: most_cases = 10000
  !> The number of a job that tells a worker to stop.
  integer, parameter :: no_job = 0

contains

  !> Distributes all cases of a job among the workers of a team. job: its number, above 0. threads:
  !> the number of cases that a worker computes at the same time. messages: the number of messages
  !> sent. lost: a worker has ended, and not all cases have an answer.
  subroutine hand_out(team, job, foreman, threads, messages, lost)
    class(team_t), intent(inout) :: team
    integer, intent(in) :: job, threads
    class(foreman_t), intent(inout) :: foreman
    integer, intent(out), optional :: messages
    logical, intent(out), optional :: lost
    type(byte_record_t) :: answers
    real(wp) :: seconds
    logical :: idle(team%workers)
    integer :: goal(team%workers), from, cases, sent, i

    if (present(lost)) lost = .false.
    sent = 0
    goal = threads
    idle = .true.
    do
      ! After an answer more than one case may become available.
      do i = 1, team%workers
        if (idle(i)) call give(i)
      end do
      if (all(idle)) exit
      call team%receive(answers, from)
      if (from < 1) then
        if (present(lost)) lost = .true.
        exit
      end if
      idle(from) = .true.
      call answers%pass(cases)
      call answers%pass(seconds)
      do i = 1, cases
        call foreman%take_answer(answers)
      end do
      ! A batch has at most twice as many cases as the last one, since computing times differ.
      goal(from) = max(threads, min(2*goal(from), most_cases, &
        nint(batch_seconds*cases/max(seconds, batch_seconds*cases/most_cases))))
    end do
    if (present(messages)) messages = sent

  contains

    !> Sends the next batch to a worker, if there are cases left.
    subroutine give(to)
      integer, intent(in) :: to
      type(byte_record_t) :: batch, message
      logical :: found
      integer :: held

      do held = 0, goal(to) - 1
        call foreman%put_next(batch, found)
        if (.not. found) exit
      end do
      if (held == 0) return
      call message%pass(job)
      call message%pass(held)
      call message%add(batch%words(:batch%held))
      call team%send(message, to)
      idle(to) = .false.
      sent = sent + 1
    end subroutine give

  end subroutine hand_out

  !> Computes batches until there are no more cases.
  subroutine work_through(team, worker)
    class(team_t), intent(inout) :: team
    class(worker_t), intent(inout) :: worker
    type(byte_record_t) :: batch, answers, message
    real(wp) :: seconds
    integer :: job, cases, from

    do
      call team%receive(batch, from)
      if (from < 0) return
      call batch%pass(job)
      if (job == no_job) return
      call batch%pass(cases)
      call answers%clear()
      call worker%work(job, cases, batch, answers, seconds)
      call message%clear()
      call message%pass(cases)
      call message%pass(seconds)
      call message%add(answers%words(:answers%held))
      call team%send(message, from)
    end do
  end subroutine work_through

  !> Tells the workers of a team that there are no more cases.
  subroutine dismiss(team)
    class(team_t), intent(in) :: team
    type(byte_record_t) :: message
    integer :: to

    call message%pass(no_job)
    do to = 1, team%workers
      call team%send(message, to)
    end do
  end subroutine dismiss

end module dispatch
