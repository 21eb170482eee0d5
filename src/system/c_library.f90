!> The system calls for files, terminal and process, and their error messages. They are called
!> through `posix.c` and `beyond_posix.c`, or through `windows.c`. A negative status is a failure,
!> which `check_status` reports. Paths and names end with `nul`.
module c_library
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_long, nul => c_null_char
  use failure, only: failure_t, fail, file_trouble
  implicit none
  private
  public :: c_open, c_read, c_write, c_sync, c_sync_in, c_sync_above, c_close, c_size, c_cut, &
    c_seek, c_make_folder, c_current_folder, c_own_path, c_is_absolute, c_use_slashes, c_lock, &
    c_kind, c_same_file, c_rename, c_remove, c_remove_folder, c_beginning, c_free_disk, &
    c_is_terminal, c_prepare, c_end_with_parent, c_pause, c_openblas_threads, &
    c_openblas_end_threads, c_openblas_config, c_build_id, explain, check_status, nul, as_input, &
    as_output, as_kept_output, as_folder, as_data, not_there, locked_elsewhere, not_regular

  !> How a path is opened. as_input: a file of any kind, for reading. as_output: a regular file, for
  !> reading and writing, created or emptied. as_kept_output: the same, but its contents are kept.
  !> as_folder: a folder. as_data: a regular file, for reading.
  integer(c_int), parameter :: as_input = 1, as_output = 2, as_kept_output = 3, as_folder = 4, &
    as_data = 5

  !> Failures for which there is advice or a treatment of its own.
  integer(c_int), parameter :: too_large = 1, disk_full = 2, in_the_way = 3, not_there = 4, &
    locked_elsewhere = 5
  !> Minus this number is the status if a name is a link, a pipe or a device where a file is needed.
  integer(c_int), parameter :: not_regular = 100000

  interface
    !> Opens a file or folder; returns its descriptor.
    integer(c_int) function c_open(path, how) bind(c, name='snapin_open')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: how
    end function c_open

    !> Reads bytes; returns their number, which is smaller than `count` only at the end of the file.
    !> It is a failure if no program opens a pipe for writing within two seconds.
    integer(c_long) function c_read(descriptor, bytes, count) bind(c, name='snapin_read')
      import :: c_char, c_int, c_long
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(inout) :: bytes(*)
      integer(c_long), value :: count
    end function c_read

    !> Writes all of `count` bytes.
    integer(c_int) function c_write(descriptor, bytes, count) bind(c, name='snapin_write')
      import :: c_char, c_int, c_long
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_long), value :: count
    end function c_write

    !> Waits until a file, or the names in a folder, have been written to the disk.
    integer(c_int) function c_sync(descriptor) bind(c, name='snapin_sync')
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_sync

    !> Waits until the names in the subfolder `name` have been written to the disk.
    integer(c_int) function c_sync_in(folder, name) bind(c, name='snapin_sync_in')
      import :: c_char, c_int
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_sync_in

    !> Waits until the names in the folder above `folder`, among them that of `folder`, have been
    !> written to the disk.
    integer(c_int) function c_sync_above(folder) bind(c, name='snapin_sync_above')
      import :: c_int
      integer(c_int), value :: folder
    end function c_sync_above

    integer(c_int) function c_close(descriptor) bind(c, name='snapin_close')
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_close

    !> Number of bytes in a file.
    integer(c_long) function c_size(descriptor) bind(c, name='snapin_size')
      import :: c_int, c_long
      integer(c_int), value :: descriptor
    end function c_size

    !> Truncates a file after `length` bytes and moves to `place` [bytes from the beginning].
    integer(c_int) function c_cut(descriptor, length, place) bind(c, name='snapin_cut')
      import :: c_int, c_long
      integer(c_int), value :: descriptor
      integer(c_long), value :: length, place
    end function c_cut

    !> Sets the position where the next reading begins [bytes from the beginning].
    integer(c_int) function c_seek(descriptor, place) bind(c, name='snapin_seek')
      import :: c_int, c_long
      integer(c_int), value :: descriptor
      integer(c_long), value :: place
    end function c_seek

    integer(c_int) function c_make_folder(path) bind(c, name='snapin_make_folder')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_make_folder

    !> Absolute path of the current folder; blank if it cannot be found.
    subroutine c_current_folder(path, size) bind(c, name='snapin_current_folder')
      import :: c_char, c_int
      character(kind=c_char), intent(out) :: path(*)
      integer(c_int), value :: size
    end subroutine c_current_folder

    !> Absolute path of this program's file; blank if it cannot be found.
    subroutine c_own_path(path, size) bind(c, name='snapin_own_path')
      import :: c_char, c_int
      character(kind=c_char), intent(out) :: path(*)
      integer(c_int), value :: size
    end subroutine c_own_path

    !> 1 if a path does not depend on the current folder, otherwise 0.
    pure integer(c_int) function c_is_absolute(path) bind(c, name='snapin_is_absolute')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_is_absolute

    !> Replaces the characters that separate folders on this system by slashes.
    subroutine c_use_slashes(path, size) bind(c, name='snapin_use_slashes')
      import :: c_char, c_int
      character(kind=c_char), intent(inout) :: path(*)
      integer(c_int), value :: size
    end subroutine c_use_slashes

    !> Locks a folder without waiting. It fails with `locked_elsewhere` if another process has
    !> locked the folder.
    integer(c_int) function c_lock(folder) bind(c, name='snapin_lock')
      import :: c_int
      integer(c_int), value :: folder
    end function c_lock

    !> Kind of a name in a folder: 0 nothing, 1 a file, 2 a folder.
    integer(c_int) function c_kind(folder, name) bind(c, name='snapin_kind')
      import :: c_char, c_int
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_kind

    !> 1 if both paths lead to the same file or folder; 0 if they do not, or if a path leads
    !> nowhere.
    integer(c_int) function c_same_file(path, other) bind(c, name='snapin_same_file')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*), other(*)
    end function c_same_file

    integer(c_int) function c_rename(folder, from, to) bind(c, name='snapin_rename')
      import :: c_char, c_int
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: from(*), to(*)
    end function c_rename

    !> Removes a file from a folder; a missing file is not a failure.
    integer(c_int) function c_remove(folder, name) bind(c, name='snapin_remove')
      import :: c_char, c_int
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_remove

    !> Removes an empty folder from a folder.
    integer(c_int) function c_remove_folder(folder, name) bind(c, name='snapin_remove_folder')
      import :: c_char, c_int
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_remove_folder

    !> Reads at most `count` bytes from the beginning of a file in a folder; returns their number.
    !> Only a regular file is opened.
    integer(c_int) function c_beginning(folder, name, bytes, count) bind(c, name='snapin_beginning')
      import :: c_char, c_int
      integer(c_int), value :: folder, count
      character(kind=c_char), intent(in) :: name(*)
      character(kind=c_char), intent(inout) :: bytes(*)
    end function c_beginning

    !> Number of bytes that may still be written below a path; huge if it is not known.
    real(c_double) function c_free_disk(path) bind(c, name='snapin_free_disk')
      import :: c_char, c_double
      character(kind=c_char), intent(in) :: path(*)
    end function c_free_disk

    !> 1 if the descriptor is that of a terminal, otherwise 0.
    integer(c_int) function c_is_terminal(descriptor) bind(c, name='snapin_is_terminal')
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_is_terminal

    !> Makes failures to write an error of the file instead of a signal that ends the process.
    subroutine c_prepare() bind(c, name='snapin_prepare')
    end subroutine c_prepare

    !> Ends this process when its parent process ends, if the system supports that.
    subroutine c_end_with_parent() bind(c, name='snapin_end_with_parent')
    end subroutine c_end_with_parent

    !> Waits for a number of microseconds, or somewhat longer.
    subroutine c_pause(microseconds) bind(c, name='snapin_pause')
      import :: c_int
      integer(c_int), value :: microseconds
    end subroutine c_pause

    !> 1 if the linear algebra is OpenBLAS, otherwise 0. OpenBLAS is given `count` threads; if
    !> `count` is 0, their number is kept.
    integer(c_int) function c_openblas_threads(count) bind(c, name='snapin_openblas_threads')
      import :: c_int
      integer(c_int), value :: count
    end function c_openblas_threads

    !> Ends the threads of OpenBLAS; setting more than one thread starts them again. Meanwhile no
    !> other thread may compute with OpenBLAS.
    subroutine c_openblas_end_threads() bind(c, name='snapin_openblas_end_threads')
    end subroutine c_openblas_end_threads

    !> The description that OpenBLAS gives of itself; blank for another library.
    subroutine c_openblas_config(text, size) bind(c, name='snapin_openblas_config')
      import :: c_char, c_int
      character(kind=c_char), intent(out) :: text(*)
      integer(c_int), value :: size
    end subroutine c_openblas_config

    !> The first digits of the id that the linker gave this program or library; blank if there is
    !> none.
    subroutine c_build_id(text, size) bind(c, name='snapin_build_id')
      import :: c_char, c_int
      character(kind=c_char), intent(out) :: text(*)
      integer(c_int), value :: size
    end subroutine c_build_id

    integer(c_int) function c_explain(status, reason, size) bind(c, name='snapin_explain')
      import :: c_char, c_int
      integer(c_int), value :: status, size
      character(kind=c_char), intent(out) :: reason(*)
    end function c_explain
  end interface

contains

  !> Finds the kind of a failure, 0 for kinds without advice, and the system's message.
  subroutine explain(status, sort, reason)
    integer(c_int), intent(in) :: status
    integer(c_int), intent(out) :: sort
    character(len=:), allocatable, intent(out) :: reason
    character(len=160) :: text

    sort = c_explain(status, text, len(text))
    reason = trim(text)
  end subroutine explain

  !> If the status is a failure, fails with `what`, the system's message and advice.
  subroutine check_status(what, status, error)
    character(len=*), intent(in) :: what
    integer(c_int), intent(in) :: status
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: advice, reason
    integer(c_int) :: sort

    if (status >= 0) return
    call explain(status, sort, reason)
    select case (sort)
    case (too_large)
      advice = 'raise the limit on the size of files (ulimit -f)'
    case (disk_full)
      advice = 'make room there, or choose another folder with --out'
    case (in_the_way)
      advice = 'move away what is in the way, or choose another folder with --out'
    case default
      advice = 'choose a folder with --out that you may write to'
    end select
    call fail(error, file_trouble, what // ': ' // reason // '; ' // advice)
  end subroutine check_status

end module c_library
