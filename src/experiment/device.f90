!> Bodies that a spring or a dead load drives towards each other and apart again: along the stable
!> pieces of the equilibrium path, with a jump from the end of each piece to the next stable piece
!> at the same position of the drive; and the energy that is dissipated.
module device
  use kinds, only: wp, nan
  use solver, only: solver_t
  use path_tangent, only: of_h0
  use traced_path, only: traced_path_t
  use curve_states, only: path_state_t
  use driven_pieces, only: drive_t, driven_piece_t, jump_t, find_pieces, find_jump, piece_with, &
    state_driven
  implicit none
  private
  public :: driven_t, leg_t, states_on, drive_bodies

  !> The motion along one stable piece; piece: its index in `driven_t`; jumps: a jump follows.
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    type(path_state_t) :: from, to
    logical :: jumps = .false.
  end type leg_t

  !> The motion of bodies under a drive. energy_lost: dissipated in all jumps; cycle_energy: the
  !> area between loading and unloading, computed independently; NaN if the bodies do not return to
  !> their start.
  type :: driven_t
    type(drive_t) :: drive
    !> The stiffness in the deck [N/m]; infinite if h0 is prescribed.
    real(wp) :: stiffness = 0
    !> All stable pieces, from large separations inward.
    type(driven_piece_t), allocatable :: piece(:)
    type(leg_t), allocatable :: leg(:)
    type(jump_t), allocatable :: jump(:)
    real(wp) :: energy_lost = 0, cycle_energy = 0, uncertainty = 0
    !> Whether every state was solved, and whether every jump landed.
    logical :: solved = .true., caught = .true.
  contains
    procedure :: area
  end type driven_t

contains

  !> Drives the bodies from large separation, or from `start`, to `finish` or, if it is not
  !> allocated, to the innermost piece at h0_end, and back. Positions are those of the drive
  !> (`driven_pieces`).
  subroutine drive_bodies(solver, path, drive, h0_end, start, finish, driven)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0_end
    real(wp), allocatable, intent(in) :: start, finish
    type(driven_t), intent(out) :: driven
    !> The present piece of the bodies, and their state.
    integer :: here, outermost
    type(path_state_t) :: state

    allocate (driven%leg(0), driven%jump(0))
    driven%drive = drive
    driven%energy_lost = nan
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

    !> Moves inward or outward, with all jumps.
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

    !> Moves to the state at a position on the present piece.
    subroutine move_to(position)
      real(wp), intent(in) :: position

      call state_driven(solver, path, drive, driven%piece(here), position, state)
      driven%solved = driven%solved .and. state%converged
    end subroutine move_to

    !> The position at which the motion on the present piece stops; stops = .false.: it continues to
    !> the end of the piece.
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
          ! It stops at h0_end or at the end of the known path, whichever is farther out.
          at = drive%position(piece%last)
          stops = .not. piece%last_turns
          if (h0_end <= piece%first%h0 .and. h0_end >= piece%last%h0) then
            call state_driven(solver, path, drive_t(of_h0), piece, h0_end, there)
            stops = stops .or. there%converged
            if (there%converged) at = max(at, drive%position(there))
          end if
        end if
        ! Positions that are already passed mean the present one.
        if (stops) at = min(at, drive%position(state))
      end associate
    end subroutine find_limit

  end subroutine drive_bodies

  !> The states of a leg in order: its ends, and the points of the path between them.
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

  !> The energy that the drive supplies along all legs: minus the integral of the conjugate over the
  !> position.
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
