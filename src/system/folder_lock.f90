!> A lock that allows one run at a time in a folder of results. The kernel locks the folder itself.
!> The lock ends with the process, however the process ends, and leaves no file. All operations act
!> on this folder, even if another folder has taken its name meanwhile.
module folder_lock
  use, intrinsic :: iso_c_binding, only: c_int
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_open, c_lock, c_kind, c_rename, c_remove, c_remove_folder, c_beginning, &
    c_sync, c_sync_in, c_sync_above, c_close, explain, check_status, as_folder, &
    locked_elsewhere, nul
  implicit none
  private
  public :: folder_lock_t

  !> A lock, which must not be copied while it is held.
  type :: folder_lock_t
    private
    integer(c_int) :: folder = -1
    character(len=:), allocatable :: path
    logical :: held = .false.
  contains
    procedure :: take
    procedure :: look_into
    procedure :: is_held
    procedure :: path_of
    procedure :: contains_file
    procedure :: contains_folder
    procedure :: read_beginning
    procedure :: rename_file
    procedure :: remove_file
    procedure :: remove_folder
    procedure :: sync
    procedure :: sync_above
    procedure :: release
  end type folder_lock_t

contains

  !> Locks the folder `path`. It fails if another run has locked the folder, or if the folder cannot
  !> be opened. On a network file system without locks there is neither a lock nor an error, since
  !> otherwise no run could work there.
  subroutine take(self, path, error)
    class(folder_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: status, sort
    character(len=:), allocatable :: reason

    call self%look_into(path, error)
    if (allocated(error)) return
    status = c_lock(self%folder)
    self%held = status == 0
    if (self%held) return
    call explain(status, sort, reason)
    if (sort /= locked_elsewhere) return
    call fail(error, file_trouble, 'another run is writing into this folder; wait for it, or ' // &
      'choose another folder with --out')
    call self%release()
  end subroutine take

  !> Opens the folder `path` without locking it. Fails if it cannot be opened.
  subroutine look_into(self, path, error)
    class(folder_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error

    self%path = path
    self%folder = c_open(path // nul, as_folder)
    call check_status('cannot open the folder ' // path, self%folder, error)
  end subroutine look_into

  !> Whether this run holds the lock.
  pure logical function is_held(self)
    class(folder_lock_t), intent(in) :: self

    is_held = self%held
  end function is_held

  !> Path of a file in the folder.
  pure function path_of(self, name) result(path)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: path

    path = self%path // '/' // name
  end function path_of

  !> Whether the folder has a file `name`. The result is .true. if the system cannot tell; using the
  !> file then fails.
  logical function contains_file(self, name) result(found)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer(c_int) :: kind

    kind = c_kind(self%folder, name // nul)
    found = kind /= 0 .and. kind /= 2
  end function contains_file

  !> Whether the folder has a subfolder `name`.
  logical function contains_folder(self, name) result(found)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name

    found = c_kind(self%folder, name // nul) == 2
  end function contains_folder

  !> Reads the first bytes of the file `name`, as many as the file has and `text` can hold. A
  !> negative length is a failure; it is -not_regular if `name` is not a file but a link, a pipe or
  !> a device.
  subroutine read_beginning(self, name, text, length)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    character(len=*), intent(out) :: text
    integer, intent(out) :: length

    length = c_beginning(self%folder, name // nul, text, len(text, kind=c_int))
  end subroutine read_beginning

  !> Renames the file `from` to `to` in a single step. A file with the name `to` is replaced.
  subroutine rename_file(self, from, to, error)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: from, to
    type(failure_t), allocatable, intent(out) :: error

    call check_status('cannot rename ' // self%path_of(from) // ' to ' // self%path_of(to), &
      c_rename(self%folder, from // nul, to // nul), error)
  end subroutine rename_file

  !> Removes the file `name`; a missing file is not an error.
  subroutine remove_file(self, name, error)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    type(failure_t), allocatable, intent(out) :: error

    call check_status('cannot remove ' // self%path_of(name), c_remove(self%folder, name // nul), &
      error)
  end subroutine remove_file

  !> Removes the folder `name` if it is empty.
  subroutine remove_folder(self, name)
    class(folder_lock_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer(c_int) :: status

    status = c_remove_folder(self%folder, name // nul)
  end subroutine remove_folder

  !> Waits until all files created, renamed and removed in the folder, or in its subfolder `name`,
  !> have been written to the disk.
  subroutine sync(self, error, name)
    class(folder_lock_t), intent(in) :: self
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), intent(in), optional :: name

    if (present(name)) then
      call check_status('cannot write the folder ' // self%path_of(name), &
        c_sync_in(self%folder, name // nul), error)
    else
      call check_status('cannot write the folder ' // self%path, c_sync(self%folder), error)
    end if
  end subroutine sync

  !> Waits until the folder's own name has been written to the disk.
  subroutine sync_above(self, error)
    class(folder_lock_t), intent(in) :: self
    type(failure_t), allocatable, intent(out) :: error

    call check_status('cannot write the folder above ' // self%path, c_sync_above(self%folder), &
      error)
  end subroutine sync_above

  !> Unlocks and closes the folder, if it is open.
  subroutine release(self)
    class(folder_lock_t), intent(inout) :: self
    integer(c_int) :: status

    ! Closing the descriptor releases its lock.
    if (self%folder >= 0) status = c_close(self%folder)
    self%folder = -1
    self%held = .false.
  end subroutine release

end module folder_lock
