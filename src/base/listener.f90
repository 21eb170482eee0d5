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

  !> Takes the present activity in a few words.
  subroutine hear(self, what)
    class(listener_t), intent(inout) :: self
    character(len=*), intent(in) :: what
  end subroutine hear

end module listener
