!> Bodies driven through a spring, or by a dead load, towards each other and apart again: along the
!> stable pieces of the equilibrium path, with a jump at the end of each to the next stable piece at
!> the same position of the drive.
module device
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use solver, only: solver_t
  use path_tangent, only: of_h0
  use traced_path, only: traced_path_t
  use curve_states, only: curve_state_t, state_where
  use driven_pieces, only: drive_t, driven_piece_t, find_pieces, piece_with, state_driven
  use driven_cycle, only: driven_t, leg_t, jump_t
  implicit none
  private
  public :: drive_bodies

  !> Bodies on their way: what solves their states, where they are to go from and to, and the piece
  !> and the state that they are in.
  type :: travel_t
    class(solver_t), pointer :: solver => null()
    type(traced_path_t), pointer :: path => null()
    real(wp) :: h0_end = 0
    real(wp), allocatable :: start, finish
    integer :: piece = 1
    type(curve_state_t) :: state
  contains
    procedure :: begin
    procedure :: go
    procedure :: move_to
    procedure :: find_limit
    procedure :: find_innermost
    procedure :: leap
  end type travel_t

contains

  !> Drives the bodies from afar, or from `start`, to `finish` or, where that is absent, to the
  !> innermost piece at h0_end, and back. Positions are those of the drive (`driven_pieces`).
  subroutine drive_bodies(solver, path, drive, h0_end, start, finish, driven)
    class(solver_t), intent(inout), target :: solver
    type(traced_path_t), intent(in), target :: path
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0_end
    real(wp), allocatable, intent(in) :: start, finish
    type(driven_t), intent(out) :: driven
    type(travel_t) :: travel
    integer :: outermost

    allocate (driven%leg(0), driven%jump(0))
    driven%drive = drive
    driven%energy_lost = ieee_value(1.0_wp, ieee_quiet_nan)
    driven%cycle_energy = driven%energy_lost
    call find_pieces(solver, path, drive, driven%piece, driven%solved)
    if (size(driven%piece) == 0) return
    travel%solver => solver
    travel%path => path
    travel%h0_end = h0_end
    if (allocated(start)) travel%start = start
    if (allocated(finish)) travel%finish = finish
    call travel%begin(driven)
    outermost = travel%piece
    call travel%go(.true., driven)
    call travel%go(.false., driven)
    driven%energy_lost = sum(driven%jump%energy)
    driven%uncertainty = sum(driven%jump%uncertainty)
    driven%caught = all(driven%jump%landed)
    if (travel%piece == outermost .and. driven%caught .and. driven%solved) &
      driven%cycle_energy = driven%area(path)
  end subroutine drive_bodies

  !> Takes the outermost stable state, or that at the position to start from.
  subroutine begin(self, driven)
    class(travel_t), intent(inout) :: self
    type(driven_t), intent(inout) :: driven
    integer :: k

    self%state = driven%piece(1)%first
    if (.not. allocated(self%start)) return
    k = piece_with(driven%piece, driven%drive, self%start, 0, .true.)
    if (k == 0) return
    self%piece = k
    call self%move_to(self%start, driven)
  end subroutine begin

  !> Goes inward or outward over all jumps.
  subroutine go(self, inward, driven)
    class(travel_t), intent(inout) :: self
    logical, intent(in) :: inward
    type(driven_t), intent(inout) :: driven
    type(jump_t) :: jump
    type(leg_t) :: leg
    real(wp) :: stop_at
    logical :: stops, turns

    do
      leg%inward = inward
      leg%piece = self%piece
      leg%from = self%state
      call self%find_limit(inward, driven, stop_at, stops)
      associate (piece => driven%piece(self%piece))
        turns = merge(piece%last_turns, piece%first_turns, inward)
        if (.not. stops) then
          self%state = piece%last
          if (.not. inward) self%state = piece%first
        end if
      end associate
      if (stops) call self%move_to(stop_at, driven)
      driven%solved = driven%solved .and. self%state%converged
      leg%to = self%state
      driven%leg = [driven%leg, leg]
      if (stops .or. .not. driven%solved .or. .not. turns) return
      call self%leap(inward, driven, jump)
      driven%jump = [driven%jump, jump]
      if (.not. jump%landed) return
    end do
  end subroutine go

  !> Solves the state at a position on the present piece, and is there.
  subroutine move_to(self, position, driven)
    class(travel_t), intent(inout) :: self
    real(wp), intent(in) :: position
    type(driven_t), intent(inout) :: driven

    call state_driven(self%solver, self%path, driven%drive, driven%piece(self%piece), position, &
      self%state)
    driven%solved = driven%solved .and. self%state%converged
  end subroutine move_to

  !> The position at which the way along the present piece ends; stops = .false.: at its end.
  subroutine find_limit(self, inward, driven, at, stops)
    class(travel_t), intent(inout) :: self
    logical, intent(in) :: inward
    type(driven_t), intent(in) :: driven
    real(wp), intent(out) :: at
    logical, intent(out) :: stops

    at = 0
    associate (piece => driven%piece(self%piece), drive => driven%drive)
      if (.not. inward) then
        stops = allocated(self%start)
        if (stops) at = self%start
        if (stops) stops = at <= drive%position(piece%first)
        return
      end if
      if (allocated(self%finish)) then
        at = self%finish
        stops = at >= drive%position(piece%last)
      else
        stops = self%piece == size(driven%piece)
        if (stops) call self%find_innermost(drive, piece, at, stops)
      end if
      ! What lies behind already is here.
      if (stops) at = min(at, drive%position(self%state))
    end associate
  end subroutine find_limit

  !> The position at h0_end on the innermost piece, or at the end of what is known of it;
  !> there_is = .false.: it ends in a jump before.
  subroutine find_innermost(self, drive, piece, at, there_is)
    class(travel_t), intent(inout) :: self
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(out) :: at
    logical, intent(out) :: there_is
    type(curve_state_t) :: there
    integer :: i

    at = drive%position(piece%last)
    there_is = .not. piece%last_turns
    do i = piece%last%interval, piece%first%interval, -1
      if (.not. self%path%point(i)%leads_on) cycle
      associate (ends => self%path%point(i:i + 1))
        if (.not. (ends(1)%state%h0 >= self%h0_end .and. ends(2)%state%h0 <= self%h0_end)) cycle
        call state_where(self%solver, self%path, i, of_h0, self%h0_end, ends(1)%coordinate, &
          ends(2)%coordinate, there)
      end associate
      there_is = there_is .or. there%converged
      if (there%converged) at = max(at, drive%position(there))
      exit
    end do
  end subroutine find_innermost

  !> Jumps from the present state to the nearest stable piece with the same position.
  subroutine leap(self, inward, driven, jump)
    class(travel_t), intent(inout) :: self
    logical, intent(in) :: inward
    type(driven_t), intent(inout) :: driven
    type(jump_t), intent(out) :: jump
    integer :: k

    jump%inward = inward
    jump%before = self%state
    jump%energy = ieee_value(1.0_wp, ieee_quiet_nan)
    k = piece_with(driven%piece, driven%drive, driven%drive%position(self%state), self%piece, &
      inward)
    if (k == 0) return
    call state_driven(self%solver, self%path, driven%drive, driven%piece(k), &
      driven%drive%position(self%state), jump%after)
    jump%landed = jump%after%converged
    driven%solved = driven%solved .and. jump%landed
    if (.not. jump%landed) return
    jump%energy = driven%drive%energy(jump%before) - driven%drive%energy(jump%after)
    jump%uncertainty = jump%before%uncertainty + jump%after%uncertainty
    self%piece = k
    self%state = jump%after
  end subroutine leap

end module device
