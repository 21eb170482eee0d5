!> Derivatives of all reported numbers by the parameters of &sensitivity, as finite differences
!> between whole runs with other values of a parameter.
module number_rates
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use scene_problem, only: problem_of
  use variation, only: find_rule
  use experiment, only: run_experiment
  use experiment_result, only: experiment_result_t
  use reported_numbers, only: run_numbers_t, differentiate
  use records, only: observer_t
  use progress_observer, only: progress_observer_t
  implicit none
  private
  public :: rate_numbers

  !> Positions of the runs relative to the parameter, in units of their distance: on both sides or,
  !> at the end of the parameter's range, on one side. The difference formula is of fourth order,
  !> and of second order without the outermost runs.
  real(wp), parameter :: places(5, 3) = reshape([-2, -1, 1, 2, 0,  0, 1, 2, 3, 4,  &
    0, -1, -2, -3, -4]*1.0_wp, [5, 3])
  integer, parameter :: runs(3) = [4, 5, 5]
  !> Distance of the runs of a drive in time, relative to the parameter. It is large because the
  !> time steps follow the motion, so that the errors of two similar runs differ.
  real(wp), parameter :: of_drive = 0.05_wp

contains

  !> Sets the derivatives of the numbers of an outcome, and adds the cost of the runs.
  subroutine rate_numbers(scene, observer, outcome)
    type(scene_t), intent(in) :: scene
    class(progress_observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(scene_t), allocatable :: variant(:)
    type(experiment_result_t) :: other
    type(problem_t) :: problem
    type(run_numbers_t), allocatable :: numbers(:)
    real(wp), allocatable, dimension(:) :: offset, weight, coarser
    type(observer_t) :: silent
    logical :: found
    integer :: j, k

    if (.not. allocated(outcome%places%number)) return
    do j = 1, size(scene%varied)
      call observer%hear('differentiating by ' // scene%varied(j)%parameter%name)
      call pose_variants(scene, j, offset, variant)
      outcome%differentiated = outcome%differentiated .and. allocated(variant)
      if (.not. allocated(variant)) cycle
      if (allocated(numbers)) deallocate (numbers)
      allocate (numbers(size(variant)))
      do k = 1, size(variant)
        problem = problem_of(variant(k))
        call run_experiment(variant(k), problem, silent, other, like=outcome)
        other%cost%states = outcome%cost%states
        outcome%cost = other%cost
        numbers(k)%number = other%places%numbers(problem)
      end do
      call find_rule(offset, weight, coarser)
      call differentiate(outcome%places%number, numbers, weight, coarser, j, &
        size(scene%varied), found)
      outcome%differentiated = outcome%differentiated .and. found
    end do
  end subroutine rate_numbers

  !> Makes the scenes with other values of parameter j. They are not allocated if the deck allows
  !> such values on no side. offset: the differences of the values.
  subroutine pose_variants(scene, j, offset, variant)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: j
    real(wp), allocatable, intent(out) :: offset(:)
    type(scene_t), allocatable, intent(out) :: variant(:)
    type(failure_t), allocatable :: error
    real(wp) :: apart
    integer :: side, k

    associate (varied => scene%varied(j))
      apart = of_drive*abs(varied%parameter%value)
      ! The problem varies smoothly over the range of the varied problems.
      if (allocated(varied%offset)) apart = (maxval(varied%offset) - minval(varied%offset))/4
      do side = 1, size(runs)
        offset = apart*places(:runs(side), side)
        allocate (variant(size(offset)))
        do k = 1, size(offset)
          call swept_scene(scene, varied%parameter%name, [varied%parameter%value + offset(k)], &
            variant(k), error)
          if (allocated(error)) exit
          ! Allocated, so that everything that only &sensitivity needs is also read for this scene.
          allocate (variant(k)%varied(0))
        end do
        if (.not. allocated(error)) return
        deallocate (variant)
      end do
    end associate
  end subroutine pose_variants

end module number_rates
