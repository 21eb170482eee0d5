!> The smallest pieces of a deck: blanks and comments, words, strings.
module deck_token
  use failure, only: failure_t
  use text, only: lower
  use deck_source, only: source_t
  implicit none
  private
  public :: skip_blank, next_is_equals, take_word, take_string, is_name

  character(len=*), parameter :: newline = new_line('a')
  character(len=*), parameter :: blank = ' ' // achar(9) // newline
  character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz'
  character(len=*), parameter :: name_characters = letters // '0123456789_'

contains

  !> Moves `at` to the next character that is neither blank nor part of a comment.
  pure subroutine skip_blank(text, at)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at

    do while (at <= len(text))
      if (text(at:at) == '!') then
        do while (at <= len(text))
          if (text(at:at) == newline) exit
          at = at + 1
        end do
      else if (index(blank, text(at:at)) == 0) then
        return
      else
        at = at + 1
      end if
    end do
  end subroutine skip_blank

  !> Whether the next character after blanks and comments is `=`.
  pure logical function next_is_equals(text, at)
    character(len=*), intent(in) :: text
    integer, intent(in) :: at
    integer :: ahead

    ahead = at
    call skip_blank(text, ahead)
    next_is_equals = .false.
    if (ahead <= len(text)) next_is_equals = text(ahead:ahead) == '='
  end function next_is_equals

  !> Moves `at` behind a word. What stands in parentheses belongs to it, so that a subscript can be
  !> named as such.
  subroutine take_word(source, at, group, error)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: at
    character(len=*), intent(in) :: group
    type(failure_t), allocatable, intent(inout) :: error
    character(len=1) :: c
    logical :: inside

    inside = .false.
    do while (at <= len(source%text))
      c = source%text(at:at)
      if (c == newline) exit
      if (index(blank // ',=/!&', c) > 0 .and. .not. inside) exit
      if (c == '''' .or. c == '"') then
        call source%complain(at, group, '', 'a quote in the middle of a word', error)
        return
      end if
      if (.not. plain(c)) then
        call source%complain(at, group, '', unprintable(source%text(at:)), error)
        return
      end if
      if (c == '(') inside = .true.
      if (c == ')') inside = .false.
      at = at + 1
    end do
  end subroutine take_word

  !> Moves `at` behind a string, quotes included.
  subroutine take_string(source, at, group, key, error)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: at
    character(len=*), intent(in) :: group, key
    type(failure_t), allocatable, intent(inout) :: error
    character(len=1) :: quote, c
    integer :: start

    start = at
    quote = source%text(at:at)
    do
      at = at + 1
      c = newline
      if (at <= len(source%text)) c = source%text(at:at)
      if (c == newline) then
        call source%complain(start, group, key, 'this string has no closing ' // quote // &
                             ' on its line', error)
        return
      else if (c == quote) then
        at = at + 1
        if (at > len(source%text)) return
        if (source%text(at:at) /= quote) exit
      else if (.not. plain(c)) then
        call source%complain(at, group, key, unprintable(source%text(at:)), error)
        return
      end if
    end do
    if (index(blank // ',/!', source%text(at:at)) == 0) &
      call source%complain(at, group, key, 'text right after a closing quote; ' // &
                           'a quote inside a string is written twice', error)
  end subroutine take_string

  !> Whether a character may stand outside comments.
  pure logical function plain(c)
    character(len=1), intent(in) :: c

    plain = (iachar(c) >= 32 .and. iachar(c) <= 126) .or. iachar(c) == 9
  end function plain

  !> Names the character at the beginning of a text, which may not stand in a group, and the one
  !> that is meant where word processors put it: quotes, a minus, a blank.
  pure function unprintable(text) result(what)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: what
    character(len=*), parameter :: e2 = char(226)//char(128), single(2) = [e2//char(152), &
      e2//char(153)], double(2) = [e2//char(156), e2//char(157)], minus(3) = &
      [char(226)//char(136)//char(146), e2//char(147), e2//char(148)]
    character(len=4) :: code
    integer :: length

    length = max(1, bytes_of(text))
    if (length == 1) then
      write (code, '(i0)') iachar(text(1:1))
      what = 'a byte that is not plain ASCII (code ' // trim(code) // ')'
    else
      what = 'the character ' // text(:length) // ', which is not plain ASCII'
    end if
    if (length == 3) then
      if (any(text(:3) == single)) what = what // "; write a straight quote: '"
      if (any(text(:3) == double)) what = what // '; write a straight quote: "'
      if (any(text(:3) == minus)) what = what // '; write a minus: -'
    else if (text(:length) == char(194) // char(160)) then
      what = 'a blank that does not break lines, which is not plain ASCII; write a blank'
    end if
    what = what // '; only comments may hold such characters'
  end function unprintable

  !> Bytes of the UTF-8 character at the beginning of a text; 0 where there is none.
  pure integer function bytes_of(text)
    character(len=*), intent(in) :: text
    integer :: i

    bytes_of = 0
    select case (iachar(text(1:1)))
    case (194:223)
      bytes_of = 2
    case (224:239)
      bytes_of = 3
    case (240:244)
      bytes_of = 4
    end select
    if (len(text) < bytes_of) bytes_of = 0
    do i = 2, bytes_of
      if (iand(iachar(text(i:i)), 192) /= 128) then
        bytes_of = 0
        return
      end if
    end do
  end function bytes_of

  !> Whether `text` can name a group or a key.
  pure logical function is_name(text)
    character(len=*), intent(in) :: text

    is_name = .false.
    if (len(text) == 0) return
    is_name = index(letters, lower(text(1:1))) > 0 .and. verify(lower(text), name_characters) == 0
  end function is_name

end module deck_token
