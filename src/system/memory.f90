!> The available memory, if the system reports it.
module memory
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp
  use c_library, only: c_open, c_read, c_close, as_input, nul
  implicit none
  private
  public :: available_memory

  !> Smallest number that means no limit [bytes].
  real(wp), parameter :: no_limit = 1.0e18_wp

contains

  !> Number of bytes that may still be allocated: the smallest of the machine's free memory, the
  !> process's limit of address space (`ulimit -v`) less `mapped` bytes that will be mapped and
  !> never used, and the limit of its control group. Huge if none is known.
  real(wp) function available_memory(mapped) result(bytes)
    real(wp), intent(in) :: mapped
    real(wp), parameter :: kilo = 1024
    real(wp) :: limit

    bytes = kilo*number_after('/proc/meminfo', 'MemAvailable:', huge(1.0_wp)/kilo)
    limit = number_after('/proc/self/limits', 'Max address space', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - kilo*number_after('/proc/self/status', 'VmSize:', 0.0_wp) - mapped)
    ! Control groups, version 2 and version 1.
    limit = number_after('/sys/fs/cgroup/memory.max', '', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - number_after('/sys/fs/cgroup/memory.current', '', 0.0_wp))
    limit = number_after('/sys/fs/cgroup/memory/memory.limit_in_bytes', '', huge(1.0_wp))
    if (limit < no_limit) bytes = min(bytes, &
      limit - number_after('/sys/fs/cgroup/memory/memory.usage_in_bytes', '', 0.0_wp))
    bytes = max(bytes, 0.0_wp)
  end function available_memory

  !> The number behind `name` at the beginning of a line of a small file; `otherwise` if there is
  !> none ("max", "unlimited", no such line or file). Fortran's `open` would load the system's
  !> messages for each missing file.
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

end module memory
