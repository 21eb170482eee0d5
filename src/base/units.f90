!> Units of the columns of measured data, metres, newtons and volts with the prefixes milli to pico,
!> and Angstrom; and values with their errors in units, for messages.
module units
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use text, only: rounded, rounded_to
  implicit none
  private
  public :: find_unit, unit_in, split_unit, is_unit_cell, with_unit

  character(len=*), parameter :: prefixes = 'munp', bases = 'mNV'
  integer, parameter :: powers(*) = [-3, -6, -9, -12]
  real(wp), parameter :: angstrom_in_m = 1.0e-10_wp
  !> The sign of Angstrom in UTF-8, of two code points, and in Latin-1; brackets about a unit.
  character(len=*), parameter :: angstrom(*) = [character(len=8) :: 'Angstrom', 'angstrom', &
    char(195) // char(133), char(226) // char(132) // char(171), char(197)], &
    opens = '([{', closes = ')]}'

contains

  !> Converts a unit such as 'nm' or 'N' to SI. base is 'm', 'N' or 'V', or 'R' for the unit N/m of
  !> a force over a radius; it is blank if `text` is no such unit. factor is 1e-9 for nano.
  pure recursive subroutine find_unit(text, factor, base)
    character(len=*), intent(in) :: text
    real(wp), intent(out) :: factor
    character, intent(out) :: base
    character(len=:), allocatable :: unit
    integer :: k

    factor = 1
    base = ' '
    unit = trim(adjustl(text))
    if (any(unit == angstrom) .and. len(unit) > 0) then
      factor = angstrom_in_m
      base = 'm'
      return
    end if
    if (any(unit == [character(len=7) :: 'micron', 'microns'])) unit = 'um'
    if (is_over_length(unit)) then
      call find_unit(unit(:len(unit) - 2), factor, base)
      base = 'R'
      return
    end if
    if (len(unit) < 1 .or. len(unit) > 2) return
    if (index(bases, unit(len(unit):)) == 0) return
    if (len(unit) == 2) then
      k = index(prefixes, unit(1:1))
      if (k == 0) return
      factor = 10.0_wp**powers(k)
    end if
    base = unit(len(unit):)
  end subroutine find_unit

  !> Whether a unit is that of a force over a length, such as 'mN/m'.
  pure logical function is_over_length(unit) result(is)
    character(len=*), intent(in) :: unit
    integer :: last

    is = .false.
    last = len(unit) - 2
    if (last < 1 .or. last > 2) return
    is = unit(last:) == 'N/m'
    if (is .and. last == 2) is = index(prefixes, unit(1:1)) > 0
  end function is_over_length

  !> The unit in a column's name or in a cell of a line of units; '' if there is none.
  pure function unit_in(name) result(unit)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unit, bare

    call split_unit(name, bare, unit)
  end function unit_in

  !> Divides a column's name: 'Force (nN)', 'Force [nN]' and 'Force / nN' are 'Force' and 'nN', the
  !> cell 'nN' is '' and 'nN'. unit: '' if there is none.
  pure subroutine split_unit(name, bare, unit)
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(out) :: bare, unit
    character(len=:), allocatable :: inner
    real(wp) :: factor
    character :: base, before
    integer :: first, last

    last = len_trim(name)
    bare = name(:last)
    unit = ''
    if (last == 0) return
    if (is_over_length(name(:last))) then
      unit = bare
      bare = ''
      return
    end if
    if (scan(name(last:last), closes) > 0) then
      first = scan(name(:last), opens, back=.true.)
      last = last - 1
    else
      first = index(name(:last), '/', back=.true.)
      ! 'nN/nm' is the unit of a slope.
      call find_unit(name(:max(0, first - 1)), factor, before)
      if (before /= ' ') return
    end if
    inner = trim(adjustl(name(first + 1:last)))
    call find_unit(inner, factor, base)
    if (base == ' ') return
    unit = inner
    bare = trim(name(:max(0, first - 1)))
  end subroutine split_unit

  !> Whether a cell may stand in a line of units. It may be a unit that this module knows, anything
  !> in brackets, another common unit, or empty.
  pure logical function is_unit_cell(cell) result(is)
    character(len=*), intent(in) :: cell
    character(len=:), allocatable :: bare, unit
    integer :: last

    call split_unit(cell, bare, unit)
    last = len_trim(cell)
    is = last == 0
    if (is) return
    is = (len(unit) > 0 .and. len(bare) == 0) .or. (scan(cell(1:1), opens) > 0 .and. &
      scan(cell(last:last), closes) > 0) .or. any(cell == [character(len=5) :: '-', '--', 's', &
      'ms', 'us', 'min', 'Hz', 'kHz', 'deg', 'Pa', 'kPa', 'A', 'nA', 'pA', 'N/m', 'nN/nm', 'V/m', &
      'a.u.', '%'])
  end function is_unit_cell

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
