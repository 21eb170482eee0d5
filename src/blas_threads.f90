!> How many threads the linear algebra uses. Below some size threads cost more than they bring, and
!> on a busy machine very much more; and with one, results do not depend on their number.
module blas_threads
  use, intrinsic :: iso_c_binding, only: c_funptr, c_int, c_associated, c_f_procpointer
  use c_library, only: procedure_named
  !$ use omp_lib, only: omp_get_max_threads, omp_in_parallel
  implicit none
  private
  public :: use_threads_for

  !> Order of the matrix from which threads pay, even on a machine with other work.
  integer, parameter :: worthwhile = 2500

  abstract interface
    subroutine set_threads(count) bind(c)
      import :: c_int
      integer(c_int), value :: count
    end subroutine set_threads
  end interface

contains

  !> Chooses the threads for matrices of the given order, where the library is OpenBLAS; any other
  !> keeps to its own rules. Where several cases are computed at once each has one. OpenBLAS is
  !> asked at run time, so that nothing depends on it.
  subroutine use_threads_for(order)
    integer, intent(in) :: order
    procedure(set_threads), pointer :: set
    type(c_funptr) :: address
    integer(c_int) :: count

    address = procedure_named('openblas_set_num_threads')
    if (.not. c_associated(address)) return
    call c_f_procpointer(address, set)
    count = 1
    !$ if (order >= worthwhile .and. .not. omp_in_parallel()) &
    !$   count = int(omp_get_max_threads(), c_int)
    call set(count)
  end subroutine use_threads_for

end module blas_threads
