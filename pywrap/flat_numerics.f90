!> The numerics as f2py can see them: kernel, quadrature, product integration, meshes and one state
!> of equilibrium. Conventions as in `flat_deck`.
!>
!> A mesh is described by its kind, its centre, the ends of its panels as offsets from the centre,
!> and its order: 'panels' has `order` nodes on each; 'uniform' has one panel [0, extent] with
!> `order` nodes in all. Either way there are order*(m - 1) nodes, m being the number of ends.
module flat_numerics
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: kernel_values, gauss_rule, panel_integrals
  public :: mesh_nodes, mesh_matrix, mesh_interpolation
  public :: mapped_nodes, mapped_matrix, mapped_interpolation
  public :: equilibrium_state, edge_state

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

  !> Nodes of a mesh, the weights of integral f x dx, and the distance between nodes.
  subroutine mesh_nodes(kind, centre, panel_end, order, x, weight, spacing, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m
    real(c_double), intent(in) :: centre, panel_end(m)
    real(c_double), intent(out) :: x(order*(m - 1)), weight(order*(m - 1)), spacing
    type(discretisation_t) :: mesh

    call make_mesh(kind, centre, panel_end, order, .false., mesh)
    x = mesh%x
    weight = mesh%weight
    spacing = mesh%spacing
  end subroutine mesh_nodes

  !> The kernel's matrix: rows for the axis, for the mesh's centre, and for the nodes.
  subroutine mesh_matrix(kind, centre, panel_end, order, matrix, m)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m
    real(c_double), intent(in) :: centre, panel_end(m)
    real(c_double), intent(out) :: matrix(order*(m - 1) + 2, order*(m - 1))
    type(discretisation_t) :: mesh

    call make_mesh(kind, centre, panel_end, order, .true., mesh)
    matrix = mesh%kernel
  end subroutine mesh_matrix

  !> Values at positions `at` within a mesh of the function with the given values at its nodes.
  subroutine mesh_interpolation(kind, centre, panel_end, order, values, at, found, m, n)
    use discretisation, only: discretisation_t
    character(len=*), intent(in) :: kind
    integer(c_int), intent(in) :: order, m, n
    real(c_double), intent(in) :: centre, panel_end(m), values(order*(m - 1)), at(n)
    real(c_double), intent(out) :: found(n)
    type(discretisation_t) :: mesh
    integer :: i

    call make_mesh(kind, centre, panel_end, order, .false., mesh)
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
  subroutine mapped_interpolation(centre, d, inner, order, z_length, tail_order, values, at, &
    found, panels, nodes, n)
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

  !> One state of a deck's law at a prescribed H0 and coupling, in the units of
  !> `dimensionless_problem`, on a mesh enlarged `scale` times, from the gaps `start`.
  !> stop_on_change: 0 or 1. numbers: gap on the axis, load, residual. counts: converged (0 or 1),
  !> operator products, factorisations, rejected steps. A state that did not converge is not a
  !> failure; its residual says how far it is from equilibrium.
  subroutine equilibrium_state(deck, coupling, kind, centre, panel_end, order, scale, h0, start, &
    method, tolerance, most_iterations, depth, patience, mixing_limit, stop_on_change, &
    displacement_tolerance, gap, pressure, numbers, counts, stat, message, m)
    use deck_problem, only: pose
    use equilibrium, only: control_t, state_t, at_h0, state_from
    use solver, only: solver_t
    use solver_options, only: solver_options_t
    character(len=*), intent(in) :: deck, kind, method
    integer(c_int), intent(in) :: order, most_iterations, depth, patience, stop_on_change, m
    real(c_double), intent(in) :: coupling, centre, panel_end(m), scale, h0
    real(c_double), intent(in) :: start(order*(m - 1))
    real(c_double), intent(in) :: tolerance, mixing_limit, displacement_tolerance
    real(c_double), intent(out) :: gap(order*(m - 1)), pressure(order*(m - 1)), numbers(3)
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
    this%problem%rigid = .not. coupling > 0
    allocate (this%meshes%grid(1))
    call make_mesh(kind, centre, panel_end, order, coupling > 0, this%meshes%grid(1))
    this%options = solver_options_t(method=method, tolerance=tolerance, depth=depth, &
      patience=patience, most_iterations=most_iterations, mixing_limit=mixing_limit, &
      stop_on_change=stop_on_change /= 0, displacement_tolerance=displacement_tolerance)
    state = state_from(this%meshes%grid(1)%nodes)
    state%gap = start
    call this%solve(control_t(kind=at_h0, value=h0, scale=scale), state, met)
    gap = state%gap
    pressure = state%pressure
    numbers = [state%axis_gap, state%load, state%residual]
    counts = int([merge(1, 0, met), int(this%cost%operator_products), &
      int(this%cost%factorisations), int(this%cost%rejected_steps)], c_int)
  end subroutine equilibrium_state

  !> The state of a deck's problem with the contact radius c (lateral units) on panels locked to the
  !> edge, from the gaps of bodies that do not deform. numbers: H0 and load, and their derivatives
  !> by c. stat is not 0 where the deck is wrong or nothing converged.
  subroutine edge_state(deck, panel_end, order, c, numbers, stat, message, m)
    use deck_problem, only: pose
    use equilibrium, only: control_t, state_t, at_edge_radius, state_from
    use path_slopes, only: slopes_along_path
    use solver, only: solver_t
    use solver_options, only: solver_options_t
    character(len=*), intent(in) :: deck
    integer(c_int), intent(in) :: order, m
    real(c_double), intent(in) :: panel_end(m), c
    real(c_double), intent(out) :: numbers(4)
    integer(c_int), intent(out) :: stat
    character(len=16000), intent(out) :: message
    type(solver_t) :: this
    type(control_t) :: control
    type(state_t) :: state
    logical :: met, found

    numbers = 0
    call pose(deck, this%problem, stat, message)
    if (stat /= 0) return
    allocate (this%meshes%grid(1))
    call make_mesh('panels', 1.0_c_double, panel_end, order, .true., this%meshes%grid(1))
    this%options = solver_options_t(method='newton', tolerance=1.0e-12_c_double)
    control = control_t(kind=at_edge_radius, value=c)
    associate (problem => this%problem, grid => this%meshes%grid(1))
      state = state_from(grid%nodes)
      state%h0 = problem%law%edge_gap - problem%shape%height(c)
      state%gap = state%h0 + problem%shape%height(c*grid%x(:grid%nodes))
      state%scale = c
    end associate
    call this%solve(control, state, met)
    call slopes_along_path(this%equations_t, control, state, this%frozen, numbers(3), numbers(4), &
      found)
    numbers(:2) = [state%h0, state%load]
    stat = merge(0, 1, met .and. found)
    if (stat /= 0) message = 'no state was found'
  end subroutine edge_state

  !> The mesh of this description.
  subroutine make_mesh(kind, centre, panel_end, order, elastic, mesh)
    use discretisation, only: discretisation_t
    use panels, only: new_panel_grid
    use uniform_grid, only: new_uniform_grid
    character(len=*), intent(in) :: kind
    real(c_double), intent(in) :: centre, panel_end(:)
    integer(c_int), intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t), intent(out) :: mesh

    if (kind == 'uniform') then
      mesh = new_uniform_grid(order, panel_end(size(panel_end)), elastic)
    else
      mesh = new_panel_grid(centre, panel_end, order, elastic)
    end if
  end subroutine make_mesh

end module flat_numerics
