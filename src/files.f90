!> Folders, whether files exist, and standard error.
module files
  use, intrinsic :: iso_c_binding, only: c_int, c_null_char, c_size_t
  use, intrinsic :: iso_fortran_env, only: error_unit
  use failure, only: failure_t
  use c_library, only: c_mkdir, c_isatty, c_write, errno, system_failure
  implicit none
  private
  public :: make_folder, file_exists, is_terminal, write_stderr

  !> Number of standard error.
  integer(c_int), parameter :: standard_error = 2

contains

  !> Makes the folder `path` and those above it, where they do not exist.
  subroutine make_folder(path, error)
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int), parameter :: everyone = int(o'777', c_int)
    integer(c_int) :: code
    integer :: i

    do i = 1, len(path)
      if (i < len(path)) then
        if (path(i + 1:i + 1) /= '/') cycle
      end if
      if (path(i:i) == '/') cycle
      if (file_exists(path(:i) // '/.')) cycle
      if (c_mkdir(path(:i) // c_null_char, everyone) == 0) cycle
      code = errno()
      ! Another process may have made it meanwhile.
      if (file_exists(path(:i) // '/.')) cycle
      call system_failure('cannot make the folder ' // path(:i), code, error)
      return
    end do
  end subroutine make_folder

  !> Whether there is a file or folder `path`.
  logical function file_exists(path)
    character(len=*), intent(in) :: path

    inquire (file=path, exist=file_exists)
  end function file_exists

  !> Whether standard error is a terminal.
  logical function is_terminal()
    is_terminal = c_isatty(standard_error) == 1
  end function is_terminal

  !> Writes `text` as it is to standard error; a Fortran unit would end it with a new line. That
  !> nobody may be listening is no error.
  subroutine write_stderr(text)
    character(len=*), intent(in) :: text
    integer(c_size_t) :: written, sent
    integer :: status

    flush (error_unit, iostat=status)
    sent = 0
    do while (sent < len(text))
      written = c_write(standard_error, text(sent + 1:), len(text) - sent)
      if (written < 1) return
      sent = sent + written
    end do
  end subroutine write_stderr

end module files
