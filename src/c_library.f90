!> The few procedures of the C library that files, the terminal and signals need, and its error
!> messages.
module c_library
  use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_funptr, c_int, c_intptr_t, c_long, &
    c_null_char, c_null_ptr, c_ptr, c_size_t
  use failure, only: failure_t, fail, file_trouble
  implicit none
  private
  public :: c_mkdir, c_faccessat, c_renameat, c_unlinkat, c_isatty, c_write, c_fopen, c_fwrite, c_fread, c_fflush, &
    c_fseek, c_fileno, c_ftruncate, c_fclose, c_opendir, c_dirfd, c_closedir, c_flock, &
    c_signal
  public :: c_ferror, errno, reason, system_failure, text_at, procedure_named
  public :: from_start, from_here, lock_or_fail, locked_elsewhere

  !> Numbers of errors, the same on every Linux.
  integer(c_int), parameter :: file_exists_already = 17, not_a_folder = 20, is_a_folder = 21, &
    file_too_large = 27, disk_full = 28, quota_used_up = 122

  !> Of `c_fseek`: where offsets are counted from.
  integer(c_int), parameter :: from_start = 0, from_here = 1
  !> Of `c_flock`: an exclusive lock, without waiting for it; and the error where another has it.
  integer(c_int), parameter :: lock_or_fail = 2 + 4, locked_elsewhere = 11

  interface
    function c_mkdir(path, mode) bind(c, name='mkdir') result(status)
      import :: c_char, c_int
      implicit none
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
      integer(c_int) :: status
    end function c_mkdir

    function c_faccessat(folder, name, mode, flags) bind(c, name='faccessat') result(status)
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder, mode, flags
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int) :: status
    end function c_faccessat

    function c_renameat(folder, from, new_folder, to) bind(c, name='renameat') result(status)
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder, new_folder
      character(kind=c_char), intent(in) :: from(*), to(*)
      integer(c_int) :: status
    end function c_renameat

    function c_unlinkat(folder, name, flags) bind(c, name='unlinkat') result(status)
      import :: c_char, c_int
      implicit none
      integer(c_int), value :: folder, flags
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int) :: status
    end function c_unlinkat

    function c_isatty(descriptor) bind(c, name='isatty') result(yes)
      import :: c_int
      implicit none
      integer(c_int), value :: descriptor
      integer(c_int) :: yes
    end function c_isatty

    function c_write(descriptor, text, length) bind(c, name='write') result(written)
      import :: c_char, c_int, c_size_t
      implicit none
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: text(*)
      integer(c_size_t), value :: length
      integer(c_size_t) :: written
    end function c_write

    function c_fopen(path, mode) bind(c, name='fopen') result(stream)
      import :: c_char, c_ptr
      implicit none
      character(kind=c_char), intent(in) :: path(*), mode(*)
      type(c_ptr) :: stream
    end function c_fopen

    function c_fwrite(text, size, count, stream) bind(c, name='fwrite') result(written)
      import :: c_char, c_ptr, c_size_t
      implicit none
      character(kind=c_char), intent(in) :: text(*)
      integer(c_size_t), value :: size, count
      type(c_ptr), value :: stream
      integer(c_size_t) :: written
    end function c_fwrite

    function c_fread(text, size, count, stream) bind(c, name='fread') result(taken)
      import :: c_char, c_ptr, c_size_t
      implicit none
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_size_t), value :: size, count
      type(c_ptr), value :: stream
      integer(c_size_t) :: taken
    end function c_fread

    function c_fseek(stream, offset, origin) bind(c, name='fseek') result(status)
      import :: c_int, c_long, c_ptr
      implicit none
      type(c_ptr), value :: stream
      integer(c_long), value :: offset
      integer(c_int), value :: origin
      integer(c_int) :: status
    end function c_fseek

    function c_fileno(stream) bind(c, name='fileno') result(descriptor)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: stream
      integer(c_int) :: descriptor
    end function c_fileno

    function c_ftruncate(descriptor, length) bind(c, name='ftruncate') result(status)
      import :: c_int, c_long
      implicit none
      integer(c_int), value :: descriptor
      integer(c_long), value :: length
      integer(c_int) :: status
    end function c_ftruncate

    function c_ferror(stream) bind(c, name='ferror') result(status)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_ferror

    function c_fflush(stream) bind(c, name='fflush') result(status)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_fflush

    function c_fclose(stream) bind(c, name='fclose') result(status)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: stream
      integer(c_int) :: status
    end function c_fclose

    function c_opendir(path) bind(c, name='opendir') result(folder)
      import :: c_char, c_ptr
      implicit none
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr) :: folder
    end function c_opendir

    function c_dirfd(folder) bind(c, name='dirfd') result(descriptor)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: folder
      integer(c_int) :: descriptor
    end function c_dirfd

    function c_closedir(folder) bind(c, name='closedir') result(status)
      import :: c_int, c_ptr
      implicit none
      type(c_ptr), value :: folder
      integer(c_int) :: status
    end function c_closedir

    function c_flock(descriptor, operation) bind(c, name='flock') result(status)
      import :: c_int
      implicit none
      integer(c_int), value :: descriptor, operation
      integer(c_int) :: status
    end function c_flock

    function c_signal(number, action) bind(c, name='signal') result(before)
      import :: c_int, c_intptr_t
      implicit none
      integer(c_int), value :: number
      integer(c_intptr_t), value :: action
      integer(c_intptr_t) :: before
    end function c_signal

    function c_dlsym(handle, name) bind(c, name='dlsym') result(address)
      import :: c_ptr, c_funptr, c_char
      implicit none
      type(c_ptr), value :: handle
      character(kind=c_char), intent(in) :: name(*)
      type(c_funptr) :: address
    end function c_dlsym

    ! errno itself is a macro; this is what it stands for in glibc and musl.
    function c_errno_location() bind(c, name='__errno_location') result(place)
      import :: c_ptr
      implicit none
      type(c_ptr) :: place
    end function c_errno_location

    function c_strerror(code) bind(c, name='strerror') result(text)
      import :: c_int, c_ptr
      implicit none
      integer(c_int), value :: code
      type(c_ptr) :: text
    end function c_strerror

    function c_strlen(text) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      implicit none
      type(c_ptr), value :: text
      integer(c_size_t) :: length
    end function c_strlen
  end interface

contains

  !> What could not be done, the system's reason, and what to do about it.
  subroutine system_failure(what, code, error)
    character(len=*), intent(in) :: what
    integer(c_int), intent(in) :: code
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: advice

    select case (code)
    case (file_too_large)
      advice = 'raise the limit on the size of files (ulimit -f)'
    case (disk_full, quota_used_up)
      advice = 'make room there, or choose another folder with --out'
    case (file_exists_already, not_a_folder, is_a_folder)
      advice = 'move away what is in the way, or choose another folder with --out'
    case default
      advice = 'choose a folder with --out that you may write to'
    end select
    call fail(error, file_trouble, what // ': ' // reason(code) // '; ' // advice)
  end subroutine system_failure

  !> The C library's number of what went wrong last.
  integer(c_int) function errno()
    integer(c_int), pointer :: code

    call c_f_pointer(c_errno_location(), code)
    errno = code
  end function errno

  !> The C library's words for an error.
  function reason(code) result(text)
    integer(c_int), intent(in) :: code
    character(len=:), allocatable :: text

    text = text_at(c_strerror(code))
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
