!> A new set of results takes the place of an old one, whole or not at all.
!>
!> A file of intent, `INCOMPLETE.txt`, lists the new set. It appears when every file of that set is
!> on the disk under its `.partial` name, and disappears when all have their final names. While it
!> is there, the new file NAME is NAME.partial where that exists and NAME otherwise. Whatever is
!> interrupted in between can therefore be done again from the beginning, by the next run. Old files
!> are not overwritten but set aside, so that they can be put back where a step fails. Without
!> `INCOMPLETE.txt` the files that are not called `.partial` are one set of results.
!>
!> Each of these steps is on the disk before the next begins. The summary is the first to be set
!> aside and the last to get its name: it never stands beside tables that are not its own.
module publication
  use failure, only: failure_t, fail, file_trouble
  use files, only: read_file, file_exists
  use folder_lock, only: folder_lock_t
  use text_file, only: output_t, partial
  implicit none
  private
  public :: publish, mend, result_files, journal_name

  !> The files of a folder of results, the summary last.
  character(len=*), parameter :: result_files(*) = [character(len=21) :: 'curve.csv', &
    'profiles.csv', 'approximations.csv', 'classical.csv', 'device.csv', &
    'device_jumps.csv', 'fixed_load.csv', 'table.csv', 'sensitivity.csv', &
    'curve_sensitivity.csv', 'fit.csv', 'fit.nml', 'sweep.csv', 'summary.nml']
  character(len=*), parameter :: journal_name = 'journal' // partial

  character(len=*), parameter :: intent_name = 'INCOMPLETE.txt', set_aside = '.old' // partial
  character(len=1), parameter :: nl = new_line('a')
  character(len=*), parameter :: explanation = &
    'The files in this folder may not belong together: newer results were taking the place' // &
    nl // 'of older ones when the program was stopped. Do not use them like this. Run the deck' // &
    nl // 'again, best with --resume: that first puts the newer results in place, all of them.' // &
    nl // 'By hand: of each file listed below NAME.partial is the newer one where it exists,' // &
    nl // 'and is to be renamed to NAME. Then remove other results, what is called .partial,' // &
    nl // 'and this file.' // nl

contains

  !> Gives the files of `folder` that are marked in `new` (one for each of `result_files`), complete
  !> under their partial names, their own; those of an earlier run disappear, and so does the
  !> journal. Where that fails, `error` says what the folder then holds.
  subroutine publish(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: again

    call refuse_folders(folder, error)
    if (.not. allocated(error)) call declare(folder, new, error)
    if (allocated(error)) then
      call withdraw(folder, again)
    else
      call put_in_place(folder, new, error)
      if (allocated(error)) then
        call undo(folder, new)
      else
        call clean_up(folder, new, error)
        if (allocated(error)) call tell(folder, 'the new results are complete, but ', error)
        return
      end if
    end if
    if (allocated(error)) call tell(folder, 'no results were replaced: ', error)
  end subroutine publish

  !> Completes what was interrupted in the folder `path`, if anything was: then mended is true, or
  !> there is an error.
  subroutine mend(path, mended, error)
    character(len=*), intent(in) :: path
    logical, intent(out) :: mended
    type(failure_t), allocatable, intent(out) :: error
    type(folder_lock_t) :: folder
    logical :: new(size(result_files))

    mended = .false.
    if (.not. file_exists(path // '/' // intent_name)) return
    call folder%take(path, error)
    if (allocated(error)) return
    ! The run that was at it may have ended meanwhile.
    if (folder%contains_file(intent_name)) then
      call read_intent(folder, new, error)
      if (.not. allocated(error)) call put_in_place(folder, new, error)
      if (.not. allocated(error)) call clean_up(folder, new, error)
      mended = .not. allocated(error)
      if (allocated(error)) call tell(folder, 'the results are complete, but ', error)
    end if
    call folder%release()
  end subroutine mend

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

  !> Writes the file of intent.
  subroutine declare(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    type(output_t) :: file
    integer :: i

    call file%open(folder%path_of(intent_name // partial), error)
    if (.not. allocated(error)) call file%put(explanation, error)
    do i = 1, size(new)
      if (allocated(error)) return
      if (new(i)) call file%line(trim(result_files(i)), error)
    end do
    if (.not. allocated(error)) call file%close(error)
    ! The new set's names must be on the disk before the file that counts on them.
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call folder%rename_file(intent_name // partial, intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine declare

  !> Which files are new, as `declare` wrote it.
  subroutine read_intent(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(out) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), parameter :: advice = '; if ' // intent_name // &
      ' is removed the deck can be run again from the beginning'
    character(len=:), allocatable :: text, name
    logical :: named, waiting
    integer :: i

    new = .false.
    call read_file(folder%path_of(intent_name), text)
    if (.not. allocated(text)) text = ''
    do i = 1, size(new)
      name = trim(result_files(i))
      new(i) = index(text, nl // name // nl) > 0
      named = folder%contains_file(name)
      waiting = folder%contains_file(name // partial)
      if (new(i) .and. .not. (named .or. waiting)) call fail(error, file_trouble, &
        folder%path_of(name) // ' is missing' // advice)
    end do
    if (.not. any(new)) call fail(error, file_trouble, folder%path_of(intent_name) // &
      ' lists no results' // advice)
  end subroutine read_intent

  !> Sets old files aside and gives new ones their names.
  subroutine put_in_place(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    logical :: waiting
    integer :: i

    do i = size(new), 1, -1
      name = trim(result_files(i))
      waiting = folder%contains_file(name // partial)
      ! Then it is new.
      if (new(i) .and. .not. waiting) cycle
      if (.not. folder%contains_file(name)) cycle
      call folder%rename_file(name, name // set_aside, error)
      if (allocated(error)) return
    end do
    do i = 1, size(new)
      name = trim(result_files(i))
      waiting = folder%contains_file(name // partial)
      if (.not. (new(i) .and. waiting)) cycle
      call folder%rename_file(name // partial, name, error)
      if (allocated(error)) return
    end do
    call folder%sync(error)
  end subroutine put_in_place

  !> Takes back what `put_in_place` has done. Where that fails too the file of intent stays.
  subroutine undo(folder, new)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable :: error
    character(len=:), allocatable :: name
    logical :: waiting
    integer :: i

    do i = size(new), 1, -1
      name = trim(result_files(i))
      waiting = folder%contains_file(name // partial)
      if (waiting .or. .not. new(i)) cycle
      call folder%rename_file(name, name // partial, error)
      if (allocated(error)) return
    end do
    do i = 1, size(new)
      name = trim(result_files(i))
      if (.not. folder%contains_file(name // set_aside)) cycle
      call folder%rename_file(name // set_aside, name, error)
      if (allocated(error)) return
    end do
    call folder%sync(error)
    if (.not. allocated(error)) call withdraw(folder, error)
  end subroutine undo

  !> Removes what the new set has no use for, and says that it is complete.
  subroutine clean_up(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    integer :: i

    do i = 1, size(new)
      name = trim(result_files(i))
      call folder%remove_file(name // set_aside, error)
      if (.not. (new(i) .or. allocated(error))) call folder%remove_file(name // partial, error)
      if (allocated(error)) return
    end do
    call folder%remove_file(journal_name, error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call withdraw(folder, error)
  end subroutine clean_up

  !> Removes the file of intent. It must not come back when files have partial names again.
  subroutine withdraw(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error

    call folder%remove_file(intent_name // partial, error)
    if (.not. allocated(error)) call folder%remove_file(intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine withdraw

end module publication
