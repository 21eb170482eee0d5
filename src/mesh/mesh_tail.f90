!> The outer end of a mesh: the tail of the pressure, and whether the force at the end of the bodies
!> matters.
module mesh_tail
  use kinds, only: wp
  use root_finding, only: bracket_t
  use dimensionless_problem, only: problem_t
  use mapped_shape, only: mapped_shape_t
  implicit none
  private
  public :: give_tail, end_matters, beyond_poles

  !> Beginning of the tail, as a multiple of the radius at which the height of the bodies is H0. For
  !> a parabola the poles of the pressure, at rho**2 = -2 H0, are as far from the axis as this
  !> radius.
  real(wp), parameter :: beyond_poles = 1.3_wp
  !> Number of nodes of the tail: a constant, and the number to be added for each digit.
  real(wp), parameter :: tail_nodes = 1.5_wp, tail_nodes_of_digit = 0.6_wp
  !> The tail begins beyond the end of a body if the end is nearer than this multiple of the usual
  !> beginning of the tail.
  real(wp), parameter :: near_end = 100
  !> A pressure that decreases faster than any power ends where it is this fraction of the accuracy;
  !> the number of nodes up to this end is multiplied by `crowding`.
  real(wp), parameter :: negligible = 1.0e-2_wp, crowding = 1.7_wp
  !> Such a pressure ends at the law's range or at this many of its lengths.
  real(wp), parameter :: farthest = 60
  !> The pressure of a fluid between parabolas decreases as this power of the position.
  real(wp), parameter :: film_decay = 4

contains

  !> The tail of the pressure: an algebraic panel if the pressure decreases as a power. Otherwise
  !> the mesh ends where the pressure is negligible; this sets `reach` (lateral units) and increases
  !> the density of nodes. from: a gap with a pressure of typical magnitude. widest: radius of a
  !> contact, outside which gaps open at least as they do from the axis; 0 on a mesh that is locked
  !> to the edge.
  pure subroutine give_tail(problem, from, widest, digits, reach, density, shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: from, widest, digits
    real(wp), intent(inout) :: reach, density
    type(mapped_shape_t), intent(inout) :: shape
    integer :: nodes

    nodes = ceiling(tail_nodes + tail_nodes_of_digit*digits)
    if (problem%law%tail_power < huge(1.0_wp)) then
      shape%tail_order = nodes
      shape%decay = problem%shape%growth*problem%law%tail_power
      ! For some shapes the pressure over its power is not a polynomial in the inverse position.
      if (abs(problem%shape%growth - nint(problem%shape%growth)) > 0 .or. &
        problem%shape%ends < huge(1.0_wp)) shape%tail_order = 2*shape%tail_order
      reach = max(reach, problem%shape%position_of(problem%law%power_from), &
        beyond_poles*problem%shape%smooth_from())
      if (problem%shape%ends < near_end*reach) reach = max(reach, beyond_poles*problem%shape%ends)
    else
      reach = widest + problem%shape%position_of( &
        max(fading_gap(problem, from, negligible*10.0_wp**(-digits)), 1.0_wp))
      density = crowding*density
    end if
    if (.not. problem%film_gap > 0) return
    shape%tail_order = max(shape%tail_order, nodes)
    shape%decay = min(merge(shape%decay, huge(1.0_wp), shape%decay > 0), film_decay)
    reach = max(reach, beyond_poles*problem%shape%position_of(problem%film_gap))
  end subroutine give_tail

  !> The gap beyond `from` at which the pressure is the fraction `part` of its value at `from`.
  pure real(wp) function fading_gap(problem, from, part) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: from, part
    type(bracket_t) :: bracket
    real(wp) :: most, pressure(1)

    pressure = problem%law%pressure([from])
    most = abs(pressure(1))
    bracket = bracket_t(from, max(problem%law%range, from + farthest))
    do while (bracket%is_open())
      pressure = problem%law%pressure([bracket%middle()])
      call bracket%narrow(abs(pressure(1)) > part*most)
    end do
    gap = bracket%middle()
  end function fading_gap

  !> Whether a mesh up to a radius contains the end of the bodies and the force there matters.
  !> contact: the radius of a contact, 0 before contact; without adhesion the gap around the contact
  !> is the smallest.
  pure logical function end_matters(problem, digits, radius, contact) result(matters)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: digits, radius, contact
    real(wp) :: gap(1), pressure(2)

    associate (shape => problem%shape, law => problem%law)
      matters = radius > shape%ends
      if (.not. (matters .and. law%edge_gap > 0 .and. contact < shape%ends)) return
      gap = shape%height(shape%ends)
      if (contact > 0) gap = shape%hertz_gap(contact, [max(shape%ends/contact - 1, 0.0_wp)])
      pressure = abs(law%pressure([law%edge_gap, law%edge_gap + gap]))
      matters = pressure(2)*shape%ends**2 > negligible*10.0_wp**(-digits)*pressure(1)
    end associate
  end function end_matters

end module mesh_tail
