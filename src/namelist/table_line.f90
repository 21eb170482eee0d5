!> One line of a table: its comment, and its cells. Blanks, tabs, commas or semicolons separate the
!> cells, which may be in double quotes. If semicolons, tabs or blanks separate the cells, a comma
!> within a number is a decimal comma.
module table_line
  use text, only: counted, replaced
  use deck_scan, only: span_t
  implicit none
  private
  public :: split, split_at, separator_of, blanks, after_mark, uncommented, comment_in, &
    excel_errors, ends_empty, point_decimals, plain_signs, miscount, columns_where

  character(len=*), parameter :: newline = new_line('a')
  !> Separators of cells: blank and tab; comma and semicolon.
  character, parameter :: tab = achar(9)
  character(len=*), parameter :: blanks = ' ' // tab, marks = ',;', between = blanks // marks
  !> Texts that spreadsheets write for a number that does not exist.
  character(len=*), parameter :: excel_errors(*) = [character(len=7) :: '#N/A', '#NUM!', &
    '#DIV/0!', '#VALUE!', '#NAME?', '#REF!', '#NULL!']

contains

  !> A line without its comment.
  pure function uncommented(line) result(text)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: text

    text = line(:comment_in(line) - 1)
  end function uncommented

  !> The position where the comment of a line begins; the line's length + 1 without a comment.
  pure integer function comment_in(line) result(at)
    character(len=*), intent(in) :: line
    integer :: k

    at = 0
    do
      k = index(line(at + 1:), '#')
      if (k == 0) exit
      at = at + k
      if (all([(index(line(at:), trim(excel_errors(k))) /= 1, k=1, size(excel_errors))])) return
    end do
    at = len(line) + 1
  end function comment_in

  !> Replaces typographic minus signs and non-breaking blanks in UTF-8 by those of ASCII.
  pure subroutine plain_signs(text)
    character(len=:), allocatable, intent(inout) :: text
    character(len=*), parameter :: minus = char(226) // char(136) // char(146), &
      fixed_blank = char(194) // char(160)
    character(len=len(text)) :: plain
    integer :: i, n

    if (index(text, minus) == 0 .and. index(text, fixed_blank) == 0) return
    n = 0
    i = 1
    do while (i <= len(text))
      n = n + 1
      plain(n:n) = text(i:i)
      if (index(text(i:min(len(text), i + 2)), minus) == 1) then
        plain(n:n) = '-'
        i = i + len(minus)
      else if (index(text(i:min(len(text), i + 1)), fixed_blank) == 1) then
        plain(n:n) = ' '
        i = i + len(fixed_blank)
      else
        i = i + 1
      end if
    end do
    text = plain(:n)
  end subroutine plain_signs

  !> The first line of `lines`, in which blanks replace the comment marks.
  pure function after_mark(lines) result(line)
    character(len=*), intent(in) :: lines
    character(len=:), allocatable :: line
    integer :: i

    i = index(lines, newline) - 1
    if (i < 0) i = len(lines)
    line = replaced(lines(:i), '#', ' ')
  end function after_mark

  !> Replaces decimal commas by points. Decimal commas are commas between digits in lines with other
  !> separators of cells. Comments are neither changed nor taken into account.
  pure subroutine point_decimals(text)
    character(len=*), intent(inout) :: text
    character(len=:), allocatable :: line
    integer :: first, next, last, i

    next = 1
    do while (next <= len(text))
      first = next
      next = first + scan(text(first:), newline)
      if (next == first) next = len(text) + 2
      line = uncommented(text(first:next - 2))
      last = verify(line, blanks, back=.true.)
      if (last == 0) cycle
      if (.not. has_decimal_commas(line(verify(line, blanks):last))) cycle
      do i = first + 1, first + last - 2
        if (between_digits(text(first:first + last - 1), i - first + 1)) text(i:i) = '.'
      end do
    end do
  end subroutine point_decimals

  !> Whether commas between digits are decimal commas. They are if semicolons or tabs separate the
  !> cells, or if blanks do and there is no other comma. line: without blanks at its ends.
  pure logical function has_decimal_commas(line) result(has)
    character(len=*), intent(in) :: line
    integer :: i

    has = scan(line, ';' // tab) > 0
    if (has .or. index(line, ' ') == 0) return
    has = all([(line(i:i) /= ',' .or. between_digits(line, i), i=1, len(line))])
  end function has_decimal_commas

  !> Whether character i of a line is a comma between two digits.
  pure logical function between_digits(line, i)
    character(len=*), intent(in) :: line
    integer, intent(in) :: i
    character(len=*), parameter :: digits = '0123456789'

    between_digits = .false.
    if (i < 2 .or. i >= len(line)) return
    if (line(i:i) == ',') between_digits = scan(line(i - 1:i - 1), digits) > 0 .and. &
      scan(line(i + 1:i + 1), digits) > 0
  end function between_digits

  !> The character that separates the cells of a line: a semicolon, otherwise a comma, otherwise a
  !> tab, otherwise a blank.
  pure character function separator_of(line) result(separator)
    character(len=*), intent(in) :: line
    character(len=*), parameter :: known = ';,' // tab
    integer :: i

    separator = ' '
    do i = len(known), 1, -1
      if (index(trim(line), known(i:i)) > 0) separator = known(i:i)
    end do
  end function separator_of

  !> The cells of a line between `separator`s, without blanks at their ends and without their double
  !> quotes. An empty cell has last < first. For the separator ' ' the procedure `split` is used.
  subroutine split_at(line, separator, cells)
    character(len=*), intent(in) :: line
    character, intent(in) :: separator
    type(span_t), allocatable, intent(out) :: cells(:)
    integer :: i, n, first
    logical :: quoted

    if (separator == ' ') then
      call split(line, cells)
      return
    end if
    allocate (cells(0))
    if (verify(line, blanks) == 0) return
    deallocate (cells)
    allocate (cells(count([(line(i:i) == separator, i=1, len(line))]) + 1))
    n = 0
    first = 1
    quoted = .false.
    do i = 1, len(line) + 1
      if (i <= len(line)) then
        if (line(i:i) == '"') quoted = .not. quoted
        if (line(i:i) /= separator .or. quoted) cycle
      end if
      n = n + 1
      cells(n) = trimmed(first, i - 1)
      first = i + 1
    end do
    cells = cells(:n)

  contains

    !> The part of the line from `first` to `last` without blanks at its ends, and without quotes.
    pure type(span_t) function trimmed(first, last) result(cell)
      integer, intent(in) :: first, last

      cell = span_t(first, first - 1)
      if (verify(line(first:last), blanks) == 0) return
      cell%first = first - 1 + verify(line(first:last), blanks)
      cell%last = first - 1 + verify(line(first:last), blanks, back=.true.)
      if (cell%last == cell%first .or. line(cell%first:cell%first) /= '"' .or. &
        line(cell%last:cell%last) /= '"') return
      cell = span_t(cell%first + 1, cell%last - 1)
    end function trimmed

  end subroutine split_at

  !> The cells of a line up to the last one that is not empty, without their double quotes. A comma
  !> or semicolon that follows another one, or precedes the first cell, marks an empty cell.
  subroutine split(line, cells)
    character(len=*), intent(in) :: line
    type(span_t), allocatable, intent(out) :: cells(:)
    integer :: first, next, inside, n, i

    allocate (cells(1 + count([(scan(line(i:i), between) > 0, i=1, len(line))])))
    n = 0
    first = after_blanks(1)
    do while (first <= len(line))
      next = scan(line(first:), between)
      next = merge(first + next - 1, len(line) + 1, next > 0)
      inside = quoted_length(line(first:))
      n = n + 1
      cells(n) = span_t(first, next - 1)
      if (inside >= 0) then
        cells(n) = span_t(first + 1, first + inside)
        next = first + inside + 2
      end if
      next = after_blanks(next)
      first = next
      if (next > len(line)) exit
      if (scan(line(next:next), marks) > 0) first = after_blanks(next + 1)
    end do
    cells = cells(:findloc(cells(:n)%last >= cells(:n)%first, .true., 1, back=.true.))

  contains

    !> Number of characters between the quotes of a cell; -1 if the cell is not in quotes.
    pure integer function quoted_length(rest) result(length)
      character(len=*), intent(in) :: rest

      length = -1
      if (rest(1:1) /= '"') return
      length = index(rest(2:), '"') - 1
      if (length + 3 <= len(rest) .and. length >= 0) then
        if (scan(rest(length + 3:length + 3), between) == 0) length = -1
      end if
    end function quoted_length

    !> The first position from `at` on that has no blank.
    pure integer function after_blanks(at)
      integer, intent(in) :: at

      after_blanks = verify(line(at:), blanks)
      after_blanks = merge(at + after_blanks - 1, len(line) + 1, after_blanks > 0)
    end function after_blanks

  end subroutine split

  !> Whether the last cell of a line is empty: nothing, or empty quotes, after a separator.
  pure logical function ends_empty(line)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: text
    integer :: last

    text = uncommented(line)
    last = verify(text, blanks, back=.true.)
    ends_empty = .false.
    if (last > 1) ends_empty = scan(text(last:last), marks) > 0 .or. text(last - 1:last) == '""'
  end function ends_empty

  !> A message about a line that does not have the expected number of columns.
  pure function miscount(line, found, expected) result(what)
    character(len=*), intent(in) :: line
    integer, intent(in) :: found, expected
    character(len=:), allocatable :: what

    what = columns_where(found, expected)
    if (found < expected .and. ends_empty(line)) what = what // '; the last cell is empty'
  end function miscount

  !> The text '1 column where 3 columns are expected', with these numbers.
  pure function columns_where(found, expected) result(what)
    integer, intent(in) :: found, expected
    character(len=:), allocatable :: what

    what = counted(found, 'column') // ' where ' // counted(expected, 'column') // ' are expected'
    if (expected == 1) what = counted(found, 'column') // ' where 1 column is expected'
  end function columns_where

end module table_line
