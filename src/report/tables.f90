!> Tables as comma-separated values, written row by row to a `.partial` file; whoever has it made
!> gives it its name when it is whole.
module tables
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use failure, only: failure_t
  use decimal, only: put_real, longest_real
  use text_file, only: output_t, partial, plain
  implicit none
  private
  public :: table_t, cells, put_cells

  !> A table being written, a row a line, made with `cells`.
  type, extends(output_t) :: table_t
  contains
    procedure :: begin
  end type table_t

contains

  !> Begins the table `path`, for now `path`.partial: lines that start with '#' (title, version,
  !> what each column is), then the names of the columns. A column is described as 'name [unit] what
  !> it is'. stream: the table `path` is part of that (`text_file`).
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
    if (present(stream)) then
      call self%open(path, error, stream)
    else
      call self%open(path // partial, error)
    end if
    if (.not. allocated(error)) call self%line(text // names, error)
    if (.not. allocated(error)) call self%flush(error)
  end subroutine begin

  !> Numbers as cells that read back as the same numbers; a NaN is `NaN`.
  pure function cells(values) result(text)
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text
    character(len=(longest_real + 1)*size(values)) :: row
    integer :: held

    held = 0
    call put_cells(values, row, held)
    text = row(2:held)
  end function cells

  !> Adds numbers to row(:held), a comma before each; the row has room for `longest_real` + 1 each.
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
