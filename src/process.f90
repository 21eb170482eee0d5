!> What a process must be told once so that trouble with a file stays an error of that file.
module process
  use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_intptr_t, c_null_char, c_ptr
  use c_library, only: c_fopen, c_fileno, c_fclose, c_signal
  implicit none
  private
  public :: prepare_process

  !> Numbers of signals, on Linux; and what `signal` takes for ignoring one.
  integer(c_int), parameter :: broken_pipe = 13, file_size_exceeded = 25
  integer(c_intptr_t), parameter :: ignore = 1
  !> The last of the descriptors that every process expects to have.
  integer(c_int), parameter :: standard_error = 2

contains

  !> Writing to a pipe that nobody reads, or beyond the largest file that the user may have, fails
  !> instead of ending the process; and no file takes the place of a closed standard stream, where
  !> messages would be written into it.
  subroutine prepare_process()
    type(c_ptr) :: stream
    integer(c_intptr_t) :: before
    integer(c_int) :: status

    before = c_signal(broken_pipe, ignore)
    before = c_signal(file_size_exceeded, ignore)
    do
      stream = c_fopen('/dev/null' // c_null_char, 'r+' // c_null_char)
      if (.not. c_associated(stream)) return
      if (c_fileno(stream) > standard_error) exit
    end do
    status = c_fclose(stream)
  end subroutine prepare_process

end module process
