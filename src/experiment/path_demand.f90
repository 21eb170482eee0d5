!> How far the path must be known for what is read from it: a soft spring lets bodies land far
!> apart, and pulls them far into contact.
module path_demand
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, coupling_over, yielding_gap
  use contact_scales, only: beyond_contact
  use convex_contact, only: jkr_like_pull_off
  use undeformed, only: load_undeformed
  use experiment_request, only: request_t
  implicit none
  private
  public :: widen_path, farthest_wanted, h0_in_contact

  !> What is left of the bodies' yielding, over what makes them jump, where their deformation no
  !> longer shows in the load: beyond, closed forms take the place of the path.
  real(wp), parameter :: no_yielding = 1.0e-9_wp
  !> A contact radius is tried in steps of this ratio; and what JKR theory may miss of an h0.
  real(wp), parameter :: ratio = 1.1_wp, margin = 0.1_wp
  !> h0 that are tried for the tension of rigid bodies.
  integer, parameter :: tried = 100

contains

  !> Widens a range of h0 (law's lengths) to what has to be traced.
  pure subroutine widen_path(request, problem, low, high)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp), intent(inout) :: low, high
    real(wp) :: b, wanted
    integer :: i

    if (.not. problem%law%adhesion > 0) return
    high = max(high, min(farthest_wanted(request, problem), yielding_gap(problem, no_yielding)))
    if (allocated(request%fixed_load)) then
      do i = 1, size(request%fixed_load%load)
        low = min(low, h0_in_contact(problem, 0.0_wp, 1.0_wp, &
          -max(request%fixed_load%load(i)/problem%load, 0.0_wp)))
      end do
    end if
    if (.not. allocated(request%device)) return
    associate (device => request%device)
      if (allocated(device%z_end) .and. size(device%stiffness) == 0) &
        low = min(low, problem%law%gap_of(device%z_end))
      do i = 1, size(device%stiffness)
        if (device%stiffness(i) > 0) then
          ! The drive comes this close, at least behind the highest barrier.
          b = problem%load/(device%stiffness(i)*problem%length)
          wanted = 1 - b*barrier_load(problem)
          if (allocated(device%z_end)) wanted = min(wanted, problem%law%gap_of(device%z_end))
          low = min(low, h0_in_contact(problem, 1.0_wp, b, wanted))
        else
          low = min(low, h0_in_contact(problem, 0.0_wp, 1.0_wp, -barrier_load(problem)))
        end if
      end do
    end associate
  end subroutine widen_path

  !> The largest h0 at which a state is wanted (law's lengths); 0: nothing asks for any.
  pure real(wp) function farthest_wanted(request, problem) result(farthest)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp) :: load
    integer :: i

    farthest = 0
    if (allocated(request%device)) then
      if (allocated(request%device%z_start)) farthest = problem%law%gap_of(request%device%z_start)
      do i = 1, size(request%device%stiffness)
        associate (k => request%device%stiffness(i))
          if (k > 0) farthest = max(farthest, beyond_contact(problem) + &
            ratio*largest_pull(problem)*problem%load/(k*problem%length))
        end associate
      end do
    end if
    if (.not. allocated(request%fixed_load)) return
    do i = 1, size(request%fixed_load%load)
      load = request%fixed_load%load(i)/problem%load
      if (abs(load) > 0) farthest = max(farthest, gap_of_load(problem, load))
    end do
  end function farthest_wanted

  !> A gap beyond which the load between undeformed bodies is smaller than `load`.
  pure real(wp) function gap_of_load(problem, load) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: load
    integer :: step

    gap = 1
    do step = 1, 400
      if (max(abs(load_undeformed(problem, gap)), abs(load_undeformed(problem, ratio*gap)), &
        abs(load_undeformed(problem, ratio**2*gap))) < abs(load)) exit
      gap = ratio*gap
    end do
  end function gap_of_load

  !> The largest repulsion between undeformed bodies outside the well of contact; 0 without one.
  pure real(wp) function barrier_load(problem) result(load)
    type(problem_t), intent(in) :: problem
    integer :: step
    real(wp) :: gap

    load = 0
    gap = max(problem%law%edge_gap, problem%law%rest_gap)
    do step = 1, 200
      load = max(load, load_undeformed(problem, gap))
      gap = ratio*gap
    end do
  end function barrier_load

  !> A tension that no pull-off exceeds: of parabolas that of rigid bodies; of others the larger one
  !> of rigid bodies and of JKR theory. Thin films hold on for up to
  !> twice that.
  pure real(wp) function largest_pull(problem) result(tension)
    type(problem_t), intent(in) :: problem
    integer :: step

    if (problem%shape%parabolic) then
      tension = merge(2, 4, problem%body%is_homogeneous())*pi*problem%law%adhesion
      return
    end if
    tension = 0
    if (problem%law%work > 0) tension = -jkr_like_pull_off(problem)
    do step = -tried/2, tried/2
      tension = max(tension, -load_undeformed(problem, &
        max(problem%law%edge_gap, problem%law%rest_gap)*ratio**step))
    end do
  end function largest_pull

  !> An h0 below that at which a h0 - b load in contact is `wanted`, by JKR theory (10), (11).
  pure real(wp) function h0_in_contact(problem, a, b, wanted) result(h0)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: a, b, wanted
    real(wp) :: c

    c = 1
    do while (position(c) > wanted)
      c = 2*c
    end do
    do while (c > 0.1_wp .and. position(c/ratio) < wanted)
      c = c/ratio
    end do
    h0 = h0_at(c)
    h0 = h0 - margin*(1 + abs(h0))

  contains

    pure real(wp) function h0_at(radius)
      real(wp), intent(in) :: radius

      h0_at = 1 - problem%shape%indentation(radius) + &
        sqrt(4*pi*coupling_over(problem, radius)*problem%law%adhesion*radius)
    end function h0_at

    pure real(wp) function position(radius)
      real(wp), intent(in) :: radius

      associate (coupling => coupling_over(problem, radius))
        position = a*h0_at(radius) - b*(problem%shape%indentation_load(radius)/coupling - &
          sqrt(4*pi*problem%law%adhesion*radius**3/coupling))
      end associate
    end function position

  end function h0_in_contact

end module path_demand
