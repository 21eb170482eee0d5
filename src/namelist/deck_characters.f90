!> Characters of a deck: blanks and comments, names, and the characters accepted outside comments.
module deck_characters
  use text, only: lower
  implicit none
  private
  public :: newline, blank, skip_blank, next_is_equals, plain, is_name

  character(len=*), parameter :: newline = new_line('a')
  character(len=*), parameter :: blank = ' ' // achar(9) // newline
  character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz'

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
      else if (index(blank, text(at:at)) > 0) then
        at = at + 1
      else
        return
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

  !> Whether a character is accepted outside comments.
  pure logical function plain(c)
    character(len=1), intent(in) :: c

    plain = (iachar(c) >= 32 .and. iachar(c) <= 126) .or. iachar(c) == 9
  end function plain

  !> Whether `text` can be the name of a group or a key.
  pure logical function is_name(text)
    character(len=*), intent(in) :: text

    is_name = .false.
    if (len(text) == 0) return
    is_name = index(letters, lower(text(1:1))) > 0 .and. &
      verify(lower(text), letters // '0123456789_') == 0
  end function is_name

end module deck_characters
