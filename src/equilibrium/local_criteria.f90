!> The paper's local criteria of stability at fixed h0, (28) and (29), which are estimates.
module local_criteria
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use interpolation, only: polynomial_weights
  use contact_state, only: state_t, radius_of_step
  use root_finding, only: bracket_t
  use stability, only: unknown
  implicit none
  private
  public :: local_criterion, axis_criterion

  !> Smaller pressures count as zero and are not used as divisors.
  real(wp), parameter :: least_pressure = 1.0e-100_wp
  !> Number of points between two neighbouring nodes, and of steps of the golden section about the
  !> largest value.
  integer, parameter :: points = 4, most_sections = 40
  !> Number of nodes of the interpolating polynomial if the panels have fewer nodes.
  integer, parameter :: few = 4
  !> The least relative increase in the search; less is rounding.
  real(wp), parameter :: gained = 1.0e-9_wp
  !> The relative change of the gap for a derivative.
  real(wp), parameter :: little = 1.0e-5_wp

contains

  !> The maximum over r of the left side of (28), |2 u p'/p|; above 1 the state is unstable by this
  !> criterion. The criterion is derived for surfaces that attract each other, with p < 0 and p' >
  !> 0. Only places with these signs count: inside the contact edge p passes zero, and the ratio is
  !> unbounded. Adhesive contacts always violate the criterion just outside the edge. NaN if there
  !> is no attraction. error: due to the interpolation between nodes; by_gap: the magnitude of the
  !> derivative by the gap at this place.
  pure subroutine local_criterion(problem, grid, state, value, error, by_gap)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: value, error, by_gap
    real(wp) :: x(2 + (points + 1)*size(state%gap)), at(size(x)), raised(size(state%gap))
    real(wp) :: front, best, gap, two(2)
    type(bracket_t) :: bracket
    integer :: j, k, n, held, largest

    value = unknown()
    error = 0
    by_gap = 0
    if (problem%rigid) then
      if (problem%law%adhesion > 0) value = 0
      return
    end if
    n = size(state%gap)
    raised = state%gap - problem%shape%height(state%scale*grid%x(:n))
    ! The axis, points between the nodes, and the front of a step of the law.
    held = 0
    do j = 0, n - 1
      do k = 0, points
        held = held + 1
        x(held) = grid%x(j + 1)*k/(points + 1)
        if (j > 0) x(held) = grid%x(j) + (grid%x(j + 1) - grid%x(j))*k/(points + 1)
      end do
    end do
    held = held + 1
    x(held) = grid%x(n)
    front = radius_of_step(problem, grid, state)/state%scale
    if (front > 0 .and. front < x(held)) then
      j = count(x(:held) <= front)
      x(j + 1:held + 1) = [front, x(j + 1:held)]
      held = held + 1
    end if
    do j = 1, held
      at(j) = ratio(problem, state, x(j), gap_near(problem, grid, state, raised, x(j), 0))
    end do
    at(1) = ratio(problem, state, 0.0_wp, state%axis_gap)
    largest = maxloc(at(:held), 1)
    if (.not. at(largest) > 0) return
    value = at(largest)
    bracket = bracket_t(x(max(1, largest - 1)), x(min(held, largest + 1)))
    do k = 1, most_sections
      do j = 1, 2
        associate (place => bracket%golden_points())
          two(j) = ratio(problem, state, place(j), &
            gap_near(problem, grid, state, raised, place(j), 0))
        end associate
      end do
      call bracket%keep_larger(two)
    end do
    best = bracket%middle()
    two(1) = ratio(problem, state, best, gap_near(problem, grid, state, raised, best, 0))
    if (.not. two(1) > (1 + gained)*value) best = x(largest)
    value = max(value, two(1))
    if (best > 0) then
      error = abs(value - &
        ratio(problem, state, best, gap_near(problem, grid, state, raised, best, 1)))
      gap = gap_near(problem, grid, state, raised, best, 0)
    else
      gap = state%axis_gap
    end if
    by_gap = abs(ratio(problem, state, best, (1 + little)*gap) - &
      ratio(problem, state, best, (1 - little)*gap))/(2*little*gap)
  end subroutine local_criterion

  !> |2 u p'/p| at a position with a gap; 0 where surfaces do not attract each other.
  pure real(wp) function ratio(problem, state, x, gap)
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: x, gap
    real(wp) :: pressure(1), slope(1)

    ratio = 0
    if (.not. gap > problem%law%smallest_gap) return
    pressure = problem%law%pressure([gap])
    slope = problem%law%slope([gap])
    ! The product cannot overflow: slopes are below 1e121 and lengths below 1e80.
    if (attracts(pressure(1), slope(1))) ratio = &
      abs((state%h0 + problem%shape%height(state%scale*x) - gap)*slope(1))/(-pressure(1))
  end function ratio

  !> The gap at a position, by the polynomial of the panel's deformations or, on panels of few
  !> nodes, of those at the nearest nodes. fewer: the number of nearest nodes that are omitted.
  pure real(wp) function gap_near(problem, grid, state, raised, x, fewer) result(gap)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: raised(:), x
    integer, intent(in) :: fewer
    integer :: k, first, last, nearest, j
    integer, allocatable :: node(:)

    k = grid%panel_at(x)
    first = grid%first(k)
    last = first + size(grid%local(grid%which(k))%node) - 1
    if (last - first + 1 >= few) then
      if (fewer == 0) then
        gap = problem%shape%height(state%scale*x) + grid%interpolate(raised, x)
        return
      end if
    else
      first = max(1, min(count(grid%x(:size(raised)) <= x) - few/2 + 1, size(raised) - few + 1))
      last = min(size(raised), first + few - 1)
    end if
    node = [(j, j=first, last)]
    nearest = minloc(abs(grid%x(first:last) - x), 1)
    if (fewer > 0 .and. size(node) > 2) node = [node(:nearest - 1), node(nearest + 1:)]
    associate (panel => grid%panel(k))
      gap = problem%shape%height(state%scale*x) + dot_product(raised(node), polynomial_weights( &
        panel%locals(grid%x(node) - grid%centre), panel%local(x - grid%centre)))
    end associate
  end function gap_near

  !> The left side of (29), 2 p'(h(0)) u(0)/p(h(0)); below -1 the state is unstable by this
  !> criterion. NaN if the bodies do not attract each other on the axis, as in contact.
  pure real(wp) function axis_criterion(problem, state) result(value)
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state
    real(wp) :: slope(1), pressure(1)

    value = unknown()
    slope = problem%law%slope([state%axis_gap])
    pressure = problem%law%pressure([state%axis_gap])
    if (all(attracts(pressure, slope))) value = (state%h0 - state%axis_gap)*slope(1)/pressure(1)
  end function axis_criterion

  !> Whether surfaces attract each other, with an attraction that decreases with the gap.
  elemental logical function attracts(pressure, slope)
    real(wp), intent(in) :: pressure, slope

    attracts = pressure < -least_pressure .and. slope > 0
  end function attracts

end module local_criteria
