!> The one way in which a procedure says that it could not do its work.
!> Every fallible procedure ends its argument list with
!> `type(failure_t), allocatable, intent(out) :: error`; unallocated on return means success.
module failure
  implicit none
  private
  public :: failure_t, fail, bad_input, no_convergence, file_trouble, no_room

  !> What is wrong is the deck, the command line or an argument.
  integer, parameter :: bad_input = 1
  !> The calculation was well posed, but its equations were not satisfied.
  integer, parameter :: no_convergence = 2
  !> A file or folder could not be read or written.
  integer, parameter :: file_trouble = 3
  !> There is not the memory, or the room on a disk, that the calculation needs.
  integer, parameter :: no_room = 4

  type :: failure_t
    integer :: kind = bad_input
    !> One or more lines for the user: what is wrong, where, what to do about it.
    character(len=:), allocatable :: message
  end type failure_t

contains

  !> Allocates `error` with the given kind and message.
  pure subroutine fail(error, kind, message)
    type(failure_t), allocatable, intent(inout) :: error
    integer, intent(in) :: kind
    character(len=*), intent(in) :: message

    if (allocated(error)) deallocate (error)
    allocate (error)
    error%kind = kind
    error%message = trim(message)
  end subroutine fail

end module failure
