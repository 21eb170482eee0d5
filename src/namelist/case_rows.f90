!> Reads the rows of a file with a line of names, one after the other. Only a piece of the file is
!> in memory, however many rows it has. Lines are as in `table_line`.
module case_rows
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp, long
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_read, c_close, explain, as_data
  use checksums, only: checksum
  use text, only: lower, printable, word_of
  use deck_number, only: parse_real
  use deck_numbers, only: words_of, number_of_word, holds_text
  use deck_scan, only: span_t
  use deck_source, only: source_t, take_source, open_file
  use deck_store, only: deck_t
  use table_layout, only: is_header
  use table_line, only: split, blanks, after_mark, uncommented, point_decimals, miscount
  implicit none
  private
  public :: case_rows_t

  !> Largest number of bytes of the file in memory.
  integer, parameter :: piece = 65536
  character(len=*), parameter :: return = achar(13), newline = new_line('a')

  !> A file that is being read. It must not be copied while it is open.
  type :: case_rows_t
    !> The names, blank-separated, in lower case.
    character(len=:), allocatable :: names
    !> For each column the words that it may hold, from `words_of`.
    character(len=80), allocatable :: words(:)
    !> The column whose cells are texts, and the cell of the present row; 0 and '' if there is none.
    integer :: text_column = 0
    character(len=:), allocatable :: text
    !> Checksum of the lines read so far.
    integer(long) :: digest = 0
    character(len=:), allocatable, private :: file
    integer(c_int), private :: descriptor = -1
    character(len=piece), private :: buffer
    !> Number of bytes in the buffer; number of those that have been made into lines.
    integer, private :: held = 0, used = 0
    !> The present line and its cells.
    type(source_t), private :: line
    type(span_t), allocatable, private :: cells(:)
    integer, private :: lines = 0, rows = 0
    !> Whether the present line is a row that `next` has not returned yet.
    logical, private :: waiting = .false.
  contains
    procedure :: open => open_rows
    procedure :: next
    procedure :: close => close_rows
    procedure, private :: next_line
  end type case_rows_t

contains

  !> Opens a file and reads its line of names. This is the first line that is not a comment or, if
  !> that line holds numbers, the last comment before it. deck: shows which names are keys that hold
  !> a word.
  subroutine open_rows(self, file, deck, error)
    class(case_rows_t), intent(out) :: self
    character(len=*), intent(in) :: file
    type(deck_t), intent(in) :: deck
    type(failure_t), allocatable, intent(out) :: error
    type(source_t) :: comment, named
    type(span_t), allocatable :: names(:)
    logical :: found
    integer :: k

    self%file = file
    self%names = ''
    self%text = ''
    call open_file(file, as_data, self%descriptor, error)
    if (allocated(error)) return
    comment%text = ''
    do
      call self%next_line(found, error)
      if (allocated(error) .or. .not. found) return
      if (size(self%cells) > 0) exit
      if (index(self%line%text, '#') > 0) comment = self%line
    end do
    names = self%cells
    named = self%line
    if (.not. is_header(self%line%text, self%cells)) then
      self%waiting = .true.
      named = comment
      call split(after_mark(comment%text), names)
      if (size(names) /= size(self%cells)) then
        call self%line%complain(1, 'no line of names before the numbers', error)
        return
      end if
    end if
    allocate (self%words(size(names)))
    do k = 1, size(names)
      if (names(k)%last < names(k)%first) then
        call named%complain(1, 'a column without a name', error)
        return
      else if (scan(named%part(names(k)%first, names(k)%last), blanks) > 0) then
        call named%complain(names(k)%first, 'a name with a blank', error)
        return
      end if
      if (k > 1) self%names = self%names // ' '
      self%names = self%names // lower(named%part(names(k)%first, names(k)%last))
      self%words(k) = words_of(deck, word_of(self%names, k))
      if (.not. holds_text(deck, word_of(self%names, k))) cycle
      if (self%text_column > 0) then
        call named%complain(names(k)%first, 'only one column may hold texts', error)
        return
      end if
      self%text_column = k
    end do
  end subroutine open_rows

  !> The values of the next row. A word is replaced by its number, a text by the number of the row.
  !> found = .false.: there are no more rows, and the file is closed. error: the mistake in the row,
  !> with file and line.
  subroutine next(self, values, found, error)
    class(case_rows_t), intent(inout) :: self
    real(wp), allocatable, intent(inout) :: values(:)
    logical, intent(out) :: found
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: what
    integer :: k

    found = self%waiting
    do while (.not. found)
      call self%next_line(found, error)
      if (allocated(error)) return
      if (.not. found) then
        call self%close()
        return
      end if
      found = size(self%cells) > 0
    end do
    self%waiting = .false.
    if (size(self%cells) /= size(self%words)) then
      call self%line%complain(1, miscount(self%line%text, size(self%cells), size(self%words)), &
        error)
      return
    end if
    self%rows = self%rows + 1
    if (.not. allocated(values)) allocate (values(size(self%words)))
    do k = 1, size(self%words)
      associate (first => self%cells(k)%first, last => self%cells(k)%last)
        if (k == self%text_column) then
          self%text = self%line%text(first:last)
          values(k) = self%rows
        else if (self%words(k) == '') then
          call parse_real(self%line%text(first:last), values(k), what)
        else
          call number_of_word(self%line%text(first:last), self%words(k), values(k), what)
        end if
        if (.not. allocated(what)) cycle
        call self%line%complain(first, what, error)
        return
      end associate
    end do
  end subroutine next

  !> Closes the file, if it is open.
  subroutine close_rows(self)
    class(case_rows_t), intent(inout) :: self
    integer(c_int) :: status

    ! The status does not matter, since nothing has been written.
    if (self%descriptor >= 0) status = c_close(self%descriptor)
    self%descriptor = -1
  end subroutine close_rows

  !> Reads one more line and finds its cells.
  subroutine next_line(self, found, error)
    class(case_rows_t), intent(inout) :: self
    logical, intent(out) :: found
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: bytes, reason
    integer(c_int) :: sort
    integer :: length

    found = .false.
    if (self%descriptor < 0) return
    length = line_length()
    if (length < 0) then
      ! What remains in the buffer may be the beginning of a line.
      self%held = self%held - self%used
      self%buffer(:self%held) = self%buffer(self%used + 1:self%used + self%held)
      self%used = 0
      length = int(c_read(self%descriptor, self%buffer(self%held + 1:), &
        int(piece - self%held, c_long)))
      if (length < 0) then
        call explain(int(length, c_int), sort, reason)
        call fail(error, file_trouble, printable(self%file) // ': cannot be read: ' // reason)
        return
      end if
      self%held = self%held + length
      length = line_length()
      ! What remains is the last line, perhaps with a carriage return.
      if (length < 0) length = index(self%buffer(:self%held) // return, return) - 1
      if (self%held == 0) return
    end if
    if (length == piece) then
      call fail(error, file_trouble, printable(self%file) // ': a line is too long for a table')
      return
    end if
    bytes = self%buffer(self%used + 1:self%used + length)
    self%used = self%used + length
    ! CR LF together are one end of a line.
    length = 1 + index(self%buffer(self%used + 1:min(self%held, self%used + 2)), return // newline)
    self%used = min(self%held, self%used + length)
    call take_source(self%file, bytes, self%line, error, lines_before=self%lines)
    self%lines = self%lines + 1
    if (allocated(error)) return
    self%digest = checksum([self%digest, checksum(self%line%text)])
    call point_decimals(self%line%text)
    call split(uncommented(self%line%text), self%cells)
    found = .true.

  contains

    !> Number of characters before the end of the next line (LF, CR LF or CR) in the buffer. It is
    !> -1 if there is no such end, or if the LF of CR LF may be in the next piece of the file.
    integer function line_length()
      line_length = scan(self%buffer(self%used + 1:self%held), return // newline) - 1
      if (line_length < 0 .or. self%used + line_length + 1 < self%held) return
      if (self%buffer(self%held:self%held) == return) line_length = -1
    end function line_length

  end subroutine next_line

end module case_rows
