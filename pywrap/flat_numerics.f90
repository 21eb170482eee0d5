!> The numerics for f2py: linear algebra, kernel, quadrature, product integration,
!> turns of a curve, meshes and one state of equilibrium. Conventions as in `flat_deck`.
!>
!> A mesh is described by its kind, its centre, lengths and orders: 'panels' has lengths from the
!> centre to the ends of panels, and orders(1) nodes on each; 'uniform' ends at the last length and
!> has orders(1) nodes in all; 'mapped' has sinh panels of these lengths in z, one of them inside a
!> place that is not the axis, with their orders and the order of the tail, and map = [d, decay,
!> digits, axis_power, focus] (`mapped_mesh`). `nodes` is the number of nodes in all.
module flat_numerics
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: linear_solution, kernel_values, gauss_rule, panel_integrals
  public :: mesh_nodes, mesh_matrix, mesh_interpolation, turning_intervals
  public :: equilibrium_state, stable_state

contains

  !> x = a^{-1} b by rough LU factors; regular = 0 if there are none.
  subroutine linear_solution(a, b, x, regular, n)
    use linear_algebra, only: factorisation_t, factorise, solve
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: a(n, n), b(n)
    real(c_double), intent(out) :: x(n)
    integer(c_int), intent(out) :: regular
    type(factorisation_t) :: factors

    factors%lu = a
    call factorise(factors, rough=.true.)
    regular = merge(1, 0, factors%valid)
    x = b
    if (factors%valid) call solve(factors, x)
  end subroutine linear_solution

  !> k and the coefficient of its logarithm for sums r + t and distances |r - t|, all positive, the
  !> distance no larger than the sum. Same unit for both, results in one over that.
  subroutine kernel_values(total, distance, k, log_coefficient, n)
    use elastic_kernel, only: kernel, kernel_log_coefficient
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: total(n), distance(n)
    real(c_double), intent(out) :: k(n), log_coefficient(n)

    k = kernel(total, distance)
    log_coefficient = kernel_log_coefficient(total, distance)
  end subroutine kernel_values

  !> Gauss-Legendre nodes on [0, 1], their weights, weights against ln(s), and barycentric weights.
  subroutine gauss_rule(x, weight, log_weight, barycentric, n)
    use quadrature, only: gauss_legendre, logarithm_weights, barycentric_weights
    integer(c_int), intent(in) :: n
    real(c_double), intent(out) :: x(n), weight(n), log_weight(n), barycentric(n)

    call gauss_legendre(x, weight)
    log_weight = logarithm_weights(x, weight)
    barycentric = barycentric_weights(x)
  end subroutine gauss_rule

  !> Whether a curve with these values and slopes at ascending abscissas may turn between one
  !> abscissa and the next: 0 or 1.
  subroutine turning_intervals(x, value, slope, turns, n)
    use path_extrema, only: may_turn
    use interpolation, only: hermite_through
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: x(n), value(n), slope(n)
    integer(c_int), intent(out) :: turns(n - 1)
    integer :: i

    do i = 1, n - 1
      turns(i) = merge(1, 0, may_turn(hermite_through(x(i:i + 1), value(i:i + 1), &
        slope(i:i + 1)), x(i:i + 1)))
    end do
  end subroutine turning_intervals

  !> weights(j, i): integral of k(r, t) L_j(t) t dt over the panel of offsets [left, right] from the
  !> centre, r = centre + target(i), L_j the Lagrange polynomials on the nodes `node` of [0, 1].
  subroutine panel_integrals(node, centre, target, left, right, weights, order, n)
    use local_nodes, only: given_nodes
    use panel_kernel, only: add_panel
    use panel_map, only: panel_map_t, linear_map
    integer(c_int), intent(in) :: order, n
    real(c_double), intent(in) :: node(order), centre, target(n), left, right
    real(c_double), intent(out) :: weights(order, n)
    real(c_double), parameter :: all_digits = 14
    real(c_double) :: matrix(n, order)

    call add_panel(panel_map_t(linear_map, left, right), given_nodes(node), all_digits, centre, &
      target, 0, matrix)
    weights = transpose(matrix)
  end subroutine panel_integrals

  !> Nodes of a mesh, the weights of integral f x dx, and the distance between nodes.
  subroutine mesh_nodes(kind, centre, lengths, orders, map, x, weight, spacing, nodes, l, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: nodes, l, m, orders(m)
    real(c_double), intent(in) :: centre, lengths(l), map(5)
    real(c_double), intent(out) :: x(nodes), weight(nodes), spacing
    type(discretisation_t) :: mesh

    mesh = mesh_of(kind, centre, lengths, orders, map, .false.)
    x = mesh%x
    weight = mesh%weight
    spacing = mesh%spacing
  end subroutine mesh_nodes

  !> The kernel's matrix: rows for the axis, for the mesh's centre, and for the nodes.
  subroutine mesh_matrix(kind, centre, lengths, orders, map, matrix, nodes, l, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: nodes, l, m, orders(m)
    real(c_double), intent(in) :: centre, lengths(l), map(5)
    real(c_double), intent(out) :: matrix(nodes + 2, nodes)
    type(discretisation_t) :: mesh

    mesh = mesh_of(kind, centre, lengths, orders, map, .true.)
    matrix = mesh%kernel
  end subroutine mesh_matrix

  !> Values at positions `at` of the function with the given values at the nodes: within a mesh that
  !> ends, anywhere on a mesh with a tail if the function is bounded.
  subroutine mesh_interpolation(kind, centre, lengths, orders, map, values, at, found, nodes, n, &
    l, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: nodes, n, l, m, orders(m)
    real(c_double), intent(in) :: centre, lengths(l), map(5), values(nodes), at(n)
    real(c_double), intent(out) :: found(n)
    type(discretisation_t) :: mesh
    integer :: i

    mesh = mesh_of(kind, centre, lengths, orders, map, .false.)
    do i = 1, n
      found(i) = mesh%interpolate(values, at(i))
    end do
  end subroutine mesh_interpolation

  !> One state of a deck's law at a prescribed H0 and coupling, in the units of
  !> `dimensionless_problem`, on a mesh enlarged `scale` times, from the gaps `start`.
  !> stop_on_change: 0 or 1. numbers: gap on the axis, load, residual. counts: converged (0 or 1),
  !> operator products, factorisations, rejected steps. A state that did not converge is not a
  !> failure; its residual is its distance from equilibrium.
  subroutine equilibrium_state(deck, coupling, kind, centre, lengths, orders, map, scale, h0, &
    start, method, tolerance, most_iterations, depth, patience, mixing_limit, stop_on_change, &
    displacement_tolerance, gap, pressure, numbers, counts, stat, message, nodes, l, m)
    use deck_problem, only: pose
    use contact_state, only: state_t
    use controls, only: control_t, at_h0
    use solver, only: solver_t
    use solver_options, only: solver_options_t, newton_of
    character(len=*), intent(in) :: deck, kind, method
    integer(c_int), intent(in) :: nodes, l, m, orders(m)
    integer(c_int), intent(in) :: most_iterations, depth, patience, stop_on_change
    real(c_double), intent(in) :: coupling, centre, lengths(l), map(5), scale, h0, start(nodes)
    real(c_double), intent(in) :: tolerance, mixing_limit, displacement_tolerance
    real(c_double), intent(out) :: gap(nodes), pressure(nodes), numbers(3)
    integer(c_int), intent(out) :: counts(4), stat
    character(len=16000), intent(out) :: message
    type(solver_t) :: this
    type(state_t) :: state
    logical :: met

    gap = 0
    pressure = 0
    numbers = 0
    counts = 0
    call pose(deck, this%problem, stat, message)
    if (stat /= 0) return
    this%problem%coupling = coupling
    allocate (this%meshes%grid(1))
    this%meshes%grid(1) = mesh_of(kind, centre, lengths, orders, map, .true.)
    this%options = solver_options_t(mixing=index(method, 'mixing') > 0, tolerance=tolerance, &
      depth=depth, mixing_depth=merge(depth, 0, method == 'anderson_mixing'), &
      patience=patience, most_iterations=most_iterations, mixing_limit=mixing_limit, &
      stop_on_change=stop_on_change /= 0, displacement_tolerance=displacement_tolerance)
    if (method == 'newton') this%options = newton_of(this%options)
    state%gap = start
    state%pressure = 0*start
    call this%solve(control_t(kind=at_h0, value=h0, scale=scale), state, met)
    gap = state%gap
    pressure = state%pressure
    numbers = [state%axis_gap, state%load, state%residual]
    counts = int([merge(1, 0, met), int(this%cost%operator_products), &
      int(this%cost%factorisations), int(this%cost%rejected_steps)], c_int)
  end subroutine equilibrium_state

  !> Whether the gaps on a mesh are a state that is stable at fixed h0, by products alone: 0 or 1.
  subroutine stable_state(deck, coupling, kind, centre, lengths, orders, map, gap, stable, stat, &
    message, nodes, l, m)
    use deck_problem, only: pose
    use contact_state, only: state_t
    use controls, only: control_t
    use equilibrium, only: equations_t
    use stability_by_products, only: is_stable
    character(len=*), intent(in) :: deck, kind
    integer(c_int), intent(in) :: nodes, l, m, orders(m)
    real(c_double), intent(in) :: coupling, centre, lengths(l), map(5), gap(nodes)
    integer(c_int), intent(out) :: stable, stat
    character(len=16000), intent(out) :: message
    type(equations_t) :: this
    type(state_t) :: state

    stable = 0
    call pose(deck, this%problem, stat, message)
    if (stat /= 0) return
    this%problem%coupling = coupling
    allocate (this%meshes%grid(1))
    this%meshes%grid(1) = mesh_of(kind, centre, lengths, orders, map, .true.)
    state%gap = gap
    stable = merge(1, 0, is_stable(this, control_t(), state))
  end subroutine stable_state

  !> The mesh with this description.
  function mesh_of(kind, centre, lengths, orders, map, elastic) result(mesh)
    use discretisation, only: discretisation_t
    use mapped_mesh, only: new_mapped_mesh
    use mapped_shape, only: mapped_shape_t
    use linear_mesh, only: new_panel_grid, new_uniform_grid
    character(len=*), intent(in) :: kind
    real(c_double), intent(in) :: centre, lengths(:), map(5)
    integer(c_int), intent(in) :: orders(:)
    logical, intent(in) :: elastic
    type(discretisation_t) :: mesh

    select case (kind)
    case ('uniform')
      mesh = new_uniform_grid(orders(1), lengths(size(lengths)), elastic)
    case ('panels')
      mesh = new_panel_grid(centre, lengths, orders(1), elastic)
    case ('mapped')
      associate (panels => size(lengths))
        mesh = new_mapped_mesh(mapped_shape_t(centre, map(1), merge(1, 0, centre + map(5) > 0), &
          orders(:panels), lengths, orders(panels + 1), map(2), map(3), axis_power=nint(map(4)), &
          focus=map(5)), elastic)
      end associate
    end select
  end function mesh_of

end module flat_numerics
