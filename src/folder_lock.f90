!> One run at a time in a folder of results. The lock is the kernel's, on the folder itself: it is
!> gone with the process, however that ends, and leaves no file. What is done to its files here is
!> done in that very folder: another that has taken its name meanwhile is another run's.
module folder_lock
  use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_null_char, c_null_ptr, c_ptr
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_opendir, c_dirfd, c_closedir, c_flock, c_faccessat, c_renameat, &
    c_unlinkat, errno, lock_or_fail, locked_elsewhere, system_failure
  implicit none
  private
  public :: folder_lock_t

  !> Not to be copied while it is held.
  type :: folder_lock_t
    private
    type(c_ptr) :: folder = c_null_ptr
    character(len=:), allocatable :: path
    logical :: held = .false.
  contains
    procedure :: take
    procedure :: is_held
    procedure :: contains_file
    procedure :: rename_file
    procedure :: remove_file
    procedure :: release
  end type folder_lock_t

contains

  !> Locks the folder `path`. Fails where another run has it, or where the folder cannot be opened.
  !> Some network file systems have no such locks: then nothing is held and nothing fails, since no
  !> run could work there at all; the folder is open all the same.
  subroutine take(self, path, error)
    class(folder_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error

    call self%release()
    self%path = path
    self%folder = c_opendir(path // c_null_char)
    if (.not. c_associated(self%folder)) then
      call system_failure('cannot open the folder ' // path, errno(), error)
      return
    end if
    self%held = c_flock(c_dirfd(self%folder), lock_or_fail) == 0
    if (self%held) return
    if (errno() /= locked_elsewhere) return
    call fail(error, file_trouble, 'another run is writing into this folder; wait for it, or ' // &
      'choose another folder with --out')
    call self%release()
  end subroutine take

  !> Whether this run has the folder for itself.
  pure logical function is_held(self)
    class(folder_lock_t), intent(in) :: self

    is_held = self%held
  end function is_held

  !> Whether the folder that was taken has a file `name`; not where it has been removed since.
  logical function contains_file(self, name) result(found)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer(c_int), parameter :: exists = 0

    found = c_faccessat(c_dirfd(self%folder), name // c_null_char, exists, 0_c_int) == 0
  end function contains_file

  !> Gives the folder's file `from` the name `to`, replacing a file of that name at one stroke.
  subroutine rename_file(self, from, to, error)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: from, to
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: here

    here = c_dirfd(self%folder)
    if (c_renameat(here, from // c_null_char, here, to // c_null_char) /= 0) &
      call system_failure('cannot rename ' // self%path // '/' // from // ' to ' // &
      self%path // '/' // to, errno(), error)
  end subroutine rename_file

  !> Removes the folder's file `name`; that it does not exist is no error.
  subroutine remove_file(self, name, error)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: code

    if (c_unlinkat(c_dirfd(self%folder), name // c_null_char, 0_c_int) == 0) return
    code = errno()
    if (self%contains_file(name)) &
      call system_failure('cannot remove ' // self%path // '/' // name, code, error)
  end subroutine remove_file

  !> Lets others have the folder; nothing is done where no lock is held.
  subroutine release(self)
    class(folder_lock_t), intent(inout) :: self
    integer(c_int) :: status

    ! Closing the descriptor gives up its lock.
    if (c_associated(self%folder)) status = c_closedir(self%folder)
    self%folder = c_null_ptr
    self%held = .false.
  end subroutine release

end module folder_lock
