!> The results of one run: the curve, the profiles, the tables and the summary, as files of a folder
!> (`result_folder`). The curve, the profiles and the tables are written row by row.
module results
  use kinds, only: wp
  use text, only: quoted, word_of
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use records, only: record_t, observer_t
  use scene_groups, only: scene_t, sweep_t
  use deck, only: deck_t
  use publication, only: summary_name
  use text_file, only: output_t
  use tables, only: table_t, cells, columns_of_curve, curve_row, columns_of_profiles, write_profile
  use result_folder, only: result_folder_t
  use result_tables, only: columns_of
  use summary, only: summary_t, summary_text
  use progress, only: progress_t
  implicit none
  private
  public :: results_t

  !> Takes the results of a run, between `open` and `finish`. The first error is kept in `trouble`;
  !> after an error nothing more is written. An object of this type must not be copied while its
  !> files are open.
  type, extends(observer_t) :: results_t
    !> Not allocated if there was no error.
    type(failure_t), allocatable :: trouble
    !> After its start, the progress counts a step for each record of a cycle. The states of a path
    !> all come at the end of the computation and are not counted.
    type(progress_t) :: progress
    type(result_folder_t) :: folder
    character(len=:), allocatable, private :: title, version
    type(table_t), private :: curve, shapes, cases, costs, beside
    !> Number of rows of the curve.
    integer, private :: states = 0
  contains
    procedure :: open => open_results
    procedure :: take
    procedure :: hear
    procedure :: take_case
    procedure :: take_costs
    procedure :: begin_table
    procedure :: row
    procedure :: write_text
    procedure :: write_summary
    procedure :: finish
    procedure, private :: begin
  end type results_t

contains

  !> Opens the folder, and begins the curve and the profiles if the scene has them. A folder that
  !> cannot be written is thus reported before the computation. owner, resume: as in
  !> `result_folder`.
  subroutine open_results(self, folder, scene, version, problem, owner, resume, error)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: folder, version, owner
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: resume
    type(failure_t), allocatable, intent(out) :: error

    self%title = scene%title
    self%version = version
    call self%folder%open(folder, owner, resume, error)
    if (scene%has_curve() .and. .not. allocated(error)) then
      call self%begin(self%curve, 'curve.csv', columns_of_curve(scene%has_eigenvalues(), &
        scene%drive_columns()), error)
      if (allocated(scene%profile_h0) .and. .not. allocated(error)) &
        call self%begin(self%shapes, 'profiles.csv', columns_of_profiles(problem), error)
    end if
    if (.not. allocated(error)) return
    self%trouble = error
    call self%folder%lock%release()
  end subroutine open_results

  !> Begins the table `name`, a file of the folder.
  subroutine begin(self, table, name, columns, error)
    class(results_t), intent(inout) :: self
    type(table_t), intent(inout) :: table
    character(len=*), intent(in) :: name, columns(:)
    type(failure_t), allocatable, intent(inout) :: error

    call table%begin(self%folder%new_file(name), self%title, self%version, columns, error, &
      self%folder%stream)
  end subroutine begin

  !> Shows what the program does at present.
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
      call self%progress%step(record%branch)
    end if
    if (allocated(self%trouble)) return
    call self%curve%line(curve_row(record), self%trouble)
    self%states = self%states + 1
    if (.not. allocated(self%trouble)) call self%curve%show(self%trouble)
    if (profile .and. .not. allocated(self%trouble)) call write_profile(self%shapes, &
      record, self%states, problem, grid, state, self%trouble)
  end subroutine take

  !> Adds a case of a sweep to `sweep.csv`: the values of its keys, its numbers, and texts. The
  !> value of one key may be the text `of_case`. The last text is the reason of a failure, blank if
  !> there is none. `columns` describes the columns.
  subroutine take_case(self, columns, sweep, values, of_case, numbers, texts)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: columns(:), of_case, texts(:)
    type(sweep_t), intent(in) :: sweep
    real(wp), intent(in) :: values(:), numbers(:)
    character(len=:), allocatable :: line
    integer :: i

    if (allocated(self%trouble)) return
    if (.not. self%cases%is_open()) call self%begin(self%cases, 'sweep.csv', columns, self%trouble)
    line = key_cells(sweep, values, of_case) // cells(numbers)
    do i = 1, size(texts)
      line = line // ',' // trim(without_commas(texts(i)))
    end do
    if (.not. allocated(self%trouble)) call self%cases%line(line, self%trouble)
    if (.not. allocated(self%trouble)) call self%cases%flush(self%trouble)
  end subroutine take_case

  !> Adds the cost of a case of a sweep to `costs.csv`; the arguments are those of `take_case`.
  subroutine take_costs(self, columns, sweep, values, of_case, numbers)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: columns(:), of_case
    type(sweep_t), intent(in) :: sweep
    real(wp), intent(in) :: values(:), numbers(:)

    if (allocated(self%trouble)) return
    if (.not. self%costs%is_open()) call self%begin(self%costs, 'costs.csv', columns, self%trouble)
    if (.not. allocated(self%trouble)) call self%costs%line(key_cells(sweep, values, &
      of_case) // cells(numbers), self%trouble)
    if (.not. allocated(self%trouble)) call self%costs%flush(self%trouble)
  end subroutine take_costs

  !> The values of a sweep's keys as cells, each with a comma after it.
  pure function key_cells(sweep, values, of_case) result(line)
    type(sweep_t), intent(in) :: sweep
    real(wp), intent(in) :: values(:)
    character(len=*), intent(in) :: of_case
    character(len=:), allocatable :: line
    integer :: k

    line = ''
    do k = 1, size(values)
      if (k == sweep%text_key) then
        line = line // quoted_cell(of_case) // ','
      else if (sweep%words(k) == '') then
        line = line // cells(values(k:k)) // ','
      else
        line = line // word_of(sweep%words(k), nint(values(k))) // ','
      end if
    end do
  end function key_cells

  !> A text as a cell of a table: in double quotes if it has a comma or a quote.
  pure function quoted_cell(text) result(cell)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: cell

    cell = text
    if (scan(text, ',"') > 0) cell = quoted(text, '"')
  end function quoted_cell

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

  !> Begins one of `result_tables`, whose rows follow, and ends the table before it.
  subroutine begin_table(self, name)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name

    if (allocated(self%trouble)) return
    call self%progress%note('writing ' // name)
    call self%begin(self%beside, name, columns_of(name), self%trouble)
  end subroutine begin_table

  !> Adds a row: the text, if there is one, then the numbers, then 1 or 0 for each of `truths`.
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
    call file%open(self%folder%new_file(name), self%trouble, self%folder%stream)
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
    ! The folder may have been replaced by another one of the same name, with the summary of another
    ! run.
    call self%folder%check_presence(missing)
    if (allocated(missing)) then
      call move_alloc(missing, self%trouble)
      return
    end if
    call self%write_text(summary_name, summary_text(summary) // deck%resolved())
  end subroutine write_summary

  !> Ends the progress and closes the folder, which puts the files in place. After an error, also
  !> one in writing the journal, the partial files stay and `error` gives the reason.
  subroutine finish(self, error)
    class(results_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error

    call self%progress%finish()
    if (.not. allocated(self%trouble) .and. allocated(self%folder%journal%trouble)) &
      self%trouble = self%folder%journal%trouble
    call finish_table(self%curve, self%trouble)
    call finish_table(self%shapes, self%trouble)
    call finish_table(self%cases, self%trouble)
    call finish_table(self%costs, self%trouble)
    call finish_table(self%beside, self%trouble)
    if (allocated(self%trouble)) error = self%trouble
    call self%folder%close(error)
  end subroutine finish

  subroutine finish_table(table, error)
    type(table_t), intent(inout) :: table
    type(failure_t), allocatable, intent(inout) :: error
    type(failure_t), allocatable :: another

    call table%close(another)
    if (allocated(another) .and. .not. allocated(error)) call move_alloc(another, error)
  end subroutine finish_table

end module results
