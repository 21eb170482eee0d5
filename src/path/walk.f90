!> The way of bodies along the stable pieces of the path: at prescribed h0, behind a spring, or
!> under a dead load. The drive moves inward or outward; where it turns at the end of a piece, the
!> bodies jump to another piece.
module walk
  use kinds, only: wp
  use driven_pieces, only: driven_pieces_t
  implicit none
  private
  public :: leg_t, walk_t, way_along

  !> The motion along one stable piece. jumps: it goes to the end of the piece, where the drive
  !> turns, and a jump follows (`driven_pieces_t`).
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    logical :: jumps = .false.
  end type leg_t

  !> Legs in order. arrives: the last leg goes to where the way was to end; otherwise to the end of
  !> its piece, from which no jump lands or at which the known path ends.
  type :: walk_t
    type(leg_t), allocatable :: leg(:)
    logical :: arrives = .false.
  end type walk_t

contains

  !> The way from a piece inward or outward to a position of the drive, to the piece `until`, or to
  !> a position on this piece.
  pure type(walk_t) function way_along(pieces, from, inward, position, until) result(walk)
    class(driven_pieces_t), intent(in) :: pieces
    integer, intent(in) :: from
    logical, intent(in) :: inward
    real(wp), intent(in), optional :: position
    integer, intent(in), optional :: until
    type(leg_t) :: leg
    integer :: side

    leg = leg_t(inward, from)
    side = merge(1, 2, inward)
    allocate (walk%leg(0))
    do
      walk%arrives = .true.
      if (present(until)) walk%arrives = leg%piece == until
      if (present(position) .and. inward) walk%arrives = walk%arrives .and. &
        position >= pieces%drive%position(pieces%piece(leg%piece)%last)
      if (present(position) .and. .not. inward) walk%arrives = walk%arrives .and. &
        position <= pieces%drive%position(pieces%piece(leg%piece)%first)
      leg%jumps = .not. walk%arrives .and. pieces%piece(leg%piece)%turns(inward)
      walk%leg = [walk%leg, leg]
      if (.not. leg%jumps) return
      leg%piece = pieces%jump(leg%piece, side)%piece
      if (leg%piece == 0) return
    end do
  end function way_along

end module walk
