!> Working precision and mathematical constants.
module kinds
  use, intrinsic :: iso_fortran_env, only: real64, real32, int64
  implicit none
  private
  public :: wp, sp, pi, nan, long

  !> Working precision of all reals.
  integer, parameter :: wp = real64
  !> Precision of approximate factors of matrices.
  integer, parameter :: sp = real32
  !> Integers that may exceed 2^31.
  integer, parameter :: long = int64
  real(wp), parameter :: pi = 3.14159265358979323846264338327950288_wp
  !> The value of a number that does not exist.
  real(wp), parameter :: nan = transfer(int(z'7ff8000000000000', int64), 0.0_wp)
end module kinds
