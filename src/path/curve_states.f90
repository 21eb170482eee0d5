!> Single equilibria of the path: at a place, or where Q = weights(1) h0 + weights(2) load has a
!> given value or an extremum. They are on the path's meshes or, farther out, those of undeformed
!> bodies.
module curve_states
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use interpolation, only: hermite_t
  use root_finding, only: root_search_t, new_root_search
  use contact_state, only: state_t, contact_radius_of
  use solver, only: solver_t
  use path_tangent, only: tangent_t
  use path_extrema, only: find_extrema, may_turn
  use path_search, only: found_t, find_place
  use traced_path, only: traced_path_t
  use path_state, only: path_state_t, path_place_t, no_mesh
  use path_span, only: path_span_t, new_path_span
  use potential_energy, only: energy_of
  use undeformed, only: load_undeformed, load_slope_undeformed, energy_undeformed
  implicit none
  private
  public :: states_of_points, state_of, state_where, states_where, find_turns

  !> Parts of an interval of undeformed bodies at whose ends the slope is evaluated.
  integer, parameter :: looks = 8

contains

  !> The reported values at the points of a path, up to the end of its last stable piece. At a fold
  !> the number of modes is that of the more unstable side.
  function states_of_points(solver, path) result(states)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(path_state_t), allocatable :: states(:)
    integer :: i

    allocate (states(path%last))
    do i = 1, path%last
      call state_of(solver, path, path_place_t(i, path%point(i)%coordinate), states(i))
      states(i)%modes = path%modes_at(i)
      states(i)%again = .not. (path%point(i)%leads_on .or. i == path%last)
    end do
  end function states_of_points

  !> The equilibrium at a place on a mesh, with its tangent by the path's coordinate.
  subroutine equilibrium_at(solver, path, place, state, tangent, converged)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    class(path_place_t), intent(in) :: place
    type(state_t), intent(out) :: state
    type(tangent_t), intent(out) :: tangent
    logical, intent(out) :: converged
    type(path_span_t) :: span
    integer :: i

    do i = place%interval, min(place%interval + 1, path%held)
      associate (point => path%point(i))
        converged = abs(point%coordinate - place%x) <= 0
        if (.not. converged) cycle
        state = point%state
        tangent = point%tangent
        return
      end associate
    end do
    span = new_path_span(path, place%interval)
    call span%state_at(solver, place%x, state, tangent, converged)
  end subroutine equilibrium_at

  !> The reported values of the equilibrium at a place.
  subroutine state_of(solver, path, place, found)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(path_place_t), intent(in) :: place
    type(path_state_t), intent(out) :: found
    type(state_t) :: state
    type(tangent_t) :: tangent
    logical :: converged

    if (path%point(place%interval)%mesh == no_mesh) then
      found = undeformed_at(solver%problem, place)
    else
      call equilibrium_at(solver, path, place, state, tangent, converged)
      found = told(solver, path, place, state, tangent, converged)
    end if
  end subroutine state_of

  !> The reported values of undeformed bodies at a place.
  pure type(path_state_t) function undeformed_at(problem, place) result(state)
    type(problem_t), intent(in) :: problem
    type(path_place_t), intent(in) :: place

    state%interval = place%interval
    state%x = place%x
    state%h0 = exp(-place%x)
    state%load = load_undeformed(problem, state%h0)
    state%axis_gap = state%h0
    state%energy = energy_undeformed(problem, state%h0)
    state%slopes = -state%h0*[1.0_wp, load_slope_undeformed(problem, state%h0)]
    state%converged = .true.
  end function undeformed_at

  !> The reported values of a state on a mesh.
  type(path_state_t) function told(solver, path, place, state, tangent, converged) result(found)
    class(solver_t), intent(in) :: solver
    type(traced_path_t), intent(in) :: path
    type(path_place_t), intent(in) :: place
    type(state_t), intent(in) :: state
    type(tangent_t), intent(in) :: tangent
    logical, intent(in) :: converged

    found%interval = place%interval
    found%x = place%x
    found%modes = path%point(place%interval)%modes
    found%mesh = path%point(place%interval)%mesh
    found%converged = converged
    if (.not. converged) return
    found%state = state
    found%h0 = state%h0
    found%load = state%load
    found%axis_gap = state%axis_gap
    found%residual = state%residual
    found%slopes = [tangent%h0, tangent%load]
    found%radius = contact_radius_of(solver%problem, solver%meshes%grid(found%mesh), state)
    call energy_of(solver%equations_t, found%mesh, state, found%energy, found%uncertainty)
  end function told

  !> The equilibrium with Q = `wanted` in interval i between x = from and x = to, where Q is
  !> monotonic.
  subroutine state_where(solver, path, i, weights, wanted, from, to, state)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), wanted, from, to
    type(path_state_t), intent(out) :: state
    type(path_span_t) :: span
    type(found_t) :: found
    type(root_search_t) :: search
    real(wp) :: x
    logical :: done

    if (path%point(i)%mesh == no_mesh) then
      search = new_root_search(from, beyond(from), to, beyond(to))
      do while (search%is_open())
        x = search%place()
        call search%note(x, beyond(x))
      end do
      state = undeformed_at(solver%problem, path_place_t(i, search%root))
      return
    end if
    span = new_path_span(path, i)
    call find_place(solver, span%arc_t, [from, to], weights, found, done, wanted)
    state = told(solver, path, path_place_t(i, found%coordinate), found%state, found%tangent, done)

  contains

    !> Q of undeformed bodies minus the given value.
    real(wp) function beyond(at)
      real(wp), intent(in) :: at

      beyond = dot_product(weights, [exp(-at), load_undeformed(solver%problem, exp(-at))]) - wanted
    end function beyond

  end subroutine state_where

  !> All equilibria with Q = `wanted`, stable and unstable, from large separations inward. solved =
  !> .false.: a state was not solved.
  subroutine states_where(solver, path, weights, wanted, states, solved)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    real(wp), intent(in) :: weights(2), wanted
    type(path_state_t), allocatable, intent(out) :: states(:)
    logical, intent(out) :: solved
    type(path_state_t) :: found
    type(path_state_t), allocatable :: turns(:)
    real(wp), allocatable :: x(:), beyond(:)
    integer :: i, k
    logical :: all_turns

    allocate (states(0))
    solved = .true.
    do i = 1, path%last - 1
      if (.not. path%point(i)%leads_on) cycle
      call find_turns(solver, path, i, weights, turns, all_turns)
      solved = solved .and. all_turns
      associate (ends => path%point(i:i + 1))
        x = [ends(1)%coordinate, turns%x, ends(2)%coordinate]
        beyond = weights(1)*[ends(1)%state%h0, turns%h0, ends(2)%state%h0] + &
          weights(2)*[ends(1)%state%load, turns%load, ends(2)%state%load] - wanted
      end associate
      do k = 1, size(x) - 1
        if ((beyond(k) < 0) .eqv. (beyond(k + 1) < 0)) cycle
        ! Far out a load underflows to zero, which is no equilibrium without load.
        if (path%point(i)%mesh == no_mesh .and. .not. abs(beyond(k)) > 0) cycle
        call state_where(solver, path, i, weights, wanted, x(k), x(k + 1), found)
        solved = solved .and. found%converged
        if (found%converged) states = [states, found]
      end do
    end do
  end subroutine states_where

  !> The extrema of Q inside interval i, in order. solved = .false.: a state was not solved.
  subroutine find_turns(solver, path, i, weights, turns, solved)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    type(path_state_t), allocatable, intent(out) :: turns(:)
    logical, intent(out) :: solved
    type(path_span_t) :: span
    type(found_t), allocatable :: extrema(:)
    type(hermite_t) :: curve
    real(wp) :: ends(2)
    integer :: k
    logical :: lost

    solved = .true.
    call path%curve_between(i, weights, curve, ends)
    if (path%point(i)%mesh == no_mesh) then
      turns = undeformed_turns(solver%problem, i, ends, weights)
      return
    end if
    allocate (turns(0))
    if (.not. may_turn(curve, ends)) return
    span = new_path_span(path, i)
    call find_extrema(solver, span%arc_t, span%ends, weights, extrema, lost)
    solved = .not. lost
    deallocate (turns)
    allocate (turns(size(extrema)))
    do k = 1, size(extrema)
      turns(k) = told(solver, path, path_place_t(i, extrema(k)%coordinate), extrema(k)%state, &
        extrema(k)%tangent, .true.)
    end do
  end subroutine find_turns

  !> The extrema of Q for undeformed bodies between the coordinates `ends`.
  function undeformed_turns(problem, i, ends, weights) result(turns)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: i
    real(wp), intent(in) :: ends(2), weights(2)
    type(path_state_t), allocatable :: turns(:)
    type(path_state_t) :: turn
    type(root_search_t) :: search
    real(wp) :: x(0:looks), at
    integer :: k

    allocate (turns(0))
    x = [(ends(1) + (ends(2) - ends(1))*k/looks, k=0, looks)]
    do k = 1, looks
      if ((slope(x(k - 1)) < 0) .eqv. (slope(x(k)) < 0)) cycle
      search = new_root_search(x(k - 1), slope(x(k - 1)), x(k), slope(x(k)))
      do while (search%is_open())
        at = search%place()
        call search%note(at, slope(at))
      end do
      turn = undeformed_at(problem, path_place_t(i, search%root))
      turns = [turns, turn]
    end do

  contains

    !> The derivative of Q by h0.
    real(wp) function slope(at)
      real(wp), intent(in) :: at

      slope = dot_product(weights, [1.0_wp, load_slope_undeformed(problem, exp(-at))])
    end function slope

  end function undeformed_turns

end module curve_states
