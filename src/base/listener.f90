!> The receiver of messages about the progress of long work.
module listener
  implicit none
  private
  public :: listener_t

  !> Ignores the messages; extensions show them.
  type :: listener_t
  contains
    procedure :: hear
  end type listener_t

contains

  !> Receives a short description of the present activity.
  subroutine hear(self, what)
    class(listener_t), intent(inout) :: self
    character(len=*), intent(in) :: what
  end subroutine hear

end module listener
