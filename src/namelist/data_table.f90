!> A text file with a table of numbers, as measuring programs write it: comments after #, perhaps a
!> line with the names of the columns, itself perhaps a comment, then a row a line, cells apart by
!> blanks, tabs, commas or semicolons. Where semicolons or tabs stand between cells, a comma within
!> a number is a decimal one.
module data_table
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: lower, quoted, clip, guess
  use deck_number, only: parse_real, parse_integer
  use deck_source, only: source_t, load_source
  use number_columns, only: uncommented, between
  implicit none
  private
  public :: data_table_t, read_data_table, largest_table
  public :: cell_t, split, is_header, after_mark, point_decimals, counted

  !> The columns asked for, value(row, column), and where in the file's text each row stands.
  type :: data_table_t
    type(source_t) :: source
    real(wp), allocatable :: value(:, :)
    integer, allocatable :: place(:)
  end type data_table_t

  !> A cell: its first and last character in a line.
  type :: cell_t
    integer :: first = 0, last = 0
  end type cell_t

  !> Bytes of a table.
  integer, parameter :: largest_table = 64*2**20
  character(len=*), parameter :: newline = new_line('a')

contains

  !> Reads the columns `wanted` of `file`: names from its header line, in upper or lower case, or
  !> numbers counted from 1; a minus before either turns the column's sign. error: what is wrong
  !> with the file, with the line.
  subroutine read_data_table(file, wanted, table, error)
    character(len=*), intent(in) :: file, wanted(:)
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error
    type(cell_t), allocatable :: cells(:), names(:)
    integer, allocatable :: at(:)
    logical, allocatable :: turned(:)
    integer :: first, next, n, columns, named

    call load_source(file, table%source, error, largest_table)
    if (allocated(error)) return
    call point_decimals(table%source%text)
    n = count([(table%source%text(first:first) == newline, first=1, &
      len(table%source%text))]) + 1
    allocate (table%place(n), at(size(wanted)))
    turned = index(adjustl(wanted), '-') == 1
    n = 0
    columns = 0
    named = 0
    next = 1
    do while (next <= len(table%source%text))
      first = next
      next = first + scan(table%source%text(first:), newline)
      if (next == first) next = len(table%source%text) + 2
      call split(uncommented(table%source%part(first, next - 2)), cells)
      if (size(cells) == 0) then
        ! The last comment before the rows may have the names.
        if (columns == 0 .and. index(table%source%part(first, next - 2), '#') > 0) named = first
        cycle
      end if
      if (columns == 0) then
        columns = size(cells)
        if (.not. is_header(table%source, first, cells) .and. named > 0) then
          call split(after_mark(table%source%part(named, first - 2)), names)
          if (size(names) /= columns) named = 0
        else
          named = 0
        end if
        if (named == 0) then
          names = cells
          named = first
        end if
        call find_columns(table%source, named, names, wanted, at, error)
        if (allocated(error)) return
        allocate (table%value(size(table%place), size(at)))
        if (is_header(table%source, first, cells)) cycle
      end if
      if (size(cells) /= columns) then
        call table%source%complain(first, '', '', counted(size(cells)) // ' where ' // &
          counted(columns) // ' are expected', error)
        return
      end if
      n = n + 1
      call read_row(table%source, first, cells(at), turned, table%value(n, :), error)
      if (allocated(error)) return
      table%place(n) = first
    end do
    if (.not. allocated(table%value)) allocate (table%value(0, size(at)))
    table%value = table%value(:n, :)
    table%place = table%place(:n)
  end subroutine read_data_table

  !> The first line of some, with its comment mark a blank.
  pure function after_mark(lines) result(line)
    character(len=*), intent(in) :: lines
    character(len=:), allocatable :: line
    integer :: i

    i = index(lines, newline) - 1
    if (i < 0) i = len(lines)
    line = lines(:i)
    do i = 1, len(line)
      if (line(i:i) == '#') line(i:i) = ' '
    end do
  end function after_mark

  !> Writes decimal commas as points: commas between digits in lines that have semicolons or tabs
  !> between cells.
  pure subroutine point_decimals(text)
    character(len=*), intent(inout) :: text
    character(len=*), parameter :: digits = '0123456789'
    integer :: first, next, i

    next = 1
    do while (next <= len(text))
      first = next
      next = first + scan(text(first:), newline)
      if (next == first) next = len(text) + 2
      if (scan(text(first:next - 2), ';' // achar(9)) == 0) cycle
      do i = first + 1, next - 3
        if (text(i:i) /= ',') cycle
        if (scan(text(i - 1:i - 1), digits) > 0 .and. scan(text(i + 1:i + 1), digits) > 0) &
          text(i:i) = '.'
      end do
    end do
  end subroutine point_decimals

  !> The cells of a line.
  subroutine split(line, cells)
    character(len=*), intent(in) :: line
    type(cell_t), allocatable, intent(out) :: cells(:)
    integer :: first, length

    allocate (cells(0))
    first = 1
    do while (first <= len(line))
      length = verify(line(first:), between)
      if (length == 0) return
      first = first + length - 1
      length = scan(line(first:), between) - 1
      if (length < 0) length = len(line) - first + 1
      cells = [cells, cell_t(first, first + length - 1)]
      first = first + length
    end do
  end subroutine split

  !> Whether a line has a cell that is no number.
  logical function is_header(source, start, cells)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(cell_t), intent(in) :: cells(:)
    character(len=:), allocatable :: what
    real(wp) :: number
    integer :: i

    is_header = .false.
    do i = 1, size(cells)
      call parse_real(source%part(start + cells(i)%first - 1, start + cells(i)%last - 1), number, &
        what)
      is_header = is_header .or. allocated(what)
    end do
  end function is_header

  !> In which column each wanted one is, from the first line that is no comment.
  subroutine find_columns(source, start, cells, wanted, at, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(cell_t), intent(in) :: cells(:)
    character(len=*), intent(in) :: wanted(:)
    integer, intent(out) :: at(:)
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: names, name, what
    integer :: i, k

    names = ''
    do k = 1, size(cells)
      names = names // ' ' // lower(cell(k))
    end do
    do i = 1, size(wanted)
      name = unsigned(wanted(i))
      call parse_integer(name, at(i), what)
      if (allocated(what)) at(i) = 0
      do k = 1, size(cells)
        if (allocated(what) .and. lower(cell(k)) == lower(name)) at(i) = k
      end do
      if (at(i) >= 1 .and. at(i) <= size(cells)) cycle
      call source%complain(start, '', '', 'no column ' // quoted(clip(name)) // &
        guess(name, names(2:), '') // '; this line has ' // counted(size(cells)), error)
    end do

  contains

    pure function cell(k)
      integer, intent(in) :: k
      character(len=:), allocatable :: cell

      cell = source%part(start + cells(k)%first - 1, start + cells(k)%last - 1)
    end function cell

  end subroutine find_columns

  !> A column's name or number without its sign.
  pure function unsigned(name)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unsigned

    unsigned = trim(adjustl(name))
    if (index(unsigned, '-') == 1) unsigned = trim(adjustl(unsigned(2:)))
  end function unsigned

  !> The numbers in these cells of a line; turned: with the other sign.
  subroutine read_row(source, start, cells, turned, row, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(cell_t), intent(in) :: cells(:)
    logical, intent(in) :: turned(:)
    real(wp), intent(out) :: row(:)
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: what
    integer :: i

    do i = 1, size(cells)
      associate (first => start + cells(i)%first - 1, last => start + cells(i)%last - 1)
        call parse_real(source%part(first, last), row(i), what)
      end associate
      if (allocated(what)) then
        call source%complain(start + cells(i)%first - 1, '', '', what, error)
        return
      end if
      if (turned(i)) row(i) = -row(i)
    end do
  end subroutine read_row

  !> '1 column', '3 columns'.
  pure function counted(n)
    integer, intent(in) :: n
    character(len=:), allocatable :: counted
    character(len=12) :: number

    write (number, '(i0)') n
    counted = trim(number) // ' column' // trim(merge(' ', 's', n == 1))
  end function counted

end module data_table
