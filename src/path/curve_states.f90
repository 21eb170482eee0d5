!> Solves single equilibria of the path: at a given coordinate, or where Q = weights(1) h0 +
!> weights(2) load has a given value or an extremum. They are solved on the meshes of the path;
!> farther out they are states of undeformed bodies. Their contact radii and energies are computed
!> too.
module curve_states
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use interpolation, only: hermite_t
  use root_finding, only: root_search_t, new_root_search
  use contact_state, only: contact_radius_of
  use solver, only: solver_t
  use path_extrema, only: find_extrema, may_turn
  use path_search, only: find_place
  use path_point, only: path_point_t, no_mesh
  use traced_path, only: traced_path_t, undeformed_at
  use path_span, only: path_span_t, new_path_span
  use potential_energy, only: energy_of
  use undeformed, only: load_undeformed, load_slope_undeformed, energy_undeformed
  implicit none
  private
  public :: read_points, solve_at, state_where, states_where, find_turns

  !> Number of parts of an interval of undeformed bodies; the slope is evaluated at the ends of each
  !> part.
  integer, parameter :: looks = 8

contains

  !> The points of a path, up to the end of its last stable piece, with contact radii and energies.
  !> At a fold the number of unstable modes is that of the more unstable side.
  function read_points(solver, path) result(points)
    class(solver_t), intent(in) :: solver
    type(traced_path_t), intent(in) :: path
    type(path_point_t), allocatable :: points(:)
    integer :: i

    points = path%point(:path%last)
    do i = 1, path%last
      if (points(i)%mesh == no_mesh) then
        points(i)%energy = energy_undeformed(solver%problem, points(i)%state%h0)
      else
        call read_state(solver, points(i))
      end if
      points(i)%interval = i
      points(i)%modes = path%modes_at(i)
    end do
  end function read_points

  !> The equilibrium at the coordinate x after point i, with its contact radius and energy.
  subroutine solve_at(solver, path, i, x, found)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: x
    type(path_point_t), intent(out) :: found
    type(path_span_t) :: span
    logical :: converged
    integer :: k

    if (path%point(i)%mesh == no_mesh) then
      found = undeformed_after(solver%problem, i, x)
      return
    end if
    do k = i, min(i + 1, path%held)
      if (abs(path%point(k)%coordinate - x) > 0) cycle
      found = path%point(k)
      call finish(solver, path, i, .true., found)
      return
    end do
    span = new_path_span(path, i)
    call span%solve_at(solver, x, found, converged)
    call finish(solver, path, i, converged, found)
  end subroutine solve_at

  !> The state of undeformed bodies at the coordinate x after point i, with its energy.
  pure type(path_point_t) function undeformed_after(problem, i, x) result(point)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: i
    real(wp), intent(in) :: x

    point = undeformed_at(problem, exp(-x))
    point%interval = i
    point%coordinate = x
    point%energy = energy_undeformed(problem, exp(-x))
  end function undeformed_after

  !> Completes an equilibrium after point i that was solved on a mesh.
  subroutine finish(solver, path, i, converged, point)
    class(solver_t), intent(in) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    logical, intent(in) :: converged
    type(path_point_t), intent(inout) :: point

    point%interval = i
    point%modes = path%point(i)%modes
    point%converged = converged
    if (converged) call read_state(solver, point)
  end subroutine finish

  !> Computes the contact radius and the energy of a point on a mesh.
  subroutine read_state(solver, point)
    class(solver_t), intent(in) :: solver
    type(path_point_t), intent(inout) :: point

    point%radius = contact_radius_of(solver%problem, solver%meshes%grid(point%mesh), point%state)
    call energy_of(solver%equations_t, point%mesh, point%state, point%energy, point%uncertainty)
  end subroutine read_state

  !> The equilibrium with Q = `wanted` in interval i between x = from and x = to, where Q is
  !> monotonic.
  subroutine state_where(solver, path, i, weights, wanted, from, to, found)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2), wanted, from, to
    type(path_point_t), intent(out) :: found
    type(path_span_t) :: span
    type(root_search_t) :: search
    real(wp) :: x
    logical :: done

    if (path%point(i)%mesh == no_mesh) then
      search = new_root_search(from, beyond(from), to, beyond(to))
      do while (search%is_open())
        x = search%place()
        call search%note(x, beyond(x))
      end do
      found = undeformed_after(solver%problem, i, search%root)
      return
    end if
    span = new_path_span(path, i)
    call find_place(solver, span%arc_t, [from, to], weights, found, done, wanted)
    call finish(solver, path, i, done, found)

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
    type(path_point_t), allocatable, intent(out) :: states(:)
    logical, intent(out) :: solved
    type(path_point_t) :: found
    type(path_point_t), allocatable :: turns(:)
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
        x = [ends(1)%coordinate, turns%coordinate, ends(2)%coordinate]
        beyond = weights(1)*[ends(1)%state%h0, turns%state%h0, ends(2)%state%h0] + &
          weights(2)*[ends(1)%state%load, turns%state%load, ends(2)%state%load] - wanted
      end associate
      do k = 1, size(x) - 1
        if ((beyond(k) < 0) .eqv. (beyond(k + 1) < 0)) cycle
        ! Far out the load underflows to zero; such a state does not count as one without load.
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
    type(path_point_t), allocatable, intent(out) :: turns(:)
    logical, intent(out) :: solved
    type(path_span_t) :: span
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
    call find_extrema(solver, span%arc_t, span%ends, weights, turns, lost)
    solved = .not. lost
    do k = 1, size(turns)
      call finish(solver, path, i, .true., turns(k))
    end do
  end subroutine find_turns

  !> The extrema of Q for undeformed bodies between the coordinates `ends`.
  function undeformed_turns(problem, i, ends, weights) result(turns)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: i
    real(wp), intent(in) :: ends(2), weights(2)
    type(path_point_t), allocatable :: turns(:)
    type(path_point_t) :: turn
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
      turn = undeformed_after(problem, i, search%root)
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
