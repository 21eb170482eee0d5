!> Gives a set of results its names. While this happens, the folder has the file of intent,
!> `INCOMPLETE.txt`. Without that file, all results that are not called `.partial` are one complete
!> set on the disk.
!>
!> The folder may hold other files, so that it cannot be replaced as a whole. The file of intent
!> lists the new set: while it exists, the new file NAME is NAME.partial if that exists and NAME
!> otherwise, and an interrupted replacement is repeated from the beginning. The steps, each on the
!> disk before the next begins:
!>
!> 1. The new files, the list, their partial names, and the name of the folder are written.
!> 2. The list is renamed to `INCOMPLETE.txt`.
!> 3. New files get their names, the summary last; results of an earlier run without a successor,
!>    other partial files and the journal are removed.
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
    'curve_sensitivity.csv', 'fit.csv', 'fit.nml', 'sweep.csv', 'costs.csv', &
    summary_name]
  character(len=*), parameter :: journal_name = 'journal' // partial
  character(len=*), parameter :: intent_name = 'INCOMPLETE.txt'
  character(len=1), parameter :: nl = new_line('a')
  character(len=*), parameter :: explanation = &
    'The files in this folder may not belong together: the program was stopped while it' // &
    nl // 'replaced older results by new ones. Do not use them as they are.' // &
    nl // 'Run the deck again, best with --resume: this first completes the replacement.' // &
    nl // 'By hand: for each file NAME listed below, rename NAME.partial to NAME if it exists.' // &
    nl // 'Then remove all other results, all files that end in .partial, and this file.' // nl

contains

  !> Gives the complete files of `folder` that are marked in `new` (one for each of `result_files`,
  !> the summary among them) their final names instead of the partial ones. Files of an earlier run
  !> and the journal are removed. If that fails, `error` says what the folder then holds.
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

  !> Completes an interrupted replacement in the folder `path`, if there is one. mended: the folder
  !> now has complete results.
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
    ! Another run may have completed it meanwhile.
    if (folder%contains_file(intent_name)) then
      call read_intent(folder, new, error)
      if (.not. allocated(error)) call put_in_place(folder, new, error)
      mended = .not. allocated(error)
      if (allocated(error)) call tell(folder, 'the results are complete, but ', error)
    end if
    call folder%release()
  end subroutine mend

  !> Adds to an error what the folder holds: `otherwise`, unless the file of intent exists.
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
    ! The names of the new set must be on the disk before the file of intent.
    if (.not. allocated(error)) call folder%sync_above(error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call folder%rename_file(intent_name // partial, intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine declare

  !> The new files, as listed in the file of intent.
  subroutine read_intent(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(out) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), parameter :: advice = '; if ' // intent_name // &
      ' is removed the deck can be run again from the beginning'
    character(len=:), allocatable :: text, name
    logical :: there
    integer :: i

    call read_file(folder%path_of(intent_name), text)
    if (.not. allocated(text)) text = ''
    do i = 1, size(new)
      name = trim(result_files(i))
      new(i) = index(text, nl // name // nl) > 0
      if (.not. new(i)) cycle
      there = folder%contains_file(name)
      if (.not. there) there = folder%contains_file(name // partial)
      if (.not. there) &
        call fail(error, file_trouble, folder%path_of(name) // ' is missing' // advice)
    end do
    if (.not. any(new)) call fail(error, file_trouble, folder%path_of(intent_name) // &
      ' lists no results' // advice)
  end subroutine read_intent

  !> Gives new files their names, removes other results, and then removes the file of intent.
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

  !> Removes the file of intent, also its partial one, which must not return with the next set.
  subroutine withdraw(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error

    call folder%remove_file(intent_name // partial, error)
    if (.not. allocated(error)) call folder%remove_file(intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine withdraw

end module publication
