!> What `snapin --results` prints: every file of results with its columns, and every entry of
!> summary.nml. Columns and entries are read from the tables that write the files.
module result_listing
  use result_names, only: result_files
  use result_rows, only: row_t, rows, in_summary, in_cost
  use curve_rows, only: curve_columns, stability_columns, drive_columns
  use derived_tables, only: theory_columns
  use device_rows, only: device_columns, jump_columns
  use fixed_load_rows, only: fixed_load_columns
  use table_rows, only: table_columns
  use sensitivity_rows, only: sensitivity_columns, curve_sensitivity_columns
  use fit_rows, only: fit_columns
  use profiles, only: profile_columns, unlike_columns
  implicit none
  private
  public :: write_result_listing

  character(len=*), parameter :: theories = &
    'One row for each theory and each h0 at which it has a state.'

contains

  !> Prints, for each file, a line with its name and the group that asks for it, a line that says
  !> what it holds, and two lines for each column or entry: name and unit, then the meaning.
  subroutine write_result_listing(unit)
    integer, intent(in) :: unit
    integer :: i, status

    do i = 1, size(result_files)
      if (i > 1) write (unit, '()', iostat=status)
      select case (result_files(i))
      case ('curve.csv')
        call heading('with &loading, &equilibrium_path or &drive', 'One row for each equilibrium.')
        call list_columns(unit, curve_columns, '')
        call list_columns(unit, stability_columns, 'with &stability')
        call list_columns(unit, drive_columns, 'with &drive')
      case ('profiles.csv')
        call heading('with &profiles', 'One row for each node of each profile, from r = 0 outward.')
        call list_columns(unit, profile_columns, '')
        call list_columns(unit, unlike_columns, 'of bodies that are not alike')
      case ('approximations.csv')
        call heading('with &approximations', theories)
        call list_columns(unit, theory_columns, '')
      case ('classical.csv')
        call heading('with &classical', theories)
        call list_columns(unit, theory_columns, '')
      case ('device.csv')
        call heading('with &device', 'One row for each equilibrium, for each stiffness.')
        call list_columns(unit, device_columns, '')
      case ('device_jumps.csv')
        call heading('with &device', 'One row for each jump, for each stiffness.')
        call list_columns(unit, jump_columns, '')
      case ('fixed_load.csv')
        call heading('with &fixed_load', 'One row for each equilibrium, for each load.')
        call list_columns(unit, fixed_load_columns, '')
      case ('table.csv')
        call heading('with &table', 'One row for each stable state, in and out.')
        call list_columns(unit, table_columns, '')
      case ('sensitivity.csv')
        call heading('with &sensitivity', 'One row for each number that is differentiated ' // &
          'and each parameter.')
        call list_columns(unit, sensitivity_columns, '')
      case ('curve_sensitivity.csv')
        call heading('with &sensitivity', 'One row for each equilibrium, parameter and stiffness.')
        call list_columns(unit, curve_sensitivity_columns, '')
      case ('fit.csv')
        call heading('with &fit', 'One row for each sample of the measured curve.')
        call list_columns(unit, fit_columns, '')
      case ('fit.nml')
        call heading('with &fit', 'A namelist: &fit, the values found, and a group for each ' // &
          'classical theory, fitted to the same samples.')
      case ('sweep.csv')
        call heading('with &sweep', 'One row for each case: the values of the keys, then the ' // &
          'entries of &summary marked "in sweep.csv", and failure: why a case has not all of them.')
      case ('summary.nml')
        call heading('', 'A namelist: &summary, &cost, and the deck with every default.')
        write (unit, '(/, a, /, 4x, a)', iostat=status) '&summary', 'What was found.'
        call list_rows(unit, in_summary)
        write (unit, '(/, a, /, 4x, a)', iostat=status) '&cost', 'What it took.'
        call list_rows(unit, in_cost)
      end select
    end do

  contains

    subroutine heading(when, what)
      character(len=*), intent(in) :: when, what

      write (unit, '(a)', advance='no', iostat=status) trim(result_files(i))
      if (when /= '') write (unit, '(3a)', advance='no', iostat=status) ' (', when, ')'
      write (unit, '(/, 4x, a)', iostat=status) what
    end subroutine heading

  end subroutine write_result_listing

  !> Prints columns, each described as 'name [unit] meaning'.
  subroutine list_columns(unit, columns, note)
    integer, intent(in) :: unit
    character(len=*), intent(in) :: columns(:), note
    integer :: i, opening, closing

    do i = 1, size(columns)
      opening = index(columns(i), ' [')
      closing = opening + index(columns(i)(opening:), ']') - 1
      call list_one(unit, columns(i)(:opening - 1), columns(i)(opening + 2:closing - 1), note, &
        columns(i)(closing + 2:))
    end do
  end subroutine list_columns

  !> Prints the entries of a group of summary.nml.
  subroutine list_rows(unit, group)
    integer, intent(in) :: unit, group
    integer :: i

    do i = 1, size(rows)
      if (rows(i)%group /= group) cycle
      call list_one(unit, trim(rows(i)%key), trim(rows(i)%unit), sweep_note(rows(i)), &
        rows(i)%meaning)
      if (rows(i)%error /= '') call list_one(unit, trim(rows(i)%key) // trim(rows(i)%error), &
        trim(rows(i)%unit), '', 'estimated error of ' // trim(rows(i)%key))
    end do
  end subroutine list_rows

  !> When a row is a column of sweep.csv; empty for never.
  pure function sweep_note(row) result(note)
    type(row_t), intent(in) :: row
    character(len=:), allocatable :: note

    select case (row%sweep)
    case ('')
      note = ''
    case ('always')
      note = 'in sweep.csv'
    case ('(forces)')
      note = 'in sweep.csv with forces other than a plain &force'
    case ('unloading')
      note = 'in sweep.csv for each turning point'
    case default
      note = 'in sweep.csv with &' // trim(row%sweep)
    end select
  end function sweep_note

  subroutine list_one(unit, name, physical_unit, note, meaning)
    integer, intent(in) :: unit
    character(len=*), intent(in) :: name, physical_unit, note, meaning
    character(len=:), allocatable :: text
    integer :: status

    text = name
    if (physical_unit /= '') text = text // ' [' // physical_unit // ']'
    if (note /= '') text = text // '; ' // note
    write (unit, '(2x, a)', iostat=status) text
    if (meaning /= '') write (unit, '(26x, a)', iostat=status) trim(meaning)
  end subroutine list_one

end module result_listing
