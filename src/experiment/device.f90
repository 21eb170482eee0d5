!> Bodies driven through a spring, or by a dead load, towards each other and apart again: along the
!> stable pieces of the equilibrium path, with a jump at the end of each to the next stable piece at
!> the same position of the drive.
module device
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use equilibrium, only: equations_t
  use known_path, only: known_path_t
  use curve_states, only: curve_solver_t, curve_state_t
  use driven_pieces, only: drive_t, driven_piece_t, find_pieces, state_driven
  implicit none
  private
  public :: driven_t, leg_t, jump_t, drive_bodies

  !> A way along one stable piece, of this number in `driven_t`.
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    type(curve_state_t) :: from, to
  end type leg_t

  !> A jump and the energy that it loses, in units of load times length; landed = .false.: nothing
  !> that is known of the path catches the bodies.
  type :: jump_t
    logical :: inward = .true., landed = .false.
    type(curve_state_t) :: before, after
    real(wp) :: energy = 0, uncertainty = 0
    !> Derivatives of the energy by each parameter of &sensitivity, SI units.
    real(wp), allocatable :: energy_rate(:)
  end type jump_t

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
    procedure :: jumps_after
  end type driven_t

contains

  !> Drives the bodies from afar, or from `start`, to `finish` or, where that is absent, to the
  !> innermost piece at h0_end, and back. Positions are those of the drive (`driven_pieces`).
  subroutine drive_bodies(solver, equations, known, drive, h0_end, start, finish, driven)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0_end
    real(wp), allocatable, intent(in) :: start, finish
    type(driven_t), intent(out) :: driven
    type(driven_piece_t), allocatable :: pieces(:)
    type(curve_state_t) :: state
    integer :: piece, outermost

    allocate (driven%leg(0), driven%jump(0))
    driven%drive = drive
    driven%energy_lost = ieee_value(1.0_wp, ieee_quiet_nan)
    driven%cycle_energy = driven%energy_lost
    call find_pieces(solver, equations, known, drive, pieces, driven%solved)
    driven%piece = pieces
    if (size(pieces) == 0) return
    piece = 1
    state = pieces(1)%first
    if (allocated(start)) call begin_at(start)
    outermost = piece
    call go(.true.)
    call go(.false.)
    driven%energy_lost = sum(driven%jump%energy)
    driven%uncertainty = sum(driven%jump%uncertainty)
    driven%caught = all(driven%jump%landed)
    if (piece == outermost .and. driven%caught .and. driven%solved) &
      driven%cycle_energy = area(solver, drive, driven%leg)

  contains

    !> Takes the outermost stable state at a position.
    subroutine begin_at(position)
      real(wp), intent(in) :: position
      integer :: k

      k = piece_with(pieces, drive, position, 1, 1)
      if (k == 0) return
      piece = k
      call state_driven(solver, equations, known, drive, pieces(k), position, state)
      driven%solved = driven%solved .and. state%converged
    end subroutine begin_at

    !> Goes inward or outward over all jumps.
    subroutine go(inward)
      logical, intent(in) :: inward
      type(jump_t) :: jump
      type(leg_t) :: leg
      real(wp) :: stop_at
      logical :: stops

      do
        leg%inward = inward
        leg%piece = piece
        leg%from = state
        stop_at = limit(inward, stops)
        if (stops) then
          call state_driven(solver, equations, known, drive, pieces(piece), stop_at, state)
        else
          state = pieces(piece)%last
          if (.not. inward) state = pieces(piece)%first
        end if
        driven%solved = driven%solved .and. state%converged
        leg%to = state
        driven%leg = [driven%leg, leg]
        if (stops .or. .not. driven%solved) return
        if (.not. merge(pieces(piece)%last_turns, pieces(piece)%first_turns, inward)) return
        call leap(inward, jump)
        driven%jump = [driven%jump, jump]
        if (.not. jump%landed) return
      end do
    end subroutine go

    !> The position at which the way along the present piece ends; stops = .false.: at its end.
    real(wp) function limit(inward, stops) result(at)
      logical, intent(in) :: inward
      logical, intent(out) :: stops

      at = 0
      if (.not. inward) then
        stops = allocated(start)
        if (stops) at = start
        if (stops) stops = at <= drive%position(pieces(piece)%first)
        return
      end if
      if (allocated(finish)) then
        at = finish
        stops = at >= drive%position(pieces(piece)%last)
      else
        stops = piece == size(pieces)
        if (stops) call find_innermost(at, stops)
      end if
      ! What lies behind already is here.
      if (stops) at = min(at, drive%position(state))
    end function limit

    !> The position at h0_end on the innermost piece, or at the end of what is known of it;
    !> there_is = .false.: it ends in a jump before.
    subroutine find_innermost(at, there_is)
      real(wp), intent(out) :: at
      logical, intent(out) :: there_is
      type(curve_state_t) :: there
      real(wp) :: ends(2)
      integer :: i

      at = drive%position(pieces(piece)%last)
      there_is = .not. pieces(piece)%last_turns
      do i = pieces(piece)%last%interval, pieces(piece)%first%interval, -1
        associate (begin => solver%curve%begin_of(i), end => solver%curve%end_of(i))
          if (.not. (begin%h0 >= h0_end .and. end%h0 <= h0_end)) cycle
          ends = [begin%x, end%x]
        end associate
        call solver%root_of(equations, known, i, [1.0_wp, 0.0_wp], ends(1), ends(2), there, h0_end)
        there_is = there_is .or. there%converged
        if (there%converged) at = max(at, drive%position(there))
        exit
      end do
    end subroutine find_innermost

    !> Jumps from the present state to the nearest stable piece with the same position.
    subroutine leap(inward, jump)
      logical, intent(in) :: inward
      type(jump_t), intent(out) :: jump
      integer :: k, sense

      jump%inward = inward
      jump%before = state
      sense = merge(1, -1, inward)
      k = piece_with(pieces, drive, drive%position(state), piece + sense, sense)
      if (k > 0) then
        call state_driven(solver, equations, known, drive, pieces(k), drive%position(state), &
          jump%after)
        jump%landed = jump%after%converged
        driven%solved = driven%solved .and. jump%landed
      end if
      jump%energy = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. jump%landed) return
      jump%energy = drive%energy(jump%before) - drive%energy(jump%after)
      jump%uncertainty = jump%before%uncertainty + jump%after%uncertainty
      piece = k
      state = jump%after
    end subroutine leap

  end subroutine drive_bodies

  !> Whether a leg ends where a jump starts.
  pure logical function jumps_after(self, leg)
    class(driven_t), intent(in) :: self
    type(leg_t), intent(in) :: leg

    jumps_after = any((self%jump%inward .eqv. leg%inward) .and. &
      self%jump%before%interval == leg%to%interval .and. &
      abs(self%jump%before%x - leg%to%x) <= 0)
  end function jumps_after

  !> The first piece from number k on, counting by `sense`, with a state at a position; 0: none.
  pure integer function piece_with(pieces, drive, position, k, sense) result(found)
    type(driven_piece_t), intent(in) :: pieces(:)
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: position
    integer, intent(in) :: k, sense

    found = k
    do while (found >= 1 .and. found <= size(pieces))
      if (position <= drive%position(pieces(found)%first) .and. &
        position >= drive%position(pieces(found)%last)) return
      found = found + sense
    end do
    found = 0
  end function piece_with

  !> The energy put in along all legs: minus the integral of the conjugate over the position.
  pure real(wp) function area(solver, drive, legs)
    type(curve_solver_t), intent(in) :: solver
    type(drive_t), intent(in) :: drive
    type(leg_t), intent(in) :: legs(:)
    integer :: i

    area = 0
    do i = 1, size(legs)
      if (legs(i)%inward) then
        area = area - drive%work_between(solver%curve, legs(i)%from, legs(i)%to)
      else
        area = area + drive%work_between(solver%curve, legs(i)%to, legs(i)%from)
      end if
    end do
  end function area

end module device
