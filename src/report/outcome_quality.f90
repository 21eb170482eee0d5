!> The quality of all experiments of an outcome together: residuals, spacing of nodes, extent, and
!> whether one of them ended early.
module outcome_quality
  use kinds, only: wp
  use ending, only: ending_t
  use records, only: extent_t
  use experiment_result, only: experiment_result_t
  implicit none
  private
  public :: quality_t, quality_of

  !> The largest residual, the widest spacing of nodes over the neck width, the extent of the
  !> states, and whether an experiment ended early.
  type :: quality_t
    real(wp) :: residual = 0, spacing = 0
    type(extent_t) :: extent
    logical :: early = .false.
  end type quality_t

contains

  type(quality_t) function quality_of(outcome) result(all)
    type(experiment_result_t), intent(in) :: outcome
    type(ending_t) :: planned
    integer :: k

    if (allocated(outcome%path)) call join(outcome%path%worst_residual, &
      outcome%path%worst_spacing, outcome%path%extent, outcome%path%ending)
    if (allocated(outcome%stepped_path)) call join(outcome%stepped_path%worst_residual, &
      outcome%stepped_path%worst_spacing, outcome%stepped_path%extent, outcome%stepped_path%ending)
    if (allocated(outcome%loading)) call join(outcome%loading%worst_residual, &
      outcome%loading%worst_spacing, outcome%loading%extent, outcome%loading%ending)
    if (allocated(outcome%timed)) call join(outcome%timed%worst_residual, &
      outcome%timed%worst_spacing, outcome%timed%extent, planned)
    if (.not. allocated(outcome%unloading)) return
    do k = 1, size(outcome%unloading)
      associate (branch => outcome%unloading(k))
        call join(branch%worst_residual, branch%worst_spacing, branch%extent, branch%ending)
      end associate
    end do

  contains

    subroutine join(residual, spacing, extent, ending)
      real(wp), intent(in) :: residual, spacing
      type(extent_t), intent(in) :: extent
      type(ending_t), intent(in) :: ending

      all%residual = max(all%residual, residual)
      all%spacing = max(all%spacing, spacing)
      all%extent%contact_radius = max(all%extent%contact_radius, extent%contact_radius)
      all%extent%pressure = max(all%extent%pressure, extent%pressure)
      all%early = all%early .or. ending%early()
    end subroutine join

  end function quality_of

end module outcome_quality
