!> Properties of the machine: the available memory, if the system reports it, and the number of
!> threads for the linear algebra. For small matrices, and on a busy machine, several threads are
!> slower than one. With one thread, results do not depend on the number of available threads.
module machine
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp
  use c_library, only: c_open, c_read, c_close, as_input, nul, c_openblas_threads, &
    c_openblas_end_threads
  !$ use omp_lib, only: omp_get_max_threads, omp_in_parallel
  implicit none
  private
  public :: available_memory, begin_with_one_thread, use_threads_for, thread_count, blas_buffers

  !> Numbers of bytes from this one on mean that there is no limit.
  real(wp), parameter :: no_limit = 1.0e18_wp

  !> Order of a matrix above which several threads are faster even on a busy machine.
  integer, parameter :: worthwhile = 2500
  !> Address space [bytes] that OpenBLAS 0.3 maps for each thread that calls it, for matrices of any
  !> size. Address space [bytes] that each further thread needs for its stack and `malloc`. Most of
  !> both is never used.
  real(wp), parameter :: of_buffer = 136.0e6_wp, of_thread = 76.0e6_wp

contains

  !> Number of bytes that may still be allocated. It is the smallest of three: the machine's free
  !> memory; the limit of the process's control group; the process's limit of address space (`ulimit
  !> -v`) minus `mapped` bytes, which will be mapped and never used. It is huge if no limit is
  !> known.
  real(wp) function available_memory(mapped) result(bytes)
    real(wp), intent(in) :: mapped
    real(wp), parameter :: kilo = 1024
    real(wp) :: limit

    bytes = kilo*number_after('/proc/meminfo', 'MemAvailable:', huge(1.0_wp)/kilo)
    limit = number_after('/proc/self/limits', 'Max address space', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - kilo*number_after('/proc/self/status', 'VmSize:', 0.0_wp) - mapped)
    ! Control groups of version 2 and of version 1.
    limit = number_after('/sys/fs/cgroup/memory.max', '', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - number_after('/sys/fs/cgroup/memory.current', '', 0.0_wp))
    limit = number_after('/sys/fs/cgroup/memory/memory.limit_in_bytes', '', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - number_after('/sys/fs/cgroup/memory/memory.usage_in_bytes', '', 0.0_wp))
    bytes = max(bytes, 0.0_wp)
  end function available_memory

  !> The number after `name` at the beginning of a line in a small file. It is `otherwise` if there
  !> is no number ("max", "unlimited", no such line or file). The file is read without Fortran's
  !> `open`, which would load the system's messages for each missing file.
  real(wp) function number_after(file, name, otherwise) result(number)
    character(len=*), intent(in) :: file, name
    real(wp), intent(in) :: otherwise
    character(len=1), parameter :: nl = new_line('a')
    character(len=8192) :: text
    integer(c_int) :: descriptor, closed
    integer :: length, first, last, status

    number = otherwise
    descriptor = c_open(file // nul, as_input)
    if (descriptor < 0) return
    length = int(max(c_read(descriptor, text, len(text, kind=c_long)), 0_c_long))
    closed = c_close(descriptor)
    first = index(nl // text(:length), nl // name)
    if (first == 0) return
    first = first + len(name)
    last = first + index(text(first:length) // nl, nl) - 2
    read (text(first:last), *, iostat=status) number
    if (status /= 0) number = otherwise
  end function number_after

  !> Ends the threads that OpenBLAS starts when it is loaded, one for each further core. Each of
  !> them keeps a core busy for some 25 ms, as long as a short run takes. This procedure must be
  !> called once when a program starts; `use_threads_for` starts the threads again for large
  !> matrices.
  subroutine begin_with_one_thread()
    integer(c_int) :: known

    known = c_openblas_threads(1_c_int)
    call c_openblas_end_threads()
  end subroutine begin_with_one_thread

  !> Sets the number of threads for matrices of the given order, if the library is OpenBLAS. In a
  !> parallel region, where several cases are computed at once, each case has one thread.
  subroutine use_threads_for(order)
    integer, intent(in) :: order
    integer(c_int) :: count, known

    count = 1
    if (order >= worthwhile) then
      !$ if (.not. omp_in_parallel()) count = int(omp_get_max_threads(), c_int)
    end if
    known = c_openblas_threads(count)
  end subroutine use_threads_for

  !> Address space [bytes] that threads and linear algebra map for matrices of the given order if
  !> `cases` cases are computed at once. If OpenBLAS cannot map its part, it never stops trying.
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

end module machine
