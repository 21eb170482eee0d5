!> Adaptive refinement of panels for force laws with barriers, oscillations or steps, whose
!> positions between the edge and infinity a general rule does not know.
!>
!> The pressure is evaluated for predicted gaps (`predicted_gaps`) or, once there is a path, for
!> computed ones (`computed_gaps`). A panel in z on which the last Legendre coefficients of this
!> pressure are not small gets more nodes or is halved, whichever takes fewer nodes (`left_out`).
module law_panels
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use force_law, only: force_law_t, whole_step
  use local_nodes, only: local_nodes_t, gauss_nodes
  use mapped_shape, only: mapped_shape_t
  use predicted_gaps, only: axis_gaps, between, predicted_gap
  use computed_gaps, only: computed_gaps_t
  use represented_pressure, only: panel_pressure
  use step_front, only: step_height
  implicit none
  private
  public :: fit_panels, nodes_on, left_out
  public :: about_axis, about_front, about_edge

  !> The centre of a mesh: the axis, the front of a step, or the contact edge.
  integer, parameter :: about_axis = 1, about_front = 2, about_edge = 3

  !> Number of nodes of a panel in addition to the number proportional to its length in z.
  real(wp), parameter :: more_nodes = 3
  !> Panels shorter than twice `shortest` are not halved.
  real(wp), parameter :: shortest = 0.01_wp
  !> Factors by which the number of nodes is increased in turn. A panel that needs no more nodes
  !> than its halves is not halved: oscillations need more nodes, steps need shorter panels.
  real(wp), parameter :: times(*) = [1.0_wp, 1.3_wp, 1.7_wp, 2.2_wp, 2.8_wp, 3.6_wp]

contains

  !> Number of nodes of panels with the given lengths in z, with `density` nodes per unit of z, and
  !> at least `fewest`.
  elemental integer function nodes_on(length, density, fewest) result(order)
    real(wp), intent(in) :: length, density
    integer, intent(in) :: fewest

    order = max(fewest, ceiling(density*length + more_nodes))
  end function nodes_on

  !> Lengths in z and numbers of nodes of panels at offsets focus + side*d sinh(z), with the centre,
  !> focus and d of `mapped`. A given panel gets the number `nodes_on` of nodes or more, or is
  !> replaced by its halves. Contact radii are between low and high; about: the kind of centre.
  !> digits: accuracy of load and h0. seen: gaps that replace the predicted ones.
  subroutine fit_panels(problem, about, side, mapped, low, high, density, fewest, digits, &
    length, order, seen)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: about, side, fewest
    type(mapped_shape_t), intent(in) :: mapped
    real(wp), intent(in) :: low, high, density, digits
    real(wp), allocatable, intent(inout) :: length(:)
    integer, allocatable, intent(out) :: order(:)
    type(computed_gaps_t), intent(in), optional :: seen
    !> Number of places on a panel at which a step is tried.
    integer, parameter :: places = 5
    real(wp), allocatable :: given(:), parameter(:), load(:)
    real(wp) :: most, worst_radius
    !> Gauss rules by their number of nodes, made when they are needed.
    type(local_nodes_t), allocatable :: rule(:)
    integer :: worst, k

    most = 10.0_wp**(-digits)
    worst = 0
    if (present(seen)) then
      parameter = [(0.0_wp, k=1, seen%tried())]
    else if (about == about_axis) then
      parameter = axis_gaps(problem)
    else
      parameter = between(low, high, problem%law)
    end if
    load = [(load_of(k), k=1, size(parameter))]
    call move_alloc(length, given)
    allocate (rule(ceiling(maxval(times)*nodes_on(maxval(given), density, fewest))))
    allocate (length(0), order(0))
    do k = 1, size(given)
      call add(sum(given(:k - 1)), given(k), huge(1), length, order)
    end do

  contains

    !> Adds the panel that begins at z, or its halves if these have fewer nodes; adds nothing if
    !> both need more than `allowed` nodes.
    recursive subroutine add(z, z_length, allowed, length, order)
      real(wp), intent(in) :: z, z_length
      integer, intent(in) :: allowed
      real(wp), allocatable, intent(inout) :: length(:)
      integer, allocatable, intent(inout) :: order(:)
      real(wp), allocatable :: halves(:)
      integer, allocatable :: orders(:)
      integer :: nodes, left, first

      nodes = order_of(z, z_length, allowed)
      left = allowed
      if (nodes > 0) left = nodes - 1
      if (left >= 2*fewest .and. .not. z_length < 2*shortest) then
        allocate (halves(0), orders(0))
        call add(z, 0.5_wp*z_length, left - fewest, halves, orders)
        first = size(halves)
        if (first > 0) call add(z + 0.5_wp*z_length, 0.5_wp*z_length, left - sum(orders), halves, &
          orders)
        if (size(halves) > first) then
          length = [length, halves]
          order = [order, orders]
          return
        end if
      end if
      if (nodes == 0) return
      length = [length, z_length]
      order = [order, nodes]
    end subroutine add

    !> Number of nodes that resolve the pressure on a panel; 0 if more than `allowed` are needed.
    integer function order_of(z, z_length, allowed) result(nodes)
      real(wp), intent(in) :: z, z_length
      integer, intent(in) :: allowed
      integer :: k

      do k = 1, size(times)
        nodes = ceiling(times(k)*nodes_on(z_length, density, fewest))
        if (nodes > allowed) exit
        if (z_length < 2*shortest) return
        if (is_resolved(z, z_length, nodes)) return
      end do
      nodes = 0
    end function order_of

    !> Whether the nodes of a panel integrate the pressure accurately enough for the load and the
    !> gap nearby. The gap that was worst before is tested first.
    logical function is_resolved(z, z_length, nodes)
      real(wp), intent(in) :: z, z_length
      integer, intent(in) :: nodes
      real(wp), allocatable :: radius(:)
      integer :: j, i

      if (.not. allocated(rule(nodes)%node)) rule(nodes) = gauss_nodes(nodes)
      is_resolved = .true.
      if (worst > 0) is_resolved = suffices(z, z_length, rule(nodes), worst, worst_radius)
      do j = 1, size(parameter)
        radius = radii_of(j, offset_at(z + z_length*[(i, i=0, places - 1)]/(places - 1.0_wp)))
        do i = 1, size(radius)
          if (.not. is_resolved) return
          is_resolved = suffices(z, z_length, rule(nodes), j, radius(i))
          if (is_resolved) cycle
          worst = j
          worst_radius = radius(i)
        end do
      end do
    end function is_resolved

    !> The radii at which gap number j is tried on a panel with places at the given offsets.
    function radii_of(j, offset) result(radius)
      integer, intent(in) :: j
      real(wp), intent(in) :: offset(:)
      real(wp), allocatable :: radius(:)

      if (present(seen)) then
        radius = seen%radii(j, offset)
      else
        radius = [parameter(j)]
      end if
    end function radii_of

    !> Whether the nodes of a panel resolve the pressure of gap number j at a radius. Under a law
    !> with a step, gaps between the first and the last one are tested only if their step is on the
    !> panel. If it is not, their pressures are as smooth as those of the first or the last gap.
    logical function suffices(z, z_length, local, j, radius)
      real(wp), intent(in) :: z, z_length, radius
      type(local_nodes_t), intent(in) :: local
      integer, intent(in) :: j
      real(wp), dimension(size(local%node)) :: offset, gap
      real(wp) :: ends(2)

      offset = offset_at(z + z_length*local%node)
      if (j > 1 .and. j < size(parameter) .and. problem%law%step_width > 0) then
        suffices = .not. meets_step(problem%law, gap_of(j, radius, offset([1, size(offset)])))
        if (suffices) return
      end if
      gap = gap_of(j, radius, offset)
      ends = mapped%centre + offset_at(z + z_length*[0, 1])
      if (side < 0) ends = [ends(2), ends(1)]
      associate (unit => merge(1.0_wp, radius, about == about_axis))
        suffices = left_out(problem, local, unit*(mapped%centre + mapped%focus), unit*ends, &
          unit*(mapped%centre + offset), gap, panel_pressure(problem%law, local, gap), load(j)) &
          <= most
      end associate
    end function suffices

    !> Offsets from the centre of the mesh.
    elemental real(wp) function offset_at(z) result(offset)
      real(wp), intent(in) :: z

      offset = mapped%focus + side*mapped%d*sinh(z)
    end function offset_at

    !> The gap number j at offsets from the centre; radius: that of a contact.
    function gap_of(j, radius, offset) result(gap)
      integer, intent(in) :: j
      real(wp), intent(in) :: radius, offset(:)
      real(wp) :: gap(size(offset))

      if (present(seen)) then
        gap = seen%gap(problem%shape, j, radius, offset)
      else
        gap = predicted_gap(problem, about == about_axis, parameter(j), offset, mapped%d)
      end if
    end function gap_of

    !> The load, except for a factor of 2 pi, to which the error is relative: the adhesion or,
    !> before contact, the load of the absolute pressure, if that is smaller.
    real(wp) function load_of(j) result(load)
      integer, intent(in) :: j
      integer, parameter :: points = 64
      real(wp), dimension(points) :: z, offset
      integer :: i

      load = problem%law%adhesion
      if (present(seen)) then
        load = seen%load(j)
      else if (about == about_axis) then
        z = sum(length)/points*[(i - 0.5_wp, i=1, points)]
        offset = offset_at(z)
        load = min(load, sum(length)/points* &
          sum(abs(problem%law%pressure(gap_of(j, 1.0_wp, offset)))*offset*mapped%d*cosh(z)))
      end if
    end function load_of

  end subroutine fit_panels

  !> The relative error of load and gap due to the nodes of a panel. Since nodes integrate
  !> polynomials of twice the degree, the error is the tail of the pressure times the ratio of the
  !> tail to the pressure. If a step is smaller than the pressure around it, the tail is divided by
  !> the height of the step, since nodes may miss the step completely.
  !>
  !> Pressures are weighted by their area, which is limited by the length of the panel and by the
  !> area of the total load. Within the panel they are weighted by their effect on the gap. Under
  !> oscillating laws they are weighted by the area of the panel. focus: radius to which the mesh is
  !> mapped; ends, r: radii of the panel's ends and of its nodes; gap, pressure: at the nodes; load:
  !> the reference load without the factor of 2 pi.
  pure real(wp) function left_out(problem, local, focus, ends, r, gap, pressure, load) result(left)
    type(problem_t), intent(in) :: problem
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: focus, ends(2), r(:), gap(:), pressure(:), load
    real(wp), dimension(size(pressure)) :: weight
    real(wp) :: most(1), area, tail, largest, whole

    if (problem%law%period > 0) then
      weight = (ends(2) - ends(1))*(1 + ends(2))
      whole = load
    else
      most = max(1.0_wp, maxval(abs(pressure)))
      if (problem%law%edge_gap > 0) most = abs(problem%law%pressure([problem%law%edge_gap]))
      area = min(1.0_wp, load/most(1))
      weight = min(area, ends(2)**2) + &
        r*abs(r - focus)*(ends(2) - ends(1))/maxval(abs(ends - focus))
      whole = max(most(1)*area, load)
    end if
    tail = local%tail(weight*pressure)
    largest = maxval(abs(weight*pressure))
    if (meets_step(problem%law, gap)) largest = min(largest, &
      step_height(problem%law)*weight(minloc(abs(gap - problem%law%step_at), 1)))
    left = tail/max(whole, tiny(whole))*min(1.0_wp, tail/max(largest, tiny(largest)))
  end function left_out

  !> Whether gaps that rise or fall have the step of a law between them, or nearby.
  pure logical function meets_step(law, gap)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: gap(:)

    associate (ends => gap([1, size(gap)]))
      meets_step = law%step_width > 0 .and. &
        maxval(ends) > law%step_at - whole_step*law%step_width .and. &
        minval(ends) < law%step_at + whole_step*law%step_width
    end associate
  end function meets_step

end module law_panels
