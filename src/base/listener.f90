!> Who wants to know how far long work is.
module listener
  implicit none
  private
  public :: listener_t

  !> Hears nothing; who wants to extends it.
  type :: listener_t
  contains
    procedure :: hear
  end type listener_t

contains

  !> Takes what is being done just now, a few words.
  subroutine hear(self, what)
    class(listener_t), intent(inout) :: self
    character(len=*), intent(in) :: what
  end subroutine hear

end module listener
