!> The few things that files, the terminal and the process need of the system, most of them by way
!> of `posix.c`, and its error messages. A status below zero is a failure, for `system_failure`.
module c_library
  use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_funptr, c_int, c_long, &
    c_null_char, c_null_ptr, c_ptr, c_size_t
  use failure, only: failure_t, fail, file_trouble
  implicit none
  private
  public :: c_open_input, c_open_output, c_read, c_write, c_sync, c_close, c_size, c_go_to, &
    c_truncate, c_make_folder, c_open_folder, c_lock, c_kind, c_rename, c_remove, c_is_terminal, &
    c_prepare
  public :: sort_of, reason, system_failure, text_at, procedure_named
  public :: too_large, disk_full, in_the_way, not_there, locked_elsewhere

  !> Sorts of failure that users are told apart, as in `posix.c`.
  integer(c_int), parameter :: too_large = 1, disk_full = 2, in_the_way = 3, not_there = 4, &
    locked_elsewhere = 5

  interface
    !> A descriptor of the file `path`, whatever kind it is of, to be read.
    integer(c_int) function c_open_input(path) bind(c, name='snapin_open_input')
      import :: c_char, c_int
      implicit none
      character(kind=c_char), intent(in) :: path(*)
    end function c_open_input

    !> A descriptor of the regular file `path`, to be read and written: as it is where `keep` is not
    !> 0, otherwise empty, and made where there is none.
    integer(c_int) function c_open_output(path, keep) bind(c, name='snapin_open_output')
      import :: c_char, c_int
      implicit none
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: keep
    end function c_open_output

    !> Number of bytes read; fewer than `count` at the end of the file only.
    integer(c_long) function c_read(descriptor, bytes, count) bind(c, name='snapin_read')
      import :: c_char, c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(inout) :: bytes(*)
      integer(c_long), value :: count
    end function c_read

    !> Writes all of `count` bytes.
    integer(c_int) function c_write(descriptor, bytes, count) bind(c, name='snapin_write')
      import :: c_char, c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_long), value :: count
    end function c_write

    !> Waits until a file, or the names in a folder, are on the disk.
    integer(c_int) function c_sync(descriptor) bind(c, name='snapin_sync')
      import :: c_int
      implicit none
      integer(c_int), value :: descriptor
    end function c_sync

    integer(c_int) function c_close(descriptor) bind(c, name='snapin_close')
      import :: c_int
      implicit none
      integer(c_int), value :: descriptor
    end function c_close

    !> Bytes in a file.
    integer(c_long) function c_size(descriptor) bind(c, name='snapin_size')
      import :: c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
    end function c_size

    !> Moves to a place [bytes from the start] in a file.
    integer(c_int) function c_go_to(descriptor, offset) bind(c, name='snapin_go_to')
      import :: c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
      integer(c_long), value :: offset
    end function c_go_to

    integer(c_int) function c_truncate(descriptor, length) bind(c, name='snapin_truncate')
      import :: c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
      integer(c_long), value :: length
    end function c_truncate

    integer(c_int) function c_make_folder(path) bind(c, name='snapin_make_folder')
      import :: c_char, c_int
      implicit none
      character(kind=c_char), intent(in) :: path(*)
    end function c_make_folder

    !> A descriptor of a folder.
    integer(c_int) function c_open_folder(path) bind(c, name='snapin_open_folder')
      import :: c_char, c_int
      implicit none
      character(kind=c_char), intent(in) :: path(*)
    end function c_open_folder

    !> Locks a folder without waiting: it fails as `locked_elsewhere` where another has it.
    integer(c_int) function c_lock(folder) bind(c, name='snapin_lock')
      import :: c_int
      implicit none
      integer(c_int), value :: folder
    end function c_lock

    !> What a name in a folder is: 0 nothing, 1 a file, 2 a folder.
    integer(c_int) function c_kind(folder, name) bind(c, name='snapin_kind')
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_kind

    integer(c_int) function c_rename(folder, from, to) bind(c, name='snapin_rename')
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: from(*), to(*)
    end function c_rename

    !> Removes a file from a folder; that there is none is no failure.
    integer(c_int) function c_remove(folder, name) bind(c, name='snapin_remove')
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: name(*)
    end function c_remove

    !> 1 for a terminal.
    integer(c_int) function c_is_terminal(descriptor) bind(c, name='snapin_is_terminal')
      import :: c_int
      implicit none
      integer(c_int), value :: descriptor
    end function c_is_terminal

    !> Makes trouble with a file an error of that file, and nothing that ends the process.
    subroutine c_prepare() bind(c, name='snapin_prepare')
      implicit none
    end subroutine c_prepare

    type(c_ptr) function c_reason(status) bind(c, name='snapin_reason')
      import :: c_int, c_ptr
      implicit none
      integer(c_int), value :: status
    end function c_reason

    integer(c_int) function c_sort(status) bind(c, name='snapin_sort')
      import :: c_int
      implicit none
      integer(c_int), value :: status
    end function c_sort

    type(c_funptr) function c_dlsym(handle, name) bind(c, name='dlsym')
      import :: c_ptr, c_funptr, c_char
      implicit none
      type(c_ptr), value :: handle
      character(kind=c_char), intent(in) :: name(*)
    end function c_dlsym

    integer(c_size_t) function c_strlen(text) bind(c, name='strlen')
      import :: c_ptr, c_size_t
      implicit none
      type(c_ptr), value :: text
    end function c_strlen
  end interface

contains

  !> What could not be done, the system's reason, and what to do about it.
  subroutine system_failure(what, status, error)
    character(len=*), intent(in) :: what
    integer(c_int), intent(in) :: status
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: advice

    select case (sort_of(status))
    case (too_large)
      advice = 'raise the limit on the size of files (ulimit -f)'
    case (disk_full)
      advice = 'make room there, or choose another folder with --out'
    case (in_the_way)
      advice = 'move away what is in the way, or choose another folder with --out'
    case default
      advice = 'choose a folder with --out that you may write to'
    end select
    call fail(error, file_trouble, what // ': ' // reason(status) // '; ' // advice)
  end subroutine system_failure

  !> The sort of a failure; 0: none of those above.
  integer(c_int) function sort_of(status)
    integer(c_int), intent(in) :: status

    sort_of = c_sort(status)
  end function sort_of

  !> The system's words for a failure.
  function reason(status) result(text)
    integer(c_int), intent(in) :: status
    character(len=:), allocatable :: text

    text = text_at(c_reason(status))
  end function reason

  !> A copy of the C string at `place`.
  function text_at(place) result(text)
    type(c_ptr), intent(in) :: place
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: i

    call c_f_pointer(place, letters, [c_strlen(place)])
    allocate (character(len=size(letters)) :: text)
    do i = 1, size(letters)
      text(i:i) = letters(i)
    end do
  end function text_at

  !> The address of a procedure that this process may or may not have, such as one of a particular
  !> BLAS; null where it does not.
  type(c_funptr) function procedure_named(name)
    character(len=*), intent(in) :: name

    procedure_named = c_dlsym(c_null_ptr, name // c_null_char)
  end function procedure_named

end module c_library
