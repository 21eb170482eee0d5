!> The output of `snapin --results`: all files of results with their columns, and all entries of
!> summary.nml, from the tables that write the files.
module result_listing
  use result_rows, only: row_t, rows, in_summary, in_cost, turning, spring, &
    given_load, carpick, pietrement_troyon, layered_regime
  use result_tables, only: tables
  implicit none
  private
  public :: write_result_listing

contains

  !> Prints for each file a line with its name and the group that asks for it, a line with its
  !> content, and two lines for each column or entry: name and unit, then the meaning.
  subroutine write_result_listing(unit)
    integer, intent(in) :: unit
    character(len=len(tables)) :: note
    integer :: i, first, last, status

    do i = 1, size(tables)
      associate (line => tables(i))
        first = scan(line, '|')
        last = scan(line, '|', back=.true.)
        select case (line(:2))
        case ('= ')
          if (i > 1) write (unit, '()', iostat=status)
          write (unit, '(a)', advance='no', iostat=status) trim(line(3:first - 1))
          note = line(first + 2:last - 1)
          if (note /= '') write (unit, '(3a)', advance='no', iostat=status) ' (', trim(note), ')'
          write (unit, '(/, 4x, a)', iostat=status) trim(line(last + 2:))
          note = ''
        case ('+ ')
          note = line(3:)
        case default
          first = index(line, ' [')
          last = first + index(line(first:), ']') - 1
          call list_one(unit, line(:first - 1), line(first + 2:last - 1), trim(note), &
            line(last + 2:))
        end select
      end associate
    end do
    write (unit, '(/, a, /, 4x, a)', iostat=status) '&summary', 'Results of the run.'
    call list_rows(unit, in_summary)
    write (unit, '(/, a, /, 4x, a)', iostat=status) '&cost', 'Time and work of the run.'
    call list_rows(unit, in_cost)
  end subroutine write_result_listing

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

  !> Says when a row is a column of sweep.csv; empty for never.
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
    case (turning)
      note = 'in sweep.csv for each turning point'
    case (spring)
      note = 'in sweep.csv for each stiffness'
    case (given_load)
      note = 'in sweep.csv for each load'
    case (carpick, pietrement_troyon)
      note = 'in sweep.csv with this theory'
    case (layered_regime)
      note = 'in sweep.csv with &regime and &layer'
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
