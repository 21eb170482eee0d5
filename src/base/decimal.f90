!> Numbers as decimal text with the same digits that the compiler's library writes, at a fortieth of
!> its cost: most of a result file is numbers.
!>
!> A real is m 2^b with an integer m of 53 bits. Times 10^p it is m 5^p 2^(b + p). For numbers of
!> common size m 5^p fits into two words of 128 bits, so that digits and rounding are exact. The
!> library writes very small and very large numbers and NaN.
module decimal
  use kinds, only: wp, long
  implicit none
  private
  public :: put_real, put_whole, longest_real

  !> The largest number of characters of a real number.
  integer, parameter :: longest_real = 24

  integer, parameter :: wide = selected_int_kind(38)
  !> Significant digits, enough to read the same number back.
  integer, parameter :: places = 17
  !> The largest power of five that fits one factor below 2^63, and the largest power of ten.
  integer, parameter :: one_factor = 27, most_powers = 2*one_factor
  !> Number of bits in the lower of two words.
  integer, parameter :: low_bits = 60
  integer(long), parameter :: smallest = 10_long**(places - 1), beyond = 10*smallest

contains

  !> Writes x with 17 significant digits, as es24.16e3 without leading blanks, into text(:length);
  !> `text` has at least `longest_real` characters.
  pure subroutine put_real(x, text, length)
    real(wp), intent(in) :: x
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    integer(long) :: significand
    integer :: order, sign_width
    logical :: found

    call decompose(abs(x), significand, order, found)
    if (.not. found) then
      call put_by_library(x, text, length)
      return
    end if
    sign_width = 0
    if (sign(1.0_wp, x) < 0) then
      sign_width = 1
      text(1:1) = '-'
    end if
    ! The digits start one place to the right, so that a point fits in after the first digit.
    call put_digits(significand, places, text(sign_width + 2:))
    text(sign_width + 1:sign_width + 1) = text(sign_width + 2:sign_width + 2)
    text(sign_width + 2:sign_width + 2) = '.'
    length = sign_width + places + 1
    text(length + 1:length + 2) = merge('E-', 'E+', order < 0)
    call put_digits(int(abs(order), long), 3, text(length + 3:))
    length = length + 5
  end subroutine put_real

  !> Writes an integer into text(:length); `text` has at least 11 characters.
  pure subroutine put_whole(i, text, length)
    integer, intent(in) :: i
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    integer(long) :: rest
    integer :: sign_width

    sign_width = 0
    if (i < 0) then
      sign_width = 1
      text(1:1) = '-'
    end if
    length = 1
    rest = abs(int(i, long))/10
    do while (rest > 0)
      length = length + 1
      rest = rest/10
    end do
    call put_digits(abs(int(i, long)), length, text(sign_width + 1:))
    length = length + sign_width
  end subroutine put_whole

  !> Writes the last `count` digits of a nonnegative integer.
  pure subroutine put_digits(number, count, text)
    integer(long), intent(in) :: number
    integer, intent(in) :: count
    character(len=*), intent(inout) :: text
    integer(long) :: rest, next
    integer :: i

    rest = number
    do i = count, 1, -1
      next = rest/10
      text(i:i) = achar(iachar('0') + int(rest - 10*next))
      rest = next
    end do
  end subroutine put_digits

  !> x >= 0 as significand*10^(order - 16), correctly rounded, halves to even. found = .false. if
  !> two words cannot hold m 5^p.
  pure subroutine decompose(x, significand, order, found)
    real(wp), intent(in) :: x
    integer(long), intent(out) :: significand
    integer, intent(out) :: order
    logical, intent(out) :: found
    integer(long) :: m, bits
    integer :: b

    significand = 0
    order = 0
    ! Bits of positive numbers have the order of the numbers, and comparing bits traps no NaN.
    bits = transfer(x, 0_long)
    found = bits == 0
    if (bits < transfer(tiny(x), 0_long) .or. bits > transfer(huge(x), 0_long)) return
    m = int(scale(fraction(x), digits(x)), long)
    b = exponent(x) - digits(x)
    ! 2^(exponent - 1) <= x, so that this order is right or one too small.
    order = floor((exponent(x) - 1)*log10(2.0_wp))
    call scaled(m, b, places - 1 - order, significand, found)
    if (significand < beyond) return
    order = order + 1
    call scaled(m, b, places - 1 - order, significand, found)
  end subroutine decompose

  !> m 2^b 10^p as an integer, halves to even. found = .false. if p is beyond the table.
  pure subroutine scaled(m, b, p, number, found)
    integer(long), intent(in) :: m
    integer, intent(in) :: b, p
    integer(long), intent(out) :: number
    logical, intent(out) :: found
    integer(wide) :: product, low, rest, half
    integer :: shift

    number = 0
    found = p >= 0 .and. p <= most_powers
    if (.not. found) return
    product = int(m, wide)*5_long**min(p, one_factor)
    low = 0
    shift = -(b + p)
    if (p > one_factor) then
      ! product 2^60 + low is above 2^117 and the number below 2^57, so that shift exceeds 60.
      low = iand(product, mask(low_bits))*5_long**(p - one_factor)
      product = ishft(product, -low_bits)*5_long**(p - one_factor) + ishft(low, -low_bits)
      low = iand(low, mask(low_bits))
      shift = shift - low_bits
    end if
    if (shift <= 0) then
      number = int(ishft(product, -shift), long)
      return
    end if
    number = int(ishft(product, -shift), long)
    rest = iand(product, mask(shift))
    half = ishft(1_wide, shift - 1)
    if (rest > half .or. rest == half .and. (low > 0 .or. mod(number, 2_long) == 1)) &
      number = number + 1
  end subroutine scaled

  !> A word whose lowest `bits` bits are ones.
  pure integer(wide) function mask(bits)
    integer, intent(in) :: bits

    mask = ishft(1_wide, bits) - 1
  end function mask

  !> Writes a number outside the range of `decompose`.
  pure subroutine put_by_library(x, text, length)
    real(wp), intent(in) :: x
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    character(len=longest_real) :: buffer

    write (buffer, '(es24.16e3)') x
    text = adjustl(buffer)
    length = len_trim(adjustl(buffer))
  end subroutine put_by_library

end module decimal
