!> The text of a deck as one string, and messages that refer to a position in it.
!>
!> System calls read the files, since a Fortran `open` ignores blanks at the end of a name and so
!> may open another file.
module deck_source
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use failure, only: failure_t, fail, bad_input, file_trouble
  use c_library, only: c_open, c_read, c_close, explain, as_input, as_data, not_there, nul
  use text, only: brief, printable
  implicit none
  private
  public :: source_t, load_source, take_source, open_file, unprintable, largest_deck

  character(len=*), parameter :: newline = new_line('a')
  !> Largest size of a deck [bytes]; ten thousand values of a sweep take a quarter of it.
  integer, parameter :: largest_deck = 1048576

  !> A deck's text, with uniform ends of lines.
  type :: source_t
    !> Name of the file, in printable characters.
    character(len=:), allocatable :: file
    character(len=:), allocatable :: text
    !> Number of lines that the file has before the text, if the text is a part of the file.
    integer :: lines_before = 0
    !> The folder of the file, up to the last slash. Files named in the deck are searched for there.
    character(len=:), allocatable :: folder
  contains
    procedure :: part
    procedure :: line_at
    procedure :: complain
  end type source_t

contains

  !> Reads the whole `file`. Fails if it is missing, unreadable, a folder, larger than `most` bytes,
  !> or not plain text.
  subroutine load_source(file, source, error, most)
    character(len=*), intent(in) :: file
    type(source_t), intent(out) :: source
    type(failure_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: most
    character(len=:), allocatable :: bytes, reason
    integer(c_int) :: descriptor, status, sort
    integer :: n

    source%file = printable(file)
    source%text = ''
    if (len_trim(file) == 0) then
      call fail(error, file_trouble, 'a deck needs a file name')
      return
    end if
    ! A deck may come through a pipe, a table may not.
    call open_file(file, merge(as_data, as_input, present(most)), descriptor, error)
    if (allocated(error)) return
    n = largest_deck
    if (present(most)) n = most
    allocate (character(len=n + 1) :: bytes)
    n = int(c_read(descriptor, bytes, int(len(bytes), c_long)))
    status = c_close(descriptor)
    if (n < 0) then
      call explain(int(n, c_int), sort, reason)
      call fail(error, file_trouble, source%file // ': cannot be read: ' // reason)
    else
      call take_source(file, bytes(:n), source, error, most)
    end if
  end subroutine load_source

  !> Opens a file for reading. how: one of the modes in `c_library`.
  subroutine open_file(file, how, descriptor, error)
    character(len=*), intent(in) :: file
    integer(c_int), intent(in) :: how
    integer(c_int), intent(out) :: descriptor
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: reason
    integer(c_int) :: sort

    descriptor = c_open(file // nul, how)
    if (descriptor >= 0) return
    call explain(descriptor, sort, reason)
    reason = 'cannot be opened: ' // reason
    if (sort == not_there) reason = 'no such file'
    call fail(error, file_trouble, printable(file) // ': ' // reason)
  end subroutine open_file

  !> Takes the bytes of a deck. name: the name of the deck in messages. lines_before: the number of
  !> lines that the file has before these bytes. It fails if there are more than `most` bytes, or if
  !> they are not plain text.
  subroutine take_source(name, bytes, source, error, most, lines_before)
    character(len=*), intent(in) :: name, bytes
    type(source_t), intent(out) :: source
    type(failure_t), allocatable, intent(out) :: error
    integer, intent(in), optional :: most, lines_before
    integer :: n

    source%file = printable(name)
    source%text = ''
    if (present(lines_before)) source%lines_before = lines_before
    source%folder = name(:index(name, '/', back=.true.))
    n = largest_deck
    if (present(most)) n = most
    if (len(bytes) > n) then
      call fail(error, bad_input, source%file // ': larger than ' // brief(n/2**20) // &
        ' MiB, so ' // merge('not a table', 'not a deck ', present(most)))
      return
    end if
    call straighten(bytes, source%text)
    n = index(source%text, achar(0))
    if (n > 0) call source%complain(n, 'a NUL byte, which plain text does not have', error)
  end subroutine take_source

  !> Replaces every end of a line (LF, CR LF or CR) by a single line feed and removes a byte-order
  !> mark. Text in UTF-16, recognised by a mark or by zero bytes, is converted to UTF-8.
  pure recursive subroutine straighten(bytes, text)
    character(len=*), intent(in) :: bytes
    character(len=:), allocatable, intent(out) :: text
    character(len=*), parameter :: mark = char(239) // char(187) // char(191)
    character(len=1), parameter :: return = achar(13)
    integer :: i, n, first, high

    high = high_byte_of_16(bytes)
    if (high >= 0) then
      call straighten(narrowed(bytes, high), text)
      return
    end if

    first = 1
    if (len(bytes) >= 3) then
      if (bytes(:3) == mark) first = 4
    end if
    text = bytes(first:)
    n = 0
    do i = first, len(bytes)
      if (bytes(i:i) == newline .and. i > first) then
        if (bytes(i - 1:i - 1) == return) cycle
      end if
      n = n + 1
      text(n:n) = bytes(i:i)
      if (bytes(i:i) == return) text(n:n) = newline
    end do
    text = text(:n)
  end subroutine straighten

  !> Position (0 or 1) of the high byte in the pairs of bytes of a text in UTF-16. It is -1 if the
  !> text begins neither with a byte-order mark nor with pairs of a character and a zero byte.
  pure integer function high_byte_of_16(bytes) result(high)
    character(len=*), intent(in) :: bytes
    integer, parameter :: enough = 8
    logical :: is_zero(enough)
    integer :: i

    high = -1
    if (len(bytes) < 2 .or. mod(len(bytes), 2) > 0) return
    if (bytes(:2) == char(255) // char(254)) high = 1
    if (bytes(:2) == char(254) // char(255)) high = 0
    if (high >= 0 .or. len(bytes) < enough) return
    is_zero = [(bytes(i:i) == achar(0), i=1, enough)]
    if (all(is_zero(2::2)) .and. .not. any(is_zero(1::2))) high = 1
    if (all(is_zero(1::2)) .and. .not. any(is_zero(2::2))) high = 0
  end function high_byte_of_16

  !> Converts text in UTF-16 to UTF-8. high: the position of the high byte in each pair. Characters
  !> outside the basic plane become question marks.
  pure function narrowed(bytes, high) result(text)
    character(len=*), intent(in) :: bytes
    integer, intent(in) :: high
    character(len=:), allocatable :: text
    integer :: i, n, code

    allocate (character(len=3*(len(bytes)/2)) :: text)
    n = 0
    do i = 1, len(bytes) - 1, 2
      code = 256*iachar(bytes(i + high:i + high)) + iachar(bytes(i + 1 - high:i + 1 - high))
      if (code < 128) then
        text(n + 1:n + 1) = achar(code)
        n = n + 1
      else if (code < 2048) then
        text(n + 1:n + 2) = char(192 + code/64) // char(128 + mod(code, 64))
        n = n + 2
      else if (code >= 55296 .and. code < 57344) then
        text(n + 1:n + 1) = '?'
        n = n + 1
      else
        text(n + 1:n + 3) = char(224 + code/4096) // char(128 + mod(code/64, 64)) // &
          char(128 + mod(code, 64))
        n = n + 3
      end if
    end do
    text = text(:n)
  end function narrowed

  !> The text from position `first` to `last`.
  pure function part(self, first, last) result(text)
    class(source_t), intent(in) :: self
    integer, intent(in) :: first, last
    character(len=:), allocatable :: text

    text = self%text(first:last)
  end function part

  !> Number of the line that contains the position `at` of the text.
  pure integer function line_at(self, at)
    class(source_t), intent(in) :: self
    integer, intent(in) :: at
    integer :: i

    line_at = self%lines_before + 1
    do i = 1, min(at - 1, len(self%text))
      if (self%text(i:i) == newline) line_at = line_at + 1
    end do
  end function line_at

  !> Adds `FILE:LINE: &group: key "key": what` to `error`, with the line itself and a caret below
  !> position `at`. `error` may already contain other mistakes. `group` and `key` may be blank.
  pure subroutine complain(self, at, what, error, group, key)
    class(source_t), intent(in) :: self
    integer, intent(in) :: at
    character(len=*), intent(in) :: what
    type(failure_t), allocatable, intent(inout) :: error
    character(len=*), intent(in), optional :: group, key
    character(len=:), allocatable :: line, message

    line = brief(self%line_at(at))
    message = self%file // ':' // line // ': '
    if (present(group)) then
      if (len_trim(group) > 0) message = message // '&' // trim(group) // ': '
      if (len_trim(key) > 0) message = message // 'key "' // trim(key) // '": '
    end if
    message = message // what // excerpt(self%text, at, line)
    if (allocated(error)) then
      error%message = error%message // newline // message
    else
      call fail(error, bad_input, message)
    end if
  end subroutine complain

  !> The line that contains position `at`, with its number, and a caret in the line below it.
  pure function excerpt(text, at, number) result(lines)
    character(len=*), intent(in) :: text, number
    integer, intent(in) :: at
    character(len=:), allocatable :: lines
    !> Number of characters of a long line that are shown; number of those before the caret.
    integer, parameter :: width = 90, lead = 60
    character(len=:), allocatable :: shown
    integer :: first, last, caret, i

    lines = ''
    if (at < 1 .or. at > len(text) + 1 .or. len(text) == 0) return
    first = index(text(:at - 1), newline, back=.true.) + 1
    last = at + scan(text(at:) // newline, newline) - 2
    if (at - first > lead) first = at - lead
    last = min(last, first + width - 1)
    shown = text(first:last)
    do i = 1, len(shown)
      if (iachar(shown(i:i)) == 9) shown(i:i) = ' '
      if (iachar(shown(i:i)) < 32 .or. iachar(shown(i:i)) == 127) shown(i:i) = '?'
    end do
    ! A character of several bytes is shown in one column.
    caret = 0
    do i = first, at - 1
      if (iand(iachar(text(i:i)), 192) /= 128) caret = caret + 1
    end do
    lines = newline // '    ' // number // ' | ' // trim(shown) // &
            newline // '    ' // repeat(' ', len(number)) // ' | ' // repeat(' ', caret) // '^'
  end function excerpt

  !> The name of the character at the beginning of a text, which is not accepted in a group. For
  !> characters that word processors write (quotes, minus, blank) the replacement is added.
  pure function unprintable(text) result(what)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: what
    character(len=*), parameter :: e2 = char(226)//char(128), single(2) = [e2//char(152), &
      e2//char(153)], double(2) = [e2//char(156), e2//char(157)], minus(3) = &
      [char(226)//char(136)//char(146), e2//char(147), e2//char(148)], micro(2) = &
      [char(194)//char(181), char(206)//char(188)]
    integer :: length

    length = max(1, bytes_of(text))
    if (length == 1) then
      what = 'a byte that is not plain ASCII (code ' // brief(iachar(text(1:1))) // ')'
    else
      what = 'the character ' // text(:length) // ', which is not plain ASCII'
    end if
    if (length == 3) then
      if (any(text(:3) == single)) what = what // "; write a straight quote: '"
      if (any(text(:3) == double)) what = what // '; write a straight quote: "'
      if (any(text(:3) == minus)) what = what // '; write a minus: -'
    else if (text(:length) == char(194) // char(160)) then
      what = 'a blank that does not break lines, which is not plain ASCII; write a blank'
    else if (any(text(:length) == micro)) then
      what = what // '; numbers have no units in a deck: 1e-6 for micro'
    end if
    what = what // '; only comments may hold such characters'
  end function unprintable

  !> Number of bytes of the UTF-8 character at the beginning of a text; 0 if there is no such
  !> character.
  pure integer function bytes_of(text)
    character(len=*), intent(in) :: text
    integer :: i

    bytes_of = 0
    if (iachar(text(1:1)) <= 244) bytes_of = count(iachar(text(1:1)) >= [194, 194, 224, 240])
    if (len(text) < bytes_of) bytes_of = 0
    if (any([(iand(iachar(text(i:i)), 192) /= 128, i=2, bytes_of)])) bytes_of = 0
  end function bytes_of

end module deck_source
