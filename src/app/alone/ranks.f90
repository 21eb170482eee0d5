!> The crew in a build without MPI, which is one process. `mpi/ranks.f90` documents each procedure.
module ranks
  use kinds, only: long
  use failure, only: failure_t, fail, bad_input
  use byte_record, only: byte_record_t
  use teams, only: team_t
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

contains

  !> Fails if other processes were started too, since each of them would do all the work.
  subroutine begin(self, error)
    class(crew_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error

    self%workers = 0
    if (started_together() <= 1) return
    self%rank = own_rank()
    call fail(error, bad_input, 'mpirun or srun has started several processes, but this build ' // &
      'has no MPI; start one, which uses all cores of the machine, or build with -Dmpi=enabled')
  end subroutine begin

  !> There are no processes to wait for.
  subroutine end_crew(self)
    class(crew_t), intent(inout) :: self

    self%workers = 0
  end subroutine end_crew

  !> 0 if `true`, otherwise -1.
  integer function first_of(self, true)
    class(crew_t), intent(in) :: self
    logical, intent(in) :: true

    first_of = merge(self%rank, -1, true)
  end function first_of

  !> Does nothing, since there are no processes to send to.
  subroutine send(self, record, to)
    class(crew_t), intent(in) :: self
    type(byte_record_t), intent(in) :: record
    integer, intent(in) :: to

    if (to > self%workers .or. record%held < 0) error stop 'no such process'
  end subroutine send

  !> Returns an empty record, since no process sends one.
  subroutine receive(self, record, from)
    class(crew_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: record
    integer, intent(out) :: from

    call record%fill([integer(long) ::])
    from = self%rank
  end subroutine receive

end module ranks
