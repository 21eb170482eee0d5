!> Numbers and logicals in a deck: strict readers for one token.
module deck_number
  use kinds, only: wp, long
  use text, only: lower, clip
  implicit none
  private
  public :: parse_real, parse_integer, parse_logical

  !> Numbers whose decimal order is outside +-50 are refused. Lengths, pressures and energies are
  !> far from these limits, and products and quotients of six numbers within them stay finite.
  integer, parameter :: largest_order = 50
  !> An exponent so large that the digits of a token cannot compensate it.
  integer, parameter :: beyond = 1000000
  !> A longer token than this has more digits than any double needs, and counts as a mistake.
  integer, parameter :: longest_number = 100

contains

  !> Reads one real number: sign, digits with at most one point, exponent with `e` or `d`. what: the
  !> mistake if `token` is not such a number.
  pure subroutine parse_real(token, value, what)
    character(len=*), intent(in) :: token
    real(wp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: what
    character(len=len(token)) :: small
    integer :: i, mark, point, before, after, order

    value = 0.0_wp
    small = lower(token)
    i = 1
    if (len(small) > 0) i = merge(2, 1, scan(small(1:1), '+-') == 1)
    if (any(small(min(i, len(small) + 1):) == ['nan     ', 'inf     ', 'infinity'])) then
      what = token // ' is not a finite number'
      return
    end if
    what = clip(token) // ' is not a number'
    if (len(token) == 0) what = 'nothing where a number is expected'
    if (len(token) > longest_number) return
    mark = scan(small, 'ed')
    if (mark == 0) mark = len(small) + 1
    if (mark <= i) return
    if (verify(small(i:mark - 1), '0123456789.') /= 0) return
    point = index(small(i:mark - 1), '.')
    if (index(small(i:mark - 1), '.', back=.true.) /= point) return
    before = merge(point - 1, mark - i, point > 0)
    after = mark - i - before - merge(1, 0, point > 0)
    if (before + after == 0) return

    order = 0
    if (mark <= len(small)) then
      call parse_integer(small(mark + 1:), order, what)
      if (allocated(what)) then
        what = token // ' is not a number'
        if (verify(small(mark + 1:), '+-0123456789') /= 0) return
        if (scan(small(mark + 1:), '0123456789') == 0) return
        if (scan(small(mark + 2:), '+-') /= 0) return
        what = token // ' is too large or too small; numbers have decimal orders from -50 to 50'
        return
      end if
      small(mark:mark) = 'e'
    end if
    i = scan(small(:mark - 1), '123456789')
    if (i > 0) then
      ! The sum is limited, since adding to the largest integer would overflow.
      order = max(-beyond, min(beyond, order))
      ! The decimal order of the first digit that is not zero.
      point = index(small(:mark - 1) // '.', '.')
      order = order + merge(point - i - 1, point - i, i < point)
      if (abs(order) > largest_order) then
        what = token // ' is too ' // merge('large', 'small', order > 0) // &
               '; numbers have decimal orders from -50 to 50'
        return
      end if
    else
      ! A zero needs no exponent; `read` would fail on 0e999.
      small = '0'
    end if
    read (small, *) value
    if (allocated(what)) deallocate (what)
  end subroutine parse_real

  !> Reads one integer; `what` as in `parse_real`.
  pure subroutine parse_integer(token, value, what)
    character(len=*), intent(in) :: token
    integer, intent(out) :: value
    character(len=:), allocatable, intent(out) :: what
    integer(long) :: wide
    integer :: i

    value = 0
    what = clip(token) // ' is not a whole number'
    if (len(token) == 0) return
    i = merge(2, 1, scan(token(1:1), '+-') == 1)
    if (len(token) < i) return
    if (verify(token(i:), '0123456789') /= 0) return
    what = clip(token) // ' is too large for a whole number'
    if (len(token) > 18) return
    read (token, *) wide
    if (abs(wide) > huge(value)) return
    value = int(wide)
    deallocate (what)
  end subroutine parse_integer

  !> Reads `.true.`, `.false.`, `true`, `false`, `.t.`, `.f.`, `t` or `f`; `what` as above.
  pure subroutine parse_logical(token, value, what)
    character(len=*), intent(in) :: token
    logical, intent(out) :: value
    character(len=:), allocatable, intent(out) :: what

    value = .false.
    select case (lower(token))
    case ('.true.', 'true', '.t.', 't')
      value = .true.
    case ('.false.', 'false', '.f.', 'f')
      value = .false.
    case default
      what = clip(token) // ' is neither .true. nor .false.'
    end select
  end subroutine parse_logical

end module deck_number
