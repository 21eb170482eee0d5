!> How much memory there is to be had, as far as the system says.
module memory
  use kinds, only: wp
  implicit none
  private
  public :: available_memory

contains

  !> Bytes that may still be taken: the least of what the machine has to spare, the process's limit
  !> of addresses (`ulimit -v`) less what will be mapped and never touched, and the limit of its
  !> control group. Huge where nobody says.
  real(wp) function available_memory(mapped) result(bytes)
    real(wp), intent(in) :: mapped
    real(wp), parameter :: kilo = 1024
    real(wp) :: limit, used

    bytes = kilo*number_after('/proc/meminfo', 'MemAvailable:', huge(1.0_wp)/kilo)
    limit = number_after('/proc/self/limits', 'Max address space', huge(1.0_wp))
    used = kilo*number_after('/proc/self/status', 'VmSize:', 0.0_wp)
    if (limit < huge(1.0_wp)) bytes = min(bytes, limit - used - mapped)
    ! Version 2, and version 1 where a huge number stands for none.
    limit = number_after('/sys/fs/cgroup/memory.max', '', huge(1.0_wp))
    used = number_after('/sys/fs/cgroup/memory.current', '', 0.0_wp)
    if (limit < huge(1.0_wp)) bytes = min(bytes, limit - used)
    limit = number_after('/sys/fs/cgroup/memory/memory.limit_in_bytes', '', huge(1.0_wp))
    used = number_after('/sys/fs/cgroup/memory/memory.usage_in_bytes', '', 0.0_wp)
    if (limit < huge(1.0_wp)) bytes = min(bytes, limit - used)
    bytes = max(bytes, 0.0_wp)
  end function available_memory

  !> The number that follows a name at the beginning of a line of a file; `otherwise` where there is
  !> none ("max", "unlimited", no such line or file).
  real(wp) function number_after(file, name, otherwise) result(number)
    character(len=*), intent(in) :: file, name
    real(wp), intent(in) :: otherwise
    character(len=256) :: line
    integer :: unit, status

    number = otherwise
    open (newunit=unit, file=file, action='read', status='old', iostat=status)
    if (status /= 0) return
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (index(line, name) /= 1) cycle
      read (line(len(name) + 1:), *, iostat=status) number
      if (status /= 0) number = otherwise
      exit
    end do
    close (unit, iostat=status)
  end function number_after

end module memory
