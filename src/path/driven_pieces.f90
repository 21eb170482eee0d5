!> Drives, the stable branches (pieces) of the path under a drive, the jumps from their ends, and
!> the motion of bodies along them. The drive moves inward or outward; at the end of a piece the
!> bodies jump to another piece. `piece_search` finds pieces and jumps.
!>
!> A drive controls the quantity Q = a h0 + b F. For a spring of stiffness k, Q is the position z =
!> h0 - F/k of its base (a = 1, b = -1/k). At prescribed h0, Q is h0 (a = 1, b = 0). Under a dead
!> load, Q is -F (a = 0, b = -1). A state is stable at fixed Q on two conditions: no mode of the
!> bodies is unstable at fixed h0, and k - dF/dh0, the Schur complement of bodies and spring, is
!> positive. Along the path inward, Q decreases where the states are stable.
module driven_pieces
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  use interpolation, only: hermite_t
  use traced_path, only: traced_path_t
  use path_point, only: path_point_t, part_of
  implicit none
  private
  public :: driven_pieces_t, driven_piece_t, jump_t, leg_t, walk_t, interval_with
  public :: drive_t, through_spring

  !> Weights of h0 and load in Q (`path_point`).
  type :: drive_t
    real(wp) :: weights(2) = [1.0_wp, 0.0_wp]
  contains
    procedure :: position
    procedure :: energy
    procedure :: work_between
  end type drive_t

  !> Nodes of the quadrature rule for an interval.
  integer, parameter :: rule = 8

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
    procedure :: way_along
    procedure :: way_to
  end type driven_pieces_t

  !> The motion along one stable piece. jumps: the motion goes to the end of the piece, where Q
  !> turns, and the bodies jump from there.
  type :: leg_t
    logical :: inward = .true.
    integer :: piece = 0
    logical :: jumps = .false.
  end type leg_t

  !> Legs in order. arrives: the last leg ends at the requested position. Otherwise it ends at the
  !> end of its piece: the known path ends there, or the jump from there leads to no known state.
  type :: walk_t
    type(leg_t), allocatable :: leg(:)
    logical :: arrives = .false.
  end type walk_t

contains

  !> The drive through a spring of stiffness k in units of load over length. k = 0 is a dead load;
  !> if k is infinite, h0 is prescribed.
  pure type(drive_t) function through_spring(k) result(drive)
    real(wp), intent(in) :: k

    if (k > 0) then
      drive%weights = [1.0_wp, -1/k]
    else
      drive%weights = [0.0_wp, -1.0_wp]
    end if
  end function through_spring

  !> Q at a state.
  elemental real(wp) function position(self, point)
    class(drive_t), intent(in) :: self
    type(path_point_t), intent(in) :: point

    position = point%state%of(self%weights)
  end function position

  !> Energy of bodies and spring, or of bodies and dead load. At fixed Q equilibria are stationary
  !> points of this energy; a jump dissipates the difference. Its derivative by Q is minus the
  !> conjugate of Q, which is the load, or h0 for a dead load.
  elemental real(wp) function energy(self, point)
    class(drive_t), intent(in) :: self
    type(path_point_t), intent(in) :: point

    if (self%weights(1) > 0) then
      energy = point%energy - 0.5_wp*self%weights(2)*point%state%load**2
    else
      energy = point%energy + point%state%load*point%state%h0
    end if
  end function energy

  !> The integral of the conjugate of Q over Q, from one state to another state farther in.
  pure real(wp) function work_between(self, path, from, to) result(work)
    class(drive_t), intent(in) :: self
    type(traced_path_t), intent(in) :: path
    type(path_point_t), intent(in) :: from, to
    type(hermite_t) :: force, driven
    real(wp) :: node(rule), weight(rule), ends(2), x
    integer :: i, k

    call gauss_legendre(node, weight)
    work = 0
    do i = from%interval, to%interval
      if (.not. path%point(i)%leads_on) cycle
      call path%curve_between(i, merge([0.0_wp, 1.0_wp], [1.0_wp, 0.0_wp], self%weights(1) > 0), &
        force, ends)
      call path%curve_between(i, self%weights, driven, ends)
      ends = part_of(ends, i, from, to)
      do k = 1, rule
        x = ends(1) + (ends(2) - ends(1))*node(k)
        work = work + (ends(2) - ends(1))*weight(k)*force%value(x)*driven%slope(x)
      end do
    end do
  end function work_between

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

  !> The interval of a piece in which weights(1) h0 + weights(2) load reaches a value. (Where the
  !> path changes its mesh this combination has a small jump, due to the errors of the meshes, and
  !> the value may be inside it.)
  pure integer function interval_with(path, piece, weights, wanted) result(i)
    type(traced_path_t), intent(in) :: path
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(in) :: weights(2), wanted

    do i = piece%first%interval, piece%last%interval - 1
      if (.not. path%point(i)%leads_on) cycle
      if (path%point(i + 1)%state%of(weights) <= wanted) return
    end do
  end function interval_with

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

  !> The legs from the piece `from`, inward or outward. They lead to a position of the drive, to the
  !> piece `until` or, if both are given, to this position on this piece.
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

  !> The legs from a piece to a position of the drive, inward or outward.
  pure type(walk_t) function way_to(pieces, from, position) result(walk)
    class(driven_pieces_t), intent(in) :: pieces
    integer, intent(in) :: from
    real(wp), intent(in) :: position

    walk = pieces%way_along(from, position < pieces%drive%position(pieces%piece(from)%last), &
      position)
  end function way_to

end module driven_pieces
