!> Approach and retract with a spring (cantilever) or a dead load, and the energy that is
!> dissipated. The bodies move along the stable pieces of the equilibrium path, and jump from the
!> end of each piece to the next stable piece at the same position of the drive.
module device
  use kinds, only: wp, nan
  use solver, only: solver_t
  use path_point, only: path_point_t, h0_alone
  use traced_path, only: traced_path_t
  use driven_pieces, only: drive_t, driven_pieces_t, jump_t, leg_t, walk_t
  use piece_search, only: find_pieces, find_jumps, state_driven
  implicit none
  private
  public :: driven_t, driven_leg_t, states_on, drive_bodies

  !> The motion along one stable piece, and the states at its ends.
  type, extends(leg_t) :: driven_leg_t
    type(path_point_t) :: from, to
  end type driven_leg_t

  !> The motion of bodies under a drive, and the stable pieces. energy_lost: dissipated in all
  !> jumps; cycle_energy: the area between loading and unloading, computed independently; NaN if the
  !> bodies do not return to their start.
  type, extends(driven_pieces_t) :: driven_t
    !> The stiffness in the deck [N/m]; infinite if h0 is prescribed.
    real(wp) :: stiffness = 0
    type(driven_leg_t), allocatable :: leg(:)
    !> The jumps from the ends of legs, in order.
    type(jump_t), allocatable :: jumped(:)
    real(wp) :: energy_lost = 0, cycle_energy = 0, uncertainty = 0
    !> Whether every state was solved, and whether every jump landed.
    logical :: solved = .true., caught = .true.
  contains
    procedure :: area
  end type driven_t

contains

  !> Drives the bodies inward to `finish` and back. They begin at `start` or, if it is not
  !> allocated, at large separation. If `finish` is not allocated, they are driven to the innermost
  !> piece at h0_end. Positions are those of the drive (`driven_pieces`).
  subroutine drive_bodies(solver, path, drive, h0_end, start, finish, driven)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0_end
    real(wp), allocatable, intent(in) :: start, finish
    type(driven_t), intent(out) :: driven
    integer :: outermost, here
    type(path_point_t) :: state
    real(wp) :: last

    allocate (driven%leg(0), driven%jumped(0))
    driven%energy_lost = nan
    driven%cycle_energy = driven%energy_lost
    call find_pieces(solver, path, drive, driven)
    driven%solved = driven%whole
    if (size(driven%piece) == 0) return
    call find_jumps(solver, path, driven)
    outermost = 0
    if (allocated(start)) outermost = driven%piece_with(start, 0, .true.)
    state = driven%piece(max(outermost, 1))%first
    if (outermost > 0) call move_to(outermost, start)
    outermost = max(outermost, 1)
    if (allocated(finish)) then
      call go(driven%way_along(outermost, .true., finish), finish)
    else
      call find_innermost(last)
      call go(driven%way_along(outermost, .true., last, size(driven%piece)), last)
    end if
    last = huge(last)
    if (allocated(start)) last = start
    call go(driven%way_along(here, .false., last), last)
    driven%energy_lost = sum(driven%jumped%energy)
    driven%uncertainty = sum(driven%jumped%uncertainty)
    driven%caught = all(driven%jumped%landed)
    if (here == outermost .and. driven%caught .and. driven%solved) &
      driven%cycle_energy = driven%area(path)

  contains

    !> Moves along the legs to the position `at`, if they lead there.
    subroutine go(walk, at)
      type(walk_t), intent(in) :: walk
      real(wp), intent(in) :: at
      type(driven_leg_t) :: leg
      type(jump_t) :: jump
      integer :: i

      do i = 1, size(walk%leg)
        leg%leg_t = walk%leg(i)
        leg%from = state
        here = leg%piece
        if (walk%arrives .and. i == size(walk%leg)) then
          ! A position that is already passed is replaced by the present one.
          call move_to(here, merge(min(at, drive%position(state)), at, leg%inward))
        else
          state = driven%piece(here)%end_of(leg%inward)
        end if
        driven%solved = driven%solved .and. state%converged
        leg%to = state
        leg%jumps = leg%jumps .and. driven%solved
        driven%leg = [driven%leg, leg]
        if (.not. leg%jumps) return
        ! A result with allocatable components leaks in an array constructor: compiler note 1.
        jump = driven%jump_from(here, leg%inward)
        driven%jumped = [driven%jumped, jump]
        driven%solved = driven%solved .and. (jump%landed .or. jump%piece == 0)
        if (.not. jump%landed) return
        here = jump%piece
        state = jump%after
      end do
    end subroutine go

    !> Moves to the state of a piece at a position.
    subroutine move_to(piece, position)
      integer, intent(in) :: piece
      real(wp), intent(in) :: position

      call state_driven(solver, path, drive, driven%piece(piece), position, state)
      driven%solved = driven%solved .and. state%converged
    end subroutine move_to

    !> The position at which the motion inward ends on the innermost piece: h0_end or the end of the
    !> known path, whichever is farther out; -huge if Q has a turning point before.
    subroutine find_innermost(at)
      real(wp), intent(out) :: at
      type(path_point_t) :: there

      associate (piece => driven%piece(size(driven%piece)))
        at = -huge(at)
        if (.not. piece%last_turns) at = drive%position(piece%last)
        if (.not. (h0_end <= piece%first%state%h0 .and. h0_end >= piece%last%state%h0)) return
        call state_driven(solver, path, drive_t(h0_alone), piece, h0_end, there)
        if (there%converged) at = max(drive%position(piece%last), drive%position(there))
      end associate
    end subroutine find_innermost

  end subroutine drive_bodies

  !> The states of a leg in order: its ends, and the points of the path between them.
  pure function states_on(all_nodes, leg) result(states)
    type(path_point_t), intent(in) :: all_nodes(:)
    type(driven_leg_t), intent(in) :: leg
    type(path_point_t), allocatable :: nodes(:), states(:)

    associate (first => min(leg%from%interval, leg%to%interval) + 1, &
      last => max(leg%from%interval, leg%to%interval))
      ! A point from which the path does not continue is repeated on the next mesh.
      nodes = pack(all_nodes(first:last), all_nodes(first:last)%leads_on)
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
