!> A team of processes that are forked from this one and compute for it. They are needed because a
!> fit makes strings, which threads may not do at the same time (compiler note 4), while processes
!> may.
module forks
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: long
  use failure, only: failure_t
  use byte_record, only: byte_record_t
  use c_library, only: c_read, c_write, c_close, check_status
  use teams, only: team_t
  implicit none
  private
  public :: forked_team_t, can_fork

  !> Largest number of processes; the same number stands in `forks.c`.
  integer, parameter :: most_forks = 1024

  !> rank: 0 for the process that forks, 1, 2, ... for the forked ones. reading, writing: the
  !> descriptors of the pipes from and to process 0; in process 0, those from and to each other
  !> process.
  type, extends(team_t) :: forked_team_t
    integer(c_int), allocatable, private :: reading(:), writing(:), child(:)
  contains
    procedure :: fork
    procedure :: send
    procedure :: receive
    procedure :: leave
  end type forked_team_t

  interface
    !> 1 if the system can fork processes, otherwise 0.
    integer(c_int) function c_can_fork() bind(c, name='snapin_can_fork')
      import :: c_int
    end function c_can_fork

    !> Forks a process. In the new process the result is 0, and no file is open except the standard
    !> streams; otherwise the result is the number of the new process. reading, writing: the pipes
    !> between the two.
    integer(c_int) function c_fork(reading, writing) bind(c, name='snapin_fork')
      import :: c_int
      integer(c_int), intent(out) :: reading, writing
    end function c_fork

    !> Waits until one of the descriptors has data to read; returns its index, counted from 0.
    integer(c_int) function c_ready(reading, count) bind(c, name='snapin_ready')
      import :: c_int
      integer(c_int), intent(in) :: reading(*)
      integer(c_int), value :: count
    end function c_ready

    !> Waits until a forked process has ended.
    subroutine c_await(child) bind(c, name='snapin_await')
      import :: c_int
      integer(c_int), value :: child
    end subroutine c_await

    !> Ends this process at once.
    subroutine c_quit() bind(c, name='snapin_quit')
    end subroutine c_quit
  end interface

contains

  !> Whether the system can fork processes.
  logical function can_fork()
    can_fork = c_can_fork() == 1
  end function can_fork

  !> Forks `count` processes. A forked process returns with its rank, and must end with `leave`.
  subroutine fork(self, count, error)
    class(forked_team_t), intent(inout) :: self
    integer, intent(in) :: count
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: reading, writing, child
    integer :: i

    allocate (self%reading(0), self%writing(0), self%child(0))
    do i = 1, min(count, most_forks)
      child = c_fork(reading, writing)
      call check_status('cannot start a process', child, error)
      if (allocated(error)) return
      if (child == 0) then
        self%rank = i
        self%reading = [reading]
        self%writing = [writing]
        return
      end if
      self%reading = [self%reading, reading]
      self%writing = [self%writing, writing]
      self%child = [self%child, child]
      self%workers = i
    end do
  end subroutine fork

  !> Sends a record: its length, then its words.
  subroutine send(self, record, to)
    class(forked_team_t), intent(in) :: self
    type(byte_record_t), intent(in) :: record
    integer, intent(in) :: to
    integer(long) :: words(record%held + 1)
    integer(c_int) :: status

    words(1) = record%held
    words(2:) = record%words(:record%held)
    ! If the other process has ended, this is noticed when the next record is received.
    status = c_write(self%writing(max(1, to)), bytes_of(words), &
      int(storage_size(words)/8*size(words), c_long))
  end subroutine send

  !> Waits for a record from any process. from = -1: a process has ended, or this process is no
  !> longer needed.
  subroutine receive(self, record, from)
    class(forked_team_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: record
    integer, intent(out) :: from
    character(len=:), allocatable :: bytes
    integer(long) :: length(1)
    integer, parameter :: letters = storage_size(0_long)/8
    integer :: i

    from = -1
    i = 1
    if (self%rank == 0) i = c_ready(self%reading, size(self%reading, kind=c_int)) + 1
    if (i < 1) return
    allocate (character(len=letters) :: bytes)
    if (c_read(self%reading(i), bytes, int(len(bytes), c_long)) < len(bytes)) return
    length = transfer(bytes, length)
    deallocate (bytes)
    allocate (character(len=letters*length(1)) :: bytes)
    if (c_read(self%reading(i), bytes, int(len(bytes), c_long)) < len(bytes)) return
    call record%fill(transfer(bytes, length, int(length(1))))
    from = merge(i, 0, self%rank == 0)
  end subroutine receive

  !> In a forked process, ends it. In process 0, ends the forked processes and waits for them.
  subroutine leave(self)
    class(forked_team_t), intent(inout) :: self
    integer(c_int) :: closed
    integer :: i

    if (self%rank > 0) call c_quit()
    do i = 1, size(self%child)
      closed = c_close(self%writing(i))
    end do
    do i = 1, size(self%child)
      call c_await(self%child(i))
      closed = c_close(self%reading(i))
    end do
    self%workers = 0
  end subroutine leave

  !> Words converted to bytes.
  pure function bytes_of(words) result(bytes)
    integer(long), intent(in) :: words(:)
    character(len=storage_size(words)/8*size(words)) :: bytes

    bytes = transfer(words, bytes)
  end function bytes_of

end module forks
