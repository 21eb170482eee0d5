!> Gaps on the axis in the approximation of slowly varying deformation: the gap at a given h0, and
!> the gaps at which approaching bodies jump.
!>
!> All quantities are in the units of `dimensionless_problem`.
module slow_jumps
  use kinds, only: wp, pi, nan
  use root_finding, only: bracket_t
  use dimensionless_problem, only: problem_t
  use slow_deformation, only: attraction_only, has_form, slow_displacement, slow_slope
  implicit none
  private
  public :: slow_gap, at_h0, at_criterion, at_fold

  !> Conditions on the gap. at_h0: h0 has a given value. at_criterion: the stability criterion (29),
  !> 2 p' u(0)/p = -1, which approaching bodies violate at smaller gaps. at_fold: the fold of h0 =
  !> gap - delta, at which the bodies lose their equilibrium within the approximation itself.
  integer, parameter :: at_h0 = 1, at_criterion = 2, at_fold = 3

  !> A search: the form of the approximation, the condition, and the given h0 for `at_h0`.
  type :: search_t
    integer :: form = 0, condition = at_h0
    real(wp) :: h0 = 0
  end type search_t

  !> Step of a search, as a fraction of the change of gap over which a law may be linearised.
  !> Largest number of steps, which suffices for a gap of the algebraic law to fall by 26 orders of
  !> magnitude.
  real(wp), parameter :: search_step = 0.1_wp
  integer, parameter :: most_steps = 2000
  !> Number of golden sections that determine half of the digits of a maximum's position, which
  !> suffices since the curve is flat there.
  integer, parameter :: most_sections = 40

contains

  !> The largest gap on the axis at which this form of the approximation meets the condition; NaN if
  !> there is none. The search for an h0 ends at the gap `nearest`, and the search for a jump ends
  !> where the attraction ends. With the attraction of Lennard-Jones alone p'/p = -3/h, and -delta =
  !> C h^(-5/2) by (35b), so that (29) has the closed form (37), 3 C h^(-7/2) = 1. For the fold 5/2
  !> replaces the 3. These closed forms do not show whether the full law has a jump.
  pure real(wp) function slow_gap(problem, form, condition, h0, nearest) result(gap)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: form, condition
    real(wp), intent(in), optional :: h0, nearest

    gap = nan
    if (condition == at_h0) then
      gap = largest_gap(problem, search_t(form, at_h0, h0), nearest)
    else if (form == attraction_only) then
      if (.not. (problem%coupling > 0 .and. has_form(problem, form))) return
      gap = (6*sqrt(2.0_wp)*pi*problem%coupling)**(2.0_wp/7)
      if (condition == at_fold) gap = gap*(5.0_wp/6)**(2.0_wp/7)
    else if (problem%law%adhesion > 0) then
      gap = largest_gap(problem, search_t(form, condition), &
        merge(problem%law%rest_gap, -huge(gap), problem%law%rest_gap > 0))
    end if
  end function slow_gap

  !> The largest gap, not smaller than `nearest`, at which the excess is zero; NaN if there is none.
  !> At large gaps the excess is negative.
  pure real(wp) function largest_gap(problem, search, nearest) result(found)
    type(problem_t), intent(in) :: problem
    type(search_t), intent(in) :: search
    real(wp), intent(in) :: nearest
    type(bracket_t) :: top
    real(wp) :: lowest, gap, next, value, highest
    integer :: step

    found = nan
    lowest = max(nearest, problem%law%smallest_gap)
    if (.not. has_form(problem, search%form)) return
    if (search%condition /= at_h0 .and. .not. problem%coupling > 0) return
    gap = far_gap()
    ! Search towards smaller gaps, to the first change of sign.
    highest = -huge(1.0_wp)
    top = bracket_t(gap, gap)
    do step = 1, most_steps
      if (gap <= lowest) exit
      next = inwards(gap)
      value = excess(next)
      if (value >= 0) then
        found = root_between(next, gap)
        return
      end if
      if (value > highest) then
        highest = value
        top = bracket_t(inwards(next), gap)
      end if
      gap = next
    end do
    ! Between two steps the excess may have a positive maximum close to zero.
    next = top%high
    do step = 1, most_sections
      call top%keep_larger(excess(top%golden_points()))
    end do
    gap = top%middle()
    if (excess(gap) >= 0) found = root_between(gap, next)

  contains

    !> A gap larger than all gaps at which the excess is zero.
    pure real(wp) function far_gap() result(gap)
      !> At gaps larger than a few edge gaps, and once the excess is smaller than `settled`, the
      !> excess falls monotonically to -1.
      real(wp), parameter :: edges = 4, settled = -0.999_wp
      real(wp) :: stride
      integer :: step

      gap = edges*max(problem%law%edge_gap, 1.0_wp)
      if (search%condition == at_h0) gap = max(search%h0, lowest, 1.0_wp)
      stride = linear_range(gap)
      do step = 1, most_steps
        if (excess(gap) < merge(0.0_wp, settled, search%condition == at_h0)) exit
        gap = gap + stride
        stride = 2*stride
      end do
    end function far_gap

    !> The excess, which is negative at gaps above the one that meets the condition, and positive
    !> below.
    elemental real(wp) function excess(gap)
      real(wp), intent(in) :: gap
      real(wp) :: pressure(1), slope(1)

      select case (search%condition)
      case (at_h0)
        excess = search%h0 - (gap - slow_displacement(problem, search%form, gap))
      case (at_fold)
        excess = slow_slope(problem, search%form, gap) - 1
      case default
        ! The criterion holds for bodies that attract each other.
        excess = -1
        pressure = problem%law%pressure([gap])
        slope = problem%law%slope([gap])
        if (pressure(1) < 0) &
          excess = slow_displacement(problem, search%form, gap)*slope(1)/pressure(1) - 1
      end select
    end function excess

    !> The next gap of the search.
    pure real(wp) function inwards(gap)
      real(wp), intent(in) :: gap

      inwards = max(gap - search_step*linear_range(gap), lowest)
    end function inwards

    !> The gap between `near` and `far` at which the excess changes its sign.
    pure real(wp) function root_between(near, far) result(root)
      real(wp), intent(in) :: near, far
      type(bracket_t) :: bracket

      bracket = bracket_t(near, far)
      do while (bracket%is_open())
        call bracket%narrow(excess(bracket%middle()) >= 0)
      end do
      root = bracket%middle()
    end function root_between

    !> Change of gap within which the law may be linearised.
    pure real(wp) function linear_range(gap)
      real(wp), intent(in) :: gap
      real(wp) :: range(1)

      range = problem%law%closure([gap])
      linear_range = range(1)
    end function linear_range

  end function largest_gap

end module slow_jumps
