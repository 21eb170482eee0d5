!> From the traced path to the equilibrium at a wanted h0: along the path every state converges, so
!> that h0 is met by moving along it, however near a fold is.
module solve_at_h0
  use kinds, only: wp
  use root_finding, only: bracket_t, resolution
  use interpolation, only: hermite_t
  use contact_state, only: state_t
  use equilibrium, only: control_t, equations_t, holds, residual_floor, at_h0_with_edge
  use solver_options, only: solver_options_t
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use edge_locked, only: contact
  use path_tangent, only: tangent_t
  use path_coordinate, only: coordinate_of
  use arc, only: arc_t, of_h0, most_states
  use traced_path, only: traced_path_t, either_side
  implicit none
  private
  public :: neighbours_t, neighbours_of, coordinate_at_h0, solve_between

  !> How near to the wanted h0 a state has to be, relative or in the law's lengths: rounding leaves
  !> no more. What is that near to an end of the piece is the end.
  real(wp), parameter :: near_enough = 2.0e-13_wp
  integer, parameter :: most_rounds = 30
  !> Change of the coordinate over which a state is the same one but for rounding.
  real(wp), parameter :: same_place = 1.0e-8_wp

  !> The arc about a piece of the path: from the state numbered `lower` to the next, with some on
  !> either side.
  type, extends(arc_t) :: neighbours_t
    integer :: lower = 0
  end type neighbours_t

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
      if (j == i) near%lower = near%held
    end do
  end function neighbours_of

  !> Where between the ends of the piece the curve that h0 is there has a value: by Newton's
  !> method from `from` or a straight line's place, kept between the ends by halving.
  pure real(wp) function coordinate_at_h0(near, curve, h0, from) result(s)
    type(neighbours_t), intent(in) :: near
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: h0
    real(wp), intent(in), optional :: from
    type(bracket_t) :: bracket
    real(wp) :: missing, before, value, slope, length
    logical :: rising

    associate (x => near%coordinate(near%lower:near%lower + 1), &
      ends => near%state(near%lower:near%lower + 1)%h0)
      bracket = bracket_t(minval(x), maxval(x))
      length = abs(x(2) - x(1))
      rising = (ends(2) - ends(1))*(x(2) - x(1)) > 0
      s = x(1) + (x(2) - x(1))*(h0 - ends(1))/(ends(2) - ends(1))
    end associate
    if (present(from)) s = from
    s = bracket%within(s)
    do while (bracket%is_open())
      call curve%evaluate(s, value, slope)
      missing = h0 - value
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
  end function coordinate_at_h0

  !> The state at h0 on the piece, on which h0 goes one way: the curve through the neighbours says
  !> where, the state there is solved and joins them, and so on; some rounds halve the piece where
  !> that gains little. s: its coordinate. Outside the piece, which is what rounding may ask for, it
  !> is the nearer end.
  subroutine solve_between(equations, options, near, h0, s, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: h0
    real(wp), intent(out) :: s
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged
    type(frozen_jacobian_t) :: frozen
    type(state_t) :: trial
    type(tangent_t) :: tangent
    real(wp) :: width
    integer :: round
    logical :: inside

    state = near%state(near%lower)
    associate (other => near%state(near%lower + 1))
      if (abs(other%h0 - h0) < abs(state%h0 - h0)) state = other
    end associate
    width = huge(1.0_wp)
    do round = 1, most_rounds
      if (abs(state%h0 - h0) <= near_enough*max(1.0_wp, abs(h0))) exit
      call choose_next(near, h0, round, width, s, inside)
      if (.not. inside) exit
      call near%exact_state_at(equations, options, frozen, s, trial, tangent, converged)
      if (.not. converged) exit
      if (abs(trial%h0 - h0) < abs(state%h0 - h0)) state = trial
      call join(near, s, trial, tangent, (trial%h0 - h0)*(near%state(near%lower)%h0 - h0) > 0)
    end do
    s = coordinate_of(equations%problem, near%mesh, state)
    associate (accepted => max(options%tolerance, residual_floor(equations%problem, state)))
      if (abs(state%h0 - h0) > accepted) &
        call finish_at_h0(equations, options, frozen, near%mesh, h0, s, state)
    end associate
    ! What is left of the way is rounding; the equations at h0 itself are off by it.
    state%residual = max(state%residual, abs(state%h0 - h0))
    converged = holds(equations%problem, options%tolerance, state)
    state%h0 = h0
  end subroutine solve_between

  !> Where on the piece the next state is to be solved, with the width of the piece in the round
  !> before. inside = .false.: h0 is not on the piece, or that has shrunk to nothing.
  pure subroutine choose_next(near, h0, round, width, s, inside)
    type(neighbours_t), intent(in) :: near
    real(wp), intent(in) :: h0
    integer, intent(in) :: round
    real(wp), intent(inout) :: width
    real(wp), intent(out) :: s
    logical, intent(out) :: inside

    s = 0
    associate (ends => near%state(near%lower:near%lower + 1)%h0, &
      at => near%coordinate(near%lower:near%lower + 1))
      inside = (ends(1) - h0)*(ends(2) - h0) <= 0 .and. &
        abs(at(2) - at(1)) > 4*resolution(maxval(abs(at)))
      if (.not. inside) return
      s = coordinate_at_h0(near, near%curve(of_h0, 0.5_wp*sum(at)), h0)
      ! Interpolation approaches from one side; halving brings the other end nearer.
      if (mod(round, 4) == 0 .and. abs(at(2) - at(1)) > 0.5_wp*width) s = 0.5_wp*(at(1) + at(2))
      width = abs(at(2) - at(1))
      inside = abs(s - at(1)) > 0 .and. abs(s - at(2)) > 0
    end associate
  end subroutine choose_next

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

  !> Adds a state inside the piece; with_lower: it takes the place of the piece's lower end, else of
  !> the upper. The farthest neighbour makes room.
  subroutine join(near, s, state, tangent, with_lower)
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: s
    type(state_t), intent(in) :: state
    type(tangent_t), intent(in) :: tangent
    logical, intent(in) :: with_lower

    if (near%held == most_states) then
      if (near%lower > most_states/2) then
        call near%drop_first()
        near%lower = near%lower - 1
      else
        near%held = near%held - 1
      end if
    end if
    call near%add(s, state, tangent)
    if (with_lower) near%lower = near%lower + 1
  end subroutine join

end module solve_at_h0
