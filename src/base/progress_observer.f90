!> The receiver of messages about the progress of long work.
module progress_observer
  implicit none
  private
  public :: progress_observer_t

  !> Ignores the messages; extensions show them.
  type :: progress_observer_t
  contains
    procedure :: hear
  end type progress_observer_t

contains

  !> Receives a short description of the present activity.
  subroutine hear(self, what)
    class(progress_observer_t), intent(inout) :: self
    character(len=*), intent(in) :: what
  end subroutine hear

end module progress_observer
