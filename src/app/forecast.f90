!> What a scene will take, before it is computed: memory for its matrices, and time.
module forecast
  use kinds, only: wp
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t
  use numerics_choice, only: choice_t, choose, companion
  use edge_locked, only: mesh_family_t, new_mesh_family
  use contact_scales, only: largest_radius, contact_level, smallest_feature, lost_in_rounding
  use h0_range, only: range_of
  use scene_problem, only: problem_of
  use h0_schedule, only: states_planned
  implicit none
  private
  public :: forecast_t, forecast_of

  type :: forecast_t
    !> Bytes of the matrices that are held at once, and [s], to a factor of three or so.
    real(wp) :: bytes = 0, seconds = 0
    !> Cases that are computed at once.
    integer :: copies = 1
    !> Equilibria of the h0-stepped branches of all cases, and nodes of the largest mesh.
    real(wp) :: states = 0
    integer :: nodes = 0
  end type forecast_t

  !> Measured on one core of a common machine: operations a second of products with a matrix and of
  !> factorisations, these of matrices of so many nodes or more (fewer: in proportion less); and
  !> what a state takes beside them [s].
  real(wp), parameter :: product_rate = 4.0e9_wp, factor_rate = 1.2e10_wp, large = 500, &
    overhead = 2.0e-5_wp
  !> Products and factorisations a state, jumps included, in steps of a tenth of the law's length or
  !> so, and in steps so fine (law's lengths) that a state is known before it is computed. Mixing's
  !> products may be a tenth of this or ten times it.
  real(wp), parameter :: products = 9, factors = 1, fine = 0.01_wp, fine_products = 1.5_wp, &
    fine_factors = 0.01_wp, newton_factors = 6.4_wp, mixed = 500
  !> The same where the path is known.
  real(wp), parameter :: known_products = 5, known_factors = 0.05_wp
  !> States of a path where adhesion is weak (sigma up to 1), and more for each factor of ten.
  real(wp), parameter :: of_path = 50, of_decade = 40
  !> Where a fixed grid does not resolve the neck, nodes being farther apart than so many widths of
  !> it, the contact edge goes from node to node: factorisations and products for each. From some
  !> strength of adhesion on (sigma) little converges, and it takes up to so many times as long. To
  !> estimate the error on more nodes takes as long again.
  real(wp), parameter :: resolved = 0.4_wp, of_node = 15, node_products = 30, hopeless = 1000, &
    hopeless_factor = 20
  !> What a run with matrices needs beside them.
  real(wp), parameter :: other_bytes = 1.0e7_wp
  !> Operations of a verified eigenvalue over the cube of the nodes, at the rate of factorisations,
  !> and the matrices that it needs.
  real(wp), parameter :: eigenvalue_work = 15, eigenvalue_matrices = 5

contains

  !> For a scene, whose sweep, if it has one, runs as many cases at once as there are threads.
  function forecast_of(scene, threads) result(expected)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: threads
    type(forecast_t) :: expected
    type(problem_t) :: problem
    type(choice_t) :: chosen
    real(wp) :: low, high, cases, entries
    logical :: locked, known

    if (.not. scene%finds_states()) return
    problem = problem_of(scene)
    if (problem%rigid) return
    call range_of(scene, problem, low, high)
    chosen = choose(scene%numerics, problem, low, allocated(scene%profiles))
    locked = chosen%grid == 'edge_locked'
    ! A cycle goes along the path too.
    known = locked .and. problem%law%adhesion > 0
    cases = 1
    if (allocated(scene%sweep)) then
      cases = size(scene%sweep%values)
      expected%copies = min(threads, size(scene%sweep%values))
    end if
    expected%states = cases*states_planned(scene)
    entries = 0
    if (allocated(scene%path) .or. locked) &
      call add_path(scene, problem, chosen, low, high, known, entries, expected)
    if (.not. locked) call add_fixed_grid(scene, chosen, entries, expected)
    if (allocated(scene%loading)) call add_cycle(scene, problem, chosen, low, known, expected)
    ! Of a contact that rounding hides nothing is computed.
    if (known) then
      if (lost_in_rounding(problem, largest_radius(problem, low, contact_level(problem)))) &
        expected%seconds = 0
    end if
    expected%seconds = expected%seconds*cases/expected%copies
    expected%bytes = other_bytes + 8*entries*expected%copies
  end function forecast_of

  !> Adds what the edge-locked meshes take and, where it is known or asked for, the path on them.
  subroutine add_path(scene, problem, chosen, low, high, known, entries, expected)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: low, high
    logical, intent(in) :: known
    real(wp), intent(inout) :: entries
    type(forecast_t), intent(inout) :: expected
    type(mesh_family_t) :: meshes
    real(wp) :: n

    meshes = new_mesh_family(problem, high, low, chosen%digits, shape_only=.true.)
    expected%nodes = maxval(meshes%grid%nodes)
    n = expected%nodes
    ! Both kernels, one factorisation and another for a fold, and about half as much
    ! again on the finer mesh of the error estimate, whose kernels are held beside them.
    entries = sum(real(meshes%grid%nodes, wp)**2) + 2*n**2
    entries = entries + 1.6_wp*(sum(real(meshes%grid%nodes, wp)**2) + n**2)
    if (scene%has_eigenvalues()) entries = entries + eigenvalue_matrices*n**2
    if (allocated(scene%path) .or. known) &
      expected%seconds = (of_path + of_decade*log10(max(problem%coupling*problem%law%adhesion, &
      1.0_wp)))*seconds_of(n, products, factors)
    if (allocated(scene%path)) &
      expected%seconds = expected%seconds + of_path*eigenvalue_seconds(scene, n)
  end subroutine add_path

  !> Adds the matrices of a mesh fixed in space.
  subroutine add_fixed_grid(scene, chosen, entries, expected)
    type(scene_t), intent(in) :: scene
    type(choice_t), intent(in) :: chosen
    real(wp), intent(inout) :: entries
    type(forecast_t), intent(inout) :: expected
    type(choice_t) :: other
    real(wp) :: matrices

    expected%nodes = max(expected%nodes, chosen%nodes)
    other = companion(chosen)
    ! The kernel, the factors in use, and those with which a jump is followed.
    matrices = 3
    if (chosen%options%method == 'mixing') matrices = 1
    if (scene%has_eigenvalues()) matrices = matrices + eigenvalue_matrices
    entries = max(entries, matrices*real(chosen%nodes, wp)**2 + 2*real(other%nodes, wp)**2)
  end subroutine add_fixed_grid

  !> Adds the time of a cycle in steps of h0.
  subroutine add_cycle(scene, problem, chosen, low, known, expected)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: low
    logical, intent(in) :: known
    type(forecast_t), intent(inout) :: expected
    type(choice_t) :: other
    real(wp) :: n, of_state

    n = merge(expected%nodes, chosen%nodes, chosen%grid == 'edge_locked')
    of_state = seconds_of(n, products, factors)
    if (known) of_state = seconds_of(n, known_products, known_factors)
    if (scene%loading%h0_step/problem%length < fine) &
      of_state = seconds_of(n, fine_products, fine_factors)
    if (chosen%options%method == 'newton') of_state = seconds_of(n, 0.0_wp, newton_factors)
    if (chosen%options%method == 'mixing') of_state = &
      seconds_of(n, min(mixed, real(chosen%options%most_iterations, wp)), 0.0_wp)
    expected%seconds = expected%seconds + &
      states_planned(scene)*(of_state + eigenvalue_seconds(scene, n))
    if (chosen%grid == 'edge_locked' .or. chosen%options%method == 'mixing') return
    other = companion(chosen)
    expected%seconds = expected%seconds + node_by_node(scene, problem, chosen, low)* &
      merge(2, 1, other%nodes > chosen%nodes)*seconds_of(n, node_products, of_node)
  end subroutine add_cycle

  !> Seconds for products with a matrix of n nodes and factorisations of it.
  pure real(wp) function seconds_of(n, products, factorisations) result(seconds)
    real(wp), intent(in) :: n, products, factorisations

    seconds = overhead + products*2*n**2/product_rate + &
      factorisations*n**3*2/3/(factor_rate*min(1.0_wp, max(n, 1.0_wp)/large))
  end function seconds_of

  !> How many times the contact edge goes from one node of a fixed grid to the next, on all branches
  !> of a scene down to H0 = low; 0 where the grid resolves the neck.
  real(wp) function node_by_node(scene, problem, chosen, low) result(times)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: low
    real(wp) :: widest, sigma

    times = 0
    widest = min(largest_radius(problem, low, contact_level(problem)), chosen%extent)
    if (chosen%extent/chosen%nodes <= resolved*smallest_feature(problem, widest)) return
    times = chosen%nodes*widest/chosen%extent
    if (allocated(scene%unloading)) times = times*(1 + size(scene%unloading%from))
    sigma = problem%coupling*problem%law%adhesion
    times = times*min(hopeless_factor, max(1.0_wp, (sigma/hopeless)**2))
  end function node_by_node

  !> Seconds for the eigenvalue of a state on n nodes.
  pure real(wp) function eigenvalue_seconds(scene, n) result(seconds)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: n

    seconds = 0
    if (scene%has_eigenvalues()) seconds = eigenvalue_work*n**3/factor_rate
  end function eigenvalue_seconds

end module forecast
