!> New results take the place of old ones.
!>
!> The file of intent, here a list of the new set, appears when every file of that set is on the
!> disk under its `.partial` name, and disappears when all have their final names. While it is
!> there, the new file NAME is NAME.partial where that exists and NAME otherwise: what is
!> interrupted is done again from the beginning. Old files are not overwritten but set aside, so
!> that they can be put back where a step fails. The steps, each on the disk before the next begins:
!>
!> 1. the new files, the list, and their partial names;
!> 2. the list is called `INCOMPLETE.txt`;
!> 3. old files are set aside, the summary first; new ones get their names, the summary last; what
!>    was set aside, other partial files and the journal are removed;
!> 4. `INCOMPLETE.txt` is removed.
module replacement
  use failure, only: failure_t, fail, file_trouble
  use folder_lock, only: folder_lock_t
  use text_file, only: output_t, partial
  use result_names, only: result_files, journal_name, intent_name
  implicit none
  private
  public :: replace_results, complete_replacement, remove_leftovers

  character(len=*), parameter :: set_aside = '.old' // partial
  character(len=1), parameter :: nl = new_line('a')
  character(len=*), parameter :: explanation = &
    'The files in this folder may not belong together: newer results were taking the place' // &
    nl // 'of older ones when the program was stopped. Do not use them like this. Run the deck' // &
    nl // 'again, best with --resume: that first puts the newer results in place, all of them.' // &
    nl // 'By hand: of each file listed below NAME.partial is the newer one where it exists,' // &
    nl // 'and is to be renamed to NAME. Then remove other results, what is called .partial,' // &
    nl // 'and this file.' // nl

contains

  !> Gives the files marked in `new`, one for each of `result_files`, their names in place of those
  !> of an earlier run. complete: that was done, whatever `error` says; otherwise the old ones are
  !> back, or the file of intent is there.
  subroutine replace_results(folder, new, complete, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    logical, intent(out) :: complete
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: again

    complete = .false.
    call declare(folder, new, error)
    if (allocated(error)) then
      call withdraw(folder, again)
      return
    end if
    call put_in_place(folder, new, error)
    if (allocated(error)) then
      call undo(folder, new)
      return
    end if
    complete = .true.
    call clean_up(folder, new, error)
  end subroutine replace_results

  !> Does what was interrupted, of which the file of intent says `text`.
  subroutine complete_replacement(folder, text, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error
    logical :: new(size(result_files))

    call read_intent(folder, text, new, error)
    if (.not. allocated(error)) call put_in_place(folder, new, error)
    if (.not. allocated(error)) call clean_up(folder, new, error)
  end subroutine complete_replacement

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

  !> Which files are new, of the `text` that `declare` wrote.
  subroutine read_intent(folder, text, new, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: text
    logical, intent(out) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    character(len=*), parameter :: advice = '; if ' // intent_name // &
      ' is removed the deck can be run again from the beginning'
    character(len=:), allocatable :: name
    logical :: named, waiting
    integer :: i

    new = .false.
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

  !> Removes what is left over, and then says that the new set is complete. What was set aside is no
  !> longer needed before the new names are on the disk, since the file of intent is there.
  subroutine clean_up(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error

    call remove_leftovers(folder, new, error)
    if (.not. allocated(error)) call folder%sync(error)
    if (.not. allocated(error)) call withdraw(folder, error)
  end subroutine clean_up

  !> Removes what a complete set has no use for: what was set aside, partial files of other runs,
  !> and the journal.
  subroutine remove_leftovers(folder, new, error)
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
  end subroutine remove_leftovers

  !> Removes the file of intent. It must not come back when files have partial names again.
  subroutine withdraw(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error

    call folder%remove_file(intent_name // partial, error)
    if (.not. allocated(error)) call folder%remove_file(intent_name, error)
    if (.not. allocated(error)) call folder%sync(error)
  end subroutine withdraw

end module replacement
