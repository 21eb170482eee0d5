!> A set of results gets its names: whole or not at all, or `INCOMPLETE.txt`, the file of intent, is
!> there. Without that file, those that are not called `.partial` are one set of results, and are on
!> the disk.
!>
!> How old results are replaced is in `replacement`. Where there are none, nothing can be mixed, and
!> what was interrupted can be taken back. The summary itself then is the file of intent. The steps,
!> each on the disk before the next begins:
!>
!> 1. the new files;
!> 2. the summary is called `INCOMPLETE.txt`; so are the partial names and the folder's own;
!> 3. the tables get their names;
!> 4. `INCOMPLETE.txt` is called summary.nml: at one stroke the set is complete;
!> 5. the journal is removed. Nobody waits for that: if it is back after a power failure, a run goes
!>    on from its end.
!>
!> Either way the summary never stands beside tables that are not its own.
module publication
  use failure, only: failure_t, fail, file_trouble
  use files, only: read_file, file_exists
  use folder_lock, only: folder_lock_t
  use text_file, only: partial
  use result_names, only: result_files, summary_name, intent_name, holds_results
  use replacement, only: replace_results, complete_replacement, remove_leftovers
  implicit none
  private
  public :: publish, mend

contains

  !> Gives the files of `folder` that are marked in `new` (one for each of `result_files`; a summary
  !> is among them), complete under their partial names, their own; those of an earlier run
  !> disappear, and so does the journal. Where that fails, `error` says what the folder then holds.
  subroutine publish(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    logical :: complete

    complete = .false.
    call refuse_folders(folder, error)
    if (.not. allocated(error)) then
      if (holds_results(folder)) then
        call replace_results(folder, new, complete, error)
      else
        call publish_first(folder, new, complete, error)
      end if
    end if
    if (.not. allocated(error)) return
    if (complete) then
      call tell(folder, 'the new results are complete, but ', error)
    else
      call tell(folder, 'no results were replaced: ', error)
    end if
  end subroutine publish

  !> Completes or takes back what was interrupted in the folder `path`, if anything was. mended: it
  !> now has complete results.
  subroutine mend(path, mended, error)
    character(len=*), intent(in) :: path
    logical, intent(out) :: mended
    type(failure_t), allocatable, intent(out) :: error
    type(folder_lock_t) :: folder

    mended = .false.
    if (.not. file_exists(path // '/' // intent_name)) return
    call folder%take(path, error)
    if (allocated(error)) return
    ! The run that was at it may have ended meanwhile.
    if (folder%contains_file(intent_name)) call mend_locked(folder, mended, error)
    call folder%release()
  end subroutine mend

  subroutine mend_locked(folder, mended, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(out) :: mended
    type(failure_t), allocatable, intent(out) :: error
    character(len=1), parameter :: nl = new_line('a')
    character(len=:), allocatable :: text

    mended = .false.
    call read_file(folder%path_of(intent_name), text)
    if (.not. allocated(text)) text = ''
    if (index(text, nl // '&summary' // nl) > 0) then
      call take_back(folder, error)
      if (allocated(error)) call tell(folder, 'there are no results yet: ', error)
    else
      call complete_replacement(folder, text, error)
      mended = .not. allocated(error)
      if (allocated(error)) call tell(folder, 'the results are complete, but ', error)
    end if
  end subroutine mend_locked

  !> Says what a folder holds after an error: `otherwise`, unless the file of intent is there.
  subroutine tell(folder, otherwise, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: otherwise
    type(failure_t), allocatable, intent(inout) :: error

    if (folder%contains_file(intent_name)) then
      error%message = 'files there may not belong together, see ' // intent_name // ' there: ' // &
        error%message
    else
      error%message = otherwise // error%message
    end if
  end subroutine tell

  !> Fails where a folder has a name that a file is to be given, or that is to be free.
  subroutine refuse_folders(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    do i = 1, size(result_files)
      if (folder%contains_folder(trim(result_files(i)))) call fail(error, file_trouble, &
        folder%path_of(trim(result_files(i))) // ' is a folder; move away what is in the way')
    end do
  end subroutine refuse_folders

  !> Gives the files marked in `new` their names in a folder that holds no results. complete: that
  !> was done, whatever `error` says; otherwise it was taken back, or the file of intent is there.
  subroutine publish_first(folder, new, complete, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    logical, intent(out) :: complete
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: again

    complete = .false.
    call folder%rename_file(summary_name // partial, intent_name, error)
    if (.not. allocated(error)) call folder%sync_above(error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call name_tables(folder, new, error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call folder%rename_file(intent_name, summary_name, error)
    if (allocated(error)) then
      call take_back(folder, again)
      return
    end if
    complete = .true.
    call folder%sync(error)
    if (.not. allocated(error)) call remove_leftovers(folder, new, error)
  end subroutine publish_first

  !> Gives the tables marked in `new` their names.
  subroutine name_tables(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    integer :: i

    do i = 1, size(new)
      name = trim(result_files(i))
      if (.not. new(i) .or. name == summary_name) cycle
      call folder%rename_file(name // partial, name, error)
      if (allocated(error)) return
    end do
  end subroutine name_tables

  !> Takes back what `publish_first` has done before the set was complete: all files are partial by
  !> name. Where that fails the file of intent stays.
  subroutine take_back(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    integer :: i

    if (.not. folder%contains_file(intent_name)) return
    do i = 1, size(result_files)
      name = trim(result_files(i))
      if (folder%contains_file(name)) call folder%rename_file(name, name // partial, error)
      if (allocated(error)) return
    end do
    call folder%sync(error)
    if (.not. allocated(error)) &
      call folder%rename_file(intent_name, summary_name // partial, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine take_back

end module publication
