!> A text file with a table of numbers, as measuring programs write it. It has comments after #,
!> then possibly a line with the names of the columns, which may itself be a comment, then one row
!> per line (`table_line`, `table_layout`).
module data_table
  use kinds, only: wp
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: brief, lower
  use deck_number, only: parse_real
  use deck_scan, only: span_t
  use deck_source, only: source_t, load_source
  use deck_store, only: deck_t
  use column_names, only: find_columns, longest_name
  use table_layout, only: layout_t, find_layout, next_line, line_of, is_missing
  use table_line, only: split_at, split, uncommented, plain_signs, &
    point_decimals, miscount, columns_where
  use units, only: unit_in
  implicit none
  private
  public :: data_table_t, style_t, take_data_table, largest_table, read_columns, plain_label

  !> How a file is read. skip_lines: number of lines at its beginning to be ignored. of_instrument:
  !> whether there may be lines before the names, words beside the numbers, and empty cells. labels:
  !> the wanted column whose cells are labels and not numbers; 0 if there is none.
  type :: style_t
    integer :: skip_lines = 0, labels = 0
    logical :: of_instrument = .false.
  end type style_t

  !> The wanted columns. value(row, column): their values; missing(row, column): whether a cell has
  !> no value, in which case the value is 0. The position of each row in the file's text, and the
  !> number of columns in the file. name, unit: those of each wanted column, as in the file; blank
  !> if it has none. label: the different labels; the value in the labels' column is an index of
  !> this list.
  type :: data_table_t
    integer :: columns = 0
    type(source_t) :: source
    real(wp), allocatable :: value(:, :)
    logical, allocatable :: missing(:, :)
    integer, allocatable :: place(:)
    character(len=longest_name), allocatable :: name(:), unit(:), label(:)
  end type data_table_t

  !> Largest number of bytes of a table; largest number of different labels.
  integer, parameter :: largest_table = 64*2**20, most_labels = 64
  character(len=*), parameter :: newline = new_line('a')

contains

  !> Reads the columns `wanted` of `file`: names from its header line, in upper or lower case, or
  !> numbers counted from 1. A minus before either changes the sign of the column's values. error:
  !> the mistake in the file, with its line.
  subroutine read_data_table(file, wanted, style, table, error)
    character(len=*), intent(in) :: file, wanted(:)
    type(style_t), intent(in) :: style
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error
    type(source_t) :: source

    call load_source(file, source, error, largest_table)
    if (.not. allocated(error)) call take_data_table(source, wanted, style, table, error)
  end subroutine read_data_table

  !> Takes the columns with the names or numbers `wanted` from the text of a file.
  subroutine take_data_table(source, wanted, style, table, error)
    type(source_t), intent(in) :: source
    character(len=*), intent(in) :: wanted(:)
    type(style_t), intent(in) :: style
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error
    type(layout_t) :: layout
    type(span_t), allocatable :: cells(:)
    character(len=:), allocatable :: line
    integer, allocatable :: at(:)
    logical, allocatable :: turned(:)
    integer :: first, next, n, unused, i

    table%source = source
    if (style%of_instrument) call plain_signs(table%source%text)
    call point_decimals(table%source%text)
    n = count([(table%source%text(i:i) == newline, i=1, len(table%source%text))]) + 1
    allocate (table%place(n), table%value(n, size(wanted)), table%missing(n, size(wanted)), &
      at(size(wanted)), turned(size(wanted)), table%label(0))
    call find_layout(table%source, style%skip_lines, style%of_instrument, &
      any(verify(wanted, '-0123456789 ') > 0), layout, error)
    if (allocated(error)) return
    n = 0
    if (layout%first > 0) then
      table%columns = layout%columns
      call find_columns(table%source, layout%named, layout%name, wanted, at, turned, error)
      if (allocated(error)) return
      table%name = layout%name(at)
      allocate (table%unit(size(at)))
      do i = 1, size(at)
        table%unit(i) = unit_in(layout%unit(at(i)))
      end do
      next = layout%first
      do
        call next_line(table%source, next, first, unused)
        if (first == 0) exit
        call take_cells()
        if (allocated(error)) return
        n = n + 1
        table%place(n) = first
        call read_row(table%value(n, :), table%missing(n, :))
        if (allocated(error)) return
      end do
    end if
    table%value = table%value(:n, :)
    table%missing = table%missing(:n, :)
    table%place = table%place(:n)

  contains

    !> Finds the cells of the line at `first`. If the line has another number of cells by the
    !> separator of the first row, it is divided at any separator.
    subroutine take_cells()
      line = uncommented(line_of(table%source, first))
      call split_at(line, layout%separator, cells)
      if (size(cells) == table%columns) return
      i = size(cells)
      call split(line, cells)
      if (size(cells) == table%columns) return
      if (layout%separator == ' ') i = size(cells)
      call table%source%complain(first, miscount(line, i, table%columns), error)
    end subroutine take_cells

    !> The wanted numbers of the present row, some with the sign changed.
    subroutine read_row(row, missing)
      real(wp), intent(out) :: row(:)
      logical, intent(out) :: missing(:)
      character(len=:), allocatable :: what
      integer :: i

      row = 0
      do i = 1, size(at)
        associate (cell => line(cells(at(i))%first:cells(at(i))%last))
          missing(i) = style%of_instrument
          if (missing(i)) missing(i) = is_missing(cell)
          if (missing(i)) cycle
          if (i == style%labels) then
            call take_label(cell, row(i), what)
          else
            call parse_real(cell, row(i), what)
          end if
        end associate
        if (allocated(what)) then
          call table%source%complain(first + cells(at(i))%first - 1, what, error)
          return
        end if
        if (turned(i)) row(i) = -row(i)
      end do
    end subroutine read_row

    !> The index of a label in the list, to which a new label is added. Numbers that are equal are
    !> one label.
    subroutine take_label(cell, number, what)
      character(len=*), intent(in) :: cell
      real(wp), intent(out) :: number
      character(len=:), allocatable, intent(out) :: what
      character(len=longest_name) :: label
      integer :: i

      label = plain_label(cell)
      i = findloc(table%label == label, .true., 1)
      if (i == 0) then
        if (size(table%label) == most_labels) then
          what = 'the column of segments has more than ' // brief(most_labels) // &
            ' different values, so it does not number the segments; columns chooses another'
          return
        end if
        table%label = [character(len=longest_name) :: table%label, label]
        i = size(table%label)
      end if
      number = i
    end subroutine take_label

  end subroutine take_data_table

  !> A label in lower case; a number without superfluous digits.
  pure function plain_label(cell) result(label)
    character(len=*), intent(in) :: cell
    character(len=longest_name) :: label
    character(len=:), allocatable :: what
    real(wp) :: value

    call parse_real(trim(cell), value, what)
    label = lower(cell)
    if (.not. allocated(what)) label = brief(value)
  end function plain_label

  !> Reads a file of two columns, with at least `fewest` rows. A key of the deck names the file.
  subroutine read_columns(deck, group, key, fewest, table, error)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, key
    integer, intent(in) :: fewest
    type(data_table_t), intent(out) :: table
    type(failure_t), allocatable, intent(out) :: error

    call read_data_table(deck%path_of(group, key), ['1', '2'], style_t(), table, error)
    if (allocated(error)) return
    call deck%note_file(group, key, checksum(table%source%text))
    if (size(table%place) > 0 .and. table%columns > 2) then
      call table%source%complain(table%place(1), columns_where(table%columns, 2), error)
    else if (size(table%place) < fewest) then
      call table%source%complain(len(table%source%text) + 1, 'fewer than ' // brief(fewest) // &
        ' points', error)
    end if
  end subroutine read_columns

end module data_table
