!> Numbers as decimal text, as the compiler's library writes them. Signs do not depend on its
!> settings (GFORTRAN_OPTIONAL_PLUS).
module decimal
  use kinds, only: wp
  implicit none
  private
  public :: put_real, put_whole, longest_real

  !> The largest number of characters of a real number.
  integer, parameter :: longest_real = 24

contains

  !> Writes x with 17 significant digits, enough to read the same number back, without leading
  !> blanks into text(:length); `text` has at least `longest_real` characters.
  pure subroutine put_real(x, text, length)
    real(wp), intent(in) :: x
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    character(len=longest_real) :: buffer

    write (buffer, '(ss, es24.16e3)') x
    call put(buffer, text, length)
  end subroutine put_real

  !> Writes an integer into text(:length); `text` has at least 11 characters.
  pure subroutine put_whole(i, text, length)
    integer, intent(in) :: i
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    character(len=longest_real) :: buffer

    write (buffer, '(ss, i0)') i
    call put(buffer, text, length)
  end subroutine put_whole

  pure subroutine put(buffer, text, length)
    character(len=*), intent(in) :: buffer
    character(len=*), intent(inout) :: text
    integer, intent(out) :: length
    character(len=len(buffer)) :: trimmed

    trimmed = adjustl(buffer)
    length = len_trim(trimmed)
    text(:length) = trimmed(:length)
  end subroutine put

end module decimal
