!> The pieces of the path that are stable when the bodies are driven through a spring.
!>
!> The drive is D = a h0 - b F: the position Z = h0 - F/k of the base of a spring of stiffness k (a
!> = 1, b = 1/k), h0 itself (a = 1, b = 0), or a dead load -F (a = 0, b = 1). A state is stable at
!> fixed D if no mode of the bodies is unstable at fixed h0 and k - dF/dh0 > 0, the Schur complement
!> of bodies and spring. On the path followed inward D decreases there.
module driven_pieces
  use kinds, only: wp, nan
  use quadrature, only: gauss_legendre
  use interpolation, only: hermite_t
  use solver, only: solver_t
  use traced_path, only: traced_path_t
  use curve_states, only: path_state_t, path_place_t, state_of, state_where, find_turns
  implicit none
  private
  public :: drive_t, driven_piece_t, jump_t, find_pieces, find_jump, piece_with, interval_with, &
    state_driven, through_spring

  !> Weights of h0 and load in D (`path_tangent`).
  type :: drive_t
    real(wp) :: weights(2) = [1.0_wp, 0.0_wp]
  contains
    procedure :: position
    procedure :: energy
    procedure :: work_between
  end type drive_t

  !> A stable piece, from large separations inward; its ends are turning points of D, or the ends of
  !> the known path.
  type :: driven_piece_t
    type(path_state_t) :: first, last
    logical :: first_turns = .false., last_turns = .false.
  end type driven_piece_t

  !> A jump from the end of a piece, and the energy that the jump dissipates, in units of load times
  !> length; landed = .false.: no piece of the known path has the drive's position.
  type :: jump_t
    logical :: inward = .true., landed = .false.
    type(path_state_t) :: before, after
    !> The piece in which the jump ends; 0: there is none.
    integer :: piece = 0
    real(wp) :: energy = 0, uncertainty = 0
  end type jump_t

  !> Least relative decrease of D over a piece: where a turn is a state of the path on two meshes,
  !> rounding leaves pieces over which D hardly decreases.
  real(wp), parameter :: least_fall = 1.0e-9_wp
  !> Nodes of the quadrature rule for an interval.
  integer, parameter :: rule = 8

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

  !> D at a state.
  elemental real(wp) function position(self, state)
    class(drive_t), intent(in) :: self
    class(path_state_t), intent(in) :: state

    position = self%weights(1)*state%h0 + self%weights(2)*state%load
  end function position

  !> Energy of bodies and spring, or of bodies and dead load. At fixed D equilibria are stationary
  !> points of this energy; a jump dissipates the difference. The derivative by D is minus the
  !> conjugate of D.
  elemental real(wp) function energy(self, state)
    class(drive_t), intent(in) :: self
    class(path_state_t), intent(in) :: state

    if (self%weights(1) > 0) then
      energy = state%energy - 0.5_wp*self%weights(2)*state%load**2
    else
      energy = state%energy + state%load*state%h0
    end if
  end function energy

  !> The integral of the conjugate of D (the load; for a dead load h0) over D from one place to
  !> another place farther in.
  pure real(wp) function work_between(self, path, from, to) result(work)
    class(drive_t), intent(in) :: self
    type(traced_path_t), intent(in) :: path
    class(path_place_t), intent(in) :: from, to
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

  !> The ends of the part of interval i, from ends(1) to ends(2), that is between two places.
  pure function part_of(ends, i, from, to) result(part)
    real(wp), intent(in) :: ends(2)
    integer, intent(in) :: i
    class(path_place_t), intent(in) :: from, to
    real(wp) :: part(2)

    part = ends
    if (i == from%interval) part(1) = from%x
    if (i == to%interval) part(2) = to%x
  end function part_of

  !> The stable pieces of a path under a drive, from large separations inward. A piece ends where
  !> stability is lost or the known path ends. whole = .false.: a state was not solved, and its
  !> piece is missing.
  subroutine find_pieces(solver, path, drive, pieces, whole)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), allocatable, intent(out) :: pieces(:)
    logical, intent(out) :: whole
    type(driven_piece_t) :: piece
    type(path_state_t) :: state
    type(path_state_t), allocatable :: turns(:)
    type(hermite_t) :: curve
    type(path_place_t) :: before
    real(wp), allocatable :: x(:)
    real(wp) :: ends(2)
    integer :: i, k
    logical :: open, stable, solved

    allocate (pieces(0))
    whole = .true.
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
        whole = whole .and. solved
      end if
      x = [ends(1), turns%x, ends(2)]
      do k = 1, size(x) - 1
        stable = path%point(i)%modes == 0 .and. curve%value(x(k + 1)) < curve%value(x(k))
        if (stable .eqv. open) cycle
        if (k > 1) then
          state = turns(k - 1)
        else
          if (stable) before = path_place_t(i, ends(1))
          call state_of(solver, path, before, state)
        end if
        if (stable) then
          piece%first = state
          piece%first_turns = i > 1 .or. k > 1
        else
          call close_piece(.true.)
        end if
        open = stable
      end do
      before = path_place_t(i, ends(2))
    end do
    if (.not. open) return
    call state_of(solver, path, before, state)
    call close_piece(.false.)

  contains

    !> Ends the piece at `state`.
    subroutine close_piece(turns)
      logical, intent(in) :: turns

      piece%last = state
      piece%last_turns = turns
      if (.not. (piece%first%converged .and. piece%last%converged)) then
        whole = .false.
      else if (drive%position(piece%first) - drive%position(piece%last) > least_fall* &
        dot_product(abs(drive%weights), abs([state%h0, state%load]))) then
        pieces = [pieces, piece]
      end if
    end subroutine close_piece

  end subroutine find_pieces

  !> The piece nearest to `from`, in the given direction, that has a state at a position of the
  !> drive; 0: there is none.
  pure integer function piece_with(pieces, drive, position, from, inward) result(found)
    type(driven_piece_t), intent(in) :: pieces(:)
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: position
    integer, intent(in) :: from
    logical, intent(in) :: inward
    integer :: sense

    sense = merge(1, -1, inward)
    found = from + sense
    do while (found >= 1 .and. found <= size(pieces))
      if (position <= drive%position(pieces(found)%first) .and. &
        position >= drive%position(pieces(found)%last)) return
      found = found + sense
    end do
    found = 0
  end function piece_with

  !> The interval of a piece in which weights(1) h0 + weights(2) load reaches a value. (Where the
  !> path changes its mesh, the combination has a small jump, the difference of the meshes' errors,
  !> and the value may be inside that jump.)
  pure integer function interval_with(path, piece, weights, wanted) result(i)
    type(traced_path_t), intent(in) :: path
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(in) :: weights(2), wanted

    do i = piece%first%interval, piece%last%interval - 1
      if (.not. path%point(i)%leads_on) cycle
      associate (end => path%point(i + 1)%state)
        if (dot_product(weights, [end%h0, end%load]) <= wanted) return
      end associate
    end do
  end function interval_with

  !> The state of a piece at a value of D between those at the ends of the piece.
  subroutine state_driven(solver, path, drive, piece, wanted, state)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(in) :: wanted
    type(path_state_t), intent(out) :: state
    real(wp) :: ends(2)
    integer :: i

    i = interval_with(path, piece, drive%weights, wanted)
    ends = part_of(path%point(i:i + 1)%coordinate, i, piece%first, piece%last)
    call state_where(solver, path, i, drive%weights, wanted, ends(1), ends(2), state)
  end subroutine state_driven

  !> The jump from the turn at the inner or outer end of a piece: the bodies land on the nearest
  !> stable piece with the same position of the drive.
  subroutine find_jump(solver, path, drive, pieces, from, inward, jump)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), intent(in) :: pieces(:)
    integer, intent(in) :: from
    logical, intent(in) :: inward
    type(jump_t), intent(out) :: jump

    jump%inward = inward
    jump%before = pieces(from)%first
    if (inward) jump%before = pieces(from)%last
    jump%energy = nan
    associate (position => drive%position(jump%before))
      jump%piece = piece_with(pieces, drive, position, from, inward)
      if (jump%piece == 0) return
      call state_driven(solver, path, drive, pieces(jump%piece), position, jump%after)
    end associate
    jump%landed = jump%after%converged
    if (.not. jump%landed) return
    jump%energy = drive%energy(jump%before) - drive%energy(jump%after)
    jump%uncertainty = jump%before%uncertainty + jump%after%uncertainty
  end subroutine find_jump

end module driven_pieces
