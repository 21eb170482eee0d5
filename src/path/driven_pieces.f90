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
  implicit none
  private
  public :: drive_t, driven_piece_t, find_pieces, state_driven, through_spring

  !> Weights of h0 and load in D (`path_tangent`).
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

  !> The part of itself by which D falls at least over a piece: where a turn is a state of the path
  !> on two meshes, rounding leaves pieces over which it hardly does.
  real(wp), parameter :: least_fall = 1.0e-9_wp
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

  !> The stable pieces of a path under a drive, from afar inward, which end where stability does, or
  !> what is known of the path; whole = .false.: a state was not solved, and a piece is left out.
  subroutine find_pieces(solver, equations, known, drive, pieces, whole)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    type(drive_t), intent(in) :: drive
    type(driven_piece_t), allocatable, intent(out) :: pieces(:)
    logical, intent(out) :: whole
    type(driven_piece_t) :: piece
    type(curve_state_t), allocatable :: turns(:)
    integer :: i, k, n
    logical :: open, stable, solved

    allocate (pieces(0))
    whole = .true.
    open = .false.
    n = size(solver%curve%interval)
    do i = 1, n
      if (solver%curve%interval(i)%modes > 0) then
        ! A fold in h0: the path is no longer stable however stiff the spring is.
        if (open) call close_piece(end_of(i - 1), .true.)
        open = .false.
        cycle
      end if
      call solver%find_turns(equations, known, i, drive%weights, turns, solved)
      whole = whole .and. solved
      associate (begin => solver%curve%begin_of(i))
        stable = dot_product(drive%weights, [begin%h0_slope, begin%load_slope]) < 0
        if (stable .neqv. open) then
          if (open) call close_piece(state_at(i, begin%x), .true.)
          if (stable) call open_piece(state_at(i, begin%x), i > 1)
        end if
      end associate
      do k = 1, size(turns)
        if (open) then
          call close_piece(turns(k), .true.)
        else
          call open_piece(turns(k), .true.)
        end if
      end do
    end do
    if (open) call close_piece(end_of(n), .false.)

  contains

    subroutine open_piece(state, turns)
      type(curve_state_t), intent(in) :: state
      logical, intent(in) :: turns

      open = .true.
      piece%first = state
      piece%first_turns = turns
    end subroutine open_piece

    subroutine close_piece(state, turns)
      type(curve_state_t), intent(in) :: state
      logical, intent(in) :: turns

      open = .false.
      piece%last = state
      piece%last_turns = turns
      if (.not. (piece%first%converged .and. piece%last%converged)) then
        whole = .false.
      else if (drive%position(piece%first) - drive%position(piece%last) > least_fall* &
        dot_product(abs(drive%weights), abs([state%h0, state%load]))) then
        pieces = [pieces, piece]
      end if
    end subroutine close_piece

    !> The state at the end of interval j.
    type(curve_state_t) function end_of(j)
      integer, intent(in) :: j

      associate (end => solver%curve%end_of(j))
        end_of = state_at(j, end%x)
      end associate
    end function end_of

    type(curve_state_t) function state_at(j, x)
      integer, intent(in) :: j
      real(wp), intent(in) :: x

      call solver%state_of(equations, known, place_t(j, x), state_at)
    end function state_at

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
    call solver%state_where(equations, known, i, drive%weights, wanted, low, high, state)
  end subroutine state_driven

end module driven_pieces
