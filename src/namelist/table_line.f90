!> One line of a table of numbers: its comment, and its cells, which blanks, tabs, commas or
!> semicolons separate and which may stand in double quotes. In a line with semicolons or tabs
!> between cells, a comma within a number is a decimal comma.
module table_line
  use text, only: counted
  use deck_scan, only: span_t
  implicit none
  private
  public :: split, blanks, after_mark, uncommented, ends_empty, point_decimals, miscount, &
    columns_where

  character(len=*), parameter :: newline = new_line('a')
  !> Separators of cells: blank and tab; comma and semicolon.
  character(len=*), parameter :: blanks = ' ' // achar(9), marks = ',;', between = blanks // marks

contains

  !> A line without its comment.
  pure function uncommented(line) result(text)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: text

    text = line(:index(line//'#', '#') - 1)
  end function uncommented

  !> The first line of `lines`, with blanks for its comment marks.
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

  !> Replaces decimal commas by points: commas between digits in lines with semicolons, or tabs
  !> between cells. Comments stay, and say nothing about the line.
  pure subroutine point_decimals(text)
    character(len=*), intent(inout) :: text
    character(len=*), parameter :: digits = '0123456789'
    character(len=:), allocatable :: line
    integer :: first, next, last, i

    next = 1
    do while (next <= len(text))
      first = next
      next = first + scan(text(first:), newline)
      if (next == first) next = len(text) + 2
      line = uncommented(text(first:next - 2))
      last = verify(line, blanks, back=.true.)
      if (scan(line(max(1, verify(line, blanks)):last), ';' // achar(9)) == 0) cycle
      do i = first + 1, first + last - 2
        if (text(i:i) /= ',') cycle
        if (scan(text(i - 1:i - 1), digits) > 0 .and. scan(text(i + 1:i + 1), digits) > 0) &
          text(i:i) = '.'
      end do
    end do
  end subroutine point_decimals

  !> The cells of a line up to the last that is not empty, without their double quotes. A comma or
  !> semicolon after another, or before the first cell, is that of an empty cell.
  subroutine split(line, cells)
    character(len=*), intent(in) :: line
    type(span_t), allocatable, intent(out) :: cells(:)
    integer :: first, next, inside

    allocate (cells(0))
    first = after_blanks(1)
    do while (first <= len(line))
      next = first + scan(line(first:) // ' ', between) - 1
      inside = quoted_length(line(first:))
      if (inside < 0) then
        cells = [cells, span_t(first, next - 1)]
      else
        cells = [cells, span_t(first + 1, first + inside)]
        next = first + inside + 2
      end if
      next = after_blanks(next)
      first = next
      if (next > len(line)) exit
      if (scan(line(next:next), marks) > 0) first = after_blanks(next + 1)
    end do
    cells = cells(:findloc(cells%last >= cells%first, .true., 1, back=.true.))

  contains

    !> Number of characters between the quotes of a cell; -1 if it does not stand in quotes.
    pure integer function quoted_length(rest) result(length)
      character(len=*), intent(in) :: rest

      length = -1
      if (rest(1:1) /= '"') return
      length = index(rest(2:), '"') - 1
      if (length + 3 <= len(rest) .and. length >= 0) then
        if (scan(rest(length + 3:length + 3), between) == 0) length = -1
      end if
    end function quoted_length

    !> The first position from `at` on that is no blank.
    pure integer function after_blanks(at)
      integer, intent(in) :: at

      after_blanks = at + verify(line(at:) // marks, blanks) - 1
    end function after_blanks

  end subroutine split

  !> Whether the last cell of a line is empty: nothing, or nothing in quotes, after a separator.
  pure logical function ends_empty(line)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: text
    integer :: last

    text = uncommented(line)
    last = verify(text, blanks, back=.true.)
    ends_empty = .false.
    if (last > 1) ends_empty = scan(text(last:last), marks) > 0 .or. text(last - 1:last) == '""'
  end function ends_empty

  !> What is wrong with a line that has not the expected number of columns.
  pure function miscount(line, found, expected) result(what)
    character(len=*), intent(in) :: line
    integer, intent(in) :: found, expected
    character(len=:), allocatable :: what

    what = columns_where(found, expected)
    if (found < expected .and. ends_empty(line)) what = what // '; the last cell is empty'
  end function miscount

  !> '1 column where 3 columns are expected'.
  pure function columns_where(found, expected) result(what)
    integer, intent(in) :: found, expected
    character(len=:), allocatable :: what

    what = counted(found, 'column') // ' where ' // counted(expected, 'column') // ' are expected'
    if (expected == 1) what = counted(found, 'column') // ' where 1 column is expected'
  end function columns_where

end module table_line
