!> From the traced path to the equilibrium at a wanted h0: along the path every state converges, so
!> that h0 is met by moving along it, however near a fold is.
module solve_at_h0
  use kinds, only: wp
  use interpolation, only: polynomial_value
  use root_finding, only: bracket_t
  use equilibrium, only: control_t, state_t, equations_t, holds, residual_floor, at_h0_with_edge
  use solver_options, only: solver_options_t, tightened
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use edge_locked, only: contact
  use continuation, only: arc_t, state_at, between, coordinate_of, most_states
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: neighbours_t, neighbours_of, coordinate_at_h0, guess_at_h0, solve_between

  !> How near to the wanted h0 a state has to be, relative or in the law's lengths: rounding leaves
  !> no more. What is that near to an end of the piece is the end.
  real(wp), parameter :: near_enough = 2.0e-13_wp
  integer, parameter :: most_rounds = 30
  !> Change of the coordinate over which a state is the same one but for rounding.
  real(wp), parameter :: same_place = 1.0e-8_wp

  !> The arc about a piece of the path: from the point numbered `lower` to the next, and one or two
  !> on either side.
  type, extends(arc_t) :: neighbours_t
    integer :: lower = 0
  end type neighbours_t

contains

  !> The points about the piece from point i of a path to the next, in order along it.
  pure function neighbours_of(path, i) result(near)
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(neighbours_t) :: near
    type(state_t) :: state
    real(wp) :: s
    integer :: j
    logical :: there

    near%mesh = path%mesh_between(i)
    do j = max(1, i - 1), min(path%held, i + 2)
      call path%seen_on(j, near%mesh, state, s, there)
      if (.not. there) cycle
      near%held = near%held + 1
      near%coordinate(near%held) = s
      near%state(near%held) = state
      if (j == i) near%lower = near%held
    end do
  end function neighbours_of

  !> Where between the ends of the piece the polynomial through the neighbours is at h0.
  pure real(wp) function coordinate_at_h0(near, h0) result(s)
    type(neighbours_t), intent(in) :: near
    real(wp), intent(in) :: h0
    type(bracket_t) :: bracket

    associate (n => near%held, k => near%lower)
      bracket = bracket_t(near%coordinate(k), near%coordinate(k + 1))
      do while (bracket%is_open())
        s = bracket%middle()
        call bracket%narrow((polynomial_value(near%coordinate(:n), near%state(:n)%h0, s) - h0)* &
          (near%state(k)%h0 - h0) > 0)
      end do
    end associate
    s = bracket%middle()
  end function coordinate_at_h0

  !> The state that the neighbours let expect at the coordinate s, on `nodes` nodes of their mesh.
  pure function guess_at_h0(equations, near, s, nodes) result(guess)
    type(equations_t), intent(in) :: equations
    type(neighbours_t), intent(in) :: near
    real(wp), intent(in) :: s
    integer, intent(in) :: nodes
    type(state_t) :: guess

    guess = between(equations%problem%shape, equations%pair%grid(near%mesh), &
      near%coordinate(:near%held), near%state(:near%held), s, nodes)
  end function guess_at_h0

  !> The state at h0 on the piece, on which h0 goes one way: the polynomial through the neighbours
  !> says where, the state there is solved and joins them, and so on; every other round halves the
  !> piece where that gains little. s: its coordinate. Outside the piece, which is what rounding may
  !> ask for, it is the nearer end.
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
    real(wp) :: width
    integer :: round, far, nodes
    logical :: inside

    state = near%state(near%lower)
    far = near%lower + 1
    if (abs(near%state(far)%h0 - h0) < abs(state%h0 - h0)) then
      state = near%state(far)
      far = near%lower
    end if
    nodes = size(state%gap)
    if (size(near%state(far)%gap) /= nodes) then
      ! More or fewer nodes beyond the edge move h0 by the error of the reach: beside a fold that is
      ! far, and the curve would have a step.
      call state_at(equations, tightened(options), frozen, near%arc_t, near%coordinate(far), &
        trial, converged, nodes)
      if (converged) near%state(far) = trial
    end if
    width = huge(1.0_wp)
    do round = 1, most_rounds
      if (abs(state%h0 - h0) <= near_enough*max(1.0_wp, abs(h0))) exit
      call choose_next(near, h0, round, width, s, inside)
      if (.not. inside) exit
      call state_at(equations, tightened(options), frozen, near%arc_t, s, trial, converged, nodes)
      if (.not. (converged .or. trial%residual <= options%tolerance)) exit
      if (abs(trial%h0 - h0) < abs(state%h0 - h0)) state = trial
      call join(near, s, trial, (trial%h0 - h0)*(near%state(near%lower)%h0 - h0) > 0)
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
        abs(at(2) - at(1)) > 4*spacing(maxval(abs(at)))
      if (.not. inside) return
      s = coordinate_at_h0(near, h0)
      ! Interpolation approaches from one side; halving brings the other end nearer.
      if (mod(round, 2) == 0 .and. abs(at(2) - at(1)) > 0.5_wp*width) s = 0.5_wp*(at(1) + at(2))
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
    if (mesh == contact) control%kind = at_h0_with_edge
    trial = state
    call solve_anderson(equations, options, frozen, control, trial, arrived)
    if (arrived .and. abs(coordinate_of(equations%problem, mesh, trial) - s) < same_place) &
      state = trial
  end subroutine finish_at_h0

  !> Adds a state inside the piece; with_lower: it takes the place of the piece's lower end, else of
  !> the upper. The farthest neighbour makes room.
  subroutine join(near, s, state, with_lower)
    type(neighbours_t), intent(inout) :: near
    real(wp), intent(in) :: s
    type(state_t), intent(in) :: state
    logical, intent(in) :: with_lower
    integer :: j

    if (near%held == most_states) then
      if (near%lower > most_states/2) then
        near%coordinate(:most_states - 1) = near%coordinate(2:)
        near%state(:most_states - 1) = near%state(2:)
        near%lower = near%lower - 1
      end if
      near%held = most_states - 1
    end if
    do j = near%held, near%lower + 1, -1
      near%coordinate(j + 1) = near%coordinate(j)
      near%state(j + 1) = near%state(j)
    end do
    near%held = near%held + 1
    near%coordinate(near%lower + 1) = s
    near%state(near%lower + 1) = state
    if (with_lower) near%lower = near%lower + 1
  end subroutine join

end module solve_at_h0
