!> The folder with the results of a run. All files are first written as `.partial` files; `close`
!> gives the whole set its names (`publication`). Until then the results of an earlier run stay
!> unchanged, and files of an interrupted run have partial names. One run at a time has the folder.
!> A journal keeps the states found, from which another run can continue.
module result_folder
  use, intrinsic :: iso_c_binding, only: c_int
  use failure, only: failure_t, fail, file_trouble
  use files, only: make_folder, file_exists
  use folder_lock, only: folder_lock_t
  use publication, only: publish, result_files, journal_name
  use journal, only: journal_t
  use run_identity, only: difference_between
  use text_file, only: partial
  implicit none
  private
  public :: result_folder_t, journal_of, to_stream

  !> Replaces a folder if results go to standard output, file by file in pieces (`text_file`).
  character(len=*), parameter :: to_stream = '-'
  integer(c_int), parameter :: standard_output = 1

  type :: result_folder_t
    !> The states found by this run, and by an interrupted one.
    type(journal_t) :: journal
    !> Excludes other runs from the folder.
    type(folder_lock_t) :: lock
    !> The descriptor, if results go to a stream. Then there is no folder and no journal.
    integer(c_int), allocatable :: stream
    character(len=:), allocatable, private :: path
    !> Whether this run has made each of `result_files`.
    logical, private :: made(size(result_files)) = .false.
  contains
    procedure :: open => open_folder
    procedure :: new_file
    procedure :: check_presence
    procedure :: close => close_folder
  end type result_folder_t

contains

  !> Creates and locks the folder and opens its journal; to be called once. `owner` is the run's
  !> identity; resume: the journal of an interrupted run, if there is one, is continued. After an
  !> error the caller unlocks the folder.
  subroutine open_folder(self, folder, owner, resume, error)
    class(result_folder_t), intent(inout) :: self
    character(len=*), intent(in) :: folder, owner
    logical, intent(in) :: resume
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: path, other
    logical :: continued

    self%path = folder
    if (len(folder) == 0) self%path = '.'
    if (folder == to_stream) then
      self%stream = standard_output
      return
    end if
    call make_folder(self%path, error)
    if (.not. allocated(error)) call self%lock%take(self%path, error)
    if (allocated(error)) return
    path = journal_of(self%path)
    continued = resume
    if (resume) continued = file_exists(path)
    if (continued) then
      call self%journal%go_on(path, owner, other, error)
      if (allocated(other)) call fail(error, file_trouble, 'cannot continue: the interrupted ' // &
        'run had another ' // difference_between(other, owner))
    else
      call self%journal%begin(path, owner, error)
    end if
  end subroutine open_folder

  !> Path of the journal in a folder of results.
  pure function journal_of(folder) result(path)
    character(len=*), intent(in) :: folder
    character(len=:), allocatable :: path

    path = folder // '/' // journal_name
  end function journal_of

  !> Path of a file that this run makes, while it is written: its partial name in the folder, or its
  !> name in a stream.
  function new_file(self, name) result(path)
    class(result_folder_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: path

    where (result_files == name) self%made = .true.
    path = self%path // '/' // name // partial
    if (allocated(self%stream)) path = name
  end function new_file

  !> Fails if a file that this run has begun is no longer in the folder.
  subroutine check_presence(self, error)
    class(result_folder_t), intent(in) :: self
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    if (allocated(self%stream)) return
    if (.not. self%lock%contains_file(journal_name)) call complain(journal_name)
    do i = 1, size(result_files)
      if (allocated(error)) return
      if (.not. self%made(i)) cycle
      if (.not. self%lock%contains_file(trim(result_files(i)) // partial)) &
        call complain(trim(result_files(i)) // partial)
    end do

  contains

    subroutine complain(name)
      character(len=*), intent(in) :: name

      call fail(error, file_trouble, self%path // '/' // name // ' was removed or moved ' // &
        'away during the run; make sure that no other program does this')
    end subroutine complain

  end subroutine check_presence

  !> Gives the files of this run their names, unless there is an error already. Files of an earlier
  !> run that this run has not made are removed, and finally the journal. After an error the partial
  !> files and the journal stay. The folder is unlocked.
  subroutine close_folder(self, error)
    class(result_folder_t), intent(inout) :: self
    type(failure_t), allocatable, intent(inout) :: error

    if (any(self%made) .and. .not. allocated(self%stream)) then
      if (.not. allocated(error)) call self%check_presence(error)
      if (.not. allocated(error)) call publish(self%lock, self%made, error)
    end if
    if (allocated(error)) then
      call self%journal%close()
    else
      call self%journal%drop()
    end if
    call self%lock%release()
  end subroutine close_folder

end module result_folder
