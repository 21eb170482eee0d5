!> The index of a file with several measured curves, which a column numbers: the position of the
!> rows of each curve. Only these positions and the lines before the rows are kept in memory,
!> however large the file is.
module curve_index
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp, long
  use checksums, only: checksum
  use failure, only: failure_t, fail, bad_input, file_trouble
  use text, only: brief, quoted, printable
  use c_library, only: c_read, c_seek, c_close, explain, as_data
  use deck_number, only: parse_real
  use deck_source, only: source_t, take_source, open_file
  use column_names, only: find_columns
  use data_table, only: largest_table
  use table_layout, only: layout_t, find_layout
  use table_line, only: blanks
  implicit none
  private
  public :: curve_index_t

  !> Number of bytes that are read at once. The lines before the rows must fit into the first piece.
  integer, parameter :: piece = 2**20
  !> Largest number of a curve.
  real(wp), parameter :: largest_number = 1.0e9_wp
  character(len=*), parameter :: newline = new_line('a')

  !> number: the number of each curve, in the order of the file. digest: checksum of the file.
  type :: curve_index_t
    integer, allocatable :: number(:)
    integer(long) :: digest = 0
    character(len=:), allocatable, private :: file, column, heading
    integer, private :: skip = 0, heading_lines = 0
    !> For each curve: the position of its first byte, counted from 0; the position after its last
    !> byte; the number of lines before it.
    integer(long), allocatable, private :: first(:), behind(:)
    integer, allocatable, private :: lines(:)
  contains
    procedure :: find_curves
    procedure :: load
  end type curve_index_t

contains

  !> Finds the curves of a file, unless they have been found before. column: the name or number of
  !> the column that numbers the curves; skip: number of lines at the beginning of the file to be
  !> ignored.
  subroutine find_curves(self, file, column, skip, error)
    class(curve_index_t), intent(inout) :: self
    character(len=*), intent(in) :: file, column
    integer, intent(in) :: skip
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: buffer
    type(layout_t) :: layout
    integer(c_int) :: descriptor, closed
    integer :: at(1)

    if (allocated(self%file)) then
      if (self%file == file .and. self%column == column .and. self%skip == skip) return
    end if
    if (allocated(self%file)) deallocate (self%file)
    call open_file(file, as_data, descriptor, error)
    if (allocated(error)) return
    allocate (character(len=piece) :: buffer)
    call find_heading(self, file, column, skip, descriptor, buffer, layout, at, error)
    if (.not. allocated(error)) call find_rows(self, file, descriptor, layout%separator, at(1), &
      buffer, error)
    closed = c_close(descriptor)
    if (allocated(error)) return
    self%file = file
    self%column = column
    self%skip = skip
  end subroutine find_curves

  !> Reads bytes from a position in the file. held: the number of bytes read, smaller than the
  !> buffer at the end of the file.
  subroutine read_bytes(file, descriptor, place, bytes, held, error)
    character(len=*), intent(in) :: file
    integer(c_int), intent(in) :: descriptor
    integer(long), intent(in) :: place
    character(len=*), intent(inout) :: bytes
    integer, intent(out) :: held
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: reason
    integer(c_int) :: sort

    held = c_seek(descriptor, int(place, c_long))
    if (held == 0) held = int(c_read(descriptor, bytes, int(len(bytes), c_long)))
    if (held >= 0) return
    call explain(int(held, c_int), sort, reason)
    call fail(error, file_trouble, printable(file) // ': cannot be read: ' // reason)
  end subroutine read_bytes

  !> Finds the lines before the rows. at(1): the position of the column among the columns.
  subroutine find_heading(self, file, column, skip, descriptor, buffer, layout, at, error)
    class(curve_index_t), intent(inout) :: self
    character(len=*), intent(in) :: file, column
    integer, intent(in) :: skip
    integer(c_int), intent(in) :: descriptor
    character(len=*), intent(inout) :: buffer
    type(layout_t), intent(out) :: layout
    integer, intent(out) :: at(1)
    type(failure_t), allocatable, intent(inout) :: error
    type(source_t) :: source
    logical :: turned(1)
    integer :: held, whole, i, n

    call read_bytes(file, descriptor, 0_long, buffer, held, error)
    if (allocated(error)) return
    ! Keep only whole lines.
    whole = held
    if (held == len(buffer)) whole = index(buffer, newline, back=.true.)
    call take_source(file, buffer(:whole), source, error, largest_table)
    if (.not. allocated(error)) call find_layout(source, skip, .true., verify(column, &
      '-0123456789 ') > 0, layout, error)
    if (.not. allocated(error) .and. layout%first == 0) call fail(error, bad_input, &
      printable(file) // ': no row of numbers')
    if (.not. allocated(error)) call find_columns(source, layout%named, layout%name, [column], at, &
      turned, error)
    if (allocated(error)) return
    self%heading_lines = count([(source%text(i:i) == newline, i=1, layout%first - 1)])
    n = 0
    do i = 1, self%heading_lines
      n = n + index(buffer(n + 1:whole), newline)
    end do
    self%heading = buffer(:n)
  end subroutine find_heading

  !> Finds the positions in the file at which the number of the curve changes.
  subroutine find_rows(self, file, descriptor, separator, column, buffer, error)
    class(curve_index_t), intent(inout) :: self
    character(len=*), intent(in) :: file
    integer(c_int), intent(in) :: descriptor
    character, intent(in) :: separator
    integer, intent(in) :: column
    character(len=*), intent(inout) :: buffer
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: label
    integer(long) :: place
    integer :: held, used, length, lines, n

    place = len(self%heading)
    lines = self%heading_lines
    label = ''
    self%digest = checksum(self%heading)
    self%number = [integer ::]
    self%first = [integer(long) ::]
    self%behind = self%first
    self%lines = self%number
    n = 0
    do
      call read_bytes(file, descriptor, place, buffer, held, error)
      if (allocated(error) .or. held == 0) exit
      self%digest = checksum([self%digest, checksum(buffer(:held))])
      used = 0
      do
        length = index(buffer(used + 1:held), newline)
        ! What remains is the beginning of a line, or the last line.
        if (length == 0 .and. (held == len(buffer) .and. used > 0)) exit
        if (length == 0) length = held - used
        if (length == 0) exit
        call take_line(buffer(used + 1:used + length), place + used)
        if (allocated(error)) return
        lines = lines + 1
        used = used + length
      end do
      place = place + used
    end do
    self%number = self%number(:n)
    self%first = self%first(:n)
    self%behind = self%behind(:n)
    self%lines = self%lines(:n)

  contains

    !> Takes a row that begins at position `at` of the file.
    subroutine take_line(line, at)
      character(len=*), intent(in) :: line
      integer(long), intent(in) :: at
      character(len=:), allocatable :: what
      real(wp) :: value
      integer :: first, last

      call find_cell(line, separator, column, first, last)
      if (last < first) return
      if (line(first:last) == label .and. n > 0) then
        self%behind(n) = at + len(line)
        return
      end if
      label = line(first:last)
      call parse_real(label, value, what)
      if (.not. allocated(what)) then
        if (abs(value - anint(value)) > 0 .or. abs(value) > largest_number) &
          what = quoted(label) // ' is not a whole number'
      end if
      if (.not. allocated(what)) then
        if (any(self%number(:n) == nint(value))) what = 'the rows of curve ' // &
          brief(nint(value)) // ' are not together'
      end if
      if (allocated(what)) then
        call fail(error, bad_input, printable(file) // ':' // brief(lines + 1) // ': ' // what)
        return
      end if
      if (n == size(self%number)) call make_room()
      n = n + 1
      self%number(n) = nint(value)
      self%first(n) = at
      self%behind(n) = at + len(line)
      self%lines(n) = lines
    end subroutine take_line

    subroutine make_room()
      integer, allocatable :: numbers(:)
      integer(long), allocatable :: places(:)

      allocate (numbers(2*n + 64), source=0)
      allocate (places(2*n + 64), source=0_long)
      self%number = [self%number, numbers]
      self%lines = [self%lines, numbers]
      self%first = [self%first, places]
      self%behind = [self%behind, places]
    end subroutine make_room

  end subroutine find_rows

  !> Finds the cell of a column in a line, without blanks and double quotes at its ends; last <
  !> first if the line has no such cell. Only this cell is looked up, since splitting each of many
  !> lines would take too long.
  pure subroutine find_cell(line, separator, column, first, last)
    character(len=*), intent(in) :: line
    character, intent(in) :: separator
    integer, intent(in) :: column
    integer, intent(out) :: first, last
    character(len=*), parameter :: ends = blanks // '"' // newline // achar(13)
    integer :: i, k, comment

    comment = index(line, '#') - 1
    if (comment < 0) comment = len(line)
    first = 1
    last = 0
    do k = 1, column
      if (separator == ' ') then
        i = verify(line(first:comment), ends)
        if (i == 0) return
        first = first + i - 1
        last = first - 2 + scan(line(first:comment) // ' ', ends)
      else
        if (first > comment + 1) return
        last = first - 2 + index(line(first:comment) // separator, separator)
      end if
      if (k < column) first = last + 2
    end do
    i = verify(line(first:last), ends)
    if (i == 0) then
      last = first - 1
      return
    end if
    last = first - 1 + verify(line(first:last), ends, back=.true.)
    first = first + i - 1
  end subroutine find_cell

  !> The text of one curve: the lines before all rows, then the rows of the curve.
  subroutine load(self, number, source, error)
    class(curve_index_t), intent(in) :: self
    integer, intent(in) :: number
    type(source_t), intent(out) :: source
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: bytes
    integer(c_int) :: descriptor, closed
    integer :: k, held

    k = findloc(self%number, number, 1)
    if (k == 0) then
      call fail(error, bad_input, printable(self%file) // ': no row is of curve ' // &
        brief(number) // '; the file has ' // brief(size(self%number)) // ' curves')
      return
    end if
    call open_file(self%file, as_data, descriptor, error)
    if (allocated(error)) return
    allocate (character(len=self%behind(k) - self%first(k)) :: bytes)
    call read_bytes(self%file, descriptor, self%first(k), bytes, held, error)
    closed = c_close(descriptor)
    if (allocated(error)) return
    call take_source(self%file, self%heading // bytes(:held), source, error, largest_table, &
      self%lines(k) - self%heading_lines)
  end subroutine load

end module curve_index
