!> Work for many processes, handed out by one: cases in batches, of which each is to take some
!> `batch_seconds`, so that messages are few whatever a case takes.
module dispatch
  use kinds, only: wp
  use byte_record, only: byte_record_t
  use ranks, only: crew_t
  implicit none
  private
  public :: foreman_t, worker_t, hand_out, work_through, dismiss

  !> Has the cases, and takes what comes of them.
  type, abstract :: foreman_t
  contains
    procedure(put_case), deferred :: put_next
    procedure(take_case), deferred :: take_answer
  end type foreman_t

  !> Does a batch of cases.
  type, abstract :: worker_t
  contains
    procedure(work), deferred :: work
  end type worker_t

  abstract interface
    !> Adds the next case to a batch. Not found: there are no more.
    subroutine put_case(self, batch, found)
      import :: foreman_t, byte_record_t
      class(foreman_t), intent(inout) :: self
      type(byte_record_t), intent(inout) :: batch
      logical, intent(out) :: found
    end subroutine put_case

    !> Takes what came of one case.
    subroutine take_case(self, answers)
      import :: foreman_t, byte_record_t
      class(foreman_t), intent(inout) :: self
      type(byte_record_t), intent(inout) :: answers
    end subroutine take_case

    !> Takes `cases` cases of the given job from a batch and puts what comes of each into `answers`.
    !> seconds: how long that took.
    subroutine work(self, job, cases, batch, answers, seconds)
      import :: worker_t, byte_record_t, wp
      class(worker_t), intent(inout) :: self
      integer, intent(in) :: job, cases
      type(byte_record_t), intent(inout) :: batch, answers
      real(wp), intent(out) :: seconds
    end subroutine work
  end interface

  !> Seconds of work in a message, and the cases that it has at most.
  real(wp), parameter :: batch_seconds = 0.05_wp
  integer, parameter :: most_cases = 10000
  !> Stands for a job where there is none any more.
  integer, parameter :: no_job = 0

contains

  !> Has the workers of a crew do all cases of a job, which has a number above 0. threads: the cases
  !> that one of them does at a time. messages: how many were sent.
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
      ! Not from one short batch to a very long one: cases differ.
      goal(from) = max(threads, min(2*goal(from), most_cases, &
        nint(min(batch_seconds*cases/max(seconds, 1.0e-9_wp), real(most_cases, wp)))))
      call give(from)
    end do
    if (present(messages)) messages = sent

  contains

    !> Gives a worker what it is to do next, if anything is left.
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

  !> Does what is handed out until there is nothing more.
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

  !> Tells the workers of a crew that there is nothing more to do.
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
