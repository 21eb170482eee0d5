!> Tables as comma-separated values, written row by row.
module tables
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use failure, only: failure_t
  use decimal, only: put_real, longest_real
  use text_file, only: output_t, plain
  implicit none
  private
  public :: table_t, cells, put_cells, direction_of

  !> A table that is being written, one row a line, made with `cells`.
  type, extends(output_t) :: table_t
  contains
    procedure :: begin
  end type table_t

contains

  !> Begins the table `path`: lines that begin with '#' (title, version, and the description of each
  !> column as 'name [unit] meaning'), then the names of the columns. stream: the stream that the
  !> table becomes part of (`text_file`).
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

  !> Numbers as cells that read back as the same numbers; NaN is `NaN`.
  pure function cells(values) result(text)
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text
    character(len=(longest_real + 1)*size(values)) :: row
    integer :: held

    held = 0
    call put_cells(values, row, held)
    text = row(2:held)
  end function cells

  !> Adds numbers to row(:held), a comma before each; `row` has `longest_real` + 1 characters for
  !> each.
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

end module tables
