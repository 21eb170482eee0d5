!> Assignments in a namelist group, made from values that may not exist.
module namelist_writer
  use kinds, only: wp, long
  use text, only: full, quoted
  use text_file, only: plain
  implicit none
  private
  public :: line_t, append, assignment_of, add_item

  !> One line of text.
  type :: line_t
    character(len=:), allocatable :: text
  end type line_t

  !> assignment_of(key, value): the lines ` key = value` with their ends, or '' if the value is not
  !> allocated. Reals are written with enough digits to give the same numbers when they are read.
  interface assignment_of
    module procedure :: of_reals, of_counts, of_logical, of_text, of_lines
  end interface assignment_of

contains

  !> Appends a line to others; if they are not allocated, it is the first.
  pure subroutine append(lines, text)
    type(line_t), allocatable, intent(inout) :: lines(:)
    character(len=*), intent(in) :: text
    type(line_t) :: line

    line%text = text
    if (.not. allocated(lines)) allocate (lines(0))
    lines = [lines, line]
  end subroutine append

  pure function of_reals(key, values) result(text)
    character(len=*), intent(in) :: key
    real(wp), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    integer :: column, i

    text = ''
    if (.not. allocated(values)) return
    do i = 1, size(values)
      call add_item(key, full(values(i)), text, column)
    end do
  end function of_reals

  pure function of_counts(key, values) result(text)
    character(len=*), intent(in) :: key
    integer(long), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    character(len=24) :: buffer
    integer :: column, i

    text = ''
    if (.not. allocated(values)) return
    do i = 1, size(values)
      write (buffer, '(i0)') values(i)
      call add_item(key, trim(buffer), text, column)
    end do
  end function of_counts

  pure function of_logical(key, value) result(text)
    character(len=*), intent(in) :: key
    logical, allocatable, intent(in) :: value
    character(len=:), allocatable :: text
    integer :: column

    text = ''
    if (allocated(value)) call add_item(key, trim(merge('.true. ', '.false.', value)), text, column)
  end function of_logical

  pure function of_text(key, value) result(text)
    character(len=*), intent(in) :: key
    character(len=:), allocatable, intent(in) :: value
    character(len=:), allocatable :: text
    integer :: column

    text = ''
    if (allocated(value)) call add_item(key, literal(value), text, column)
  end function of_text

  pure function of_lines(key, values) result(text)
    character(len=*), intent(in) :: key
    type(line_t), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    integer :: column, i

    text = ''
    if (.not. allocated(values)) return
    do i = 1, size(values)
      call add_item(key, literal(values(i)%text), text, column)
    end do
  end function of_lines

  !> `text` as a string that all namelist readers accept: nothing in it looks like the beginning of
  !> a group (compiler note 8).
  pure function literal(text)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: literal
    character(len=:), allocatable :: clean
    integer :: i

    clean = plain(text)
    do i = len(clean) - 1, 1, -1
      if (scan(clean(i:i), '&$') == 1 .and. clean(i + 1:i + 1) /= ' ') &
        clean = clean(:i) // ' ' // clean(i + 1:)
    end do
    literal = quoted(trim(clean))
  end function literal

  !> Appends an item to `text`, the assignment to the key, which is '' before the first item. If the
  !> line is full, a new line begins. column: the last column of the line.
  pure subroutine add_item(key, item, text, column)
    character(len=*), intent(in) :: key, item
    character(len=:), allocatable, intent(inout) :: text
    integer, intent(inout) :: column
    !> Last column of a line, unless a single item is longer.
    integer, parameter :: last_column = 80

    if (text == '') then
      text = '  ' // key // ' ='
      column = len(text)
    else
      text = text(:len(text) - 1) // ','
      if (column + len(item) > last_column) then
        text = text // new_line('a') // '   '
        column = 3
      end if
    end if
    text = text // ' ' // item // new_line('a')
    column = column + len(item) + 2
  end subroutine add_item

end module namelist_writer
