!> Assignments in a namelist group, made from values that may not exist.
module namelist_writer
  use kinds, only: wp, long
  use text, only: full, quoted
  use text_file, only: plain
  implicit none
  private
  public :: line_t, assignment_of

  !> One line of text.
  type :: line_t
    character(len=:), allocatable :: text
  end type line_t

  !> assignment_of(key, value): the lines `  key = value` with their ends, or '' if the value is not
  !> allocated. Reals read back as the same numbers.
  interface assignment_of
    module procedure :: of_reals, of_counts, of_logical, of_text, of_lines
  end interface assignment_of

contains

  pure function of_reals(key, values) result(text)
    character(len=*), intent(in) :: key
    real(wp), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    type(line_t), allocatable :: items(:)
    integer :: i

    text = ''
    if (.not. allocated(values)) return
    allocate (items(size(values)))
    do i = 1, size(values)
      items(i)%text = full(values(i))
    end do
    text = written(key, items)
  end function of_reals

  pure function of_counts(key, values) result(text)
    character(len=*), intent(in) :: key
    integer(long), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    character(len=24) :: buffer
    type(line_t), allocatable :: items(:)
    integer :: i

    text = ''
    if (.not. allocated(values)) return
    allocate (items(size(values)))
    do i = 1, size(values)
      write (buffer, '(i0)') values(i)
      items(i)%text = trim(buffer)
    end do
    text = written(key, items)
  end function of_counts

  pure function of_logical(key, value) result(text)
    character(len=*), intent(in) :: key
    logical, allocatable, intent(in) :: value
    character(len=:), allocatable :: text

    text = ''
    if (allocated(value)) text = single(key, trim(merge('.true. ', '.false.', value)))
  end function of_logical

  pure function of_text(key, value) result(text)
    character(len=*), intent(in) :: key
    character(len=:), allocatable, intent(in) :: value
    character(len=:), allocatable :: text

    text = ''
    if (allocated(value)) text = single(key, literal(value))
  end function of_text

  pure function of_lines(key, values) result(text)
    character(len=*), intent(in) :: key
    type(line_t), allocatable, intent(in) :: values(:)
    character(len=:), allocatable :: text
    type(line_t), allocatable :: items(:)
    integer :: i

    text = ''
    if (.not. allocated(values)) return
    allocate (items(size(values)))
    do i = 1, size(values)
      items(i)%text = literal(values(i)%text)
    end do
    text = written(key, items)
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

  !> The assignment of one item to the key.
  pure function single(key, item) result(text)
    character(len=*), intent(in) :: key, item
    character(len=:), allocatable :: text

    text = '  ' // key // ' = ' // item // new_line('a')
  end function single

  !> The assignment of the items to the key, broken into lines; '' without items.
  pure function written(key, items) result(text)
    character(len=*), intent(in) :: key
    type(line_t), intent(in) :: items(:)
    character(len=:), allocatable :: text
    !> Last column of a line, unless a single item is longer.
    integer, parameter :: last_column = 80
    integer :: i, column

    text = ''
    if (size(items) == 0) return
    text = '  ' // key // ' ='
    column = len(text)
    do i = 1, size(items)
      if (i > 1) text = text // ','
      if (i > 1 .and. column + len(items(i)%text) > last_column) then
        text = text // new_line('a') // '   '
        column = 3
      end if
      text = text // ' ' // items(i)%text
      column = column + len(items(i)%text) + 2
    end do
    text = text // new_line('a')
  end function written

end module namelist_writer
