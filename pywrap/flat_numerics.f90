!> The numerics as f2py can see them: kernel, quadrature, product integration, force laws, meshes
!> and one state of equilibrium. Conventions as in `snapin_flat`.
!>
!> A mesh is described by its kind, its centre, the ends of its panels as offsets from the centre,
!> and its order: 'panels' has `order` nodes on each; 'uniform' has one panel [0, extent] with
!> `order` nodes in all. Either way there are order*(m - 1) nodes, m being the number of ends.
!>
!> A force law is described by its name, its part and its four possible parameters, SI, of which
!> each law reads its own.
module flat_numerics
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: kernel_values, gauss_rule, panel_integrals
  public :: law_values, law_numbers
  public :: mesh_nodes, mesh_matrix, mesh_interpolation
  public :: mapped_nodes, mapped_matrix, mapped_interpolation
  public :: equilibrium_state

contains

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

  !> Gauss-Legendre nodes on [0, 1], their weights, those against ln(s), and the barycentric ones.
  subroutine gauss_rule(x, weight, log_weight, barycentric, n)
    use quadrature, only: gauss_legendre, logarithm_weights, barycentric_weights
    integer(c_int), intent(in) :: n
    real(c_double), intent(out) :: x(n), weight(n), log_weight(n), barycentric(n)

    call gauss_legendre(x, weight)
    log_weight = logarithm_weights(x, weight)
    barycentric = barycentric_weights(x)
  end subroutine gauss_rule

  !> weights(j, i): integral of k(r, t) L_j(t) t dt over the panel of offsets [left, right] from the
  !> centre, r = centre + target(i), L_j the Lagrange polynomials on the nodes `node` of [0, 1].
  subroutine panel_integrals(node, centre, target, left, right, weights, order, n)
    use product_integration, only: panel_rule_t, new_panel_rule, panel_weights
    integer(c_int), intent(in) :: order, n
    real(c_double), intent(in) :: node(order), centre, target(n), left, right
    real(c_double), intent(out) :: weights(order, n)
    type(panel_rule_t) :: rule
    integer :: i

    rule = new_panel_rule(node)
    do i = 1, n
      call panel_weights(rule, centre, target(i), left, right, weights(:, i))
    end do
  end subroutine panel_integrals

  !> Pressure [Pa], its derivative by the gap [Pa/m] and its integral from the gap to infinity
  !> [J/m^2], at gaps [m].
  subroutine law_values(name, part, hamaker, z0, p0, decay_length, gap, pressure, slope, energy, &
    stat, message, n)
    use force_law, only: force_law_t
    use law_by_name, only: make_law
    character(len=*), intent(in) :: name, part
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, gap(n)
    real(c_double), intent(out) :: pressure(n), slope(n), energy(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    class(force_law_t), allocatable :: law

    pressure = 0
    slope = 0
    energy = 0
    call make_law(name, part, hamaker, z0, p0, decay_length, law, stat, message)
    if (stat /= 0) return
    pressure = law%pressure_unit*law%pressure(gap/law%length)
    slope = law%pressure_unit/law%length*law%slope(gap/law%length)
    energy = law%pressure_unit*law%length*law%energy(gap/law%length)
  end subroutine law_values

  !> Units of gap [m] and pressure [Pa], surface energy [J/m^2], gaps of maximum tension, of zero
  !> pressure and of vanishing repulsion [m]; 0 where there is none.
  subroutine law_numbers(name, part, hamaker, z0, p0, decay_length, length, pressure_unit, &
    surface_energy, edge_gap, rest_gap, reach, stat, message)
    use force_law, only: force_law_t
    use law_by_name, only: make_law
    character(len=*), intent(in) :: name, part
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length
    real(c_double), intent(out) :: length, pressure_unit, surface_energy, edge_gap, rest_gap, reach
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    class(force_law_t), allocatable :: law

    length = 0
    pressure_unit = 0
    surface_energy = 0
    edge_gap = 0
    rest_gap = 0
    reach = 0
    call make_law(name, part, hamaker, z0, p0, decay_length, law, stat, message)
    if (stat /= 0) return
    length = law%length
    pressure_unit = law%pressure_unit
    surface_energy = law%adhesion*law%pressure_unit*law%length
    edge_gap = law%edge_gap*law%length
    rest_gap = law%rest_gap*law%length
    reach = law%range*law%length
  end subroutine law_numbers

  !> Nodes of a mesh, the weights of integral f x dx, and the distance between nodes.
  subroutine mesh_nodes(kind, centre, panel_end, order, x, weight, spacing, stat, message, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m
    real(c_double), intent(in) :: centre, panel_end(m)
    real(c_double), intent(out) :: x(order*(m - 1)), weight(order*(m - 1)), spacing
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(discretisation_t) :: mesh

    x = 0
    weight = 0
    spacing = 0
    call make_mesh(kind, centre, panel_end, order, .false., mesh, stat, message)
    if (stat /= 0) return
    x = mesh%x
    weight = mesh%weight
    spacing = mesh%spacing
  end subroutine mesh_nodes

  !> The kernel's matrix: rows for the axis, for the mesh's centre, and for the nodes.
  subroutine mesh_matrix(kind, centre, panel_end, order, matrix, stat, message, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m
    real(c_double), intent(in) :: centre, panel_end(m)
    real(c_double), intent(out) :: matrix(order*(m - 1) + 2, order*(m - 1))
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(discretisation_t) :: mesh

    matrix = 0
    call make_mesh(kind, centre, panel_end, order, .true., mesh, stat, message)
    if (stat == 0) matrix = mesh%kernel
  end subroutine mesh_matrix

  !> Values at positions `at` within a mesh of the function with the given values at its nodes.
  subroutine mesh_interpolation(kind, centre, panel_end, order, values, at, found, stat, message, &
    m, n)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m, n
    real(c_double), intent(in) :: centre, panel_end(m), values(order*(m - 1)), at(n)
    real(c_double), intent(out) :: found(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(discretisation_t) :: mesh
    integer :: i

    found = 0
    call make_mesh(kind, centre, panel_end, order, .false., mesh, stat, message)
    if (stat /= 0) return
    do i = 1, n
      found(i) = mesh%interpolate(values, at(i))
    end do
  end subroutine mesh_interpolation

  !> Nodes of a mesh mapped by sinh (`mapped_mesh`), and the weights of integral f x dx.
  subroutine mapped_nodes(centre, d, inner, order, z_length, tail_order, decay, digits, x, weight, &
    panels, nodes)
    use discretisation, only: discretisation_t
    use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
    integer(c_int), intent(in) :: panels, nodes, inner, order(panels), tail_order
    real(c_double), intent(in) :: centre, d, z_length(panels), decay, digits
    real(c_double), intent(out) :: x(nodes), weight(nodes)
    type(discretisation_t) :: mesh

    mesh = new_mapped_mesh(mapped_shape_t(centre, d, inner, order, z_length, tail_order, decay, &
      digits), .false.)
    x = mesh%x
    weight = mesh%weight
  end subroutine mapped_nodes

  !> The kernel's matrix: rows for the axis, for the mesh's centre, and for the nodes.
  subroutine mapped_matrix(centre, d, inner, order, z_length, tail_order, decay, digits, matrix, &
    panels, nodes)
    use discretisation, only: discretisation_t
    use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
    integer(c_int), intent(in) :: panels, nodes, inner, order(panels), tail_order
    real(c_double), intent(in) :: centre, d, z_length(panels), decay, digits
    real(c_double), intent(out) :: matrix(nodes + 2, nodes)
    type(discretisation_t) :: mesh

    mesh = new_mapped_mesh(mapped_shape_t(centre, d, inner, order, z_length, tail_order, decay, &
      digits), .true.)
    matrix = mesh%kernel
  end subroutine mapped_matrix

  !> Values at positions `at` of the function with the given values at the nodes, bounded far away.
  subroutine mapped_interpolation(centre, d, inner, order, z_length, tail_order, values, at, found, &
    panels, nodes, n)
    use discretisation, only: discretisation_t
    use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
    integer(c_int), intent(in) :: panels, nodes, n, inner, order(panels), tail_order
    real(c_double), intent(in) :: centre, d, z_length(panels), values(nodes), at(n)
    real(c_double), intent(out) :: found(n)
    type(discretisation_t) :: mesh
    integer :: i

    mesh = new_mapped_mesh(mapped_shape_t(centre, d, inner, order, z_length, tail_order), .false.)
    do i = 1, n
      found(i) = mesh%interpolate(values, at(i))
    end do
  end subroutine mapped_interpolation

  !> One state at a prescribed H0, in the units of `dimensionless_problem`, on a mesh enlarged
  !> `scale` times, from the gaps `start`. converged, stop_on_change: 0 or 1. A state that did not
  !> converge is not a failure; its residual says how far it is from equilibrium.
  subroutine equilibrium_state(name, part, coupling, kind, centre, panel_end, order, scale, h0, &
    start, method, tolerance, most_iterations, depth, patience, mixing_limit, stop_on_change, &
    displacement_tolerance, gap, pressure, axis_gap, load, residual, converged, operator_products, &
    factorisations, rejected_steps, stat, message, m)
    use equilibrium, only: control_t, state_t, at_h0, state_from
    use solver, only: solver_t
    use solver_options, only: solver_options_t
    character(len=*), intent(in) :: name, part, kind, method
    integer(c_int), intent(in) :: order, most_iterations, depth, patience, stop_on_change, m
    real(c_double), intent(in) :: coupling, centre, panel_end(m), scale, h0
    real(c_double), intent(in) :: start(order*(m - 1))
    real(c_double), intent(in) :: tolerance, mixing_limit, displacement_tolerance
    real(c_double), intent(out) :: gap(order*(m - 1)), pressure(order*(m - 1))
    real(c_double), intent(out) :: axis_gap, load, residual
    integer(c_int), intent(out) :: converged, operator_products, factorisations, rejected_steps
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    type(solver_t) :: this
    type(state_t) :: state
    logical :: met

    gap = 0
    pressure = 0
    axis_gap = 0
    load = 0
    residual = 0
    converged = 0
    operator_products = 0
    factorisations = 0
    rejected_steps = 0
    call make_unit_law(name, part, this%problem%law, stat, message)
    if (stat /= 0) return
    this%problem%coupling = coupling
    this%problem%rigid = .not. coupling > 0
    allocate (this%pair%grid(1))
    call make_mesh(kind, centre, panel_end, order, coupling > 0, this%pair%grid(1), stat, message)
    if (stat /= 0) return

    this%options = solver_options_t(method=method, tolerance=tolerance, depth=depth, &
      patience=patience, most_iterations=most_iterations, mixing_limit=mixing_limit, &
      stop_on_change=stop_on_change /= 0, displacement_tolerance=displacement_tolerance)
    state = state_from(this%pair%grid(1)%nodes)
    state%gap = start
    call this%solve(control_t(kind=at_h0, value=h0, scale=scale), state, met)
    gap = state%gap
    pressure = state%pressure
    axis_gap = state%axis_gap
    load = state%load
    residual = state%residual
    if (met) converged = 1
    operator_products = int(this%cost%operator_products, c_int)
    factorisations = int(this%cost%factorisations, c_int)
    rejected_steps = int(this%cost%rejected_steps, c_int)
  end subroutine equilibrium_state

  !> The law of this name in its own units.
  subroutine make_unit_law(name, part, law, stat, message)
    use force_law, only: force_law_t
    use kinds, only: pi
    use law_by_name, only: make_law
    character(len=*), intent(in) :: name, part
    class(force_law_t), allocatable, intent(out) :: law
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message
    real(c_double), parameter :: one = 1

    ! A Hamaker constant of 16 pi z0^2 makes the surface energy (34) one.
    call make_law(name, part, 16*pi, one, one, one, law, stat, message)
  end subroutine make_unit_law

  !> The mesh of this description; stat and message where there is none.
  subroutine make_mesh(kind, centre, panel_end, order, elastic, mesh, stat, message)
    use discretisation, only: discretisation_t
    use failure, only: bad_input
    use panels, only: new_panel_grid
    use uniform_grid, only: new_uniform_grid
    character(len=*), intent(in) :: kind
    real(c_double), intent(in) :: centre, panel_end(:)
    integer(c_int), intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t), intent(out) :: mesh
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    select case (kind)
    case ('uniform')
      mesh = new_uniform_grid(order, panel_end(size(panel_end)), elastic)
    case ('panels')
      mesh = new_panel_grid(centre, panel_end, order, elastic)
    case default
      stat = bad_input
      message = 'kind: there is no mesh of kind "'//trim(kind)//'"'
    end select
  end subroutine make_mesh

end module flat_numerics
