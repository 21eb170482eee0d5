!> The listener that long work tells its progress.
module listener
  implicit none
  private
  public :: listener_t

  !> Ignores what it hears; extensions show it.
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
