!> The choice of grid, iteration and fineness from the accuracy, and its reason.
module numerics_choice
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use linear_mesh, only: new_uniform_grid, new_panel_grid, graded_ends
  use mesh_digits, only: digits_for
  use contact_scales, only: largest_radius, contact_level, smallest_feature
  use experiment_request, only: request_t, numerics_t
  use path_demand, only: range_of
  use solver_options, only: solver_options_t, newton_of, usual_tolerance
  implicit none
  private
  public :: choice_t, choose, size_grid, fixed_mesh, more_digits, with_fewer_nodes, with_less_extent
  public :: grid_names, unchosen, edge_locked, uniform, panels, comfortable

  !> The grids: none, for rigid bodies; panels locked to the contact edge; two grids that are fixed
  !> in space. Their names in results.
  integer, parameter :: unchosen = 0, no_grid = 1, edge_locked = 2, uniform = 3, panels = 4
  character(len=*), parameter :: grid_names(*) = [character(len=11) :: 'none', 'edge_locked', &
    'uniform', 'panels']

  type :: choice_t
    !> The range of H0 of the experiment, and where its path ends, law's lengths.
    real(wp) :: low = 0, high = 0, ends_at = 0
    integer :: grid = unchosen
    !> The name of the iteration in results, and the reason for the grid.
    character(len=:), allocatable :: method, because
    type(solver_options_t) :: options
    !> Digits of edge-locked meshes. The requested accuracy, or a smaller value in a run for
    !> comparison.
    real(wp) :: digits = 7, accuracy = 1.0e-6_wp
    !> For fixed grids: number of nodes and extent (lateral units), nodes of a panel, and the
    !> panel's size over the smallest feature.
    integer :: nodes = 0, panel_order = 12
    real(wp) :: extent = 0, panel_over_feature = 0.5_wp
  contains
    procedure :: is_fixed
  end type choice_t

  !> Spacing over the smallest feature at which a uniform grid resolves it, and the paper's range of
  !> the number of nodes, which limits the automatic choice.
  real(wp), parameter :: comfortable = 0.2_wp
  integer, parameter :: fewest = 200, most = 1500
  !> Additional digits of a finer run on edge-locked meshes. On a fixed grid a finer run would cost
  !> many times as much. There the runs for comparison are coarser: they have `part_of_nodes` of the
  !> nodes, or `part_of_extent` of the extent, which should still contain the contact.
  real(wp), parameter :: more_digits = 1.5_wp, part_of_nodes = 2/3.0_wp, part_of_extent = 5/6.0_wp
  !> The tolerance of residuals is `part_of_accuracy` times the accuracy, but at most the usual
  !> tolerance. Except for mixing and on uniform grids it is lowered to `small_part` times the
  !> accuracy, but not below `small_tolerance`.
  real(wp), parameter :: part_of_accuracy = 0.01_wp, small_part = 1.0e-4_wp, &
    small_tolerance = 1.0e-10_wp
  !> Depth of the accelerated mixing.
  integer, parameter :: mixing_depth = 10
  !> Error of the place of an extremum over the accuracy (the error of the load is a few times
  !> larger), and its largest value. Error of slopes over that of places.
  real(wp), parameter :: place_over_accuracy = 1.0e-5_wp, largest_place_error = 1.0e-7_wp, &
    slope_over_place = 0.1_wp
  !> Number of nodes of a panel on a grid that is fixed in space: a constant, the number to be added
  !> for each decade of accuracy, and the limits of their sum.
  real(wp), parameter :: panel_nodes = 4.6_wp, panel_nodes_of_decade = 0.8_wp
  integer, parameter :: fewest_on_panel = 6, most_on_panel = 16

contains

  !> The choice for an experiment. more: further digits, if the accuracy of the deck is not enough
  !> or a finer run is needed.
  type(choice_t) function choose(request, problem, more) result(chosen)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp), intent(in), optional :: more
    type(numerics_t) :: numerics

    call range_of(request, problem, chosen%low, chosen%high)
    chosen%ends_at = chosen%low
    if (allocated(request%path)) chosen%ends_at = problem%law%gap_of(request%path%h0_end)
    if (problem%rigid) then
      chosen%grid = no_grid
      chosen%method = 'integral'
      chosen%because = 'the bodies are rigid: their load is an integral over the gap'
      if (problem%shape%parabolic) chosen%because = &
        'the bodies are rigid: their load is 2 pi R times the energy per area at h0'
      return
    end if
    numerics = request%numerics
    chosen%accuracy = numerics%accuracy
    if (present(more)) then
      ! With more digits pressures are to be resolved better too, but under a law with kinks the
      ! number of nodes and of steps for this grows fast.
      chosen%accuracy = chosen%accuracy*10**(-0.5_wp*more)
      numerics%accuracy = numerics%accuracy*10**(-more)
    end if
    ! Only a cycle is computed by mixing, or on a grid that is fixed in space.
    if (.not. allocated(request%loading)) then
      numerics%grid = 'auto'
      if (mixes(numerics%method)) numerics%method = 'auto'
    end if
    chosen%method = numerics%method
    if (numerics%method == 'auto') chosen%method = 'anderson'
    chosen%options = options_of(numerics, problem)
    chosen%digits = digits_for(problem, largest_radius(problem, chosen%low, &
      contact_level(problem)), request%numerics%accuracy, allocated(request%profile_h0))
    if (present(more)) chosen%digits = chosen%digits + more
    if (numerics%grid == 'uniform') then
      chosen%grid = uniform
      chosen%because = 'the deck asks for it'
    else if (chosen%options%mixing .and. numerics%grid == 'panels') then
      chosen%grid = panels
      chosen%because = 'mixing needs a mesh that is fixed in space'
    else if (chosen%options%is_plain_mixing() .or. &
      (chosen%options%mixing .and. problem%law%adhesion > 0)) then
      chosen%grid = uniform
      chosen%because = 'it is the grid of the mixing iteration in the paper'
    else
      chosen%grid = edge_locked
      chosen%because = 'panels locked to the contact edge converge at any adhesion strength'
      if (.not. problem%law%adhesion > 0) &
        chosen%because = 'panels scaled with the contact converge spectrally'
    end if
    if (chosen%is_fixed()) call size_grid(chosen, numerics, problem)
  end function choose

  !> The options of the iteration.
  type(solver_options_t) function options_of(numerics, problem) result(options)
    type(numerics_t), intent(in) :: numerics
    type(problem_t), intent(in) :: problem

    options%mixing = mixes(numerics%method)
    options%tolerance = min(usual_tolerance, part_of_accuracy*numerics%accuracy)
    ! The residual at which an iteration stops, below its tolerance, depends on rounding, which
    ! changes loads by a thousandth of the tolerance. The lower tolerance moves this change beyond
    ! the requested digits, at the cost of a few products. For mixing the cost would be larger, and
    ! on uniform grids the error of the mesh is far larger.
    if (.not. options%mixing .and. numerics%grid /= 'uniform') &
      options%tolerance = min(options%tolerance, max(small_tolerance, &
      small_part*numerics%accuracy))
    if (allocated(numerics%residual_tolerance)) options%tolerance = numerics%residual_tolerance
    options%place_error = min(largest_place_error, max(options%place_error, &
      place_over_accuracy*numerics%accuracy))
    options%slope_error = max(options%slope_error, slope_over_place*options%place_error)
    if (numerics%method == 'anderson_mixing') options%mixing_depth = mixing_depth
    if (allocated(numerics%anderson_depth)) then
      options%depth = numerics%anderson_depth
      if (options%mixing_depth > 0) options%mixing_depth = numerics%anderson_depth
    end if
    options%mixing_limit = numerics%mixing_limit
    options%stop_on_change = options%is_plain_mixing() .and. &
      numerics%convergence == 'displacement_change'
    options%displacement_tolerance = numerics%displacement_tolerance/problem%length
    if (options%mixing) then
      options%most_iterations = numerics%max_iterations
    else
      options%most_iterations = min(numerics%max_iterations, options%most_iterations)
    end if
    if (numerics%method == 'newton') options = newton_of(options)
  end function options_of

  !> Whether a method is the paper's mixing, accelerated or not. It uses only products, and
  !> prescribes h0.
  pure logical function mixes(method)
    character(len=*), intent(in) :: method

    mixes = method == 'mixing' .or. method == 'anderson_mixing'
  end function mixes

  !> Chooses nodes and extent of a grid that is fixed in space.
  subroutine size_grid(chosen, numerics, problem)
    type(choice_t), intent(inout) :: chosen
    type(numerics_t), intent(in) :: numerics
    type(problem_t), intent(in) :: problem
    real(wp) :: widest, feature

    ! The number of nodes is chosen for the relative accuracy of load and displacement.
    chosen%panel_order = min(most_on_panel, max(fewest_on_panel, &
      nint(panel_nodes - panel_nodes_of_decade*log10(numerics%accuracy))))
    if (allocated(numerics%panel_order)) chosen%panel_order = numerics%panel_order
    widest = largest_radius(problem, chosen%low, contact_level(problem))
    feature = smallest_feature(problem, widest)
    chosen%extent = 1.5_wp*widest + 8
    if (allocated(numerics%r_max)) chosen%extent = numerics%r_max/problem%lateral
    ! The bounds are applied before the conversion: under strong adhesion the quotient exceeds any
    ! integer.
    chosen%nodes = ceiling(min(real(most, wp), max(real(fewest, wp), &
      chosen%extent/(comfortable*feature))))
    if (allocated(numerics%nodes)) chosen%nodes = numerics%nodes
  end subroutine size_grid

  !> Whether the grid is fixed in space.
  pure logical function is_fixed(self)
    class(choice_t), intent(in) :: self

    is_fixed = self%grid >= uniform
  end function is_fixed

  !> The mesh of a fixed grid: equal spacing, or equal panels up to the largest contact radius and
  !> panels of doubling size beyond.
  type(discretisation_t) function fixed_mesh(chosen, problem) result(mesh)
    type(choice_t), intent(in) :: chosen
    type(problem_t), intent(in) :: problem
    real(wp) :: widest, finest
    real(wp), allocatable :: outer(:)
    integer :: count, j

    if (chosen%grid == uniform) then
      mesh = new_uniform_grid(chosen%nodes, chosen%extent, elastic=.true.)
      return
    end if
    widest = min(largest_radius(problem, chosen%low, contact_level(problem)), chosen%extent)
    finest = chosen%panel_over_feature*smallest_feature(problem, widest)
    ! The panels have at most as many nodes as a uniform grid would have.
    count = ceiling(min(widest/finest, real(max(1, chosen%nodes/chosen%panel_order), wp)))
    finest = widest/count
    allocate (outer(0))
    if (widest < chosen%extent) outer = widest + graded_ends(chosen%extent - widest, finest, &
      chosen%extent)
    if (size(outer) == 0) outer = [widest]
    mesh = new_panel_grid(0.0_wp, [[(finest*j, j=0, count - 1)], outer], chosen%panel_order, &
      elastic=.true.)
  end function fixed_mesh

  !> A fixed grid of the same extent with fewer nodes, for the error of the spacing.
  pure type(choice_t) function with_fewer_nodes(chosen) result(other)
    type(choice_t), intent(in) :: chosen

    other = chosen
    other%nodes = max(2, nint(part_of_nodes*chosen%nodes))
    other%panel_over_feature = chosen%panel_over_feature/part_of_nodes
  end function with_fewer_nodes

  !> A fixed grid of the same spacing with a smaller extent, for the error of the extent.
  pure type(choice_t) function with_less_extent(chosen) result(other)
    type(choice_t), intent(in) :: chosen

    other = chosen
    other%nodes = max(2, nint(part_of_extent*chosen%nodes))
    other%extent = part_of_extent*chosen%extent
  end function with_less_extent

end module numerics_choice
