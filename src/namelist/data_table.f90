!> A text file with a table of numbers, as measuring programs write it: comments after #, perhaps a
!> line with the names of the columns, which may itself be a comment, then one row a line
!> (`table_line`).
module data_table
  use kinds, only: wp
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: brief, counted, lower, quoted, clip, guess
  use deck_number, only: parse_real, parse_integer
  use deck_scan, only: span_t
  use deck_source, only: source_t, load_source
  use deck_store, only: deck_t
  use table_line, only: split, after_mark, uncommented, ends_empty, point_decimals, miscount, &
    columns_where
  implicit none
  private
  public :: data_table_t, read_data_table, largest_table, read_columns, is_header

  !> The columns asked for, value(row, column), the position of each row in the file's text, and the
  !> number of columns in the file.
  type :: data_table_t
    integer :: columns = 0
    type(source_t) :: source
    real(wp), allocatable :: value(:, :)
    integer, allocatable :: place(:)
  end type data_table_t

  !> Largest number of bytes of a table.
  integer, parameter :: largest_table = 64*2**20
  character(len=*), parameter :: newline = new_line('a')

contains

  !> Reads the columns `wanted` of `file`: names from its header line, in upper or lower case, or
  !> numbers counted from 1; a minus before either changes the column's sign. error: the mistake in
  !> the file, with its line.
  subroutine read_data_table(file, wanted, table, error)
    character(len=*), intent(in) :: file, wanted(:)
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error
    type(span_t), allocatable :: cells(:), names(:)
    integer, allocatable :: at(:)
    logical, allocatable :: turned(:)
    integer :: first, next, n, comment, named, i
    logical :: header

    call load_source(file, table%source, error, largest_table)
    if (allocated(error)) return
    call point_decimals(table%source%text)
    n = count([(table%source%text(i:i) == newline, i=1, len(table%source%text))]) + 1
    allocate (table%place(n), table%value(n, size(wanted)), at(size(wanted)))
    turned = index(adjustl(wanted), '-') == 1
    n = 0
    comment = 0
    next = 1
    call next_row()
    if (first > 0) then
      named = first
      names = cells
      header = is_header(table%source, first, cells)
      if (header) then
        call next_row()
      else if (comment > 0) then
        ! The last comment before the rows may have the names.
        named = comment
        call split(after_mark(table%source%part(comment, first - 2)), names)
      end if
      table%columns = size(names)
      if (first > 0) table%columns = size(cells)
      if (size(names) /= table%columns) then
        if (header .and. first > 0 .and. size(cells) < size(names)) then
          if (ends_empty(this_line())) then
            call table%source%complain(first, miscount(this_line(), size(cells), &
              size(names)), error)
            return
          end if
        end if
        if (header .and. any(verify(wanted, '-0123456789 ') > 0)) then
          call table%source%complain(named, columns_where(size(names), table%columns) // &
            '; number the columns if names have blanks; a comment begins with #', error)
          return
        end if
        named = first
        names = cells
      end if
      call find_columns(named, names)
      if (allocated(error)) return
    end if
    do while (first > 0)
      if (size(cells) /= table%columns) then
        call table%source%complain(first, miscount(this_line(), size(cells), &
          table%columns), error)
        return
      end if
      n = n + 1
      call read_row(table%value(n, :))
      if (allocated(error)) return
      table%place(n) = first
      call next_row()
    end do
    table%value = table%value(:n, :)
    table%place = table%place(:n)

  contains

    !> Finds the next line with cells at or after the position `next`, and moves `next` behind it.
    !> first: the position of the line; 0 if there is none. comment: the position of the last
    !> comment before the line, unchanged if there is none.
    subroutine next_row()
      associate (source => table%source)
        do while (next <= len(source%text))
          first = next
          next = first + scan(source%text(first:), newline)
          if (next == first) next = len(source%text) + 2
          call split(uncommented(source%part(first, next - 2)), cells)
          if (size(cells) > 0) return
          if (index(source%part(first, next - 2), '#') > 0) comment = first
        end do
      end associate
      first = 0
    end subroutine next_row

    pure function this_line() result(line)
      character(len=:), allocatable :: line

      line = table%source%part(first, first + scan(table%source%text(first:) // newline, newline) &
        - 2)
    end function this_line

    !> The column of each wanted name or number; the names are in the line at position `start`.
    subroutine find_columns(start, spans)
      integer, intent(in) :: start
      type(span_t), intent(in) :: spans(:)
      character(len=:), allocatable :: names, name, what
      logical :: found(size(spans))
      integer :: i, k

      names = ''
      do k = 1, size(spans)
        names = names // ' ' // lower(cell(start, spans(k)))
      end do
      do i = 1, size(wanted)
        name = trim(adjustl(wanted(i)))
        if (turned(i)) name = trim(adjustl(name(2:)))
        call parse_integer(name, at(i), what)
        if (allocated(what)) then
          found = [(lower(cell(start, spans(k))) == lower(name), k=1, size(spans))]
          at(i) = findloc(found, .true., 1)
          if (count(found) > 1) call table%source%complain(start, 'more than one column ' // &
            quoted(clip(name)) // '; give its number', error)
        end if
        if (at(i) >= 1 .and. at(i) <= size(spans)) cycle
        call table%source%complain(start, 'no column ' // quoted(clip(name)) // &
          guess(name, names(2:), '') // '; this line has ' // counted(size(spans), 'column'), &
          error)
      end do
    end subroutine find_columns

    !> The text of a span in the line at position `start`.
    pure function cell(start, span)
      integer, intent(in) :: start
      type(span_t), intent(in) :: span
      character(len=:), allocatable :: cell

      cell = table%source%part(start + span%first - 1, start + span%last - 1)
    end function cell

    !> The wanted numbers of the present row, some with the sign changed.
    subroutine read_row(row)
      real(wp), intent(out) :: row(:)
      character(len=:), allocatable :: what
      integer :: i

      do i = 1, size(at)
        call parse_real(cell(first, cells(at(i))), row(i), what)
        if (allocated(what)) then
          call table%source%complain(first + cells(at(i))%first - 1, what, error)
          return
        end if
        if (turned(i)) row(i) = -row(i)
      end do
    end subroutine read_row

  end subroutine read_data_table

  !> Reads the file of two columns, with at least `fewest` rows, that a key of the deck names.
  subroutine read_columns(deck, group, key, fewest, table, error)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, key
    integer, intent(in) :: fewest
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error

    call read_data_table(deck%path_of(group, key), ['1', '2'], table, error)
    if (allocated(error)) return
    call deck%note_file(group, key, checksum(table%source%text))
    if (size(table%place) > 0 .and. table%columns > 2) then
      call table%source%complain(table%place(1), columns_where(table%columns, 2), error)
    else if (size(table%place) < fewest) then
      call table%source%complain(len(table%source%text) + 1, 'fewer than ' // brief(fewest) // &
        ' points', error)
    end if
  end subroutine read_columns

  !> Whether a line has names, and not a number.
  logical function is_header(source, start, cells)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(span_t), intent(in) :: cells(:)
    character(len=:), allocatable :: what
    real(wp) :: number
    integer :: i

    is_header = .true.
    do i = 1, size(cells)
      call parse_real(source%part(start + cells(i)%first - 1, start + cells(i)%last - 1), number, &
        what)
      is_header = is_header .and. allocated(what)
    end do
  end function is_header

end module data_table
