!> The crew of a build with MPI.
module ranks
  use, intrinsic :: iso_c_binding, only: c_int
  use mpi_f08, only: mpi_init, mpi_finalize, mpi_comm_rank, mpi_comm_size, mpi_allreduce, &
    mpi_iprobe, mpi_get_count, mpi_send, mpi_recv, mpi_status, mpi_comm_world, mpi_any_source, &
    mpi_integer, mpi_integer8, mpi_min
  use kinds, only: long
  use failure, only: failure_t, fail, bad_input
  use byte_record, only: byte_record_t
  use teams, only: team_t
  use c_library, only: c_pause
  use launch, only: started_together, own_rank
  implicit none
  private
  public :: crew_t

  !> The processes that were started together. A single process has number 0 and no workers.
  type, extends(team_t) :: crew_t
  contains
    procedure :: begin
    procedure :: end => end_crew
    procedure :: first_of
    procedure :: send
    procedure :: receive
  end type crew_t

  !> The tag of all messages.
  integer, parameter :: tag = 1
  !> Microseconds between polls for a message: the first interval, and the longest. MPI's own
  !> waiting would occupy a whole core.
  integer(c_int), parameter :: shortest = 10, longest = 200

contains

  !> Joins the processes that were started together. For a single process MPI is not used. Fails if
  !> MPI does not know the other processes.
  subroutine begin(self, error)
    class(crew_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error
    integer :: processes

    self%workers = 0
    if (started_together() <= 1) return
    call mpi_init()
    call mpi_comm_size(mpi_comm_world, processes)
    call mpi_comm_rank(mpi_comm_world, self%rank)
    self%workers = processes - 1
    if (processes > 1) return
    call mpi_finalize()
    self%rank = own_rank()
    call fail(error, bad_input, 'mpirun belongs to another MPI than the one that snapin was ' // &
      'built with; use the mpirun of that one')
  end subroutine begin

  !> Waits for all processes. If a process ends without this call, MPI terminates all of them.
  subroutine end_crew(self)
    class(crew_t), intent(inout) :: self

    if (self%workers > 0) call mpi_finalize()
    self%workers = 0
  end subroutine end_crew

  !> The lowest number of a process for which `true` holds, or -1. All processes must call this
  !> function.
  integer function first_of(self, true)
    class(crew_t), intent(in) :: self
    logical, intent(in) :: true
    integer :: mine

    mine = merge(self%rank, huge(mine), true)
    first_of = mine
    if (self%workers > 0) &
      call mpi_allreduce(mine, first_of, 1, mpi_integer, mpi_min, mpi_comm_world)
    if (first_of == huge(mine)) first_of = -1
  end function first_of

  !> Sends a record to a process that waits for one.
  subroutine send(self, record, to)
    class(crew_t), intent(in) :: self
    type(byte_record_t), intent(in) :: record
    integer, intent(in) :: to

    if (to > self%workers) error stop 'no such process'
    call mpi_send(record%words, record%held, mpi_integer8, to, tag, mpi_comm_world)
  end subroutine send

  !> Waits for a record from any process. from: the number of this process.
  subroutine receive(self, record, from)
    class(crew_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: record
    integer, intent(out) :: from
    integer(long), allocatable :: words(:)
    type(mpi_status) :: status
    logical :: there
    integer(c_int) :: pause
    integer :: length

    from = self%rank
    pause = shortest
    do
      call mpi_iprobe(mpi_any_source, tag, mpi_comm_world, there, status)
      if (there) exit
      call c_pause(pause)
      pause = min(2*pause, longest)
    end do
    from = status%mpi_source
    call mpi_get_count(status, mpi_integer8, length)
    allocate (words(length))
    call mpi_recv(words, length, mpi_integer8, from, tag, mpi_comm_world, status)
    call record%fill(words)
  end subroutine receive

end module ranks
