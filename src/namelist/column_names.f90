!> Names of the columns of a table, and the columns that a deck refers to.
module column_names
  use failure, only: failure_t
  use text, only: lower, quoted, clip, guess, counted, listed
  use deck_number, only: parse_integer
  use deck_scan, only: span_t
  use deck_source, only: source_t
  use table_line, only: split_at, separator_of
  use units, only: split_unit
  implicit none
  private
  public :: names_in, find_columns, longest_name

  integer, parameter :: longest_name = 64

contains

  !> The names in a line above rows with this number of columns. The separator is that of the rows,
  !> that of the line itself, or any. A unit in brackets belongs to the name before it.
  subroutine names_in(line, columns, separator, names)
    character(len=*), intent(in) :: line
    integer, intent(in) :: columns
    character, intent(in) :: separator
    character(len=longest_name), allocatable, intent(out) :: names(:)
    type(span_t), allocatable :: cells(:)
    character :: separators(3)
    integer :: i, k

    separators = [separator, separator_of(line), ' ']
    do i = 1, size(separators)
      call split_at(line, separators(i), cells)
      if (size(cells) > columns .and. separators(i) == ' ') call join_brackets(line, cells)
      if (size(cells) == columns) exit
    end do
    allocate (names(size(cells)))
    do k = 1, size(cells)
      names(k) = plain_name(unquoted(line(cells(k)%first:cells(k)%last)))
    end do
  end subroutine names_in

  !> A name without the single quotes around it.
  pure function unquoted(name)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unquoted

    unquoted = name
    if (len(name) < 2) return
    if (name(1:1) == '''' .and. name(len(name):) == '''') unquoted = name(2:len(name) - 1)
  end function unquoted

  !> Joins cells that begin with a bracket to the cell before them.
  pure subroutine join_brackets(line, cells)
    character(len=*), intent(in) :: line
    type(span_t), allocatable, intent(inout) :: cells(:)
    integer :: k, n

    n = 0
    do k = 1, size(cells)
      if (n > 0 .and. scan(line(cells(k)%first:cells(k)%first), '([{') > 0) then
        cells(n)%last = cells(k)%last
      else
        n = n + 1
        cells(n) = cells(k)
      end if
    end do
    cells = cells(:n)
  end subroutine join_brackets

  !> A name in which every code of the micro sign is replaced by u, and several blanks by one.
  pure function plain_name(name) result(plain)
    character(len=*), intent(in) :: name
    character(len=longest_name) :: plain
    character(len=*), parameter :: micro = char(194) // char(181), mu = char(206) // char(188)
    integer :: i, n, length

    plain = ''
    n = 0
    i = 1
    do while (i <= len(name) .and. n < longest_name)
      length = 1
      if (i < len(name)) length = merge(2, 1, name(i:i + 1) == micro .or. name(i:i + 1) == mu)
      if (length == 2 .or. name(i:i) == char(181)) then
        n = n + 1
        plain(n:n) = 'u'
      else if (scan(name(i:i), ' ' // achar(9)) == 0) then
        n = n + 1
        plain(n:n) = name(i:i)
      else if (n > 0) then
        if (plain(n:n) /= ' ') n = n + 1
      end if
      i = i + length
    end do
  end function plain_name

  !> The columns `at` to which a deck refers by number, or by name in upper or lower case, with or
  !> without the unit after it. A minus before either changes the sign of the column's values.
  !> error: a column does not exist, or several columns have this name; its position is `named`,
  !> that of the line of names.
  subroutine find_columns(source, named, names, wanted, at, turned, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: named
    character(len=*), intent(in) :: names(:), wanted(:)
    integer, intent(out) :: at(size(wanted))
    logical, intent(out) :: turned(size(wanted))
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: name, what, list
    logical :: found(size(names))
    integer :: i, k

    list = ''
    do k = 1, size(names)
      if (index(trim(names(k)), ' ') == 0) list = list // ' ' // lower(trim(names(k)))
    end do
    do i = 1, size(wanted)
      name = plain_name(adjustl(wanted(i)))
      turned(i) = name(1:1) == '-'
      if (turned(i)) name = adjustl(name(2:))
      name = trim(name)
      call parse_integer(name, at(i), what)
      if (allocated(what)) then
        found = [(lower(trim(names(k))) == lower(name), k=1, size(names))]
        if (.not. any(found)) found = [(lower(without_unit(names(k))) == lower(name), &
          k=1, size(names))]
        at(i) = findloc(found, .true., 1)
        if (count(found) > 1) call source%complain(named, 'more than one column ' // &
          quoted(clip(name)) // '; give its number', error)
      end if
      if (at(i) >= 1 .and. at(i) <= size(names)) cycle
      what = 'this line has ' // counted(size(names), 'column')
      if (any(names /= '')) what = 'the file has ' // listed(names)
      call source%complain(named, 'no column ' // quoted(clip(name)) // &
        guess(name, list, '') // '; ' // what, error)
    end do
  end subroutine find_columns

  !> A name without the unit at its end.
  pure function without_unit(name) result(bare)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: bare, unit

    call split_unit(name, bare, unit)
    if (len(bare) == 0) bare = trim(name)
  end function without_unit

end module column_names
