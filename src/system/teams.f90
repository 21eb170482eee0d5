!> A team of processes: process 0 distributes the work, processes 1 to `workers` do it.
module teams
  use byte_record, only: byte_record_t
  implicit none
  private
  public :: team_t

  type, abstract :: team_t
    integer :: rank = 0, workers = 0
  contains
    procedure(send_record), deferred :: send
    procedure(receive_record), deferred :: receive
  end type team_t

  abstract interface
    !> Sends a record to a process that waits for one.
    subroutine send_record(self, record, to)
      import :: team_t, byte_record_t
      class(team_t), intent(in) :: self
      type(byte_record_t), intent(in) :: record
      integer, intent(in) :: to
    end subroutine send_record

    !> Waits for a record from any process. from: the number of this process; -1 if a process has
    !> ended.
    subroutine receive_record(self, record, from)
      import :: team_t, byte_record_t
      class(team_t), intent(inout) :: self
      type(byte_record_t), intent(inout) :: record
      integer, intent(out) :: from
    end subroutine receive_record
  end interface

end module teams
