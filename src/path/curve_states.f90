!> Single equilibria of the path's curve: where a combination of h0 and load has a given value, or
!> turns round.
module curve_states
  use kinds, only: wp
  use root_finding, only: root_search_t, new_root_search
  use contact_state, only: state_t, radius_of_gap
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use frozen_jacobian, only: frozen_jacobian_t
  use path_tangent, only: tangent_t
  use state_search, only: neighbours_t, neighbours_of, find_state
  use path_extremum, only: extremum_t, find_extrema, may_turn
  use known_path, only: known_path_t
  use potential_energy, only: energy_of
  use undeformed, only: load_undeformed, load_slope_undeformed, energy_undeformed
  use path_curve, only: curve_t, no_mesh
  implicit none
  private
  public :: curve_state_t, curve_solver_t, place_t

  !> A place on a curve.
  type :: place_t
    integer :: interval = 0
    real(wp) :: x = 0
  end type place_t

  !> A solved equilibrium at a place: h0, load, gap on the axis, energy in the units of
  !> `dimensionless_problem`, derivatives of h0 and load by x, modes unstable at fixed h0.
  !> radius: of the given gap, lateral units; what rounding leaves of the energy.
  type, extends(place_t) :: curve_state_t
    real(wp) :: h0 = 0, load = 0, axis_gap = 0, radius = 0, energy = 0, uncertainty = 0
    real(wp) :: slopes(2) = 0, residual = 0
    integer :: modes = 0
    logical :: converged = .false.
    !> The equilibrium itself, if it is on a mesh.
    type(state_t) :: state
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
    procedure :: state_where
    procedure :: find_turns
    procedure, private :: tell
    procedure, private :: undeformed_turns
  end type curve_solver_t

  !> Parts of an interval of undeformed bodies at whose ends the slope is looked at.
  integer, parameter :: looks = 8

contains

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
    end associate
    call self%equilibrium_at(equations, known, place, state, tangent, found%converged)
    call self%tell(equations, place, state, tangent, found)
  end subroutine state_of

  !> What is reported of a state that is on a mesh.
  subroutine tell(self, equations, place, state, tangent, found)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(in) :: equations
    type(place_t), intent(in) :: place
    type(state_t), intent(in) :: state
    type(tangent_t), intent(in) :: tangent
    type(curve_state_t), intent(inout) :: found

    self%solved = self%solved + 1
    found%interval = place%interval
    found%x = place%x
    found%modes = self%curve%interval(place%interval)%modes
    found%h0 = state%h0
    found%load = state%load
    found%axis_gap = state%axis_gap
    found%residual = state%residual
    found%state = state
    if (.not. found%converged) return
    associate (node => self%curve%begin_of(place%interval))
      found%radius = radius_of_gap(equations%problem%shape, self%curve%contact_gap, &
        equations%meshes%grid(node%mesh), state)
      call energy_of(equations, node%mesh, state, found%energy, found%uncertainty)
    end associate
    found%slopes = [tangent%h0, tangent%load]
  end subroutine tell

  !> The equilibrium in interval i between x = from and x = to, where D = weights(1) h0 + weights(2)
  !> load goes one way, at which D is `wanted`.
  subroutine state_where(self, equations, known, i, weights, wanted, from, to, found)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), wanted, from, to
    type(curve_state_t), intent(out) :: found
    type(neighbours_t) :: near
    type(root_search_t) :: search
    type(state_t) :: state
    type(tangent_t) :: tangent
    real(wp) :: x

    associate (node => self%curve%begin_of(i))
      if (node%mesh == no_mesh) then
        search = new_root_search(from, beyond(from), to, beyond(to))
        do while (search%is_open())
          x = search%place()
          call search%note(x, beyond(x))
        end do
        call self%state_of(equations, known, place_t(i, search%root), found)
        return
      end if
      near = neighbours_of(known%path, node%point)
    end associate
    near%ends = [from, to]
    call find_state(equations, self%options, self%frozen, near, weights, wanted, x, state, &
      tangent, found%converged)
    call self%tell(equations, place_t(i, x), state, tangent, found)

  contains

    !> By how much D of undeformed bodies is beyond what is wanted.
    real(wp) function beyond(at)
      real(wp), intent(in) :: at

      beyond = dot_product(weights, [exp(-at), load_undeformed(equations%problem, exp(-at))]) - &
        wanted
    end function beyond

  end subroutine state_where

  !> The equilibria inside interval i at which D turns round, in order. solved = .false.: not all
  !> were solved.
  subroutine find_turns(self, equations, known, i, weights, turns, solved)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    type(curve_state_t), allocatable, intent(out) :: turns(:)
    logical, intent(out) :: solved
    type(neighbours_t) :: near
    type(extremum_t), allocatable :: extrema(:)
    integer :: k

    solved = .true.
    associate (begin => self%curve%begin_of(i), end => self%curve%end_of(i))
      if (begin%mesh == no_mesh) then
        turns = self%undeformed_turns(equations, known, i, weights)
        return
      end if
      allocate (turns(0))
      if (.not. may_turn(self%curve%polynomial(i, weights), [begin%x, end%x], &
        [dot_product(weights, [begin%h0_slope, begin%load_slope]), &
        dot_product(weights, [end%h0_slope, end%load_slope])])) return
      near = neighbours_of(known%path, begin%point)
    end associate
    call find_extrema(equations, self%options, near%arc_t, &
      findloc(near%coordinate(:near%held), near%ends(1), 1), weights, extrema, solved)
    solved = .not. solved
    deallocate (turns)
    allocate (turns(size(extrema)))
    do k = 1, size(extrema)
      turns(k)%converged = .true.
      call self%tell(equations, place_t(i, extrema(k)%coordinate), extrema(k)%state, &
        extrema(k)%tangent, turns(k))
    end do
  end subroutine find_turns

  !> The same of bodies that do not deform.
  function undeformed_turns(self, equations, known, i, weights) result(turns)
    class(curve_solver_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    type(curve_state_t), allocatable :: turns(:)
    type(curve_state_t) :: turn
    type(root_search_t) :: search
    real(wp) :: x(0:looks), at
    integer :: k

    allocate (turns(0))
    associate (begin => self%curve%begin_of(i), end => self%curve%end_of(i))
      x = [(begin%x + (end%x - begin%x)*k/looks, k=0, looks)]
    end associate
    do k = 1, looks
      if ((slope(x(k - 1)) < 0) .eqv. (slope(x(k)) < 0)) cycle
      search = new_root_search(x(k - 1), slope(x(k - 1)), x(k), slope(x(k)))
      do while (search%is_open())
        at = search%place()
        call search%note(at, slope(at))
      end do
      call self%state_of(equations, known, place_t(i, search%root), turn)
      turns = [turns, turn]
    end do

  contains

    !> The derivative of D by h0.
    real(wp) function slope(at)
      real(wp), intent(in) :: at

      slope = dot_product(weights, [1.0_wp, load_slope_undeformed(equations%problem, exp(-at))])
    end function slope

  end function undeformed_turns

end module curve_states
