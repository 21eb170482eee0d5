!> From the traced path to the equilibrium at which what drives the bodies, h0 or another
!> combination D of h0 and load, has a wanted value: along the path every state converges, so that
!> the value is met by moving along it, however near a fold is.
module state_search
  use kinds, only: wp
  use root_finding, only: bracket_t, resolution
  use interpolation, only: hermite_t
  use contact_state, only: state_t
  use equilibrium, only: control_t, equations_t, holds, residual_floor, at_h0_with_edge
  use solver_options, only: solver_options_t
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use edge_locked, only: contact
  use path_tangent, only: tangent_t, of_h0
  use path_coordinate, only: coordinate_of
  use arc, only: arc_t, most_states
  use traced_path, only: traced_path_t, either_side
  implicit none
  private
  public :: neighbours_t, neighbours_of, coordinate_where, find_state, solve_at_h0

  !> How near to the wanted value a state has to be, relative or in the law's lengths: rounding
  !> leaves no more. What is that near to an end is the end.
  real(wp), parameter :: near_enough = 2.0e-13_wp
  !> The correction of the coordinate that is left under a load, which rounding shows in; and the
  !> one that may be left where a round was lost.
  real(wp), parameter :: found_at = 1.0e-12_wp, left_over = 1.0e-5_wp
  integer, parameter :: most_rounds = 30
  !> Change of the coordinate over which a state is the same one but for rounding.
  real(wp), parameter :: same_place = 1.0e-8_wp

  !> The arc about a piece of the path, and the coordinates of the piece's ends.
  type, extends(arc_t) :: neighbours_t
    real(wp) :: ends(2) = 0
  contains
    procedure :: curve_there
  end type neighbours_t

  !> The state nearest to the wanted one so far, and by how much its D is beyond.
  type :: nearest_t
    type(state_t) :: state
    type(tangent_t) :: tangent
    real(wp) :: s = 0, beyond = huge(1.0_wp)
  end type nearest_t

contains

  !> The points about the piece from point i of a path to the next, in order along it.
  pure function neighbours_of(path, i) result(near)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(neighbours_t) :: near
    integer :: j

    near%mesh = path%mesh_between(i)
    do j = max(1, i - either_side), min(path%held, i + 1 + either_side)
      call path%add_to(j, near)
      if (j == i .or. j == i + 1) near%ends(j + 1 - i) = near%coordinate(near%held)
    end do
  end function neighbours_of

  !> The polynomial that D is between the ends.
  pure type(hermite_t) function curve_there(self, weights) result(curve)
    class(neighbours_t), intent(in) :: self
    real(wp), intent(in) :: weights(2)

    curve = self%curve(weights, 0.5_wp*sum(self%ends))
  end function curve_there

  !> Where between two places a curve has a value: by Newton's method from `from` or a straight
  !> line's place, kept between them by halving. Outside them it is the nearer one.
  pure real(wp) function coordinate_where(curve, ends, wanted, from) result(s)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: ends(2), wanted
    real(wp), intent(in), optional :: from
    type(bracket_t) :: bracket
    real(wp) :: beyond(2), missing, before, value, slope, length
    logical :: rising

    beyond = [curve%value(ends(1)), curve%value(ends(2))] - wanted
    s = ends(minloc(abs(beyond), 1))
    if (.not. beyond(1)*beyond(2) < 0) return
    bracket = bracket_t(minval(ends), maxval(ends))
    length = bracket%high - bracket%low
    rising = (beyond(2) - beyond(1))*(ends(2) - ends(1)) > 0
    s = ends(1) + (ends(2) - ends(1))*beyond(1)/(beyond(1) - beyond(2))
    if (present(from)) s = from
    s = bracket%within(s)
    do while (bracket%is_open())
      call curve%evaluate(s, value, slope)
      missing = wanted - value
      call bracket%narrow((missing > 0) .eqv. rising, s)
      before = s
      ! At a fold there is none; longer steps than the piece end in its middle too.
      if (abs(missing) < length*abs(slope)) then
        s = bracket%within(s + missing/slope)
      else
        s = bracket%middle()
      end if
      if (abs(s - before) <= resolution(s)) exit
    end do
  end function coordinate_where

  !> The state between the ends at which D = weights(1) h0 + weights(2) load, which goes one way
  !> there, is `wanted`, with its tangent: the curve through the neighbours says where, the state
  !> there is solved and joins them, and so on; some rounds halve the piece where that gains little.
  !> s: its coordinate. Outside the piece, which is what rounding may ask for, it is the nearer end.
  subroutine find_state(equations, options, frozen, near, weights, wanted, s, state, tangent, found)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: weights(2), wanted
    real(wp), intent(out) :: s
    type(state_t), intent(out) :: state
    type(tangent_t), intent(out) :: tangent
    logical, intent(out) :: found
    type(nearest_t) :: nearest
    type(hermite_t) :: curve
    real(wp) :: beyond(2), width
    integer :: round, k, j
    logical :: solved, useful

    do k = 1, 2
      j = findloc(near%coordinate(:near%held), near%ends(k), 1)
      if (j > 0) then
        beyond(k) = beyond_of(near%state(j))
        call offer(near%state(j), near%tangent(j), near%ends(k))
      else
        curve = near%curve_there(weights)
        beyond(k) = curve%value(near%ends(k)) - wanted
      end if
    end do
    width = huge(1.0_wp)
    do round = 1, most_rounds
      if (abs(nearest%beyond) <= precision_of(nearest)) exit
      call choose_next(near, weights, wanted, beyond, round, width, s, useful)
      if (.not. useful) then
        if (abs(nearest%beyond) < huge(1.0_wp)) exit
        s = near%ends(minloc(abs(beyond), 1))
      end if
      call near%exact_state_at(equations, options, frozen, s, state, tangent, solved)
      if (.not. solved) exit
      call offer(state, tangent, s)
      k = merge(1, 2, beyond_of(state)*beyond(1) > 0)
      near%ends(k) = s
      beyond(k) = beyond_of(state)
      call join(near, s, state, tangent)
    end do
    found = abs(nearest%beyond) < huge(1.0_wp)
    if (.not. found) return
    s = nearest%s
    state = nearest%state
    tangent = nearest%tangent
    found = abs(nearest%beyond) <= max(precision_of(nearest), left_over*abs(tangent%of(weights)))

  contains

    pure real(wp) function beyond_of(state)
      type(state_t), intent(in) :: state

      beyond_of = dot_product(weights, [state%h0, state%load]) - wanted
    end function beyond_of

    !> Keeps a state if it is the nearest.
    subroutine offer(state, tangent, s)
      type(state_t), intent(in) :: state
      type(tangent_t), intent(in) :: tangent
      real(wp), intent(in) :: s

      if (.not. abs(beyond_of(state)) < abs(nearest%beyond)) return
      nearest%state = state
      nearest%tangent = tangent
      nearest%s = s
      nearest%beyond = beyond_of(state)
    end subroutine offer

    !> By how much D of a state may be beyond what is wanted.
    pure real(wp) function precision_of(near) result(least)
      type(nearest_t), intent(in) :: near

      associate (w => abs(weights))
        least = near_enough*(w(1)*max(1.0_wp, abs(near%state%h0)) + w(2)*abs(near%state%load))
        if (w(2) > 0 .and. abs(near%beyond) < huge(1.0_wp)) &
          least = max(least, found_at*abs(near%tangent%of(weights)))
      end associate
    end function precision_of

  end subroutine find_state

  !> Where on the piece the next state is to be solved, with the width of the piece in the round
  !> before, and by how much D is beyond what is wanted at its ends. useful = .false.: the value is
  !> not on the piece, or that has shrunk to nothing.
  pure subroutine choose_next(near, weights, wanted, beyond, round, width, s, useful)
    type(neighbours_t), intent(in) :: near
    real(wp), intent(in) :: weights(2), wanted, beyond(2)
    integer, intent(in) :: round
    real(wp), intent(inout) :: width
    real(wp), intent(out) :: s
    logical, intent(out) :: useful

    s = 0
    associate (at => near%ends)
      useful = beyond(1)*beyond(2) <= 0 .and. abs(at(2) - at(1)) > 4*resolution(maxval(abs(at)))
      if (.not. useful) return
      s = coordinate_where(near%curve_there(weights), at, wanted)
      ! Interpolation approaches from one side; halving brings the other end nearer.
      if (mod(round, 4) == 0 .and. abs(at(2) - at(1)) > 0.5_wp*width) s = 0.5_wp*(at(1) + at(2))
      width = abs(at(2) - at(1))
      useful = abs(s - at(1)) > 0 .and. abs(s - at(2)) > 0
    end associate
  end subroutine choose_next

  !> Adds a state that is now an end of the piece. The farthest neighbour makes room.
  subroutine join(near, s, state, tangent)
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: s
    type(state_t), intent(in) :: state
    type(tangent_t), intent(in) :: tangent

    if (near%held == most_states) then
      if (s - near%coordinate(1) > near%coordinate(near%held) - s) then
        call near%drop_first()
      else
        near%held = near%held - 1
      end if
    end if
    call near%add(s, state, tangent)
  end subroutine join

  !> The state at h0 between the ends of a piece, and its coordinate s.
  subroutine solve_at_h0(equations, options, near, h0, s, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: h0
    real(wp), intent(out) :: s
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged
    type(frozen_jacobian_t) :: frozen
    type(tangent_t) :: tangent

    call find_state(equations, options, frozen, near, of_h0, h0, s, state, tangent, converged)
    if (abs(state%h0 - h0) > max(options%tolerance, residual_floor(equations%problem, state))) &
      call finish_at_h0(equations, options, frozen, near%mesh, h0, s, state)
    ! What is left of the way is rounding; the equations at h0 itself are off by it.
    state%residual = max(state%residual, abs(state%h0 - h0))
    converged = holds(equations%problem, options%tolerance, state)
    state%h0 = h0
  end subroutine solve_at_h0

  !> Where the contact is wide and far from a fold, h0 changes by more than the tolerance with the
  !> last digit of the coordinate; there it can be prescribed.
  subroutine finish_at_h0(equations, options, frozen, mesh, h0, s, state)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    integer, intent(in) :: mesh
    real(wp), intent(in) :: h0, s
    type(state_t), intent(inout) :: state
    type(control_t) :: control
    type(state_t) :: trial
    logical :: arrived

    control%value = h0
    control%mesh = mesh
    if (mesh >= contact) control%kind = at_h0_with_edge
    trial = state
    call solve_anderson(equations, options, frozen, control, trial, arrived)
    if (arrived .and. abs(coordinate_of(equations%problem, mesh, trial) - s) < same_place) &
      state = trial
  end subroutine finish_at_h0

end module state_search
