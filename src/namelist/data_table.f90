!> A text file with a table of numbers, as measuring programs write it: comments after #, perhaps a
!> line with the names of the columns, which may itself be a comment, then one row a line
!> (`table_line`).
module data_table
  use kinds, only: wp
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: brief, lower, quoted, clip, guess
  use deck_number, only: parse_real, parse_integer
  use deck_scan, only: span_t
  use deck_source, only: source_t, load_source
  use deck_store, only: deck_t
  use table_line, only: split, after_mark, uncommented, ends_empty, point_decimals, counted, &
    miscount
  implicit none
  private
  public :: data_table_t, read_data_table, largest_table, read_columns
  public :: is_header

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
    integer :: first, next, n, comment, named
    logical :: header

    call load_source(file, table%source, error, largest_table)
    if (allocated(error)) return
    call point_decimals(table%source%text)
    n = lines_of(table%source%text)
    allocate (table%place(n), table%value(n, size(wanted)), at(size(wanted)))
    turned = index(adjustl(wanted), '-') == 1
    n = 0
    comment = 0
    next = 1
    call next_row(table%source, next, first, cells, comment)
    if (first > 0) then
      named = first
      names = cells
      header = is_header(table%source, first, cells)
      if (header) then
        call next_row(table%source, next, first, cells, comment)
      else if (comment > 0) then
        ! The last comment before the rows may have the names.
        named = comment
        call split(after_mark(table%source%part(comment, first - 2)), names)
      end if
      table%columns = size(names)
      if (first > 0) table%columns = size(cells)
      if (size(names) /= table%columns) then
        if (header .and. first > 0 .and. size(cells) < size(names)) then
          if (ends_empty(line_at(table%source, first))) then
            call table%source%complain(first, miscount(line_at(table%source, first), size(cells), &
              size(names)), error)
            return
          end if
        end if
        if (header .and. any(verify(wanted, '-0123456789 ') > 0)) then
          call table%source%complain(named, counted(size(names)) // ' where ' // &
            counted(table%columns) // ' are expected; number the columns if names have ' // &
            'blanks; a comment begins with #', error)
          return
        end if
        named = first
        names = cells
      end if
      call find_columns(table%source, named, names, wanted, at, error)
      if (allocated(error)) return
    end if
    do while (first > 0)
      if (size(cells) /= table%columns) then
        call table%source%complain(first, miscount(line_at(table%source, first), size(cells), &
          table%columns), error)
        return
      end if
      n = n + 1
      call read_row(table%source, first, cells(at), turned, table%value(n, :), error)
      if (allocated(error)) return
      table%place(n) = first
      call next_row(table%source, next, first, cells, comment)
    end do
    table%value = table%value(:n, :)
    table%place = table%place(:n)
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
      call table%source%complain(table%place(1), counted(table%columns) // &
        ' where 2 columns are expected', error)
    else if (size(table%place) < fewest) then
      call table%source%complain(len(table%source%text) + 1, 'fewer than ' // brief(fewest) // &
        ' points', error)
    end if
  end subroutine read_columns

  !> Number of lines of a text, at most.
  pure integer function lines_of(text)
    character(len=*), intent(in) :: text
    integer :: i

    lines_of = count([(text(i:i) == newline, i=1, len(text))]) + 1
  end function lines_of

  !> Finds the next line with cells at or after the position `next`, and moves `next` behind it.
  !> first: the position of the line; 0 if there is none. comment: the position of the last comment
  !> before the line, unchanged if there is none.
  subroutine next_row(source, next, first, cells, comment)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: next, comment
    integer, intent(out) :: first
    type(span_t), allocatable, intent(out) :: cells(:)

    do while (next <= len(source%text))
      first = next
      next = first + scan(source%text(first:), newline)
      if (next == first) next = len(source%text) + 2
      call split(uncommented(source%part(first, next - 2)), cells)
      if (size(cells) > 0) return
      if (index(source%part(first, next - 2), '#') > 0) comment = first
    end do
    first = 0
  end subroutine next_row

  !> The line at position `first`.
  pure function line_at(source, first) result(line)
    type(source_t), intent(in) :: source
    integer, intent(in) :: first
    character(len=:), allocatable :: line

    line = source%part(first, first + scan(source%text(first:) // newline, newline) - 2)
  end function line_at

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

  !> The column of each wanted name or number; the names are in the line at position `start`.
  subroutine find_columns(source, start, cells, wanted, at, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(span_t), intent(in) :: cells(:)
    character(len=*), intent(in) :: wanted(:)
    integer, intent(out) :: at(:)
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: names, name, what
    logical, allocatable :: found(:)
    integer :: i, k

    names = ''
    do k = 1, size(cells)
      names = names // ' ' // lower(cell(k))
    end do
    do i = 1, size(wanted)
      name = unsigned(wanted(i))
      call parse_integer(name, at(i), what)
      if (allocated(what)) then
        found = [(lower(cell(k)) == lower(name), k=1, size(cells))]
        at(i) = findloc(found, .true., 1)
        if (count(found) > 1) call source%complain(start, 'more than one column ' // &
          quoted(clip(name)) // '; give its number', error)
      end if
      if (at(i) >= 1 .and. at(i) <= size(cells)) cycle
      call source%complain(start, 'no column ' // quoted(clip(name)) // &
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

  !> The numbers in these cells of a line; turned: with the sign changed.
  subroutine read_row(source, start, cells, turned, row, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(span_t), intent(in) :: cells(:)
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
        call source%complain(start + cells(i)%first - 1, what, error)
        return
      end if
      if (turned(i)) row(i) = -row(i)
    end do
  end subroutine read_row

end module data_table
