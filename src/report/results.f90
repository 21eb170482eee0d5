!> The results of one run: a folder with the curve, the profiles, the tables and the summary.
!>
!> All files are first written as `.partial` files, the curve and the profiles row by row; `finish`
!> gives the whole set its names (`publication`). Until then the results of an earlier run stay
!> unchanged, and files of an interrupted run have partial names. One run at a time has the folder.
!> A journal keeps the states found, from which another run can continue.
module results
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use failure, only: failure_t, fail, file_trouble
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use records, only: record_t, observer_t
  use scene_groups, only: scene_t
  use deck, only: deck_t
  use files, only: make_folder, file_exists
  use folder_lock, only: folder_lock_t
  use publication, only: publish, result_files, journal_name, summary_name
  use journal, only: journal_t
  use run_identity, only: difference_between
  use text_file, only: output_t, partial
  use tables, only: table_t, cells, columns_of_curve, curve_row, columns_of_profiles, write_profile
  use result_tables, only: columns_of
  use text, only: word_of
  use summary, only: summary_t, summary_text
  use progress, only: progress_t
  implicit none
  private
  public :: results_t, journal_of, to_stream

  !> Replaces a folder if results go to standard output, file by file in pieces (`text_file`).
  character(len=*), parameter :: to_stream = '-'
  integer(c_int), parameter :: standard_output = 1

  !> Takes the results of a run, between `open` and `finish`. The first error is kept in `trouble`;
  !> after it nothing more is written. Must not be copied while files are open.
  type, extends(observer_t) :: results_t
    !> Not allocated if there was no error.
    type(failure_t), allocatable :: trouble
    !> Once started, it counts a step for each record of a cycle. The states of a path come all at
    !> once, after the work, and are not counted.
    type(progress_t) :: progress
    !> The states found by this run, and by an interrupted one.
    type(journal_t) :: journal
    !> The descriptor, if results go to a stream. Then there is no folder and no journal.
    integer(c_int), allocatable, private :: stream
    !> Excludes other runs from the folder.
    type(folder_lock_t) :: lock
    character(len=:), allocatable, private :: folder, title, version
    type(table_t), private :: curve, shapes, cases, beside
    !> Whether this run has made each of `result_files`.
    logical, private :: made(size(result_files)) = .false.
  contains
    procedure :: open => open_results
    procedure :: take
    procedure :: hear
    procedure :: take_case
    procedure :: begin_table
    procedure :: row
    procedure :: write_text
    procedure :: write_summary
    procedure :: finish
    procedure, private :: claim
    procedure, private :: check_presence
    procedure, private :: file_of
    procedure, private :: begin
  end type results_t

contains

  !> Creates and locks the folder, opens its journal and begins the curve and the profiles if the
  !> scene has them, so that a folder that cannot be written shows before anything is computed.
  !> `owner` is the run's identity; resume: the journal of an interrupted run, if there is one, is
  !> continued.
  subroutine open_results(self, folder, scene, version, problem, owner, resume, error)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: folder, version, owner
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: resume
    type(failure_t), allocatable, intent(out) :: error

    self%folder = folder
    if (len(folder) == 0) self%folder = '.'
    self%title = scene%title
    self%version = version
    if (folder == to_stream) then
      self%stream = standard_output
    else
      call self%claim(owner, resume, error)
    end if
    if (scene%has_curve() .and. .not. allocated(error)) then
      call self%begin(self%curve, 'curve.csv', columns_of_curve(scene%has_eigenvalues(), &
        scene%drive_columns()), error)
      if (allocated(scene%profile_h0) .and. .not. allocated(error)) &
        call self%begin(self%shapes, 'profiles.csv', columns_of_profiles(problem), error)
    end if
    if (.not. allocated(error)) return
    self%trouble = error
    call self%lock%release()
  end subroutine open_results

  !> Begins the table `name`, a file of the folder.
  subroutine begin(self, table, name, columns, error)
    class(results_t), intent(inout) :: self
    type(table_t), intent(inout) :: table
    character(len=*), intent(in) :: name, columns(:)
    type(failure_t), allocatable, intent(inout) :: error

    where (result_files == name) self%made = .true.
    call table%begin(self%file_of(name), self%title, self%version, columns, error, self%stream)
  end subroutine begin

  !> Creates and locks the folder and opens the journal.
  subroutine claim(self, owner, resume, error)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: owner
    logical, intent(in) :: resume
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: path, other
    logical :: left_over

    call make_folder(self%folder, error)
    if (.not. allocated(error)) call self%lock%take(self%folder, error)
    if (allocated(error)) return
    path = journal_of(self%folder)
    left_over = file_exists(path)
    if (.not. (resume .and. left_over)) then
      call self%journal%begin(path, owner, error)
      return
    end if
    call self%journal%go_on(path, owner, other, error)
    if (allocated(other)) call fail(error, file_trouble, 'cannot continue: the interrupted ' // &
      'run had another ' // difference_between(other, owner))
  end subroutine claim

  !> Path of the journal in a folder of results.
  pure function journal_of(folder) result(path)
    character(len=*), intent(in) :: folder
    character(len=:), allocatable :: path

    path = folder // '/' // journal_name
  end function journal_of

  !> Shows the present activity.
  subroutine hear(self, what)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: what

    call self%progress%note(what)
  end subroutine hear

  !> Adds a record to the curve and, if `profile`, the state to the profiles.
  subroutine take(self, record, problem, grid, state, profile)
    class(results_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile

    if (record%branch == 'path') then
      call self%progress%note(record%branch)
    else
      call self%progress%step(record%branch, given=self%journal%is_behind())
    end if
    if (allocated(self%trouble)) return
    call self%curve%line(curve_row(record), self%trouble)
    if (.not. allocated(self%trouble)) call self%curve%show(self%trouble)
    if (profile .and. .not. allocated(self%trouble)) call write_profile(self%shapes, &
      record%branch, record%h0, problem, grid, state, self%trouble)
  end subroutine take

  !> Adds a case of a sweep to `sweep.csv`: the values of its keys, its numbers, and why it failed,
  !> blank if it did not. `columns` has the columns of keys and numbers; if words(k) is not blank,
  !> value k is the number of one of these words.
  subroutine take_case(self, columns, words, values, numbers, failure)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: columns(:), words(:), failure
    real(wp), intent(in) :: values(:), numbers(:)
    character(len=:), allocatable :: line
    integer :: k

    if (allocated(self%trouble)) return
    if (.not. self%cases%is_open()) call self%begin(self%cases, 'sweep.csv', columns, self%trouble)
    line = ''
    do k = 1, size(values)
      if (words(k) == '') then
        line = line // cells(values(k:k)) // ','
      else
        line = line // word_of(words(k), nint(values(k))) // ','
      end if
    end do
    if (.not. allocated(self%trouble)) call self%cases%line(line // cells(numbers) // ',' // &
      trim(without_commas(failure)), self%trouble)
    if (.not. allocated(self%trouble)) call self%cases%flush(self%trouble)
  end subroutine take_case

  !> A text as a cell of a table: without commas and control characters.
  pure function without_commas(text) result(cell)
    character(len=*), intent(in) :: text
    character(len=len(text)) :: cell
    integer :: i

    cell = text
    do i = 1, len(cell)
      if (cell(i:i) == ',') cell(i:i) = ';'
      if (iachar(cell(i:i)) < 32) cell(i:i) = ' '
    end do
  end function without_commas

  !> Begins one of `result_tables`, for rows to follow, and ends the one before.
  subroutine begin_table(self, name)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name

    if (allocated(self%trouble)) return
    call self%progress%note('writing ' // name)
    call self%begin(self%beside, name, columns_of(name), self%trouble)
  end subroutine begin_table

  !> Adds a row: text first, if given, then numbers, then 1 or 0 for each of `truths`.
  subroutine row(self, text, numbers, truths)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in), optional :: text
    real(wp), intent(in) :: numbers(:)
    logical, intent(in), optional :: truths(:)
    character(len=:), allocatable :: line
    integer :: i

    if (allocated(self%trouble)) return
    line = cells(numbers)
    if (present(text)) line = text // ',' // line
    if (present(truths)) then
      do i = 1, size(truths)
        line = line // merge(',1', ',0', truths(i))
      end do
    end if
    call self%beside%line(line, self%trouble)
  end subroutine row

  !> Writes the whole file `name`, one of `result_files`.
  subroutine write_text(self, name, text)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name, text
    type(output_t) :: file

    if (allocated(self%trouble)) return
    call self%beside%close(self%trouble)
    if (allocated(self%trouble)) return
    where (result_files == name) self%made = .true.
    call file%open(self%file_of(name), self%trouble, self%stream)
    if (.not. allocated(self%trouble)) call file%put(text, self%trouble)
    if (.not. allocated(self%trouble)) call file%close(self%trouble)
  end subroutine write_text

  !> Writes the summary and the deck.
  subroutine write_summary(self, summary, deck)
    class(results_t), intent(inout) :: self
    type(summary_t), intent(in) :: summary
    type(deck_t), intent(in) :: deck
    type(failure_t), allocatable :: missing

    if (allocated(self%trouble)) return
    ! Another folder of the same name may hold the summary of another run.
    if (.not. allocated(self%stream)) call self%check_presence(missing)
    if (allocated(missing)) then
      call move_alloc(missing, self%trouble)
      return
    end if
    call self%write_text(summary_name, summary_text(summary) // deck%resolved())
  end subroutine write_summary

  !> Ends the progress and gives the files of this run their names. Files of an earlier run that
  !> this run has not made are removed, and finally the journal. After an error, also in the
  !> journal, the partial files stay and `error` gives the reason. The folder is unlocked.
  subroutine finish(self, error)
    class(results_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error

    call self%progress%finish()
    if (.not. allocated(self%trouble) .and. allocated(self%journal%trouble)) &
      self%trouble = self%journal%trouble
    call finish_table(self%curve, self%trouble)
    call finish_table(self%shapes, self%trouble)
    call finish_table(self%cases, self%trouble)
    call finish_table(self%beside, self%trouble)
    if (allocated(self%trouble)) then
      error = self%trouble
    else if (any(self%made) .and. .not. allocated(self%stream)) then
      call self%check_presence(error)
      if (.not. allocated(error)) call publish(self%lock, self%made, error)
    end if
    if (allocated(error)) then
      call self%journal%close()
    else
      call self%journal%drop()
    end if
    call self%lock%release()
  end subroutine finish

  !> Fails if a file that this run has begun is no longer in the folder.
  subroutine check_presence(self, error)
    class(results_t), intent(in) :: self
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

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

      call fail(error, file_trouble, self%folder // '/' // name // ' was removed or moved ' // &
        'away during the run; make sure that no other program does this')
    end subroutine complain

  end subroutine check_presence

  subroutine finish_table(table, error)
    type(table_t), intent(inout) :: table
    type(failure_t), allocatable, intent(inout) :: error
    type(failure_t), allocatable :: another

    call table%close(another)
    if (allocated(another) .and. .not. allocated(error)) call move_alloc(another, error)
  end subroutine finish_table

  !> Path of a file while it is written: its partial name in the folder, or its name in a stream.
  pure function file_of(self, name) result(path)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: path

    path = self%folder // '/' // name // partial
    if (allocated(self%stream)) path = name
  end function file_of

end module results
