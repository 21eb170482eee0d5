!> Results of the experiments of a scene, in the units of `dimensionless_problem`.
module experiment_result
  use kinds, only: wp
  use numerics_choice, only: choice_t
  use equilibrium, only: cost_t
  use ending, only: ending_t
  use records, only: quality_t
  use stepped_branch, only: branch_t
  use path, only: path_t
  use places, only: places_t
  use path_readings, only: path_readings_t
  use timed_record, only: timed_result_t
  implicit none
  private
  public :: experiment_result_t

  type :: experiment_result_t
    type(choice_t) :: chosen
    type(path_t), allocatable :: path
    type(path_readings_t), allocatable :: readings
    type(timed_result_t), allocatable :: timed
    type(branch_t), allocatable :: stepped_path, loading, unloading(:)
    !> The places at which numbers are reported.
    type(places_t) :: places
    !> Whether all requested derivatives exist.
    logical :: differentiated = .true.
    !> Largest estimated relative error of the reported numbers.
    real(wp), allocatable :: error_estimate
    !> Largest part of the load that the nodes of the path's meshes miss (`mending`).
    real(wp) :: left_out = 0
    type(cost_t) :: cost
    integer :: nodes = 0
  contains
    procedure :: quality
  end type experiment_result_t

contains

  !> The quality of the rows of all experiments together.
  pure type(quality_t) function quality(self)
    class(experiment_result_t), intent(in) :: self
    type(ending_t) :: planned
    integer :: k

    if (allocated(self%path)) call quality%join(self%path%quality, self%path%ending)
    if (allocated(self%stepped_path)) &
      call quality%join(self%stepped_path%quality, self%stepped_path%ending)
    if (allocated(self%loading)) call quality%join(self%loading%quality, self%loading%ending)
    if (allocated(self%readings)) call quality%join(self%readings%quality, planned)
    if (allocated(self%timed)) call quality%join(self%timed%quality, planned)
    if (.not. allocated(self%unloading)) return
    do k = 1, size(self%unloading)
      call quality%join(self%unloading(k)%quality, self%unloading(k)%ending)
    end do
  end function quality

end module experiment_result
