!> Elapsed time.
module clock
  use kinds, only: wp, long
  implicit none
  private
  public :: seconds

contains

  !> Wall-clock seconds from an arbitrary origin.
  real(wp) function seconds()
    integer(long) :: count, rate

    call system_clock(count, rate)
    seconds = real(count, wp)/real(rate, wp)
  end function seconds

end module clock
