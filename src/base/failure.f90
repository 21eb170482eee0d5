!> How a procedure reports that it failed. A fallible procedure ends its argument list with
!> `type(failure_t), allocatable, intent(out) :: error`; unallocated on return means success. An
!> object that is filled by many procedures, such as a deck or results, keeps the failure itself.
module failure
  implicit none
  private
  public :: failure_t, fail, bad_input, file_trouble, no_room

  !> The deck, the command line or an argument is wrong.
  integer, parameter :: bad_input = 1
  !> A file or folder could not be read or written.
  integer, parameter :: file_trouble = 2
  !> Memory, or room on a disk, does not suffice for the calculation.
  integer, parameter :: no_room = 3

  type :: failure_t
    integer :: kind = bad_input
    !> One or more lines for the user: what is wrong, where, and what to do about it.
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
