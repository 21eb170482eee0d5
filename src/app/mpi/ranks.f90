!> The crew of a build with MPI.
module ranks
  use, intrinsic :: iso_c_binding, only: c_int
  use mpi_f08, only: mpi_init, mpi_finalize, mpi_comm_rank, mpi_comm_size, mpi_allreduce, &
    mpi_iprobe, mpi_get_count, mpi_send, mpi_recv, mpi_status, mpi_comm_world, mpi_any_source, &
    mpi_integer, mpi_integer8, mpi_min
  use kinds, only: long
  use failure, only: failure_t, fail, bad_input
  use byte_record, only: byte_record_t
  use c_library, only: c_pause
  use launch, only: started_together, own_rank
  implicit none
  private
  public :: crew_t

  !> Processes that work together, each with its number: 0 hands out what there is to do, and
  !> 1 to `workers` do it. Alone there is only 0.
  type :: crew_t
    integer :: rank = 0, workers = 0
  contains
    procedure :: begin
    procedure :: end => end_crew
    procedure :: first_of
    procedure :: send
    procedure :: receive
  end type crew_t

  !> There is one sort of message.
  integer, parameter :: tag = 1
  !> Microseconds between looks for a message, the first two and the last ones: MPI's own waiting
  !> takes a whole core, which on a full machine is another process's.
  integer(c_int), parameter :: shortest = 10, longest = 200

contains

  !> Joins the processes that were started together; does without MPI where there is one. Fails
  !> where MPI knows nothing of the others.
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
    call fail(error, bad_input, 'started several times by the mpirun of another MPI than this ' // &
      'was built with; use the one that belongs to it')
  end subroutine begin

  !> Waits until all have come here. A process that ends otherwise ends all.
  subroutine end_crew(self)
    class(crew_t), intent(inout) :: self

    if (self%workers > 0) call mpi_finalize()
    self%workers = 0
  end subroutine end_crew

  !> The first process for which something is true, -1: for none. All ask together.
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

  !> Sends a record to a process that receives.
  subroutine send(self, record, to)
    class(crew_t), intent(in) :: self
    type(byte_record_t), intent(in) :: record
    integer, intent(in) :: to

    if (to > self%workers) error stop 'nobody is there'
    call mpi_send(record%words, record%held, mpi_integer8, to, tag, mpi_comm_world)
  end subroutine send

  !> Waits for a record, and says whose it is.
  subroutine receive(self, record, from)
    class(crew_t), intent(in) :: self
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
