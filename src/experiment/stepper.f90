!> The interface between a quasi-static experiment at controlled h0 and its solver. It has an
!> approach from large separation to the start, steps from one h0 to the next, and the jumps in a
!> step. Under a law that attracts it also has the traced path.
module stepper
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use solver, only: solver_t
  use ending, only: ending_t
  use path_point, only: h0_alone
  use reported_place, only: place_t
  use traced_path, only: tracing_t
  use driven_pieces, only: driven_pieces_t, interval_with
  implicit none
  private
  public :: stepper_t, known_path_t, branch_point_t, step_result_t, memory, &
    remember, move_to, error_of_h0

  !> Number of states for the extrapolation in h0.
  integer, parameter :: memory = 4
  !> Largest error of the h0 of a fold or of the largest tension on a mesh fixed in space, relative
  !> or in the law's lengths.
  real(wp), parameter :: error_of_h0 = 1.0e-9_wp
  !> Rounding errors of the values of h0 of an experiment, relative to 1 or to h0.
  real(wp), parameter :: rounding = 1.0e-12_wp

  !> The position of an experiment: the present state and the past states that the next step can
  !> use. Positions are copied for later use (turning points, refinements).
  type :: branch_point_t
    type(state_t) :: state
    !> The solver's mesh of the state, and the stable piece of the path, if it is known.
    integer :: mesh = 1, piece = 0
    integer :: held = 0
    real(wp) :: h0(memory) = 0
    !> Allocated with `memory` elements: compiler note 11.
    type(state_t), allocatable :: past(:)
    !> The states of an experiment are numbered in order; the numbers of `state` and `past`.
    integer :: number = 0, past_number(memory) = 0
    !> On a mesh fixed in space: the energy lost in the jumps since the experiment began, with its
    !> error; NaN if it is not known.
    real(wp) :: lost = 0, lost_error = 0
  end type branch_point_t

  !> The result of a step.
  type :: step_result_t
    logical :: converged = .false.
    !> Whether the bodies jumped. h0 and load just before the first jump, with the uncertainty of
    !> h0; the place is the point of the path from which the bodies jump, if it is known.
    logical :: jumped = .false.
    type(place_t) :: jump
    !> Whether a contact edge slipped from one node to the next, and whether it may have slipped
    !> unnoticed. Of the places just before jumps and slips, the one of largest tension.
    logical :: slipped = .false., jagged = .false.
    type(place_t) :: before
    !> Whether it is not known if the bodies jumped between unsure_from and the end of the step.
    logical :: unsure = .false.
    real(wp) :: unsure_from = 0
    !> The ending is early if there is no state at h0.
    type(ending_t) :: ending
  end type step_result_t

  !> The traced path, and its pieces that are stable at prescribed h0.
  type, extends(tracing_t) :: known_path_t
    type(driven_pieces_t) :: stable
  contains
    procedure :: interval_at
  end type known_path_t

  type, abstract, extends(solver_t) :: stepper_t
    !> The path; not allocated if it was not traced (`path_stepper`).
    type(known_path_t), allocatable :: known
  contains
    procedure(begin_at), deferred :: approach_to
    procedure(go_to), deferred :: step_to
    procedure :: grid
  end type stepper_t

  abstract interface
    !> The state at h0 after an approach from large separation.
    subroutine begin_at(self, h0, position, event)
      import :: stepper_t, branch_point_t, step_result_t, wp
      class(stepper_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(branch_point_t), intent(out) :: position
      type(step_result_t), intent(out) :: event
    end subroutine begin_at

    !> Moves from the position to h0. If the step does not converge, position%state is the best
    !> state, with its residual.
    subroutine go_to(self, h0, position, event)
      import :: stepper_t, branch_point_t, step_result_t, wp
      class(stepper_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(branch_point_t), intent(inout) :: position
      type(step_result_t), intent(out) :: event
    end subroutine go_to
  end interface

contains

  !> The interval on a mesh in which a stable piece reaches h0.
  pure integer function interval_at(self, piece, h0) result(i)
    class(known_path_t), intent(in) :: self
    integer, intent(in) :: piece
    real(wp), intent(in) :: h0

    i = max(interval_with(self%path, self%stable%piece(piece), h0_alone, h0), &
      self%path%undeformed + 1)
  end function interval_at

  !> The mesh of a position's state.
  function grid(self, position)
    class(stepper_t), intent(in), target :: self
    type(branch_point_t), intent(in) :: position
    type(discretisation_t), pointer :: grid

    grid => self%meshes%grid(position%mesh)
  end function grid

  !> Makes `state` the position's present state. The past is removed if the mesh changes or the
  !> bodies jumped. predicted: the state needed no correction of its prediction, and is not added to
  !> the past.
  subroutine remember(position, state, mesh, jumped, predicted)
    type(branch_point_t), intent(inout) :: position
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    logical, intent(in) :: jumped
    logical, intent(in), optional :: predicted
    integer :: j

    if (mesh /= position%mesh .or. jumped) position%held = 0
    position%mesh = mesh
    call move_to(position, state)
    if (present(predicted)) then
      if (predicted) return
    end if
    ! After a turn of the experiment the same values of h0 occur again.
    do j = 1, position%held
      if (abs(position%h0(j) - state%h0) <= rounding*max(1.0_wp, abs(state%h0))) then
        call forget(position, j)
        exit
      end if
    end do
    if (.not. allocated(position%past)) allocate (position%past(memory))
    if (position%held == memory) call forget(position, 1)
    position%held = position%held + 1
    position%h0(position%held) = state%h0
    call position%past(position%held)%become(state)
    position%past_number(position%held) = position%number
  end subroutine remember

  !> Makes `state` the position's present state without adding it to the past.
  subroutine move_to(position, state)
    type(branch_point_t), intent(inout) :: position
    type(state_t), intent(in) :: state

    call position%state%become(state)
    position%number = position%number + 1
  end subroutine move_to

  pure subroutine forget(position, which)
    type(branch_point_t), intent(inout) :: position
    integer, intent(in) :: which
    integer :: k

    do k = which, position%held - 1
      position%h0(k) = position%h0(k + 1)
      call position%past(k)%become(position%past(k + 1))
      position%past_number(k) = position%past_number(k + 1)
    end do
    position%held = position%held - 1
  end subroutine forget

end module stepper
