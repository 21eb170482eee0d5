!> Elapsed time, and processor time.
module clock
  use, intrinsic :: iso_c_binding, only: c_double
  use kinds, only: wp, long
  implicit none
  private
  public :: seconds, thread_seconds

  interface
    real(c_double) function c_thread_seconds() bind(c, name='snapin_thread_seconds')
      import :: c_double
    end function c_thread_seconds
  end interface

contains

  !> Time of the wall clock [s] from an arbitrary origin.
  real(wp) function seconds()
    integer(long) :: count, rate

    call system_clock(count, rate)
    seconds = real(count, wp)/real(rate, wp)
  end function seconds

  !> Time [s] that a processor has worked for this thread. On an idle machine this equals the
  !> elapsed time; on a busy machine other work is not counted.
  real(wp) function thread_seconds()
    thread_seconds = real(c_thread_seconds(), wp)
  end function thread_seconds

end module clock
