!> One run at a time in a folder of results. The lock is the kernel's, on the folder itself: it is
!> gone with the process, however that ends, and leaves no file.
module folder_lock
  use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_null_char, c_null_ptr, c_ptr
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_opendir, c_dirfd, c_closedir, c_flock, errno, lock_or_fail, &
    locked_elsewhere, system_failure
  implicit none
  private
  public :: folder_lock_t

  !> Not to be copied while it is held.
  type :: folder_lock_t
    private
    type(c_ptr) :: folder = c_null_ptr
    logical :: held = .false.
  contains
    procedure :: take
    procedure :: is_held
    procedure :: release
  end type folder_lock_t

contains

  !> Locks the folder `path`. Fails where another run has it, or where the folder cannot be opened.
  !> Some network file systems have no such locks: then nothing is held and nothing fails, since no
  !> run could work there at all.
  subroutine take(self, path, error)
    class(folder_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error

    call self%release()
    self%folder = c_opendir(path // c_null_char)
    if (.not. c_associated(self%folder)) then
      call system_failure('cannot open the folder ' // path, errno(), error)
      return
    end if
    self%held = c_flock(c_dirfd(self%folder), lock_or_fail) == 0
    if (self%held) return
    if (errno() == locked_elsewhere) call fail(error, file_trouble, 'another run is writing ' // &
      'into this folder; wait for it, or choose another folder with --out')
    call self%release()
  end subroutine take

  !> Whether this run has the folder for itself.
  pure logical function is_held(self)
    class(folder_lock_t), intent(in) :: self

    is_held = self%held
  end function is_held

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
