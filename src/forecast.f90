!> What a scene will take, before it is computed: memory for its matrices, and time.
module forecast
  use kinds, only: wp
  use scene_groups, only: scene_t
  use problem, only: problem_t
  use choice, only: choice_t, choose, companion
  use edge_locked, only: mesh_pair_t, new_mesh_pair
  use experiment, only: problem_of, range_of
  use plans, only: states_planned
  implicit none
  private
  public :: forecast_t, forecast_of

  type :: forecast_t
    !> Bytes of the matrices that are held at once, and [s], to a factor of three or so.
    real(wp) :: bytes = 0, seconds = 0
    !> Equilibria of the h0-stepped branches of all cases, and nodes of the largest mesh.
    real(wp) :: states = 0
    integer :: nodes = 0
  end type forecast_t

  !> Measured on one core of a common machine: operations a second of products with a matrix and of
  !> factorisations; and what a state takes beside them [s].
  real(wp), parameter :: product_rate = 4.0e9_wp, factor_rate = 1.0e10_wp, overhead = 2.0e-5_wp
  !> Iterations a state, and states that a factorisation serves, in steps of the law's length or
  !> so, and in steps so fine (law's lengths) that a state is known before it is computed; the
  !> jumps, which take many, are few. Mixing's iterations a state may be a tenth of this or ten
  !> times it.
  real(wp), parameter :: iterations = 5, served = 8, fine = 0.01_wp, fine_iterations = 1.5_wp, &
    fine_served = 100, mixed = 500
  !> Operations of a verified eigenvalue over the cube of the nodes, at the rate of factorisations,
  !> and the matrices that it needs.
  real(wp), parameter :: eigenvalue_work = 6, eigenvalue_matrices = 2
  !> States of a path.
  real(wp), parameter :: of_path = 100

contains

  !> For a scene, whose sweep, if it has one, runs as many cases at once as there are threads.
  function forecast_of(scene, threads) result(expected)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: threads
    type(forecast_t) :: expected
    type(problem_t) :: problem
    type(choice_t) :: chosen, other
    type(mesh_pair_t) :: pair
    real(wp) :: low, high, of_state, square, cases, matrices, n
    integer :: copies

    if (.not. (allocated(scene%path) .or. allocated(scene%loading))) return
    problem = problem_of(scene)
    call range_of(scene, problem, low, high)
    chosen = choose(scene%numerics, problem, low)
    cases = 1
    copies = 1
    if (allocated(scene%sweep)) then
      cases = size(scene%sweep%values)
      copies = min(threads, size(scene%sweep%values))
    end if
    expected%states = cases*states_planned(scene)
    square = 0
    n = 0
    if (allocated(scene%path) .or. chosen%grid == 'edge_locked') then
      pair = new_mesh_pair(problem, high, low, chosen%resolution, shape_only=.true.)
      expected%nodes = maxval(pair%grid%nodes)
      n = expected%nodes
      ! Both kernels, one factorisation and another for a fold, and about half as much
      ! again on the finer mesh of the error estimate, whose kernels are held beside them.
      square = sum(real(pair%grid%nodes, wp)**2) + 2*n**2
      square = square + 1.6_wp*(sum(real(pair%grid%nodes, wp)**2) + n**2)
    end if
    if (has_eigenvalues(scene)) square = square + eigenvalue_matrices*n**2
    of_state = anderson_seconds(n, 1.0_wp) + eigenvalue_seconds(scene, n)
    if (allocated(scene%path)) expected%seconds = of_path*of_state
    if (chosen%grid /= 'edge_locked') then
      n = chosen%nodes
      expected%nodes = max(expected%nodes, chosen%nodes)
      other = companion(chosen)
      ! The kernel, the factors in use, and those with which a jump is followed.
      matrices = 3
      if (chosen%options%method == 'mixing') matrices = 1
      if (has_eigenvalues(scene)) matrices = matrices + eigenvalue_matrices
      square = max(square, matrices*n**2 + 2*real(other%nodes, wp)**2)
    end if
    if (allocated(scene%loading)) then
      of_state = anderson_seconds(n, scene%loading%h0_step/problem%length)
      if (chosen%options%method == 'mixing') of_state = overhead + &
        min(mixed, real(chosen%options%most_iterations, wp))*2*n**2/product_rate
      expected%seconds = expected%seconds + &
        states_planned(scene)*(of_state + eigenvalue_seconds(scene, n))
    end if
    expected%seconds = expected%seconds*cases/copies
    if (.not. problem%rigid) expected%bytes = 8*square*copies
  end function forecast_of

  !> Seconds for a state on n nodes by the accelerated iteration, in steps of h0 (law's lengths).
  pure real(wp) function anderson_seconds(n, step) result(seconds)
    real(wp), intent(in) :: n, step

    seconds = overhead + 4*n**2*merge(fine_iterations, iterations, step < fine)/product_rate + &
      n**3*2/3/merge(fine_served, served, step < fine)/factor_rate
  end function anderson_seconds

  !> Whether eigenvalues are computed: cases of a sweep leave none.
  pure logical function has_eigenvalues(scene)
    type(scene_t), intent(in) :: scene

    has_eigenvalues = allocated(scene%stability) .and. .not. allocated(scene%sweep)
  end function has_eigenvalues

  !> Seconds for the eigenvalue of a state on n nodes.
  pure real(wp) function eigenvalue_seconds(scene, n) result(seconds)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: n

    seconds = 0
    if (has_eigenvalues(scene)) seconds = eigenvalue_work*n**3/factor_rate
  end function eigenvalue_seconds

end module forecast
