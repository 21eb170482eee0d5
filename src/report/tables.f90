!> Tables as comma-separated values, written row by row, and the rows of states. The curve has one
!> row for each equilibrium. Profiles have separation, deformation, pressure and energy of a state
!> against r.
module tables
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use text, only: brief
  use failure, only: failure_t
  use decimal, only: put_real, longest_real, put_whole
  use text_file, only: output_t, plain
  use records, only: record_t
  use result_tables, only: columns_of
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use state_profile, only: state_profile_t, profile_of, alike
  implicit none
  private
  public :: table_t, cells, direction_of, columns_of_curve, curve_row, columns_of_profiles, &
    write_profile

  !> A table that is being written, one line for each row; `cells` makes the text of a row.
  type, extends(output_t) :: table_t
  contains
    procedure :: begin
  end type table_t

contains

  !> Begins the table `path`. The lines that begin with '#' contain the title, the version, and the
  !> description of each column as 'name [unit] meaning'; the line with the names of the columns
  !> follows. stream: the stream that the table becomes part of (`text_file`).
  subroutine begin(self, path, title, version, columns, error, stream)
    class(table_t), intent(inout) :: self
    character(len=*), intent(in) :: path, title, version, columns(:)
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int), intent(in), optional :: stream
    character(len=:), allocatable :: text, names
    integer :: i

    text = trim('# title: ' // plain(title)) // new_line('a') // &
      '# version: snapin ' // plain(version) // new_line('a')
    names = ''
    do i = 1, size(columns)
      text = text // '# ' // trim(columns(i)) // new_line('a')
      if (i > 1) names = names // ','
      names = names // columns(i)(:scan(columns(i) // ' ', ' ') - 1)
    end do
    call self%open(path, error, stream)
    if (.not. allocated(error)) call self%line(text // names, error)
    if (.not. allocated(error)) call self%flush(error)
  end subroutine begin

  !> The name of a direction of motion.
  pure function direction_of(inward) result(direction)
    logical, intent(in) :: inward
    character(len=:), allocatable :: direction

    direction = 'retreat'
    if (inward) direction = 'approach'
  end function direction_of

  !> Numbers as cells with enough digits to give the same numbers when they are read; NaN is written
  !> as `NaN`.
  pure function cells(values) result(text)
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text
    character(len=(longest_real + 1)*size(values)) :: row
    integer :: held

    held = 0
    call put_cells(values, row, held)
    text = row(2:held)
  end function cells

  !> Adds numbers to row(:held), with a comma before each. `row` must have `longest_real` + 1
  !> characters for each number.
  pure subroutine put_cells(values, row, held)
    real(wp), intent(in) :: values(:)
    character(len=*), intent(inout) :: row
    integer, intent(inout) :: held
    integer :: i, length

    do i = 1, size(values)
      row(held + 1:held + 1) = ','
      call put_real(values(i), row(held + 2:), length)
      held = held + 1 + length
    end do
  end subroutine put_cells

  !> The columns of the curve, including those of stability if there are eigenvalues, and the first
  !> `of_drive` of the columns of a drive in time.
  pure function columns_of_curve(eigenvalues, of_drive) result(columns)
    logical, intent(in) :: eigenvalues
    integer, intent(in) :: of_drive
    character(len=96), allocatable :: columns(:), more(:)

    columns = columns_of('curve.csv')
    more = columns_of('curve.csv', 'with &stability')
    if (eigenvalues) columns = [columns, more]
    more = columns_of('curve.csv', 'with &drive')
    columns = [columns, more(:of_drive)]
  end function columns_of_curve

  !> The row of a record, with columns of stability if the record has them.
  pure function curve_row(record) result(text)
    type(record_t), intent(in) :: record
    character(len=:), allocatable :: text
    character(len=len(record%branch) + 14*(longest_real + 1)) :: row
    integer :: held

    row(:len(record%branch)) = record%branch
    held = len(record%branch)
    call put_cells([record%h0, record%h_centre, record%displacement, record%load, &
      record%contact_radius], row, held)
    call put_count(record%stable, row, held)
    call put_cells([record%residual], row, held)
    call put_count(record%iterations, row, held)
    call put_count(merge(1, 0, record%converged), row, held)
    if (allocated(record%eigenvalue)) call put_cells([record%eigenvalue, record%local_criterion, &
      record%axis_criterion], row, held)
    if (allocated(record%time)) call put_cells([record%time], row, held)
    if (allocated(record%z)) call put_cells([record%z], row, held)
    text = row(:held)
  end function curve_row

  !> Adds an integer after a comma.
  pure subroutine put_count(count, row, held)
    integer, intent(in) :: count
    character(len=*), intent(inout) :: row
    integer, intent(inout) :: held
    integer :: length

    row(held + 1:held + 1) = ','
    call put_whole(count, row(held + 2:), length)
    held = held + 1 + length
  end subroutine put_count

  !> The columns of the profiles.
  pure function columns_of_profiles(problem) result(columns)
    type(problem_t), intent(in) :: problem
    character(len=96), allocatable :: columns(:), more(:)

    columns = columns_of('profiles.csv')
    more = columns_of('profiles.csv', 'of bodies that are not alike')
    if (.not. alike(problem)) columns = [columns, more]
  end function columns_of_profiles

  !> Adds a state to a table of profiles: a row for the axis, then one for each node. number: the
  !> number of the state's row in the curve.
  subroutine write_profile(table, record, number, problem, grid, state, error)
    type(table_t), intent(inout) :: table
    type(record_t), intent(in) :: record
    integer, intent(in) :: number
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    type(failure_t), allocatable, intent(inout) :: error
    type(state_profile_t) :: profile
    character(len=:), allocatable :: row, which
    integer :: j

    if (.not. table%is_open()) return
    which = ',' // brief(number) // ',' // brief(record%stable)
    profile = profile_of(problem, grid, state)
    do j = 1, size(profile%r)
      row = record%branch // ',' // cells([record%h0, profile%r(j), profile%gap(j), &
        profile%deformation(j), profile%pressure(j), profile%energy(j)]) // which
      if (.not. alike(problem)) row = row // ',' // cells(profile%each(j, :))
      call table%line(row, error)
      if (allocated(error)) return
    end do
    call table%flush(error)
  end subroutine write_profile

end module tables
