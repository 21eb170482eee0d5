!> How many threads the linear algebra uses. Below some size threads cost more than they bring, and
!> on a busy machine very much more; and with one, results do not depend on their number.
module blas_threads
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use c_library, only: c_openblas_threads, c_openblas_end_threads
  !$ use omp_lib, only: omp_get_max_threads, omp_in_parallel
  implicit none
  private
  public :: begin_with_one_thread, use_threads_for, thread_count, blas_buffers

  !> Order of the matrix from which threads pay, even on a machine with other work.
  integer, parameter :: worthwhile = 2500
  !> Address space [bytes] that OpenBLAS 0.3 maps for each thread that calls it, whatever the size
  !> of the matrices; and what every further thread has as stack and for `malloc`. Hardly any of it
  !> is ever touched.
  real(wp), parameter :: of_buffer = 136.0e6_wp, of_thread = 76.0e6_wp

contains

  !> For the beginning of a program. OpenBLAS starts a thread for every further core when it is
  !> loaded, and each looks for work for some 25 ms as fast as it can, as long as a short run takes.
  !> They are ended; `use_threads_for` has them started where a matrix is large enough.
  subroutine begin_with_one_thread()
    integer(c_int) :: known

    known = c_openblas_threads(1_c_int)
    call c_openblas_end_threads()
  end subroutine begin_with_one_thread

  !> Chooses the threads for matrices of the given order, where the library is OpenBLAS; any other
  !> keeps to its own rules. Where several cases are computed at once each has one.
  subroutine use_threads_for(order)
    integer, intent(in) :: order
    integer(c_int) :: count, known

    count = 1
    if (order >= worthwhile) then
      !$ if (.not. omp_in_parallel()) count = int(omp_get_max_threads(), c_int)
    end if
    known = c_openblas_threads(count)
  end subroutine use_threads_for

  !> Address space [bytes] that threads and the linear algebra map for themselves, for matrices of
  !> the given order in so many cases at once. OpenBLAS asks for ever where it does not get its own.
  real(wp) function blas_buffers(order, cases) result(bytes)
    integer, intent(in) :: order, cases

    bytes = (thread_count() - 1)*of_thread
    if (c_openblas_threads(0_c_int) == 0) return
    bytes = bytes + merge(max(cases, thread_count()), cases, order >= worthwhile)*of_buffer
  end function blas_buffers

  !> Threads that the program may use.
  integer function thread_count()
    thread_count = 1
    !$ thread_count = omp_get_max_threads()
  end function thread_count

end module blas_threads
