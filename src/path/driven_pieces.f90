!> The pieces of the path that are stable when the bodies are driven through a spring.
!>
!> What is driven is D = a h0 - b F: the drive's position Z = h0 - F/k behind a spring of stiffness
!> k (a = 1, b = 1/k), h0 itself (a = 1, b = 0), or under a dead load -F (a = 0, b = 1). A state is
!> stable at fixed D where no mode of the bodies is unstable at fixed h0 and k - dF/dh0 > 0, the
!> Schur complement of bodies and spring: where D falls as the path is followed inward.
module driven_pieces
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  use equilibrium, only: equations_t
  use known_path, only: known_path_t
  use path_curve, only: curve_t
  use curve_states, only: curve_solver_t, curve_state_t, place_t
  use curve_turns, only: find_turning_places
  implicit none
  private
  public :: drive_t, driven_piece_t, find_pieces, state_driven, through_spring

  !> Weights of h0 and load in D.
  type :: drive_t
    real(wp) :: weights(2) = [1.0_wp, 0.0_wp]
  contains
    procedure :: position
    procedure :: energy
    procedure :: work_between
  end type drive_t

  !> A stable piece, from afar inward; its ends are turning points of D, or the ends of what is
  !> known of the path.
  type :: driven_piece_t
    type(curve_state_t) :: first, last
    logical :: first_turns = .false., last_turns = .false.
  end type driven_piece_t

  !> Nodes of the rule that integrates over an interval.
  integer, parameter :: rule = 8

contains

  !> The drive of a spring of stiffness k in units of load over length; 0 is a dead load. Absent: h0
  !> is prescribed.
  pure type(drive_t) function through_spring(k) result(drive)
    real(wp), intent(in), optional :: k

    if (.not. present(k)) return
    if (k > 0) then
      drive%weights = [1.0_wp, -1/k]
    else
      drive%weights = [0.0_wp, -1.0_wp]
    end if
  end function through_spring

  !> D at a state.
  elemental real(wp) function position(self, state)
    class(drive_t), intent(in) :: self
    class(curve_state_t), intent(in) :: state

    position = self%weights(1)*state%h0 + self%weights(2)*state%load
  end function position

  !> Energy of bodies and spring, or dead load; at fixed D the states of equilibrium are where it is
  !> stationary, and a jump loses the difference. Its derivative by D is minus the conjugate.
  elemental real(wp) function energy(self, state)
    class(drive_t), intent(in) :: self
    class(curve_state_t), intent(in) :: state

    if (self%weights(1) > 0) then
      energy = state%energy - 0.5_wp*self%weights(2)*state%load**2
    else
      energy = state%energy + state%load*state%h0
    end if
  end function energy

  !> The integral of the conjugate (the load; for a dead load h0) over D from one place to another
  !> farther in.
  pure real(wp) function work_between(self, curve, from, to) result(work)
    class(drive_t), intent(in) :: self
    type(curve_t), intent(in) :: curve
    class(place_t), intent(in) :: from, to
    real(wp) :: node(rule), weight(rule), conjugate(2), low, high, x
    integer :: i, k

    conjugate = merge([0.0_wp, 1.0_wp], [1.0_wp, 0.0_wp], self%weights(1) > 0)
    call gauss_legendre(node, weight)
    work = 0
    do i = from%interval, to%interval
      call clip(curve, i, from, to, low, high)
      do k = 1, rule
        x = low + (high - low)*node(k)
        work = work + (high - low)*weight(k)*curve%value(i, conjugate, x)* &
          curve%slope(i, self%weights, x)
      end do
    end do
  end function work_between

  !> The part of interval i between two places.
  pure subroutine clip(curve, i, from, to, low, high)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: i
    class(place_t), intent(in) :: from, to
    real(wp), intent(out) :: low, high

    associate (begin => curve%begin_of(i), end => curve%end_of(i))
      low = begin%x
      high = end%x
    end associate
    if (i == from%interval) low = from%x
    if (i == to%interval) high = to%x
  end subroutine clip

  !> The stable pieces of a path under a drive, from afar inward; whole = .false.: a state at the
  !> end of one was not solved, and it is left out.
  subroutine find_pieces(solver, equations, known, drive, pieces, whole)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), allocatable, intent(out) :: pieces(:)
    logical, intent(out) :: whole
    type(driven_piece_t) :: piece
    real(wp), allocatable :: edges(:), places(:)
    ! Where the last stable interval ends.
    real(wp) :: end_x
    integer :: i, k, n
    logical :: open, falls

    allocate (pieces(0))
    open = .false.
    whole = .true.
    n = size(solver%curve%interval)
    do i = 1, n
      associate (begin => solver%curve%begin_of(i), end => solver%curve%end_of(i))
        if (solver%curve%interval(i)%modes > 0) then
          ! A fold in h0: the path is no longer stable however stiff the spring is.
          if (open) call close_at(i - 1, end_x, .false.)
          cycle
        end if
        call find_turning_places(solver, equations, known, i, drive%weights, places)
        edges = [begin%x, places, end%x]
        falls = solver%curve%slope(i, drive%weights, begin%x) < 0
        end_x = end%x
      end associate
      do k = 1, size(edges) - 1
        if (k > 1) falls = .not. falls
        if (falls) then
          if (.not. open) call open_at(edges(k), k > 1)
        else if (open) then
          call close_at(i, edges(k), k > 1)
        end if
      end do
    end do
    if (.not. open) return
    call close_at(n, end_x, .false.)
    if (size(pieces) > 0) pieces(size(pieces))%last_turns = .false.

  contains

    !> Begins a piece in interval i at x: at a turning point within, or at its first node.
    subroutine open_at(x, turns)
      real(wp), intent(in) :: x
      logical, intent(in) :: turns

      open = .true.
      call solve_edge(i, x, turns, piece%first)
      piece%first_turns = turns .or. i > 1
    end subroutine open_at

    !> Ends it in interval j at x.
    subroutine close_at(j, x, turns)
      integer, intent(in) :: j
      real(wp), intent(in) :: x
      logical, intent(in) :: turns

      open = .false.
      piece%last_turns = .true.
      call solve_edge(j, x, turns, piece%last)
      if (piece%first%converged .and. piece%last%converged) then
        pieces = [pieces, piece]
      else
        whole = .false.
      end if
    end subroutine close_at

    subroutine solve_edge(j, x, turns, state)
      integer, intent(in) :: j
      real(wp), intent(in) :: x
      logical, intent(in) :: turns
      type(curve_state_t), intent(out) :: state
      real(wp) :: width

      if (.not. turns) then
        call solver%state_of(equations, known, place_t(j, x), state)
        return
      end if
      ! Half the way to the neighbouring edges contains this one alone.
      width = 0.5_wp*min(edges(k) - edges(k - 1), edges(k + 1) - edges(k))
      call solver%root_of(equations, known, j, drive%weights, x - width, x + width, state)
    end subroutine solve_edge

  end subroutine find_pieces

  !> The state of a piece at which D has a value between those at its ends.
  subroutine state_driven(solver, equations, known, drive, piece, wanted, state)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), intent(in) :: piece
    real(wp), intent(in) :: wanted
    type(curve_state_t), intent(out) :: state
    real(wp) :: low, high
    integer :: i

    do i = piece%first%interval, piece%last%interval
      call clip(solver%curve, i, piece%first, piece%last, low, high)
      if (i == piece%last%interval) exit
      if (solver%curve%value(i, drive%weights, high) <= wanted) exit
    end do
    call solver%root_of(equations, known, i, drive%weights, low, high, state, wanted)
  end subroutine state_driven

end module driven_pieces
