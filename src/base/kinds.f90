!> Working precision and mathematical constants.
module kinds
  use, intrinsic :: iso_fortran_env, only: real64, int64
  implicit none
  private
  public :: wp, pi, long

  !> Working precision of every real in the library.
  integer, parameter :: wp = real64
  !> Integer for counters that may exceed 2^31.
  integer, parameter :: long = int64
  real(wp), parameter :: pi = 3.14159265358979323846264338327950288_wp
end module kinds
