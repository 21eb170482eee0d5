!> The stable branches (pieces) of the path under a drive (h0, a spring or a dead load), the jumps
!> from their ends, and the motion of bodies along them. The drive moves inward or outward; at the
!> end of a piece the bodies jump to another piece. `piece_search` finds pieces and jumps.
!>
!> A state is stable at fixed Q = a h0 + b F (`drives`) if no mode of the bodies is unstable at
!> fixed h0 and k - dF/dh0 > 0, the Schur complement of bodies and spring. On the path followed
!> inward Q decreases there.
module driven_pieces
  use kinds, only: wp
  use drives, only: drive_t
  use path_point, only: path_point_t
  implicit none
  private
  public :: driven_pieces_t, driven_piece_t, jump_t, leg_t, walk_t, way_along

  !> A stable piece, from large separations inward; its ends are turning points of Q, or the ends of
  !> the known path.
  type :: driven_piece_t
    type(path_point_t) :: first, last
    logical :: first_turns = .false., last_turns = .false.
  contains
    procedure :: end_of
    procedure :: turns
  end type driven_piece_t

  !> A jump from the end of a piece, and the energy that it dissipates, in units of load times
  !> length. landed = .false.: no piece of the known path reaches this position of the drive, or the
  !> state there was not solved.
  type :: jump_t
    logical :: inward = .true., landed = .false.
    type(path_point_t) :: before, after
    !> The piece in which the jump ends; 0: there is none.
    integer :: piece = 0
    real(wp) :: energy = 0, uncertainty = 0
  contains
    procedure :: fold
  end type jump_t

  !> All stable pieces under a drive, from large separations inward; whole = .false.: a state was
  !> not solved, and its piece is missing. jump(k, 1), jump(k, 2): from the inner and from the
  !> outer end of piece k, if Q turns there.
  type :: driven_pieces_t
    type(drive_t) :: drive
    type(driven_piece_t), allocatable :: piece(:)
    type(jump_t), allocatable :: jump(:, :)
    logical :: whole = .true.
  contains
    procedure :: jump_from
    procedure :: jump_over
    procedure :: piece_with
  end type driven_pieces_t

  !> The motion along one stable piece. jumps: it goes to the end of the piece, where the drive
  !> turns, and a jump follows.
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    logical :: jumps = .false.
  end type leg_t

  !> Legs in order. arrives: the last leg ends at the requested position. Otherwise it ends at the
  !> end of its piece, from which no jump leads to a known state or at which the known path ends.
  type :: walk_t
    type(leg_t), allocatable :: leg(:)
    logical :: arrives = .false.
  end type walk_t

contains

  !> The inner or the outer end of a piece.
  pure type(path_point_t) function end_of(self, inward)
    class(driven_piece_t), intent(in) :: self
    logical, intent(in) :: inward

    end_of = self%first
    if (inward) end_of = self%last
  end function end_of

  !> Whether Q turns at the inner or outer end of a piece; otherwise the known path ends there.
  pure logical function turns(self, inward)
    class(driven_piece_t), intent(in) :: self
    logical, intent(in) :: inward

    turns = merge(self%last_turns, self%first_turns, inward)
  end function turns

  !> The piece nearest to `from`, in the given direction, that has a state at a position of the
  !> drive; 0: there is none.
  pure integer function piece_with(self, position, from, inward) result(found)
    class(driven_pieces_t), intent(in) :: self
    real(wp), intent(in) :: position
    integer, intent(in) :: from
    logical, intent(in) :: inward
    integer :: sense

    sense = merge(1, -1, inward)
    found = from + sense
    do while (found >= 1 .and. found <= size(self%piece))
      if (position <= self%drive%position(self%piece(found)%first) .and. &
        position >= self%drive%position(self%piece(found)%last)) return
      found = found + sense
    end do
    found = 0
  end function piece_with

  !> The point of the path from which a jump at prescribed h0 starts.
  pure integer function fold(self)
    class(jump_t), intent(in) :: self

    fold = self%before%interval + merge(1, 0, self%inward)
  end function fold

  !> The jump from the inner or outer end of a piece.
  pure type(jump_t) function jump_from(self, piece, inward) result(jump)
    class(driven_pieces_t), intent(in) :: self
    integer, intent(in) :: piece
    logical, intent(in) :: inward

    jump = self%jump(piece, merge(1, 2, inward))
  end function jump_from

  !> The jump at prescribed h0 from a point of the path at which a stable piece ends.
  pure type(jump_t) function jump_over(self, fold) result(jump)
    class(driven_pieces_t), intent(in) :: self
    integer, intent(in) :: fold
    integer :: k, side

    do k = 1, size(self%piece)
      do side = 1, 2
        if (.not. self%piece(k)%turns(side == 1)) cycle
        if (self%jump(k, side)%fold() == fold) jump = self%jump(k, side)
      end do
    end do
  end function jump_over

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

end module driven_pieces
