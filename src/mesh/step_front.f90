!> The front of a step of the pressure. If an attraction ends suddenly (`step_attraction`), the
!> first attraction between approaching bodies acts where their gap has just passed the step: on a
!> disk about the axis with nearly uniform tension and no tension outside. The rim of this disk is
!> the front. The front is sharp before there is a contact edge, and meshes are locked to it until
!> there is one.
module step_front
  use kinds, only: wp, pi
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t
  implicit none
  private
  public :: front_leads, step_height, first_front, last_front, front_width

  !> Distance from the middle of the step, in its widths, at which the tension inside the step is
  !> complete. Least ratio of this tension to the largest tension at which the step, and not the
  !> attraction at smaller gaps, pulls the bodies together. With less tension the radius of the
  !> front decreases while the axis is drawn into contact.
  real(wp), parameter :: complete = 2, leading = 0.5_wp

contains

  !> Whether a step of a law pulls the bodies together.
  pure logical function front_leads(law)
    class(force_law_t), intent(in) :: law

    front_leads = tension_inside(law) > leading
  end function front_leads

  !> The tension inside a step over the largest tension; 0 without a step outside the contact edge.
  pure real(wp) function tension_inside(law)
    class(force_law_t), intent(in) :: law
    real(wp) :: pressure(2)

    tension_inside = 0
    if (.not. (law%step_width > 0 .and. law%edge_gap > 0 .and. law%step_at > law%edge_gap)) return
    pressure = law%pressure([law%edge_gap, law%step_at - complete*law%step_width])
    tension_inside = pressure(2)/pressure(1)
  end function tension_inside

  !> The change of the pressure over the step of a law.
  pure real(wp) function step_height(law)
    class(force_law_t), intent(in) :: law
    real(wp) :: pressure(2)

    pressure = law%pressure(law%step_at + complete*law%step_width*[-1, 1])
    step_height = abs(pressure(2) - pressure(1))
  end function step_height

  !> Coupling times the tension inside the step: a disk of radius c under this tension is deformed
  !> by 4 c times this product on the axis and by 8/pi c times it at the rim.
  pure real(wp) function pull(problem)
    type(problem_t), intent(in) :: problem
    real(wp) :: pressure(1)

    pressure = problem%law%pressure([problem%law%step_at - complete*problem%law%step_width])
    pull = -problem%coupling*pressure(1)
  end function pull

  !> The smallest radius of a front, in lateral units: that of a disk over which the gap changes by
  !> the width of the step.
  pure real(wp) function first_front(problem)
    type(problem_t), intent(in) :: problem

    first_front = radius_spanning(problem, problem%law%step_width)
  end function first_front

  !> The radius of the front at which the axis comes to rest.
  pure real(wp) function last_front(problem)
    type(problem_t), intent(in) :: problem

    last_front = radius_spanning(problem, problem%law%step_at - problem%law%rest_gap)
  end function last_front

  !> Radius of the disk over which the gap changes by `height`, to a factor of two.
  pure real(wp) function radius_spanning(problem, height) result(c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: height

    c = min(problem%shape%position_of(height), height/((4 - 8/pi)*pull(problem)))
  end function radius_spanning

  !> Width of the front of radius c, in units of c: the width of the step over the slope of the gap,
  !> which depends logarithmically on the width.
  pure real(wp) function front_width(problem, c) result(width)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: c
    real(wp), parameter :: logarithm = 5

    width = min(1.0_wp, problem%law%step_width/ &
      (c*(problem%shape%slope(c) + 4/pi*logarithm*pull(problem))))
  end function front_width

end module step_front
