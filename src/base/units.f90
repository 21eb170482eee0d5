!> Units of the columns of measured data, metres, newtons and volts with the prefixes milli to pico;
!> and values with their errors in units, for messages.
module units
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use text, only: rounded, rounded_to
  implicit none
  private
  public :: find_unit, unit_in, with_unit

  character(len=*), parameter :: prefixes = 'munp', bases = 'mNV'
  integer, parameter :: powers(*) = [-3, -6, -9, -12]

contains

  !> What a unit such as 'nm' or 'N' is in SI: base is 'm', 'N' or 'V', blank if `text` is no such
  !> unit; factor is 1e-9 for nano.
  pure subroutine find_unit(text, factor, base)
    character(len=*), intent(in) :: text
    real(wp), intent(out) :: factor
    character, intent(out) :: base
    character(len=:), allocatable :: unit
    integer :: k

    factor = 1
    base = ' '
    unit = trim(adjustl(text))
    if (len(unit) < 1 .or. len(unit) > 2) return
    if (index(bases, unit(len(unit):)) == 0) return
    if (len(unit) == 2) then
      k = index(prefixes, unit(1:1))
      if (k == 0) return
      factor = 10.0_wp**powers(k)
    end if
    base = unit(len(unit):)
  end subroutine find_unit

  !> The unit in a column's name or in a cell of a line of units: 'nN' of 'Force (nN)', '[nN]' and
  !> 'nN'; '' if there is none.
  pure function unit_in(name) result(unit)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unit
    character(len=*), parameter :: opens = '([{', closes = ')]}'
    real(wp) :: factor
    character :: base
    integer :: first, last

    last = len_trim(name)
    unit = name(:last)
    if (last > 1) then
      if (scan(name(last:last), closes) > 0) then
        first = scan(name(:last), opens, back=.true.)
        unit = trim(adjustl(name(first + 1:last - 1)))
      end if
    end if
    call find_unit(unit, factor, base)
    if (base == ' ') unit = ''
  end function unit_in

  !> A value and, unless it is NaN, its error in a unit; metres, newtons, pascals and m/V have a
  !> prefix.
  pure function with_unit(value, error, unit) result(words)
    real(wp), intent(in) :: value, error
    character(len=*), intent(in) :: unit
    character(len=:), allocatable :: words
    character(len=*), parameter :: prefixes = 'fpnum kMGT'
    integer, parameter :: plain = index(prefixes, ' ')
    integer :: prefix
    real(wp) :: largest, scale

    prefix = plain
    largest = max(abs(value), merge(0.0_wp, error, ieee_is_nan(error)))
    if (any(unit == [character(len=3) :: 'm', 'N', 'Pa', 'm/V']) .and. largest > 0 .and. &
      largest < huge(largest)) &
      prefix = max(1, min(len(prefixes), plain + floor(log10(largest)/3)))
    scale = 10.0_wp**(3*(prefix - plain))
    if (ieee_is_nan(error)) then
      words = rounded(value/scale)
    else
      words = rounded_to(value/scale, error/scale) // ' +- ' // rounded(error/scale)
    end if
    if (len_trim(unit) > 0) words = words // ' ' // trim(adjustl(prefixes(prefix:prefix) // unit))
  end function with_unit

end module units
