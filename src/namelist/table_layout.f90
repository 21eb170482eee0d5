!> The layout of a table in a text file: where its rows begin, what separates their cells, and the
!> names and units of its columns. An instrument's file may have lines before the names.
module table_layout
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: lower
  use deck_number, only: parse_real
  use deck_scan, only: span_t
  use deck_source, only: source_t
  use table_line, only: split_at, separator_of, uncommented, comment_in, excel_errors, after_mark, &
    ends_empty, miscount, columns_where
  use column_names, only: longest_name, names_in
  use units, only: unit_in, is_unit_cell
  implicit none
  private
  public :: layout_t, find_layout, next_line, line_of, is_missing, is_header

  !> Number of rows with as many cells that must follow the first row, if other lines may stand
  !> before the names. So many lines of numbers are not part of a heading.
  integer, parameter :: confirming = 3
  character(len=*), parameter :: newline = new_line('a'), digits = '0123456789'

  !> first: the position of the first row; 0 if there is none. named: the position of the line of
  !> names, or of the first row. separator: the separator of cells, ' ' for any. unit: as the file
  !> writes it, or blank.
  type :: layout_t
    integer :: first = 0, columns = 0, named = 0
    character :: separator = ' '
    character(len=longest_name), allocatable :: name(:), unit(:)
  end type layout_t

contains

  !> Finds the layout of a table. skip: number of lines at the beginning of the file to be ignored.
  !> of_instrument: whether there may be lines before the names, and words beside the numbers.
  !> by_name: whether columns are chosen by their names. error: the mistake, with its line.
  subroutine find_layout(source, skip, of_instrument, by_name, layout, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: skip
    logical, intent(in) :: of_instrument, by_name
    type(layout_t), intent(out) :: layout
    type(failure_t), allocatable, intent(out) :: error
    type(layout_t) :: here, likely
    integer :: at, next, comment, above(2), above_likely(2), lines

    comment = 0
    above = 0
    lines = 0
    next = after_lines(source, skip)
    do
      call next_line(source, next, at, comment)
      if (at == 0) exit
      call look_at(at, here)
      if (here%columns == 0 .and. lines == 1 .and. .not. of_instrument) &
        here = whole_line(at)
      if (here%columns > 0) then
        if (lines == 0 .or. .not. of_instrument) exit
        if (is_confirmed(here, next, likely%first > 0)) then
          ! A wrong line between two parts of a table is a mistake, and not the beginning of the
          ! table.
          if (likely%columns == here%columns) at = 0
          exit
        end if
        if (likely%first == 0) then
          likely = here
          above_likely = above
        end if
      end if
      above = [at, above(1)]
      lines = lines + 1
    end do
    if (at == 0) then
      here = likely
      if (likely%first > 0) above = above_likely
    end if
    layout = here
    allocate (layout%name(0), layout%unit(0))
    if (layout%first > 0) call find_names()

  contains

    !> Examines whether the line at `at` can be the first row of a table; columns = 0 if not. The
    !> cells of a row are numbers; in an instrument's file there may be words beside at least two
    !> numbers.
    subroutine look_at(at, row)
      integer, intent(in) :: at
      type(layout_t), intent(out) :: row
      character(len=:), allocatable :: line
      type(span_t), allocatable :: cells(:)
      integer :: numbers, missing, attempt

      line = uncommented(line_of(source, at))
      row%first = at
      do attempt = 1, 2
        row%separator = merge(separator_of(line), ' ', attempt == 1)
        call split_at(line, row%separator, cells)
        call count_cells(line, cells, numbers, missing)
        row%columns = size(cells)
        if (numbers > 0 .and. numbers + missing == size(cells)) return
        if (of_instrument .and. numbers > 1) return
      end do
      row%columns = 0
    end subroutine look_at

    !> The layout for a line that stands where a row is expected although it cannot be one.
    type(layout_t) function whole_line(at) result(row)
      integer, intent(in) :: at

      row%first = at
      row%separator = separator_of(uncommented(line_of(source, at)))
      row%columns = cells_at(at, row%separator)
    end function whole_line

    !> Whether the lines from the position `after` on have as many cells as a row. If another row
    !> (`another`) came before, at least one line must follow.
    logical function is_confirmed(row, after, another) result(confirmed)
      type(layout_t), intent(in) :: row
      integer, intent(in) :: after
      logical, intent(in) :: another
      integer :: position, there, k, unused

      position = after
      confirmed = .not. another
      do k = 1, confirming
        call next_line(source, position, there, unused)
        if (there == 0) return
        confirmed = cells_at(there, row%separator) == row%columns
        if (.not. confirmed) return
      end do
    end function is_confirmed

    integer function cells_at(at, separator) result(n)
      integer, intent(in) :: at
      character, intent(in) :: separator
      type(span_t), allocatable :: cells(:)

      call split_at(uncommented(line_of(source, at)), separator, cells)
      n = size(cells)
    end function cells_at

    !> Takes the names from the line above the first row, or from the last comment there. Between
    !> the names and the rows there may be a line with the units.
    subroutine find_names()
      character(len=longest_name), allocatable :: upper(:)
      integer :: k

      if (above(1) > 0) then
        layout%named = above(1)
        call names_in(uncommented(line_of(source, above(1))), layout%columns, layout%separator, &
          layout%name)
        if (above(2) > 0 .and. all([(is_unit_cell(layout%name(k)), k=1, size(layout%name))]) .and. &
          any([(len(unit_in(layout%name(k))) > 0, k=1, size(layout%name))])) then
          call names_in(uncommented(line_of(source, above(2))), layout%columns, layout%separator, &
            upper)
          if (size(upper) == size(layout%name)) then
            layout%named = above(2)
            layout%unit = layout%name
            layout%name = upper
          end if
        end if
        call check_names()
      else if (comment > 0) then
        layout%named = comment
        call names_in(after_mark(source%part(comment, layout%first - 2)), layout%columns, &
          layout%separator, layout%name)
      end if
      if (size(layout%name) /= layout%columns) then
        layout%named = layout%first
        layout%name = spread(repeat(' ', longest_name), 1, layout%columns)
      end if
      if (size(layout%unit) /= layout%columns) layout%unit = layout%name
    end subroutine find_names

    !> Refuses a line above the rows that is not a line of names.
    subroutine check_names()
      type(span_t), allocatable :: cells(:)
      character(len=:), allocatable :: line, what
      real(wp) :: number
      integer :: k

      line = uncommented(line_of(source, above(1)))
      call split_at(line, layout%separator, cells)
      if (size(cells) == layout%columns) then
        do k = 1, size(cells)
          if (scan(line(cells(k)%first:cells(k)%last), digits) /= 1) cycle
          call parse_real(line(cells(k)%first:cells(k)%last), number, what)
          if (.not. allocated(what)) what = 'a number among names, or a row with a mistake'
          call source%complain(above(1) + cells(k)%first - 1, what, error)
          return
        end do
      end if
      if (size(layout%name) == layout%columns .or. .not. by_name) return
      line = line_of(source, layout%first)
      if (layout%columns < size(layout%name) .and. ends_empty(line)) then
        call source%complain(layout%first, miscount(line, layout%columns, size(layout%name)), &
          error)
      else
        call source%complain(above(1), columns_where(size(layout%name), layout%columns) // &
          '; number the columns if the line of names cannot be divided; a comment begins with #', &
          error)
      end if
    end subroutine check_names

  end subroutine find_layout

  !> Counts the cells of a line that are numbers, and those without a value.
  pure subroutine count_cells(line, cells, numbers, missing)
    character(len=*), intent(in) :: line
    type(span_t), intent(in) :: cells(:)
    integer, intent(out) :: numbers, missing
    character(len=:), allocatable :: what
    real(wp) :: number
    integer :: i

    numbers = 0
    missing = 0
    do i = 1, size(cells)
      if (is_missing(line(cells(i)%first:cells(i)%last))) then
        missing = missing + 1
        cycle
      end if
      call parse_real(line(cells(i)%first:cells(i)%last), number, what)
      if (.not. allocated(what)) numbers = numbers + 1
    end do
  end subroutine count_cells

  !> Whether a cell has no value. Such a cell is empty, or it has NaN, an infinity, or a text such
  !> as n/a.
  pure logical function is_missing(cell)
    character(len=*), intent(in) :: cell

    is_missing = any(lower(cell) == [character(len=9) :: '', 'nan', '+nan', '-nan', 'nan(ind)', &
      '-nan(ind)', 'inf', '+inf', '-inf', 'infinity', '-infinity', 'na', 'n/a', 'null', 'none', &
      '-', '--']) .or. any(cell == excel_errors)
  end function is_missing

  !> Whether a line of a table is a line of names: no cell is a number.
  pure logical function is_header(line, cells)
    character(len=*), intent(in) :: line
    type(span_t), intent(in) :: cells(:)
    integer :: numbers, missing

    call count_cells(line, cells, numbers, missing)
    is_header = numbers == 0
  end function is_header

  !> Finds the next line with cells at or after the position `next`, and moves `next` behind it. at:
  !> the position of the line; 0 if there is none. comment: the position of the last comment before
  !> the line, unchanged if there is none.
  subroutine next_line(source, next, at, comment)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: next, comment
    integer, intent(out) :: at
    integer :: last, mark

    do while (next <= len(source%text))
      at = next
      last = index(source%text(at:), newline)
      last = merge(at + last - 2, len(source%text), last > 0)
      next = last + 2
      mark = comment_in(source%text(at:last))
      if (verify(source%text(at:at + mark - 2), ' ' // achar(9)) > 0) return
      if (mark <= last - at + 1) comment = at
    end do
    at = 0
  end subroutine next_line

  !> The position after the first `n` lines of a text.
  pure integer function after_lines(source, n) result(at)
    type(source_t), intent(in) :: source
    integer, intent(in) :: n
    integer :: k, length

    at = 1
    do k = 1, n
      length = index(source%text(at:), newline)
      if (length == 0) length = len(source%text) - at + 2
      at = at + length
    end do
  end function after_lines

  !> The line that begins at a position.
  pure function line_of(source, at) result(line)
    type(source_t), intent(in) :: source
    integer, intent(in) :: at
    character(len=:), allocatable :: line
    integer :: length

    length = index(source%text(at:), newline) - 1
    if (length < 0) length = len(source%text) - at + 1
    line = source%text(at:at + length - 1)
  end function line_of

end module table_layout
