!> What a drive does to bodies: the ways that they go along stable pieces of the path, the jumps
!> between these, and the energy that is lost (`device`).
module driven_cycle
  use kinds, only: wp
  use path_curve, only: curve_t, curve_node_t
  use curve_states, only: curve_state_t
  use driven_pieces, only: drive_t, driven_piece_t
  implicit none
  private
  public :: driven_t, leg_t, jump_t, nodes_on

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
    procedure :: area
  end type driven_t

contains

  !> The nodes of the curve that a leg passes, in the order of the leg.
  pure function nodes_on(curve, leg) result(nodes)
    type(curve_t), intent(in) :: curve
    type(leg_t), intent(in) :: leg
    type(curve_node_t), allocatable :: nodes(:)
    integer :: i, first, last

    first = min(leg%from%interval, leg%to%interval)
    last = max(leg%from%interval, leg%to%interval)
    allocate (nodes(last - first))
    do i = first + 1, last
      nodes(i - first) = curve%begin_of(i)
    end do
    if (.not. leg%inward) nodes = nodes(size(nodes):1:-1)
  end function nodes_on

  !> Whether a leg ends where a jump starts.
  pure logical function jumps_after(self, leg)
    class(driven_t), intent(in) :: self
    type(leg_t), intent(in) :: leg

    jumps_after = any((self%jump%inward .eqv. leg%inward) .and. &
      self%jump%before%interval == leg%to%interval .and. &
      abs(self%jump%before%x - leg%to%x) <= 0)
  end function jumps_after

  !> The energy put in along all legs: minus the integral of the conjugate over the position.
  pure real(wp) function area(self, curve)
    class(driven_t), intent(in) :: self
    type(curve_t), intent(in) :: curve
    integer :: i

    area = 0
    do i = 1, size(self%leg)
      associate (leg => self%leg(i))
        if (leg%inward) then
          area = area - self%drive%work_between(curve, leg%from, leg%to)
        else
          area = area + self%drive%work_between(curve, leg%to, leg%from)
        end if
      end associate
    end do
  end function area

end module driven_cycle
