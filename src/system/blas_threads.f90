!> The number of threads of the linear algebra. For small matrices, and on a busy machine, more
!> threads are slower than one; and with one, results do not depend on the number of threads.
module blas_threads
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use c_library, only: c_openblas_threads, c_openblas_end_threads
  !$ use omp_lib, only: omp_get_max_threads, omp_in_parallel
  implicit none
  private
  public :: begin_with_one_thread, use_threads_for, thread_count, blas_buffers

  !> Order of the matrix above which threads are faster even on a busy machine.
  integer, parameter :: worthwhile = 2500
  !> Address space [bytes] that OpenBLAS 0.3 maps for each thread that calls it, for matrices of any
  !> size; address space of each further thread for its stack and `malloc`. Most of it is never
  !> used.
  real(wp), parameter :: of_buffer = 136.0e6_wp, of_thread = 76.0e6_wp

contains

  !> Called once at the start of a program. OpenBLAS starts one thread for each further core when it
  !> is loaded, and each of them spins for some 25 ms, as long as a short run takes. This procedure
  !> ends them; `use_threads_for` starts them for large matrices.
  subroutine begin_with_one_thread()
    integer(c_int) :: known

    known = c_openblas_threads(1_c_int)
    call c_openblas_end_threads()
  end subroutine begin_with_one_thread

  !> Sets the number of threads for matrices of the given order, if the library is OpenBLAS. In a
  !> parallel region, where several cases run at once, each case has one thread.
  subroutine use_threads_for(order)
    integer, intent(in) :: order
    integer(c_int) :: count, known

    count = 1
    if (order >= worthwhile) then
      !$ if (.not. omp_in_parallel()) count = int(omp_get_max_threads(), c_int)
    end if
    known = c_openblas_threads(count)
  end subroutine use_threads_for

  !> Address space [bytes] that threads and linear algebra map for matrices of the given order in
  !> `cases` cases at once. OpenBLAS tries for ever if it does not get its share.
  real(wp) function blas_buffers(order, cases) result(bytes)
    integer, intent(in) :: order, cases

    bytes = (thread_count() - 1)*of_thread
    if (c_openblas_threads(0_c_int) == 0) return
    bytes = bytes + merge(max(cases, thread_count()), cases, order >= worthwhile)*of_buffer
  end function blas_buffers

  !> Number of threads that the program may use.
  integer function thread_count()
    thread_count = 1
    !$ thread_count = omp_get_max_threads()
  end function thread_count

end module blas_threads
