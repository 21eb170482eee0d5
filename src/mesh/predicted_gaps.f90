!> Gaps that bodies are expected to have, for the layout of meshes before there is a path: those of
!> undeformed bodies before contact; in contact the gap outside a JKR contact.
module predicted_gaps
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, calm_gap, adhesion_strength
  use force_law, only: force_law_t
  use step_front, only: front_leads
  implicit none
  private
  public :: axis_gaps, between, predicted_gap

  !> Number of gaps on the axis, or of radii, for which the pressure is evaluated: `tried`, or
  !> `often` under oscillating laws, whose waves of pressure move with the gaps.
  integer, parameter :: tried = 9, often = 33

contains

  !> Gaps on the axis before contact: from large gaps down to that of largest tension or, if a step
  !> has a front before that, through the step.
  pure function axis_gaps(problem) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), allocatable :: gap(:)
    real(wp) :: from
    integer :: k

    associate (law => problem%law)
      from = law%edge_gap
      if (front_leads(law)) from = law%step_at
      gap = between(from, max(calm_gap(problem), 2*from, merge(law%power_from, from, &
        law%period > 0)), law)
      if (front_leads(law)) gap = [gap, law%step_at + law%step_width*[(0.5_wp*k, k=-4, 6)]]
    end associate
  end function axis_gaps

  !> Values from one to another in equal ratios; more under oscillating laws.
  pure function between(from, to, law) result(values)
    real(wp), intent(in) :: from, to
    class(force_law_t), intent(in) :: law
    real(wp), allocatable :: values(:)
    integer :: last, k

    last = merge(often, tried, law%period > 0) - 1
    values = from*(to/from)**[(real(k, wp)/last, k=0, last)]
  end function between

  !> The gap at an offset from the centre. Before contact h is the gap on the axis. Otherwise the
  !> gap is that outside a JKR contact of radius h, with the gap of largest tension at its edge.
  !>
  !> The JKR gap increases as the square root of the distance from the edge; cohesion rounds the
  !> square root over the distance d.
  pure function predicted_gap(problem, before_contact, h, offset, d) result(gap)
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: before_contact
    real(wp), intent(in) :: h, offset(:), d
    real(wp), dimension(size(offset)) :: gap, beyond

    if (before_contact) then
      gap = h + problem%shape%height(offset)
    else
      beyond = offset**2/(d + sqrt(d**2 + offset**2))
      gap = problem%law%edge_gap + problem%shape%hertz_gap(h, beyond) + &
        2/pi*sqrt(4*pi*adhesion_strength(problem)*h)*atan(sqrt(beyond*(2 + beyond)))
    end if
  end function predicted_gap

end module predicted_gaps
