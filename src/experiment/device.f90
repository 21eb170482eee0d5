!> Bodies driven through a spring, or by a dead load, towards each other and apart again: along the
!> stable pieces of the equilibrium path, with a jump at the end of each to the next stable piece at
!> the same position of the drive; and the energy that is lost.
module device
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use solver, only: solver_t
  use path_tangent, only: of_h0
  use traced_path, only: traced_path_t
  use curve_states, only: path_state_t
  use driven_pieces, only: drive_t, driven_piece_t, jump_t, find_pieces, find_jump, piece_with, &
    state_driven
  implicit none
  private
  public :: driven_t, leg_t, states_on, drive_bodies

  !> A way along one stable piece, of this number in `driven_t`; jumps: from its end.
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    type(path_state_t) :: from, to
    logical :: jumps = .false.
  end type leg_t

  !> What a drive does to the bodies. Lost in all jumps, and over the cycle, the area between the
  !> ways in and out, by another route; NaN where they do not come back to where they began.
  type :: driven_t
    type(drive_t) :: drive
    !> As the deck has it [N/m]; infinite where h0 is prescribed.
    real(wp) :: stiffness = 0
    !> All that is stable, from afar inward.
    type(driven_piece_t), allocatable :: piece(:)
    type(leg_t), allocatable :: leg(:)
    type(jump_t), allocatable :: jump(:)
    real(wp) :: energy_lost = 0, cycle_energy = 0, uncertainty = 0
    !> Whether every state was solved, and every jump had an end.
    logical :: solved = .true., caught = .true.
  contains
    procedure :: area
  end type driven_t

contains

  !> Drives the bodies from afar, or from `start`, to `finish` or, where that is absent, to the
  !> innermost piece at h0_end, and back. Positions are those of the drive (`driven_pieces`).
  subroutine drive_bodies(solver, path, drive, h0_end, start, finish, driven)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0_end
    real(wp), allocatable, intent(in) :: start, finish
    type(driven_t), intent(out) :: driven
    !> Where the bodies are: the number of the piece, and the state.
    integer :: here, outermost
    type(path_state_t) :: state

    allocate (driven%leg(0), driven%jump(0))
    driven%drive = drive
    driven%energy_lost = ieee_value(1.0_wp, ieee_quiet_nan)
    driven%cycle_energy = driven%energy_lost
    call find_pieces(solver, path, drive, driven%piece, driven%solved)
    if (size(driven%piece) == 0) return
    outermost = 0
    if (allocated(start)) outermost = piece_with(driven%piece, drive, start, 0, .true.)
    here = max(outermost, 1)
    state = driven%piece(here)%first
    if (outermost > 0) call move_to(start)
    outermost = here
    call go(.true.)
    call go(.false.)
    driven%energy_lost = sum(driven%jump%energy)
    driven%uncertainty = sum(driven%jump%uncertainty)
    driven%caught = all(driven%jump%landed)
    if (here == outermost .and. driven%caught .and. driven%solved) &
      driven%cycle_energy = driven%area(path)

  contains

    !> Goes inward or outward over all jumps.
    subroutine go(inward)
      logical, intent(in) :: inward
      type(jump_t) :: jump
      type(leg_t) :: leg
      real(wp) :: stop_at
      logical :: stops

      do
        leg = leg_t(inward, here, state, state)
        call find_limit(inward, stop_at, stops)
        associate (piece => driven%piece(here))
          leg%jumps = .not. stops .and. merge(piece%last_turns, piece%first_turns, inward)
          if (stops) then
            call move_to(stop_at)
          else if (inward) then
            state = piece%last
          else
            state = piece%first
          end if
        end associate
        driven%solved = driven%solved .and. state%converged
        leg%to = state
        leg%jumps = leg%jumps .and. driven%solved
        driven%leg = [driven%leg, leg]
        if (.not. leg%jumps) return
        call find_jump(solver, path, drive, driven%piece, here, inward, jump)
        driven%solved = driven%solved .and. (jump%landed .or. jump%piece == 0)
        driven%jump = [driven%jump, jump]
        if (.not. jump%landed) return
        here = jump%piece
        state = jump%after
      end do
    end subroutine go

    !> Solves the state at a position on the present piece, and is there.
    subroutine move_to(position)
      real(wp), intent(in) :: position

      call state_driven(solver, path, drive, driven%piece(here), position, state)
      driven%solved = driven%solved .and. state%converged
    end subroutine move_to

    !> The position at which the way along the present piece ends; stops = .false.: at its end.
    subroutine find_limit(inward, at, stops)
      logical, intent(in) :: inward
      real(wp), intent(out) :: at
      logical, intent(out) :: stops
      type(path_state_t) :: there

      at = 0
      associate (piece => driven%piece(here))
        if (.not. inward) then
          stops = allocated(start)
          if (stops) at = start
          if (stops) stops = at <= drive%position(piece%first)
          return
        end if
        if (allocated(finish)) then
          at = finish
          stops = at >= drive%position(piece%last)
        else
          stops = here == size(driven%piece)
          if (.not. stops) return
          ! At h0_end or, where that is farther in, at the end of what is known.
          at = drive%position(piece%last)
          stops = .not. piece%last_turns
          if (h0_end <= piece%first%h0 .and. h0_end >= piece%last%h0) then
            call state_driven(solver, path, drive_t(of_h0), piece, h0_end, there)
            stops = stops .or. there%converged
            if (there%converged) at = max(at, drive%position(there))
          end if
        end if
        ! What lies behind already is here.
        if (stops) at = min(at, drive%position(state))
      end associate
    end subroutine find_limit

  end subroutine drive_bodies

  !> The states of a leg in its order: its ends, and the nodes of the path that it passes.
  pure function states_on(all_nodes, leg) result(states)
    type(path_state_t), intent(in) :: all_nodes(:)
    type(leg_t), intent(in) :: leg
    type(path_state_t), allocatable :: nodes(:), states(:)

    associate (first => min(leg%from%interval, leg%to%interval) + 1, &
      last => max(leg%from%interval, leg%to%interval))
      nodes = pack(all_nodes(first:last), .not. all_nodes(first:last)%again)
    end associate
    if (.not. leg%inward) nodes = nodes(size(nodes):1:-1)
    states = [leg%from, nodes, leg%to]
  end function states_on

  !> The energy put in along all legs: minus the integral of the conjugate over the position.
  pure real(wp) function area(self, path)
    class(driven_t), intent(in) :: self
    type(traced_path_t), intent(in) :: path
    integer :: i

    area = 0
    do i = 1, size(self%leg)
      associate (leg => self%leg(i))
        if (leg%inward) then
          area = area - self%drive%work_between(path, leg%from, leg%to)
        else
          area = area + self%drive%work_between(path, leg%to, leg%from)
        end if
      end associate
    end do
  end function area

end module device
