!> Recognises texts that stand for a number in a deck but are none: a number with its unit, with a
!> decimal comma, or with a blank in it. Numbers of a deck have no units.
module number_slips
  use kinds, only: wp
  use text, only: clip, lower
  use deck_number, only: parse_real
  implicit none
  private
  public :: unit_slip, comma_slip

  character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz'
  character(len=*), parameter :: prefixes = 'fpnumkMGT'
  character(len=*), parameter :: powers(*) = [character(len=3) :: '-15', '-12', '-9', '-6', '-3', &
    '3', '6', '9', '12']

contains

  !> Advice on `token`, which follows the number `before`; if `before` is empty, the number is at
  !> the beginning of the token. unit: the unit of the key. Empty if there is no number, or nothing
  !> but a number.
  pure function unit_slip(before, token, unit) result(advice)
    character(len=*), intent(in) :: before, token, unit
    character(len=:), allocatable :: advice, number, word

    advice = ''
    number = before
    word = token
    if (before == '') call divide(token, number, word)
    if (number == '' .or. word == '' .or. .not. is_number(number)) return
    if (scan(word(1:1), 'eEdD') == 1 .and. is_number(number // word)) then
      advice = clip(number // ' ' // word) // ' has a blank in it; write ' // clip(number // word)
    else if (verify(lower(word), letters) == 0 .and. all(lower(word) /= ['e', 'd'])) then
      advice = clip(word) // ' after a number: numbers have no units in a deck' // &
        written(number, word, unit)
    end if
  end function unit_slip

  !> Advice on two numbers that may be one number with a decimal comma, without a blank after the
  !> comma; otherwise empty.
  pure function comma_slip(one, other) result(advice)
    character(len=*), intent(in) :: one, other
    character(len=:), allocatable :: advice

    advice = ''
    if (verify(one, '+-0123456789') > 0 .or. scan(other(:1), '0123456789') == 0) return
    if (.not. (is_number(one) .and. is_number(one // '.' // other))) return
    advice = 'a comma separates values; the decimal sign is a point: ' // clip(one // '.' // other)
  end function comma_slip

  !> '; write 1.5e-6' for 1.5 um, if this is a number with the unit of the key, possibly with a
  !> prefix; otherwise empty.
  pure function written(number, word, unit) result(text)
    character(len=*), intent(in) :: number, word, unit
    character(len=:), allocatable :: text
    integer :: k

    text = ''
    if (unit == '') return
    if (word == unit) then
      text = '; write ' // clip(number)
    else if (word(2:) == unit .and. scan(number, 'eEdD') == 0) then
      k = index(prefixes, word(1:1))
      if (k > 0) text = '; write ' // clip(number // 'e' // trim(powers(k)))
    end if
  end function written

  !> Divides a token after the longest number at its beginning into this number and the remaining
  !> word.
  pure subroutine divide(token, number, word)
    character(len=*), intent(in) :: token
    character(len=:), allocatable, intent(out) :: number, word
    integer :: n

    do n = verify(token // 'x', '+-.0123456789eEdD') - 1, 1, -1
      if (is_number(token(:n))) exit
    end do
    number = token(:n)
    word = token(n + 1:)
  end subroutine divide

  pure logical function is_number(token)
    character(len=*), intent(in) :: token
    real(wp) :: value
    character(len=:), allocatable :: what

    call parse_real(token, value, what)
    is_number = .not. allocated(what)
  end function is_number

end module number_slips
