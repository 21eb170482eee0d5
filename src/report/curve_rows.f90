!> The curve: one row for each equilibrium.
module curve_rows
  use records, only: record_t
  use decimal, only: put_whole, longest_real
  use tables, only: put_cells
  use result_tables, only: columns_of
  implicit none
  private
  public :: columns_of_curve, curve_row

contains

  !> The columns of the table: with those of stability if there are eigenvalues, and with the first
  !> `of_drive` of those of a drive in time.
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

end module curve_rows
