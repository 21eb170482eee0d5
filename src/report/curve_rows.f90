!> The curve: one row an equilibrium.
module curve_rows
  use records, only: record_t
  use decimal, only: put_whole, longest_whole
  use tables, only: cells
  implicit none
  private
  public :: columns_of_curve, curve_row, curve_columns, stability_columns

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

contains

  !> The columns of the table; with those of stability where `eigenvalues` are shown.
  pure function columns_of_curve(eigenvalues) result(columns)
    logical, intent(in) :: eigenvalues
    character(len=96), allocatable :: columns(:)

    columns = curve_columns
    if (eigenvalues) columns = [curve_columns, stability_columns]
  end function columns_of_curve

  !> The row of a record; columns of stability where the record has them.
  pure function curve_row(record) result(text)
    type(record_t), intent(in) :: record
    character(len=:), allocatable :: text
    character(len=longest_whole) :: stable, iterations
    integer :: of_stable, of_iterations

    call put_whole(record%stable, stable, of_stable)
    call put_whole(record%iterations, iterations, of_iterations)
    text = record%branch // ',' // cells([record%h0, record%h_centre, record%displacement, &
      record%load, record%contact_radius]) // ',' // stable(:of_stable) // ',' // &
      cells([record%residual]) // ',' // iterations(:of_iterations) // &
      merge(',1', ',0', record%converged)
    if (allocated(record%eigenvalue)) text = text // ',' // cells([record%eigenvalue, &
      record%local_criterion, record%axis_criterion])
  end function curve_row

end module curve_rows
