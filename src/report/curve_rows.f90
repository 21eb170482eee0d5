!> The curve: one row an equilibrium.
module curve_rows
  use records, only: record_t
  use decimal, only: put_whole, longest_real
  use tables, only: put_cells
  implicit none
  private
  public :: columns_of_curve, curve_row, curve_columns, stability_columns, drive_columns

  !> Columns of curve.csv, each described as 'name [unit] meaning'.
  character(len=*), parameter :: curve_columns(*) = [character(len=96) :: &
    'branch [] loading, unloading_1, unloading_2, ..., or path', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'h_centre [m] separation on the axis', &
    'displacement [m] h_centre - h0', &
    'load [N] negative: tension', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stable [] 1: stable; 0: unstable, or a fold; -1: not examined', &
    'residual [] largest error of the equations, in units of the length of the force law', &
    'iterations [] products with the elastic operator', &
    'converged [] 1; 0 where the residual is larger than asked for: the row is no equilibrium']
  !> Added by &stability.
  character(len=*), parameter :: stability_columns(*) = [character(len=96) :: &
    'smallest_eigenvalue [] of the operator at fixed h0; negative: unstable', &
    'criterion_28 [] largest |2 u p''/p| where surfaces attract; above 1: unstable by (28)', &
    'criterion_29 [] 2 p'' u/p on an axis that attracts; below -1: unstable by (29)']

  !> Added by &drive, the second where there is a spring.
  character(len=*), parameter :: drive_columns(*) = [character(len=96) :: &
    'time [s] since the drive began to move', &
    'z [m] position of the base of the spring']

contains

  !> The columns of the table; with those of stability where `eigenvalues` are shown, and as many of
  !> a drive in time as there are.
  pure function columns_of_curve(eigenvalues, of_drive) result(columns)
    logical, intent(in) :: eigenvalues
    integer, intent(in) :: of_drive
    character(len=96), allocatable :: columns(:)

    columns = curve_columns
    if (eigenvalues) columns = [curve_columns, stability_columns]
    columns = [columns, drive_columns(:of_drive)]
  end function columns_of_curve

  !> The row of a record; columns of stability where the record has them.
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

  !> Adds a whole number after a comma.
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
