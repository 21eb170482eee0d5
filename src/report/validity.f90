!> Whether a scene is on the ground of its model, and how far inside: shapes that are shallow where
!> forces act and bodies touch, strains that are small, and what a force law says of itself.
module validity
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, largest_tension
  use experiment_result, only: experiment_result_t
  use records, only: extent_t
  use summary, only: summary_t
  use quality_warnings, only: short_number
  implicit none
  private
  public :: judge_law, judge_extent, extent_of, strained

  !> Part of the radius that is worth a note, and a warning: a parabola is off from a circle by a
  !> quarter of its square. Pressure over stiffness, about the strain, that is worth a warning.
  real(wp), parameter :: noted = 0.1_wp, warned = 1.0_wp/3, strained = 0.1_wp

contains

  !> What follows from law and shape alone.
  subroutine judge_law(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%caveat /= '') call summary%warn(trim(problem%law%caveat))
    ! Other shapes than parabolas, circles and ellipses have no radius on the axis.
    if (abs(problem%shape%exponent - 2) > 0) return
    call judge(summary, 'range_over_radius', range_of(problem)/problem%radius, &
      'the range of the force', &
      'Derjaguin''s approximation needs forces of short range')
  end subroutine judge_law

  !> What follows from the states of the experiments.
  subroutine judge_extent(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    type(extent_t) :: extent
    real(wp) :: strain

    extent = extent_of(outcome)
    if (extent%contact_radius > 0) call judge(summary, 'contact_over_radius', &
      problem%shape%slope(extent%contact_radius/problem%lateral)*problem%length/problem%lateral, &
      'the contact radius', 'half-spaces with small slopes stand for the bodies')
    if (problem%rigid .or. .not. extent%pressure > 0) return
    strain = extent%pressure*problem%pressure/problem%stiffness
    call summary%set('pressure_over_stiffness', strain)
    if (strain > strained) call summary%warn('beyond the model: the largest pressure is ' // &
      short_number(strain) // ' of the stiffness; strains are no longer small')
  end subroutine judge_extent

  !> Enters a length as a part of the radius, or a slope, and says so where that is not small.
  subroutine judge(summary, key, part, what, why)
    type(summary_t), intent(inout) :: summary
    character(len=*), intent(in) :: key, what, why
    real(wp), intent(in) :: part

    call summary%set(key, part)
    if (part > warned) then
      call summary%warn('beyond the model: ' // what // ' is ' // short_number(part) // &
        ' of the radius of the bodies; ' // why)
    else if (part > noted) then
      call summary%note(what // ' is ' // short_number(part) // &
        ' of the radius of the bodies, which is not small; ' // why)
    end if
  end subroutine judge

  !> Range of the force [m]: the depth of its well over its largest tension or, of a law that does
  !> not attract, its length.
  pure real(wp) function range_of(problem)
    type(problem_t), intent(in) :: problem

    range_of = problem%length
    if (problem%law%edge_gap > 0 .and. problem%law%adhesion > 0) range_of = &
      problem%law%adhesion*problem%pressure*problem%length/largest_tension(problem)
  end function range_of

  !> The extent of all rows.
  type(extent_t) function extent_of(outcome) result(extent)
    type(experiment_result_t), intent(in) :: outcome
    integer :: k

    if (allocated(outcome%path)) call join(outcome%path%extent)
    if (allocated(outcome%stepped_path)) call join(outcome%stepped_path%extent)
    if (allocated(outcome%loading)) call join(outcome%loading%extent)
    if (allocated(outcome%timed)) call join(outcome%timed%extent)
    if (.not. allocated(outcome%unloading)) return
    do k = 1, size(outcome%unloading)
      call join(outcome%unloading(k)%extent)
    end do

  contains

    subroutine join(other)
      type(extent_t), intent(in) :: other

      extent%contact_radius = max(extent%contact_radius, other%contact_radius)
      extent%pressure = max(extent%pressure, other%pressure)
    end subroutine join

  end function extent_of

end module validity
