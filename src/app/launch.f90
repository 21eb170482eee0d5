!> Whether this process was started together with others.
module launch
  implicit none
  private
  public :: started_together, own_rank

  !> Environment variables with the number of processes that were started together, and with the
  !> number of this process, as set by OpenMPI, by MPICH and its relatives, and by Slurm's srun.
  character(len=*), parameter :: sizes(*) = [character(len=20) :: 'OMPI_COMM_WORLD_SIZE', &
    'PMI_SIZE', 'SLURM_STEP_NUM_TASKS']
  character(len=*), parameter :: numbers(*) = [character(len=20) :: 'OMPI_COMM_WORLD_RANK', &
    'PMI_RANK', 'SLURM_PROCID']

contains

  !> Number of processes that mpirun or srun has started as one job; 1 for a single process.
  integer function started_together()
    started_together = first_set(sizes, 1)
  end function started_together

  !> Number of this process, counted from 0.
  integer function own_rank()
    own_rank = first_set(numbers, 0)
  end function own_rank

  !> The value of the first of these environment variables that is set; `otherwise` if none is.
  integer function first_set(names, otherwise) result(number)
    character(len=*), intent(in) :: names(:)
    integer, intent(in) :: otherwise
    character(len=12) :: value
    integer :: i, failed

    do i = 1, size(names)
      call get_environment_variable(trim(names(i)), value)
      read (value, '(i12)', iostat=failed) number
      if (failed == 0 .and. value /= '') return
    end do
    number = otherwise
  end function first_set

end module launch
