!> Finds the stable pieces of a path under a drive, the jumps from their ends, and states on them
!> (`driven_pieces`).
module piece_search
  use kinds, only: wp, nan
  use interpolation, only: hermite_t
  use solver, only: solver_t
  use traced_path, only: traced_path_t
  use driven_pieces, only: drive_t, driven_pieces_t, driven_piece_t, jump_t, interval_with
  use path_point, only: path_point_t, part_of
  use curve_states, only: solve_at, state_where, find_turns
  implicit none
  private
  public :: find_pieces, find_jumps, state_driven

  !> Least relative decrease of Q over a piece. If Q turns at a state that the path has on two
  !> meshes, rounding makes spurious pieces, over which Q hardly decreases.
  real(wp), parameter :: least_fall = 1.0e-9_wp

contains

  !> The stable pieces of a path under a drive. A piece ends where stability is lost or the known
  !> path ends.
  subroutine find_pieces(solver, path, drive, pieces)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    class(driven_pieces_t), intent(inout) :: pieces
    type(driven_piece_t) :: piece
    type(path_point_t) :: state
    type(path_point_t), allocatable :: turns(:)
    type(hermite_t) :: curve
    real(wp), allocatable :: x(:)
    real(wp) :: ends(2), last_end
    integer :: i, k, before
    logical :: open, stable, solved

    pieces%drive = drive
    pieces%whole = .true.
    if (allocated(pieces%piece)) deallocate (pieces%piece)
    if (allocated(pieces%jump)) deallocate (pieces%jump)
    allocate (pieces%piece(0), pieces%jump(0, 2))
    open = .false.
    do i = 1, path%last - 1
      if (.not. path%point(i)%leads_on) cycle
      ! Where a mode is unstable at fixed h0, no spring makes the path stable.
      stable = path%point(i)%modes == 0
      if (.not. (stable .or. open)) cycle
      call path%curve_between(i, drive%weights, curve, ends)
      if (allocated(turns)) deallocate (turns)
      allocate (turns(0))
      ! The extrema of h0 are points of the path.
      if (stable .and. abs(drive%weights(2)) > 0) then
        call find_turns(solver, path, i, drive%weights, turns, solved)
        pieces%whole = pieces%whole .and. solved
      end if
      x = [ends(1), turns%coordinate, ends(2)]
      do k = 1, size(x) - 1
        stable = path%point(i)%modes == 0 .and. curve%value(x(k + 1)) < curve%value(x(k))
        if (stable .eqv. open) cycle
        if (k > 1) then
          state = turns(k - 1)
        else
          if (stable) before = i
          if (stable) last_end = ends(1)
          call solve_at(solver, path, before, last_end, state)
        end if
        if (stable) then
          piece%first = state
          piece%first_turns = i > 1 .or. k > 1
        else
          call close_piece(.true.)
        end if
        open = stable
      end do
      before = i
      last_end = ends(2)
    end do
    if (.not. open) return
    call solve_at(solver, path, before, last_end, state)
    call close_piece(.false.)

  contains

    !> Ends the piece at `state`.
    subroutine close_piece(turns)
      logical, intent(in) :: turns

      piece%last = state
      piece%last_turns = turns
      if (.not. (piece%first%converged .and. piece%last%converged)) then
        pieces%whole = .false.
      else if (drive%position(piece%first) - drive%position(piece%last) > least_fall* &
        dot_product(abs(drive%weights), abs([state%state%h0, state%state%load]))) then
        pieces%piece = [pieces%piece, piece]
      end if
    end subroutine close_piece

  end subroutine find_pieces

  !> The state of a piece at a value of Q between those at the ends of the piece.
  subroutine state_driven(solver, path, drive, piece, wanted, state)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(in) :: wanted
    type(path_point_t), intent(out) :: state
    real(wp) :: ends(2)
    integer :: i

    i = interval_with(path, piece, drive%weights, wanted)
    ends = part_of(path%point(i:i + 1)%coordinate, i, piece%first, piece%last)
    call state_where(solver, path, i, drive%weights, wanted, ends(1), ends(2), state)
  end subroutine state_driven

  !> The jumps from all ends of pieces at which Q turns.
  subroutine find_jumps(solver, path, pieces)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    class(driven_pieces_t), intent(inout) :: pieces
    integer :: k, side

    deallocate (pieces%jump)
    allocate (pieces%jump(size(pieces%piece), 2))
    do k = 1, size(pieces%piece)
      do side = 1, 2
        if (pieces%piece(k)%turns(side == 1)) &
          call find_jump(solver, path, pieces, k, side == 1, pieces%jump(k, side))
      end do
    end do
  end subroutine find_jumps

  !> The jump from the turn at the inner or outer end of a piece: the bodies land on the nearest
  !> stable piece with the same position of the drive.
  subroutine find_jump(solver, path, pieces, from, inward, jump)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    class(driven_pieces_t), intent(in) :: pieces
    integer, intent(in) :: from
    logical, intent(in) :: inward
    type(jump_t), intent(out) :: jump

    jump%inward = inward
    jump%before = pieces%piece(from)%end_of(inward)
    jump%energy = nan
    associate (position => pieces%drive%position(jump%before))
      jump%piece = pieces%piece_with(position, from, inward)
      if (jump%piece == 0) return
      call state_driven(solver, path, pieces%drive, pieces%piece(jump%piece), position, jump%after)
    end associate
    jump%landed = jump%after%converged
    if (.not. jump%landed) return
    jump%energy = pieces%drive%energy(jump%before) - pieces%drive%energy(jump%after)
    jump%uncertainty = jump%before%uncertainty + jump%after%uncertainty
  end subroutine find_jump

end module piece_search
