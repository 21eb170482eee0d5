!> A set of results gets its names. `INCOMPLETE.txt`, the file of intent, is there while it does:
!> without that file, the results that are not called `.partial` are one set and on the disk.
!>
!> The folder may hold files of others, so that it cannot be exchanged for another as a whole. The
!> file of intent lists the new set: while it is there, the new file NAME is NAME.partial where that
!> exists and NAME otherwise, and what was interrupted is done again from the beginning. The steps,
!> each on the disk before the next begins:
!>
!> 1. the new files, the list, their partial names, and the name of the folder;
!> 2. the list is called `INCOMPLETE.txt`;
!> 3. new files get their names, the summary last; results of an earlier run that have no successor,
!>    other partial files and the journal are removed;
!> 4. `INCOMPLETE.txt` is removed.
module publication
  use failure, only: failure_t, fail, file_trouble
  use files, only: read_file, file_exists
  use folder_lock, only: folder_lock_t
  use text_file, only: output_t, partial
  implicit none
  private
  public :: publish, mend, result_files, summary_name, journal_name

  character(len=*), parameter :: summary_name = 'summary.nml'
  !> The files of a folder of results, the summary last.
  character(len=*), parameter :: result_files(*) = [character(len=21) :: 'curve.csv', &
    'profiles.csv', 'approximations.csv', 'classical.csv', 'device.csv', &
    'device_jumps.csv', 'fixed_load.csv', 'table.csv', 'sensitivity.csv', &
    'curve_sensitivity.csv', 'fit.csv', 'fit.nml', 'sweep.csv', summary_name]
  character(len=*), parameter :: journal_name = 'journal' // partial
  character(len=*), parameter :: intent_name = 'INCOMPLETE.txt'
  character(len=1), parameter :: nl = new_line('a')
  character(len=*), parameter :: explanation = &
    'The files in this folder may not belong together: new results were given their names,' // &
    nl // 'in place of older ones, when the program was stopped. Do not use them like this.' // &
    nl // 'Run the deck again, best with --resume: that first gives new results their names.' // &
    nl // 'By hand: of each file listed below NAME.partial is the newer one where it exists,' // &
    nl // 'and is to be renamed to NAME. Then remove other results, what is called .partial,' // &
    nl // 'and this file.' // nl

contains

  !> Gives the files of `folder` that are marked in `new` (one for each of `result_files`; a summary
  !> is among them), complete under their partial names, their own; those of an earlier run
  !> disappear, and so does the journal. Where that fails, `error` says what the folder then holds.
  subroutine publish(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: again
    integer :: i

    do i = 1, size(result_files)
      if (folder%contains_folder(trim(result_files(i)))) call fail(error, file_trouble, &
        folder%path_of(trim(result_files(i))) // ' is a folder; move away what is in the way')
    end do
    if (.not. allocated(error)) then
      call declare(folder, new, error)
      if (allocated(error)) then
        call withdraw(folder, again)
      else
        call put_in_place(folder, new, error)
        if (allocated(error)) call tell(folder, 'the new results are complete, but ', error)
        return
      end if
    end if
    if (allocated(error)) call tell(folder, 'no results were replaced: ', error)
  end subroutine publish

  !> Completes what was interrupted in the folder `path`, if anything was. mended: it now has
  !> complete results.
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
    ! The names of the new set must be on the disk before the file that counts on them.
    if (.not. allocated(error)) call folder%sync_above(error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call folder%rename_file(intent_name // partial, intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine declare

  !> Which files are new, by the file that `declare` wrote.
  subroutine read_intent(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(out) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), parameter :: advice = '; if ' // intent_name // &
      ' is removed the deck can be run again from the beginning'
    character(len=:), allocatable :: text, name
    integer :: i

    call read_file(folder%path_of(intent_name), text)
    if (.not. allocated(text)) text = ''
    do i = 1, size(new)
      name = trim(result_files(i))
      new(i) = index(text, nl // name // nl) > 0
      if (new(i) .and. .not. (folder%contains_file(name) .or. &
        folder%contains_file(name // partial))) call fail(error, file_trouble, &
        folder%path_of(name) // ' is missing' // advice)
    end do
    if (.not. any(new)) call fail(error, file_trouble, folder%path_of(intent_name) // &
      ' lists no results' // advice)
  end subroutine read_intent

  !> Gives new files their names, removes what the new set has no use for, and then says that it is
  !> complete.
  subroutine put_in_place(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: name
    integer :: i

    do i = 1, size(new)
      name = trim(result_files(i))
      if (.not. new(i)) then
        call folder%remove_file(name, error)
        if (.not. allocated(error)) call folder%remove_file(name // partial, error)
      else if (folder%contains_file(name // partial)) then
        call folder%rename_file(name // partial, name, error)
      end if
      if (allocated(error)) return
    end do
    call folder%remove_file(journal_name, error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call withdraw(folder, error)
  end subroutine put_in_place

  !> Removes the file of intent. It must not come back when files have partial names again.
  subroutine withdraw(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error

    call folder%remove_file(intent_name // partial, error)
    if (.not. allocated(error)) call folder%remove_file(intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine withdraw

end module publication
