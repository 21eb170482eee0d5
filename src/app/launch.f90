!> How the program was started.
module launch
  implicit none
  private
  public :: started_together

  !> What holds the number of processes that were started together: by OpenMPI, by MPICH and its
  !> relatives, by Slurm's srun.
  character(len=*), parameter :: names(*) = [character(len=20) :: 'OMPI_COMM_WORLD_SIZE', &
    'PMI_SIZE', 'SLURM_STEP_NUM_TASKS']

contains

  !> How many processes mpirun or srun has started as one job; 1: this one alone.
  integer function started_together() result(processes)
    character(len=12) :: value
    integer :: i, failed

    do i = 1, size(names)
      call get_environment_variable(trim(names(i)), value)
      read (value, '(i12)', iostat=failed) processes
      if (failed == 0 .and. processes > 1) return
    end do
    processes = 1
  end function started_together

end module launch
