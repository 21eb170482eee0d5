!> The shape of a mapped mesh: number and position of the nodes for a given number of digits of load
!> and h0 along a part of the equilibrium path. The rule was fitted to the errors of whole bands of
!> states, at adhesion strengths from 1e-4 to 1e5.
module mesh_rule
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, calm_gap, adhesion_strength, coupling_over
  use contact_scales, only: smallest_feature, cohesive_width
  use law_panels, only: fit_panels, nodes_on, about_axis, about_front, about_edge
  use computed_gaps, only: computed_gaps_t
  use shape_panels, only: panels_for, has_flat_face
  use step_front, only: front_leads, first_front, front_width
  use mapped_shape, only: mapped_shape_t
  use mesh_plan, only: is_narrow
  use mesh_tail, only: give_tail, end_matters, beyond_poles
  implicit none
  private
  public :: approach_shape, contact_shape

  !> Nodes per unit of z, as coefficients of the powers of the digits from 0: before contact, and
  !> about the edge of a contact.
  real(wp), parameter :: density_before(0:2) = [0.35_wp, 0.4_wp, 0.012_wp], &
    density_about_edge(0:2) = [0.15_wp, 0.24_wp, 0.0105_wp]
  !> Relative increase of the density for each factor of e in sigma.
  real(wp), parameter :: for_adhesion = 0.03_wp
  !> Relative increase of the density where repulsion exceeds adhesion: inside the edge proportional
  !> to the logarithm of the ratio; outside the edge proportional to the logarithm of this logarithm
  !> (`contact_shape`).
  real(wp), parameter :: inside_repulsion = 0.3_wp, outside_repulsion = 0.5_wp, &
    of_repulsion = 0.75_wp
  !> The density inside the edge over that about it under strong adhesion; the additional part under
  !> weak adhesion, and its decrease with sigma.
  real(wp), parameter :: inside_strong = 0.85_wp, inside_weak = 0.25_wp, weakening = 0.3_wp
  !> Factor of the density without adhesion, where only the repulsion is resolved. Relative increase
  !> outside the edge of contacts smaller than their cohesive zone (neck), which is divided by 1 +
  !> beside_neck*(radius/neck)^2.
  real(wp), parameter :: without_adhesion = 1.5_wp, small_contact = 0.5_wp, beside_neck = 3
  !> Digits of a kernel: `of_kernel` for each digit of the mesh, less `fewer_of_kernel`, plus
  !> `for_decade` for each decade of sigma.
  real(wp), parameter :: of_kernel = 1.2_wp, fewer_of_kernel = 2, for_decade = 0.5_wp
  !> The length d over the smallest feature: between half and twice this value errors change little.
  real(wp), parameter :: finer = 0.5_wp
  !> Least positions of the tail's beginning: in lateral units, and in units of the contact radius
  !> from the edge.
  real(wp), parameter :: nearest_tail = 5, tail_of_contact = 3
  !> Largest length in z of the panels for a fluid. On longer panels the mobility changes by many
  !> orders of magnitude. The combined matrices of film and bodies are then not positive definite,
  !> and short waves grow in time.
  real(wp), parameter :: longest_film = 3
  !> The panel on the axis of shapes that are not smooth there: its length in z, and the least power
  !> of its local coordinate that is not smooth.
  real(wp), parameter :: at_axis = 0.35_wp, smoothness = 4
  !> Number of nodes of short panels, and nodes per digit.
  real(wp), parameter :: short_order = 4, short_orders = 0.9_wp
  !> Lengths in z, and the logarithm of d, are multiples of this step, so that similar problems have
  !> the same meshes, at the cost of a fraction of a node.
  real(wp), parameter :: rung = 0.25_wp
  !> Largest number of additional digits of kernels for layered bodies, where the compliance of the
  !> half-space and the layers' correction to it are both much larger than their sum.
  real(wp), parameter :: for_layers = 2
  !> Additional digits for pressures of predicted gaps, which are only approximately those of the
  !> bodies; and digits that a shape with kinks allows on meshes over which its kinks move.
  real(wp), parameter :: of_foreseen = 1.5_wp, digits_of_broken = 4

contains

  !> The mesh before contact, about the axis, for H0 up to h0_high and contacts up to the radius
  !> `widest`. seen: gaps of computed states. If these have an edge, which moves slowly over a
  !> flat face, the mesh is mapped to the middle of the band over which it moves.
  type(mapped_shape_t) function approach_shape(problem, h0_high, widest, digits, seen) result(shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, widest, digits
    type(computed_gaps_t), intent(in), optional :: seen
    real(wp) :: density, reach, feature, edges(2)

    density = density_for(density_before, digits)* &
      (1 + for_adhesion*log(1 + adhesion_strength(problem)))
    reach = max(4.0_wp, beyond_poles*problem%shape%position_of(h0_high))
    call give_tail(problem, problem%law%edge_gap, widest, digits, reach, density, shape)
    feature = smallest_feature(problem, 1.0_wp)
    if (front_leads(problem%law)) feature = min(feature, first_front(problem))
    shape%d = exp(rung*floor(log(finer*feature)/rung))
    shape%even = problem%shape%is_even()
    edges = 0
    if (present(seen)) edges = seen%edges()
    if (edges(1) > 0 .and. has_flat_face(problem%shape)) then
      ! Nodes are equally dense over the band. Outside it `fit_panels` adds nodes where they are
      ! missing.
      shape%focus = 0.5_wp*sum(edges)
      shape%d = max(0.5_wp*(edges(2) - edges(1)), finer*smallest_feature(problem, edges(2)))
      density = density_for(density_about_edge, digits)
      ! Panels between kinks end exactly on the axis.
      call add_panels(problem, shape, about_axis, -1, asinh(shape%focus/shape%d), density, digits, &
        0.0_wp, 0.0_wp, seen)
      shape%inner = size(shape%order)
    end if
    call add_panels(problem, shape, about_axis, 1, asinh((reach - shape%focus)/shape%d), density, &
      digits, 0.0_wp, 0.0_wp, seen)
    call resolve_axis(problem, digits, 2.0_wp, shape)
    shape%digits = kernel_digits(problem, digits, 1.0_wp)
  end function approach_shape

  !> The mesh in contact, about the edge, for contact radii from `low` to `high` (lateral units), or
  !> before contact, about the front of a step. level: the gap at which a law without adhesion
  !> begins to deform the bodies. seen: gaps of computed states.
  type(mapped_shape_t) function contact_shape(problem, about, low, high, level, digits, seen) &
    result(shape)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: about
    real(wp), intent(in) :: low, high, level, digits
    type(computed_gaps_t), intent(in), optional :: seen
    real(wp) :: inner, outer, farthest, reach, repulsion

    inner = density_for(density_about_edge, digits)
    if (problem%law%adhesion > 0) then
      ! Strong adhesion draws a small contact out into a neck; a strong repulsion begins inside the
      ! edge. Both cases need more nodes, mainly inside the edge.
      inner = inner*(1 + for_adhesion*log(1 + adhesion_strength(problem)/(1 + high)**2))
      repulsion = log(1 + high/(pi*adhesion_strength(problem)))
      outer = inner*(1 + outside_repulsion*log(1 + of_repulsion*repulsion))
      inner = inner*(inside_strong + inside_weak/(1 + weakening*adhesion_strength(problem)) + &
        inside_repulsion*repulsion)
    else
      inner = without_adhesion*inner
      outer = inner
    end if
    farthest = 0.5_wp*calm_gap(problem)
    if (present(seen)) farthest = max(farthest, seen%farthest)
    reach = max(nearest_tail, beyond_poles*problem%shape%position_of(farthest))
    ! The pressure around a contact smaller than its neck is that before contact. If the neck is
    ! wider than the range of the force, this pressure is smooth enough.
    if (problem%law%adhesion > 0 .and. cohesive_width(problem) < 1) &
      outer = outer*(1 + small_contact/(1 + beside_neck*(low/cohesive_width(problem))**2))
    call give_tail(problem, max(level, problem%law%edge_gap), 0.0_wp, digits, reach, outer, shape)
    reach = max(tail_of_contact, reach/low)
    shape%centre = 1
    shape%even = problem%shape%is_even()
    shape%d = min(finer*smallest_feature(problem, high)/high, 1.0_wp)
    if (about == about_front) shape%d = finer*front_width(problem, high)
    call add_panels(problem, shape, about, -1, asinh(1/shape%d), inner, digits, low, high, &
      seen)
    call resolve_axis(problem, digits, 0.0_wp, shape)
    shape%inner = size(shape%order)
    ! Panels with an integer number of nodes are slightly longer; d is chosen so that they end on
    ! the axis.
    shape%d = 1/sinh(sum(shape%z_length))
    call add_panels(problem, shape, about, 1, asinh(reach/shape%d), outer, digits, low, high, seen)
    shape%digits = kernel_digits(problem, digits, high)
  end function contact_shape

  !> Nodes per unit of z for a number of digits.
  pure real(wp) function density_for(terms, digits) result(density)
    real(wp), intent(in) :: terms(0:2), digits

    density = terms(0) + digits*(terms(1) + terms(2)*digits)
  end function density_for

  !> Adds sinh panels over z_length: one panel, which gets more nodes or is halved if the pressure
  !> needs this (laws with lengths of their own). Shapes with kinks have short panels from the
  !> beginning. about, side, low, high, seen: see `fit_panels`.
  subroutine add_panels(problem, shape, about, side, z_length, density, digits, low, high, seen)
    type(problem_t), intent(in) :: problem
    type(mapped_shape_t), intent(inout) :: shape
    integer, intent(in) :: about, side
    real(wp), intent(in) :: z_length, density, digits, low, high
    type(computed_gaps_t), intent(in), optional :: seen
    real(wp), allocatable :: lengths(:)
    integer, allocatable :: orders(:)
    real(wp) :: digits_to_fit
    integer :: panels, fewest
    logical :: broken

    ! Around a contact wider than the radius of the shape's kinks there are no kinks.
    broken = problem%shape%smooth_from() > merge(low, 0.0_wp, side > 0 .and. about == about_edge)
    if (side > 0) broken = broken .or. end_matters(problem, digits, &
      (shape%centre + shape%focus + shape%d*sinh(z_length))* &
      merge(high, 1.0_wp, shape%centre > 0), high)
    fewest = ceiling(short_order + short_orders*digits)
    associate (law => problem%law)
      if (broken) then
        lengths = panels_for(problem%shape, shape, about == about_axis, side, z_length)
      else
        lengths = [rung*ceiling(z_length/rung)]
        panels = 1
        if (problem%film_gap > 0) panels = ceiling(lengths(1)/longest_film)
        lengths = spread(lengths(1)/panels, 1, panels)
        fewest = min(fewest, nodes_on(lengths(1), density, 0))
      end if
      digits_to_fit = digits + of_foreseen
      if (present(seen)) digits_to_fit = -log10(seen%most)
      if (about /= about_axis .and. (broken .or. problem%shape%smooth_from() > 0)) &
        digits_to_fit = min(digits_to_fit, digits_of_broken)
      ! Inside the edge the gap is the equilibrium separation except for the repulsion, whose length
      ! is known. In contact under a law with special gaps, meshes are laid out for computed gaps
      ! only.
      if (law%edge_gap > 0 .and. (present(seen) .or. about == about_axis .or. &
        .not. (side < 0 .or. is_narrow(problem)))) then
        call fit_panels(problem, about, side, shape, low, high, density, fewest, &
          digits_to_fit, lengths, orders, seen)
      else
        orders = nodes_on(lengths, density, fewest)
      end if
    end associate
    if (.not. allocated(shape%order)) allocate (shape%order(0), shape%z_length(0))
    ! The panels are stored from the axis outward.
    if (side < 0) then
      lengths = lengths(size(lengths):1:-1)
      orders = orders(size(orders):1:-1)
    end if
    shape%order = [shape%order, orders]
    shape%z_length = [shape%z_length, lengths]
  end subroutine add_panels

  !> Gives a mesh a power panel on the axis, for shapes that are not smooth there. Near the axis the
  !> pressure of a contact contains a term r**(n-1), with a logarithm if n is odd, and the gap on
  !> the axis contains Int r**(n-1) dr. Before contact the powers are higher by `beyond`, which is
  !> 2. The power panel gives this term an exponent of at least `smoothness` in the local
  !> coordinate.
  pure subroutine resolve_axis(problem, digits, beyond, shape)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: digits, beyond
    type(mapped_shape_t), intent(inout) :: shape
    integer :: order

    if (problem%shape%is_even()) return
    shape%axis_power = ceiling(smoothness/(problem%shape%exponent + beyond))
    ! A polynomial of degree n in the position is of degree n*power in the local coordinate.
    order = ceiling((0.5_wp + 0.25_wp*shape%axis_power)*(short_order + short_orders*digits))
    if (shape%z_length(1) > 2*at_axis) then
      shape%z_length = [at_axis, shape%z_length(1) - at_axis, shape%z_length(2:)]
      shape%order = [order, shape%order]
    else
      shape%order(1) = max(order, shape%order(1))
    end if
  end subroutine resolve_axis

  !> Digits of the kernel. Its errors matter less than those of the pressure's polynomials. They
  !> matter more for more compliant bodies, and for bodies that are stiffer at this contact radius
  !> than their half-spaces.
  pure real(wp) function kernel_digits(problem, digits, radius)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: digits, radius

    kernel_digits = of_kernel*digits - fewer_of_kernel + &
      for_decade*log10(1 + adhesion_strength(problem))
    if (.not. problem%body%is_homogeneous()) kernel_digits = kernel_digits + max(0.0_wp, &
      min(for_layers, log10(problem%coupling/coupling_over(problem, radius))))
    kernel_digits = max(5, ceiling(kernel_digits))
  end function kernel_digits

end module mesh_rule
