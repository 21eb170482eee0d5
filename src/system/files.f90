!> Folders, small files that are read as a whole, and the standard streams.
module files
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp, long
  use failure, only: failure_t, fail, file_trouble
  use text, only: printable
  use c_library, only: c_make_folder, c_current_folder, c_own_path, c_same_file, c_free_disk, &
    c_is_absolute, c_use_slashes, c_is_terminal, c_write, c_open, c_read, c_sync, c_sync_above, &
    c_close, as_folder, &
    check_status, explain, nul
  implicit none
  private
  public :: make_folder, sync_names, file_exists, same_file, free_disk, whole_path, own_path, &
    is_absolute, with_slashes, &
    read_file, read_standard_input, is_terminal, write_stdout, write_stderr

  !> Numbers of the standard streams.
  integer(c_int), parameter :: standard_input = 0, standard_output = 1, standard_error = 2

contains

  !> Creates the folder `path` and its parents if they do not exist. The names of the parents are
  !> written to the disk at once, since other runs may rely on them. The name of `path` is not.
  subroutine make_folder(path, error)
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: status
    integer :: i

    do i = 1, len(path)
      if (i < len(path)) then
        if (path(i + 1:i + 1) /= '/') cycle
      end if
      if (path(i:i) == '/') cycle
      if (file_exists(path(:i) // '/.')) cycle
      status = c_make_folder(path(:i) // nul)
      if (status == 0 .and. i < len(path)) call sync_names(path(:i), .false., status)
      if (status == 0) cycle
      ! Another process may have created the folder meanwhile.
      if (file_exists(path(:i) // '/.')) cycle
      call check_status('cannot make the folder ' // path(:i), status, error)
      return
    end do
  end subroutine make_folder

  !> Waits until the name of the folder `path` has been written to the disk; with `inside`, also the
  !> names in it.
  subroutine sync_names(path, inside, status)
    character(len=*), intent(in) :: path
    logical, intent(in) :: inside
    integer(c_int), intent(out) :: status
    integer(c_int) :: folder, closed

    folder = c_open(path // nul, as_folder)
    status = min(folder, 0_c_int)
    if (status < 0) return
    if (inside) status = c_sync(folder)
    if (status == 0) status = c_sync_above(folder)
    closed = c_close(folder)
  end subroutine sync_names

  !> The absolute path of `path`, or `path` itself if the current folder cannot be found.
  function whole_path(path) result(whole)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: whole
    character(len=4096) :: here

    whole = path
    if (is_absolute(path)) return
    call c_current_folder(here, len(here, kind=c_int))
    if (here /= '') whole = trim(here) // '/' // path
  end function whole_path

  !> Whether a path does not depend on the current folder.
  pure logical function is_absolute(path)
    character(len=*), intent(in) :: path

    is_absolute = c_is_absolute(path // nul) == 1
  end function is_absolute

  !> A path from the command line, with slashes on every system.
  function with_slashes(path) result(same)
    character(len=*), intent(in) :: path
    character(len=len(path)) :: same

    same = path
    call c_use_slashes(same, len(same, kind=c_int))
  end function with_slashes

  !> Whether both paths lead to the same file, possibly by different names and links.
  logical function same_file(path, other)
    character(len=*), intent(in) :: path, other

    same_file = c_same_file(path // nul, other // nul) == 1
  end function same_file

  !> Path of this program's file; blank if it cannot be found.
  function own_path() result(path)
    character(len=4096) :: path

    call c_own_path(path, len(path, kind=c_int))
  end function own_path

  !> The text of the file `path`; not allocated if the file cannot be read.
  subroutine read_file(path, text)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: text
    integer(long) :: length
    integer :: unit, status

    open (newunit=unit, file=path, status='old', action='read', access='stream', &
      form='unformatted', iostat=status)
    if (status /= 0) return
    inquire (unit, size=length)
    allocate (character(len=max(length, 0_long)) :: text)
    read (unit, iostat=status) text
    close (unit)
    if (status /= 0) deallocate (text)
  end subroutine read_file

  !> The text of standard input, at most `most` bytes, since standard input may have no end.
  function read_standard_input(most) result(text)
    integer, intent(in) :: most
    character(len=:), allocatable :: text
    integer :: length

    allocate (character(len=most) :: text)
    length = int(max(c_read(standard_input, text, int(most, c_long)), 0_c_long))
    text = text(:length)
  end function read_standard_input

  !> Whether the file or folder `path` exists.
  logical function file_exists(path)
    character(len=*), intent(in) :: path

    inquire (file=path, exist=file_exists)
  end function file_exists

  !> Number of bytes that may still be written below a path; huge if it is not known. The last
  !> folders of the path need not exist.
  real(wp) function free_disk(path)
    character(len=*), intent(in) :: path

    free_disk = c_free_disk(path // nul)
  end function free_disk

  !> Whether standard error is a terminal.
  logical function is_terminal()
    is_terminal = c_is_terminal(standard_error) == 1
  end function is_terminal

  !> Writes `text` to standard output, without control sequences that names may contain.
  subroutine write_stdout(text, error)
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: reason
    integer(c_int) :: status, sort

    status = c_write(standard_output, printable(text, lines=.true.), int(len(text), c_long))
    if (status >= 0) return
    call explain(status, sort, reason)
    call fail(error, file_trouble, 'cannot write to standard output: ' // reason)
  end subroutine write_stdout

  !> Writes `text` and the end of a line to standard error, without control sequences that names and
  !> files may contain. If writing fails, for example because a redirection leads to a full disk,
  !> the failure is ignored.
  subroutine write_stderr(text)
    character(len=*), intent(in) :: text
    integer(c_int) :: sent

    associate (line => printable(text, lines=.true.) // new_line('a'))
      sent = c_write(standard_error, line, int(len(line), c_long))
    end associate
  end subroutine write_stderr

end module files
