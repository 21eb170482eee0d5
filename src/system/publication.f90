!> The files of a folder of results: their names, how to recognise a file written by a run, and how
!> the files of a run replace older ones.
!>
!> A run writes into the folder `unfinished` within the folder of results; if it is interrupted, its
!> rows and its journal stay there. When all files are complete and on the disk, the old summary is
!> removed, then the tables are replaced, and finally the new summary is put in place. Each of these
!> steps is on the disk before the next one begins. Therefore all tables in a folder with a summary
!> belong to one run, at every moment and after a power failure.
!>
!> The folder may also contain files of other origin. A file that no run has written is never
!> replaced or removed, whatever its name is.
module publication
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: not_regular
  use folder_lock, only: folder_lock_t
  implicit none
  private
  public :: publish, check_names, clear_unfinished, result_files, summary_name, journal_name, &
    unfinished

  character(len=*), parameter :: summary_name = 'summary.nml', fit_name = 'fit.nml'
  !> The files of a folder of results, the summary last.
  character(len=*), parameter :: result_files(*) = [character(len=21) :: 'curve.csv', &
    'profiles.csv', 'approximations.csv', 'classical.csv', 'device.csv', &
    'device_jumps.csv', 'fixed_load.csv', 'table.csv', 'sensitivity.csv', &
    'curve_sensitivity.csv', 'fit.csv', fit_name, 'sweep.csv', 'costs.csv', &
    summary_name]
  !> The folder with the files of an unfinished run, and the name of its journal.
  character(len=*), parameter :: unfinished = 'unfinished', journal_name = unfinished // '/journal'

  character(len=1), parameter :: nl = new_line('a')
  !> The first characters of files that runs write: of tables; of the fit; of the journal, after
  !> four words of eight bytes. A summary has the group &summary, after lines of comment.
  character(len=*), parameter :: of_table = '# title:', of_fit = '! A fit by snapin', &
    of_journal = 'program: ', of_summary = '&summary'
  integer, parameter :: words_before = 32
  !> Number of bytes at the beginning of a file that are examined.
  integer, parameter :: enough = 4096

contains

  !> Fails if something in the folder has the name of a result although no run has written it.
  !> `error` gives this name and advice.
  subroutine check_names(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error
    integer :: i

    do i = 1, size(result_files)
      call check_file(folder, trim(result_files(i)), .false., error)
      if (allocated(error)) return
    end do
    ! Another run may be creating the folder at this moment.
    if (folder%contains_file(unfinished)) then
      call check_file(folder, unfinished, .false., error)
      if (.not. allocated(error) .and. folder%contains_file(unfinished)) &
        call refuse(folder, unfinished, 'is not a folder', error)
    else if (folder%contains_folder(unfinished)) then
      do i = 1, size(result_files)
        call check_file(folder, unfinished // '/' // trim(result_files(i)), .true., error)
        if (allocated(error)) return
      end do
      call check_file(folder, journal_name, .true., error)
    end if
  end subroutine check_names

  !> Fails if there is a file `name` that no run has written. If an interrupted run may have written
  !> the file (`cut`), its first characters may be incomplete.
  subroutine check_file(folder, name, cut, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: name
    logical, intent(in) :: cut
    type(failure_t), allocatable, intent(out) :: error
    character(len=enough) :: text
    integer :: length

    if (folder%contains_folder(name)) then
      call refuse(folder, name, 'is a folder', error)
    else if (folder%contains_file(name)) then
      call folder%read_beginning(name, text, length)
      ! Another run may have moved its file at this moment.
      if (.not. folder%contains_file(name)) return
      if (length == -not_regular) then
        call refuse(folder, name, 'is not a file but a link, a pipe or a device', error)
      else if (length < 0) then
        call refuse(folder, name, 'cannot be read, so that nothing shows who has written it', error)
      else if (.not. is_of_run(name, text(:length), cut)) then
        call refuse(folder, name, 'was not written by this program', error)
      end if
    end if
  end subroutine check_file

  subroutine refuse(folder, name, why, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: name, why
    type(failure_t), allocatable, intent(out) :: error

    call fail(error, file_trouble, folder%path_of(name) // ' ' // why // ', and has the name ' // &
      'of a result; move it away, or choose another folder')
  end subroutine refuse

  !> Whether a run has written the file `name`, whose first bytes are `text`. An empty file counts
  !> as one of a run only if it may be incomplete (`cut`).
  pure logical function is_of_run(name, text, cut)
    character(len=*), intent(in) :: name, text
    logical, intent(in) :: cut

    select case (name(index(name, '/') + 1:))
    case (summary_name)
      is_of_run = index(nl // text, nl // of_summary) > 0
    case (fit_name)
      is_of_run = begins(text, of_fit, cut)
    case ('journal')
      ! The first word is a small number; therefore its last bytes are zero.
      is_of_run = .false.
      if (len(text) >= 8) is_of_run = text(5:8) == repeat(achar(0), 4) .and. &
        begins(text(min(words_before, len(text)) + 1:), of_journal, cut)
    case default
      is_of_run = begins(text, of_table, cut)
    end select
    ! A power failure may leave bytes that are zero.
    if (cut .and. verify(text, achar(0)) == 0) is_of_run = .true.
  end function is_of_run

  !> Whether `text` begins with `mark` or, if it may be incomplete (`cut`), is the beginning of
  !> `mark`.
  pure logical function begins(text, mark, cut)
    character(len=*), intent(in) :: text, mark
    logical, intent(in) :: cut

    begins = index(text, mark) == 1
    if (cut .and. len(text) < len(mark)) begins = index(mark, text) == 1
  end function begins

  !> Removes the files that an interrupted run has left. Files of other origin stay, and so does
  !> their folder.
  subroutine clear_unfinished(folder, error)
    type(folder_lock_t), intent(in) :: folder
    type(failure_t), allocatable, intent(out) :: error
    integer :: i

    if (.not. folder%contains_folder(unfinished)) return
    do i = 1, size(result_files)
      call folder%remove_file(unfinished // '/' // trim(result_files(i)), error)
      if (allocated(error)) return
    end do
    call folder%remove_file(journal_name, error)
    if (.not. allocated(error)) call folder%remove_folder(unfinished)
  end subroutine clear_unfinished

  !> Puts those complete files of the run in place that are marked in `new` (one element for each of
  !> `result_files`; the summary must be among them). Other files of an earlier run are removed. If
  !> this fails, `error` says what the folder then contains.
  subroutine publish(folder, new, error)
    type(folder_lock_t), intent(in) :: folder
    logical, intent(in) :: new(:)
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: ignored
    integer :: i

    call check_names(folder, error)
    if (.not. allocated(error)) call folder%sync_above(error)
    if (.not. allocated(error)) call folder%sync(error, unfinished)
    if (.not. allocated(error)) call folder%remove_file(summary_name, error)
    if (allocated(error)) then
      error%message = 'no results were replaced: ' // error%message
      return
    end if
    call folder%sync(error)
    do i = 1, size(new)
      if (allocated(error)) exit
      ! All other files must be in place on the disk before the summary.
      if (i == size(new)) call folder%sync(error)
      if (.not. allocated(error)) call replace(folder, trim(result_files(i)), new(i), error)
    end do
    if (allocated(error)) then
      error%message = 'the new results are complete, but not all are in place: the others are ' // &
        'in ' // folder%path_of(unfinished) // ': ' // error%message
      return
    end if
    call folder%sync(error)
    if (allocated(error)) then
      error%message = 'the new results are in place, but may not be on the disk: ' // error%message
      return
    end if
    ! Files that cannot be removed do no harm.
    call clear_unfinished(folder, ignored)
  end subroutine publish

  !> Puts the new file `name` in place; if there is no new one, removes the old file.
  subroutine replace(folder, name, is_new, error)
    type(folder_lock_t), intent(in) :: folder
    character(len=*), intent(in) :: name
    logical, intent(in) :: is_new
    type(failure_t), allocatable, intent(out) :: error

    if (is_new) then
      call folder%rename_file(unfinished // '/' // name, name, error)
    else
      call folder%remove_file(name, error)
    end if
  end subroutine replace

end module publication
