!> Single equilibria of the path's curve: where a combination of h0 and load has a given value, or
!> is an extremum. The curve says about where; the state is solved there, and its exact value and
!> slopes correct the place until that is met.
module curve_states
  use kinds, only: wp
  use root_finding, only: bracket_t
  use contact_state, only: state_t, radius_of_gap
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use frozen_jacobian, only: frozen_jacobian_t
  use path_tangent, only: tangent_t
  use solve_at_h0, only: neighbours_t, neighbours_of
  use known_path, only: known_path_t
  use potential_energy, only: energy_of
  use undeformed, only: load_undeformed, load_slope_undeformed, energy_undeformed
  use path_curve, only: curve_t, no_mesh
  implicit none
  private
  public :: curve_state_t, curve_solver_t, place_t, reading_t, reading_of

  !> A place on a curve.
  type :: place_t
    integer :: interval = 0
    real(wp) :: x = 0
  end type place_t

  !> What is reported of an equilibrium, in the units of `dimensionless_problem`.
  type :: reading_t
    real(wp) :: h0 = 0, load = 0, displacement = 0, radius = 0
  end type reading_t

  !> A solved equilibrium at a place: h0, load, gap on the axis, energy in the units of
  !> `dimensionless_problem`, derivatives of h0 and load by x, modes unstable at fixed h0.
  !> radius: of the given gap, lateral units; what rounding leaves of the energy.
  type, extends(place_t) :: curve_state_t
    real(wp) :: h0 = 0, load = 0, axis_gap = 0, radius = 0, energy = 0, uncertainty = 0
    real(wp) :: slopes(2) = 0, residual = 0
    integer :: modes = 0
    logical :: converged = .false.
    !> Of a state that was looked for (`root_of`), whether it is where it should be.
    logical :: met = .false.
    !> Derivatives of what is reported of it by each parameter of &sensitivity
    !> (`place_sensitivity`).
    real(wp), allocatable :: rate(:, :)
    !> What is reported at the same place of a path on finer meshes (`reading_errors`).
    type(reading_t), allocatable :: fine
  end type curve_state_t

  !> A curve, and what solves states on it.
  type :: curve_solver_t
    type(curve_t) :: curve
    type(solver_options_t) :: options
    type(frozen_jacobian_t) :: frozen
    integer :: solved = 0
  contains
    procedure :: equilibrium_at
    procedure :: state_of
    procedure :: root_of
  end type curve_solver_t

  !> Corrections of a place, and the one (of x) below which it is found.
  integer, parameter :: most_corrections = 12
  real(wp), parameter :: found_at = 1.0e-12_wp
  !> The correction (of x) that rounding may leave where the path is nearly flat. Where a load that
  !> grows by orders of magnitude has no root, corrections are above 1e-3.
  real(wp), parameter :: left_over = 1.0e-5_wp
  !> Difference of x over which the polynomial's second derivative is taken.
  real(wp), parameter :: apart = 1.0e-4_wp

contains

  !> What is reported of a state.
  pure type(reading_t) function reading_of(state) result(reading)
    type(curve_state_t), intent(in) :: state

    reading = reading_t(state%h0, state%load, state%axis_gap - state%h0, state%radius)
  end function reading_of

  !> The equilibrium at a place that is on a mesh, with its tangent by the path's coordinate.
  subroutine equilibrium_at(self, equations, known, place, state, tangent, converged)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    class(place_t), intent(in) :: place
    type(state_t), intent(out) :: state
    type(tangent_t), intent(out) :: tangent
    logical, intent(out) :: converged
    type(neighbours_t) :: near

    associate (node => self%curve%begin_of(place%interval))
      near = neighbours_of(known%path, node%point)
    end associate
    call near%exact_state_at(equations, self%options, self%frozen, place%x, state, tangent, &
      converged)
    self%solved = self%solved + 1
  end subroutine equilibrium_at

  !> What is reported of the equilibrium at a place.
  subroutine state_of(self, equations, known, place, found)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    type(place_t), intent(in) :: place
    type(curve_state_t), intent(out) :: found
    type(state_t) :: state
    type(tangent_t) :: tangent

    found%interval = place%interval
    found%x = place%x
    associate (node => self%curve%begin_of(place%interval), problem => equations%problem)
      found%modes = self%curve%interval(place%interval)%modes
      if (node%mesh == no_mesh) then
        found%h0 = exp(-place%x)
        found%load = load_undeformed(problem, found%h0)
        found%axis_gap = found%h0
        found%energy = energy_undeformed(problem, found%h0)
        found%slopes = -found%h0*[1.0_wp, load_slope_undeformed(problem, found%h0)]
        found%converged = .true.
        return
      end if
      call self%equilibrium_at(equations, known, place, state, tangent, found%converged)
      found%h0 = state%h0
      found%load = state%load
      found%axis_gap = state%axis_gap
      found%residual = state%residual
      if (.not. found%converged) return
      found%radius = radius_of_gap(problem%shape, self%curve%contact_gap, &
        equations%meshes%grid(node%mesh), state)
      call energy_of(equations, node%mesh, state, found%energy, found%uncertainty)
      found%slopes = [tangent%h0, tangent%load]
    end associate
  end subroutine state_of

  !> The equilibrium in interval i between x = from and x = to at which weights(1) h0 + weights(2)
  !> load is `wanted` or, where that is absent, is an extremum. The curve has one between them;
  !> found%met: so has the path.
  subroutine root_of(self, equations, known, i, weights, from, to, found, wanted)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), from, to
    type(curve_state_t), intent(out) :: found
    real(wp), intent(in), optional :: wanted
    type(curve_state_t) :: trial
    type(bracket_t) :: bracket
    real(wp) :: x, missing, least, steepness
    integer :: round
    logical :: rising

    bracket = bracket_t(from, to)
    rising = on_curve(to) > on_curve(from)
    do while (bracket%is_open())
      call bracket%narrow((on_curve(bracket%middle()) < 0) .eqv. rising)
    end do
    x = bracket%middle()
    least = huge(1.0_wp)
    do round = 1, most_corrections
      call self%state_of(equations, known, place_t(i, x), trial)
      if (.not. trial%converged) exit
      missing = missing_of(trial)
      if (abs(missing) >= least) exit
      least = abs(missing)
      found = trial
      steepness = (on_curve(x + apart) - on_curve(x - apart))/(2*apart)
      if (present(wanted)) steepness = dot_product(weights, trial%slopes)
      if (.not. abs(steepness) > tiny(1.0_wp)) exit
      found%met = abs(missing/steepness) < left_over
      x = min(max(x - missing/steepness, min(from, to)), max(from, to))
      if (abs(x - trial%x) < found_at) exit
    end do
    found%modes = self%curve%interval(i)%modes

  contains

    pure real(wp) function on_curve(at)
      real(wp), intent(in) :: at

      if (present(wanted)) then
        on_curve = self%curve%value(i, weights, at) - wanted
      else
        on_curve = self%curve%slope(i, weights, at)
      end if
    end function on_curve

    pure real(wp) function missing_of(state)
      type(curve_state_t), intent(in) :: state

      if (present(wanted)) then
        missing_of = dot_product(weights, [state%h0, state%load]) - wanted
      else
        missing_of = dot_product(weights, state%slopes)
      end if
    end function missing_of

  end subroutine root_of

end module curve_states
