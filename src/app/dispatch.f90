!> Distributes the cases of a sweep over processes, in batches that take about `batch_seconds` each,
!> so that there are few messages, however short a case is.
module dispatch
  use kinds, only: wp
  use byte_record, only: byte_record_t
  use ranks, only: crew_t
  implicit none
  private
  public :: foreman_t, worker_t, hand_out, work_through, dismiss

  !> Provides cases and takes their answers.
  type, abstract :: foreman_t
  contains
    procedure(put_case), deferred :: put_next
    procedure(take_case), deferred :: take_answer
  end type foreman_t

  !> Computes a batch of cases.
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

    !> Takes `cases` cases of the given job from a batch and adds the answer of each to `answers`.
    !> seconds: the time that this took.
    subroutine work(self, job, cases, batch, answers, seconds)
      import :: worker_t, byte_record_t, wp
      class(worker_t), intent(inout) :: self
      integer, intent(in) :: job, cases
      type(byte_record_t), intent(inout) :: batch, answers
      real(wp), intent(out) :: seconds
    end subroutine work
  end interface

  !> Seconds of work in a message, and its largest number of cases.
  real(wp), parameter :: batch_seconds = 0.05_wp
  integer, parameter :: most_cases = 10000
  !> The job number that ends a worker.
  integer, parameter :: no_job = 0

contains

  !> Has the workers of a crew compute all cases of a job, which has a number above 0. threads: the
  !> number of cases that a worker computes at once. messages: the number of messages sent.
  subroutine hand_out(crew, job, foreman, threads, messages)
    type(crew_t), intent(in) :: crew
    integer, intent(in) :: job, threads
    class(foreman_t), intent(inout) :: foreman
    integer, intent(out), optional :: messages
    type(byte_record_t) :: answers
    real(wp) :: seconds
    integer :: goal(crew%workers), from, cases, busy, sent, i

    busy = 0
    sent = 0
    goal = threads
    do from = 1, crew%workers
      call give(from)
    end do
    do while (busy > 0)
      call crew%receive(answers, from)
      busy = busy - 1
      call answers%pass(cases)
      call answers%pass(seconds)
      do i = 1, cases
        call foreman%take_answer(answers)
      end do
      ! At most twice as many cases as in the last batch, since cases differ.
      goal(from) = max(threads, min(2*goal(from), most_cases, &
        nint(min(batch_seconds*cases/max(seconds, 1.0e-9_wp), real(most_cases, wp)))))
      call give(from)
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
      call crew%send(message, to)
      busy = busy + 1
      sent = sent + 1
    end subroutine give

  end subroutine hand_out

  !> Computes batches until there are no more.
  subroutine work_through(crew, worker)
    type(crew_t), intent(in) :: crew
    class(worker_t), intent(inout) :: worker
    type(byte_record_t) :: batch, answers, message
    real(wp) :: seconds
    integer :: job, cases, from

    do
      call crew%receive(batch, from)
      call batch%pass(job)
      if (job == no_job) return
      call batch%pass(cases)
      call answers%clear()
      call worker%work(job, cases, batch, answers, seconds)
      call message%clear()
      call message%pass(cases)
      call message%pass(seconds)
      call message%add(answers%words(:answers%held))
      call crew%send(message, from)
    end do
  end subroutine work_through

  !> Tells the workers of a crew that there is no more work.
  subroutine dismiss(crew)
    type(crew_t), intent(in) :: crew
    type(byte_record_t) :: message
    integer :: to

    call message%pass(no_job)
    do to = 1, crew%workers
      call crew%send(message, to)
    end do
  end subroutine dismiss

end module dispatch
