!> How many nodes, and where: the shape of a mapped mesh that gives load and h0 so many digits along
!> its stretch of the equilibrium path. Fitted to the errors of whole bands of states, at
!> adhesion strengths from 1e-4 to 1e5 (tools/bench/mesh_study.py).
module mesh_rule
  use kinds, only: wp, pi
  use root_finding, only: bracket_t
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t, calm_gap, adhesion_strength, coupling_over
  use contact_scales, only: smallest_feature, cohesive_width
  use law_panels, only: fit_panels, nodes_on, about_axis, about_front, about_edge
  use seen_gaps, only: seen_gaps_t
  use step_front, only: front_leads, first_front, front_width
  use mapped_mesh, only: mapped_shape_t
  implicit none
  private
  public :: approach_shape, contact_shape, is_narrow, rim_passed_at, is_even

  !> d over the smallest feature: errors change little from half of it to twice.
  real(wp), parameter :: finer = 0.5_wp
  !> Where the tail begins, as a multiple of where the bodies are H0 high: for a parabola the poles
  !> of the pressure, at rho**2 = -2 H0, are as far from there as the axis; never nearer than the
  !> next two, in lateral units and in units of the contact radius from the edge.
  real(wp), parameter :: beyond_poles = 1.3_wp, nearest_tail = 5, tail_of_contact = 3
  !> A pressure that falls faster than any power ends where this part of the accuracy is left of it;
  !> up to there it needs so many times the nodes.
  real(wp), parameter :: negligible = 1.0e-2_wp, crowding = 1.7_wp
  !> Power of the position with which the pressure of a fluid between parabolas falls.
  real(wp), parameter :: film_decay = 4
  !> Length of its panels at most: on longer ones, over which a mobility changes by many orders,
  !> matrices of film and bodies are no longer positive together, and short waves grow in time.
  real(wp), parameter :: longest_film = 3
  !> No such pressure goes on beyond the law's range or so many of its lengths.
  real(wp), parameter :: farthest = 60
  !> Short panels: their length in z, so many nodes, and more for each digit.
  real(wp), parameter :: short = 0.7_wp, short_order = 4, short_orders = 0.9_wp
  !> Widths of the cohesive zone that a flat face has at most for its rim to be passed on a mesh
  !> that stays where it is, and how far beyond the rim that goes (`rim_passed_at`).
  real(wp), parameter :: widths_to_pass = 10, beyond_rim = 1.3_wp
  !> Length there of panels in widths of the cohesive zone at most.
  real(wp), parameter :: short_at_rim = 0.7_wp
  !> Kinks of a shape between which panels end; more, as a table has, lie everywhere.
  integer, parameter :: few = 4
  !> The tail begins beyond the end of a body that is nearer than so many times where it would else.
  real(wp), parameter :: near_end = 100
  !> Lengths in z and d go up in steps of this much, d of its logarithm, so that problems that are
  !> near one another have the same meshes: at the cost of a fraction of a node.
  real(wp), parameter :: rung = 0.25_wp
  !> More digits of kernels at most where what the half-space yields and what layers yield beside it
  !> are much more than both together.
  real(wp), parameter :: for_layers = 2
  !> Digits more for pressures of foreseen gaps, which are only nearly those of the bodies; and
  !> digits that a shape with kinks allows.
  real(wp), parameter :: of_foreseen = 1.5_wp, digits_of_broken = 4

contains

  !> Whether short panels lie wherever bodies have the gaps that the law marks, so that meshes serve
  !> narrow bands of radii and wait for gaps that are seen.
  pure logical function is_narrow(problem)
    type(problem_t), intent(in) :: problem

    is_narrow = problem%law%period > 0 .or. problem%law%step_width > 0
  end function is_narrow

  !> Before contact, about the axis, for H0 up to h0_high. seen: gaps that bodies had.
  type(mapped_shape_t) function approach_shape(problem, h0_high, digits, seen) result(shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, digits
    type(seen_gaps_t), intent(in), optional :: seen
    real(wp) :: density, reach, feature

    density = (0.35_wp + digits*(0.4_wp + 0.012_wp*digits))* &
      (1 + 0.03_wp*log(1 + adhesion_strength(problem)))
    reach = max(4.0_wp, beyond_poles*problem%shape%position_of(h0_high))
    call give_tail(problem, problem%law%edge_gap, digits, reach, density, shape)
    feature = smallest_feature(problem, 1.0_wp)
    if (front_leads(problem%law)) feature = min(feature, first_front(problem))
    shape%d = exp(rung*floor(log(finer*feature)/rung))
    shape%even = is_even(problem%shape)
    call add_panels(problem, shape, about_axis, 1, asinh(reach/shape%d), density, digits, 0.0_wp, &
      0.0_wp, seen)
    call refine_axis(problem, digits, 3.0_wp, shape)
    shape%digits = kernel_digits(problem, digits, 1.0_wp)
  end function approach_shape

  !> In contact, about the edge, for contact radii from `low` to `high` (lateral units); or before,
  !> about the front of a step. level: the gap at which a law without adhesion begins to deform the
  !> bodies. seen: gaps that bodies had.
  type(mapped_shape_t) function contact_shape(problem, about, low, high, level, digits, seen) &
    result(shape)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: about
    real(wp), intent(in) :: low, high, level, digits
    type(seen_gaps_t), intent(in), optional :: seen
    real(wp) :: inner, outer, reach, repulsion

    inner = 0.15_wp + digits*(0.24_wp + 0.0105_wp*digits)
    if (problem%law%adhesion > 0) then
      ! Where adhesion is strong a small contact is drawn out far, and where the repulsion is it
      ! begins inside the edge: that needs more nodes, there most of all.
      inner = inner*(1 + 0.03_wp*log(1 + adhesion_strength(problem)/(1 + high)**2))
      repulsion = log(1 + high/(pi*adhesion_strength(problem)))
      outer = inner*(1 + 0.5_wp*log(1 + 0.75_wp*repulsion))
      inner = inner*(0.85_wp + 0.25_wp/(1 + 0.3_wp*adhesion_strength(problem)) + 0.3_wp*repulsion)
    else
      inner = 1.5_wp*inner
      outer = inner
    end if
    reach = max(nearest_tail, beyond_poles*problem%shape%position_of(0.5_wp*calm_gap(problem)))
    ! As long as a contact is smaller than its neck, the pressure around it is that before contact;
    ! where the neck is wider than the force reaches, this is smooth enough.
    if (problem%law%adhesion > 0 .and. cohesive_width(problem) < 1) &
      outer = outer*(1 + 0.5_wp/(1 + 3*(low/cohesive_width(problem))**2))
    call give_tail(problem, max(level, problem%law%edge_gap), digits, reach, outer, shape)
    reach = max(tail_of_contact, reach/low)
    shape%centre = 1
    shape%even = is_even(problem%shape)
    shape%d = min(finer*smallest_feature(problem, high)/high, 1.0_wp)
    if (about == about_front) shape%d = finer*front_width(problem, high)
    call add_panels(problem, shape, about, -1, asinh(1/shape%d), inner, digits, low, high, &
      seen)
    call refine_axis(problem, digits, 1.0_wp, shape)
    shape%inner = size(shape%order)
    ! Panels of a whole number of nodes are a little longer, and end on the axis.
    shape%d = 1/sinh(sum(shape%z_length))
    call add_panels(problem, shape, about, 1, asinh(reach/shape%d), outer, digits, low, high, seen)
    shape%digits = kernel_digits(problem, digits, high)
  end function contact_shape

  !> The tail of the pressure: an algebraic panel where it falls as a power; otherwise the mesh ends
  !> where nothing is left, which sets `reach` (lateral units), and nodes are denser up to there.
  !> from: a gap at which the pressure is as large as it matters.
  pure subroutine give_tail(problem, from, digits, reach, density, shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: from, digits
    real(wp), intent(inout) :: reach, density
    type(mapped_shape_t), intent(inout) :: shape

    if (problem%law%tail_power < huge(1.0_wp)) then
      shape%tail_order = ceiling(1.5_wp + 0.6_wp*digits)
      shape%decay = problem%shape%growth*problem%law%tail_power
      ! Of other shapes what is left of the power need not be a polynomial in the inverse position.
      if (.not. is_even(problem%shape) .or. problem%shape%ends < huge(1.0_wp)) &
        shape%tail_order = 2*shape%tail_order
      reach = max(reach, problem%shape%position_of(problem%law%power_from), &
        beyond_poles*problem%shape%smooth_from())
      if (problem%shape%ends < near_end*reach) reach = max(reach, beyond_poles*problem%shape%ends)
    else
      reach = problem%shape%position_of( &
        max(fading_gap(problem, from, negligible*10.0_wp**(-digits)), 1.0_wp))
      density = crowding*density
    end if
    if (.not. problem%film_gap > 0) return
    shape%tail_order = max(shape%tail_order, ceiling(1.5_wp + 0.6_wp*digits))
    shape%decay = min(merge(shape%decay, huge(1.0_wp), shape%decay > 0), film_decay)
    reach = max(reach, beyond_poles*problem%shape%position_of(problem%film_gap))
  end subroutine give_tail

  !> The gap beyond `from` at which `part` is left of the pressure there.
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

  !> Adds sinh panels over z_length: one, which gets more nodes or is halved where the pressure
  !> shows that it needs this, as under laws with lengths of their own. Laws that have a kink, and
  !> shapes that are not parabolas near the axis, have short panels from the beginning. about, side,
  !> low, high, seen: see `fit_panels`.
  subroutine add_panels(problem, shape, about, side, z_length, density, digits, low, high, seen)
    type(problem_t), intent(in) :: problem
    type(mapped_shape_t), intent(inout) :: shape
    integer, intent(in) :: about, side
    real(wp), intent(in) :: z_length, density, digits, low, high
    type(seen_gaps_t), intent(in), optional :: seen
    real(wp), allocatable :: lengths(:)
    integer, allocatable :: orders(:)
    real(wp) :: digits_to_fit
    integer :: panels, fewest
    logical :: broken

    ! Around a contact that is wider than where its shape has kinks there are none.
    broken = problem%shape%smooth_from() > merge(low, 0.0_wp, side > 0 .and. about == about_edge)
    if (side > 0) broken = broken .or. end_matters(problem, digits, &
      (shape%centre + shape%d*sinh(z_length))*merge(high, 1.0_wp, shape%centre > 0), high)
    fewest = ceiling(short_order + short_orders*digits)
    associate (law => problem%law)
      if (law%has_kink .or. broken .or. problem%shape%exponent > 2) then
        lengths = short_panels(z_length)
        if (about == about_axis .and. broken) lengths = ending_at_breaks(problem, shape%d, z_length)
      else
        lengths = [rung*ceiling(z_length/rung)]
        panels = 1
        if (problem%film_gap > 0) panels = ceiling(lengths(1)/longest_film)
        lengths = spread(lengths(1)/panels, 1, panels)
        fewest = min(fewest, nodes_on(lengths(1), density, 0))
      end if
      digits_to_fit = digits + merge(0.0_wp, of_foreseen, law%has_kink)
      if (present(seen)) digits_to_fit = -log10(seen%most)
      if (broken .or. problem%shape%smooth_from() > 0) &
        digits_to_fit = min(digits_to_fit, digits_of_broken)
      ! Inside the edge the bodies are at rest, but for the repulsion, whose length is known; and in
      ! contact under a law that marks gaps meshes wait for those that are seen.
      if (law%edge_gap > 0 .and. (present(seen) .or. about == about_axis .or. &
        .not. (side < 0 .or. is_narrow(problem)))) then
        call fit_panels(problem, about, side, shape%d, low, high, density, fewest, &
          digits_to_fit, lengths, orders, seen)
      else
        orders = nodes_on(lengths, density, fewest)
      end if
    end associate
    if (.not. allocated(shape%order)) allocate (shape%order(0), shape%z_length(0))
    ! From the axis outward.
    if (side < 0) then
      lengths = lengths(size(lengths):1:-1)
      orders = orders(size(orders):1:-1)
    end if
    shape%order = [shape%order, orders]
    shape%z_length = [shape%z_length, lengths]
  end subroutine add_panels

  !> The radius up to which the contact edge is followed on a mesh that stays where it is, and so
  !> has the kink at the rim of a flat face between its panels: somewhat beyond that, where the
  !> cohesive zone is not so narrow that this would be dear. 0: none.
  pure real(wp) function rim_passed_at(problem) result(radius)
    type(problem_t), intent(in) :: problem

    radius = problem%shape%smooth_from()
    if (problem%shape%height(radius) > 0 .or. radius > widths_to_pass*cohesive_width(problem)) &
      radius = 0
    radius = beyond_rim*radius
  end function rim_passed_at

  !> Short panels over a length in z.
  pure function short_panels(z_length) result(lengths)
    real(wp), intent(in) :: z_length
    real(wp), allocatable :: lengths(:)

    associate (panels => ceiling(z_length/short))
      lengths = spread(z_length/panels, 1, panels)
    end associate
  end function short_panels

  !> Short panels that end where a derivative of the shape jumps; where that is at many places, as
  !> of a table, they need not. Where the edge passes they are short.
  pure function ending_at_breaks(problem, d, z_length) result(lengths)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: d, z_length
    real(wp), allocatable :: lengths(:), long(:), breaks(:)
    real(wp) :: from, z
    integer :: i, parts

    allocate (lengths(0))
    from = 0
    allocate (breaks(0))
    if (allocated(problem%shape%breaks)) breaks = problem%shape%breaks
    do i = 1, merge(size(breaks), 0, size(breaks) <= few)
      z = asinh(breaks(i)/d)
      if (.not. z < z_length) exit
      lengths = [lengths, short_panels(z - from)]
      from = z
    end do
    lengths = [lengths, short_panels(z_length - from)]
    if (.not. rim_passed_at(problem) > 0) return
    call move_alloc(lengths, long)
    allocate (lengths(0))
    from = 0
    do i = 1, size(long)
      parts = 1
      if (d*sinh(from) < rim_passed_at(problem)) parts = ceiling( &
        d*(sinh(from + long(i)) - sinh(from))/(short_at_rim*min(1.0_wp, cohesive_width(problem))))
      lengths = [lengths, spread(long(i)/parts, 1, parts)]
      from = from + long(i)
    end do
  end function ending_at_breaks

  !> Whether a mesh up to a radius holds the end of the bodies, and forces act there. contact: the
  !> radius of a contact, 0 before; without adhesion the gap around it is the smallest.
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

  !> Halves the panel on the axis of shapes that are not smooth there. The pressure of a contact is
  !> there r^(n-1), with a logarithm if n is odd, and what the panel cannot resolve is a part
  !> r^(n+1) of the load: `beyond` n is 1. Before contact it is two powers more. On a panel as long
  !> as it is far from the axis a node makes that smaller by 3 + sqrt(8), so that every halving
  !> needs so many nodes `fewer`. The one on the axis tells the gap there.
  pure subroutine refine_axis(problem, digits, beyond, shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: digits, beyond
    real(wp), parameter :: fewer = log(2.0_wp)/log(3 + sqrt(8.0_wp)), least = 2
    type(mapped_shape_t), intent(inout) :: shape
    real(wp) :: power, order
    integer :: on_axis

    if (is_even(problem%shape)) return
    power = problem%shape%exponent + beyond
    order = short_order + short_orders*digits
    on_axis = ceiling(order)
    if (shape%z_length(1) > 2*short) then
      shape%z_length = [short, shape%z_length(1) - short, shape%z_length(2:)]
      shape%order = [on_axis, shape%order]
    end if
    do while (shape%z_length(1) > 10.0_wp**(-digits/power))
      shape%z_length = [0.5_wp*shape%z_length(1), 0.5_wp*shape%z_length(1), shape%z_length(2:)]
      shape%order = [on_axis, ceiling(order), shape%order(2:)]
      order = max(least, order - power*fewer)
    end do
  end subroutine refine_axis

  !> Whether a body is even in r, so that nothing on its axis is sharp.
  pure logical function is_even(shape)
    class(shape_t), intent(in) :: shape

    is_even = .not. abs(shape%exponent - 2*nint(0.5_wp*shape%exponent)) > 0
  end function is_even

  !> Digits of the kernel: its errors matter less than those of the pressure's polynomials, and
  !> more where bodies yield more, or yield less to contacts of this radius than their half-spaces.
  pure real(wp) function kernel_digits(problem, digits, radius)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: digits, radius

    kernel_digits = 1.2_wp*digits - 2 + 0.5_wp*log10(1 + adhesion_strength(problem))
    if (.not. problem%body%is_homogeneous()) kernel_digits = kernel_digits + max(0.0_wp, &
      min(for_layers, log10(problem%coupling/coupling_over(problem, radius))))
    kernel_digits = max(5, ceiling(kernel_digits))
  end function kernel_digits

end module mesh_rule
