!> A quasi-static experiment under a law that attracts. All equilibria lie on one path, which is
!> traced before the experiment. The path gives the motion of the bodies along its stable pieces
!> (`walk`) and the largest tension.
!>
!> The iteration solves the states; its result is accepted if it is the state on the path. Usually
!> one correction of the predicted state and a check are enough, with one factorisation for many
!> steps. Near a fold the state is found by a search along the path.
module path_stepper
  use kinds, only: wp
  use progress_observer, only: progress_observer_t
  use contact_state, only: state_t
  use locked_stepper, only: locked_stepper_t
  use path_coordinate, only: coordinate_of
  use ending, only: fallen_before, beyond_path
  use path_span, only: path_span_t, new_path_span
  use prediction, only: missed_t, expect
  use path_end, only: demand_t
  use path_point, only: path_point_t, h0_alone
  use reported_place, only: place_without_state
  use tracing, only: trace
  use driven_pieces, only: drive_t, jump_t, walk_t
  use piece_search, only: find_pieces, find_jumps
  use stepper, only: known_path_t, branch_point_t, step_result_t, remember
  implicit none
  private
  public :: path_stepper_t

  type, extends(locked_stepper_t) :: path_stepper_t
    !> The span of the path at the last step, and its errors at previous states.
    type(path_span_t), private :: span
    type(missed_t), private :: missed
  contains
    procedure :: find_path
    procedure :: approach_to
    procedure :: step_to
    procedure, private :: jump_with
    procedure, private :: solve_on_piece
  end type path_stepper_t

  !> Near a fold h0 is a quadratic function of the coordinate, and iterations at fixed h0 do not
  !> converge. In this fraction of the interval next to a fold a state is found by a search along
  !> the path.
  real(wp), parameter :: beside_fold = 0.3_wp
  !> Change of the path's coordinate by which a state may lie outside its interval: meshes with
  !> different numbers of nodes differ by their errors.
  real(wp), parameter :: slack = 1.0e-3_wp

contains

  subroutine find_path(self, h0_high, h0_low, ends_at, into_contact, accuracy, observer, demand)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0_high, h0_low, ends_at, accuracy
    logical, intent(in) :: into_contact
    class(progress_observer_t), intent(inout) :: observer
    type(demand_t), intent(in), optional :: demand
    type(known_path_t) :: nothing
    type(branch_point_t) :: position
    type(step_result_t) :: event

    self%known = nothing
    call self%operator%forget()
    call self%solve_afar(h0_high, position, event)
    if (.not. event%ending%early()) then
      call trace(self%solver_t, position%state, h0_low, into_contact, accuracy, observer, &
        self%known, demand, ends_at)
      associate (path => self%known%path, stable => self%known%stable)
        call find_pieces(self%solver_t, path, drive_t(h0_alone), stable)
        ! The part beyond the last stable piece was traced only to find the end of this piece.
        if (size(stable%piece) > 0) path%last = stable%piece(size(stable%piece))%last%interval + 1
        call find_jumps(self%solver_t, path, stable)
      end associate
    else
      self%known%ending = event%ending
      allocate (self%known%stable%piece(0), self%known%stable%jump(0, 2))
    end if
    call self%frozen%forget()
    self%span%interval = 0
  end subroutine find_path

  subroutine approach_to(self, h0, position, event)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event

    position%piece = 1
    call self%step_to(h0, position, event)
    if (event%ending%early() .and. self%known%fallen) event%ending%cause = fallen_before
    ! Jumps during the approach, before the experiment begins, are not part of the experiment.
    event%jumped = .false.
  end subroutine approach_to

  !> Moves to h0 along the stable pieces of the path, with all jumps, and records the first jump.
  subroutine step_to(self, h0, position, event)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(walk_t) :: way
    integer :: i

    if (size(self%known%stable%piece) == 0) event%ending = self%known%ending
    if (event%ending%early()) return
    way = self%known%stable%way_to(position%piece, h0)
    do i = 1, size(way%leg)
      if (way%leg(i)%jumps) call self%jump_with(self%known%stable%jump_from(way%leg(i)%piece, &
        way%leg(i)%inward), position, event)
    end do
    if (way%arrives) then
      call self%solve_on_piece(h0, position, event)
    else
      event%ending = self%known%ending
      if (.not. event%ending%early()) event%ending%cause = beyond_path
    end if
  end subroutine step_to

  !> Moves the position to the piece in which a jump ends.
  subroutine jump_with(self, jump, position, event)
    class(path_stepper_t), intent(in) :: self
    type(jump_t), intent(in) :: jump
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event

    if (.not. event%jumped) then
      event%jumped = .true.
      associate (state => self%known%path%point(jump%fold())%state)
        event%jump = place_without_state(state%h0, state%load)
      end associate
      event%jump%point = jump%fold()
    end if
    if (jump%piece == 0) return
    position%piece = jump%piece
    position%held = 0
  end subroutine jump_with

  !> Solves the state at h0 on the position's piece by iteration at fixed h0. Near a fold, or if the
  !> iteration does not converge to the state on the path, the state is found by a search along the
  !> path.
  subroutine solve_on_piece(self, h0, position, event)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(state_t) :: state
    type(path_point_t) :: found
    real(wp) :: s
    integer :: i, mesh
    logical :: jumped, beside(2)

    jumped = event%jumped
    i = self%known%interval_at(position%piece, h0)
    if (self%span%interval /= i) then
      self%span = new_path_span(self%known%path, i)
      call self%missed%clear()
    end if
    mesh = self%span%mesh
    associate (ends => self%span%ends, piece => self%known%stable%piece(position%piece))
      s = self%span%at_h0(h0)
      beside = abs(s - ends) < beside_fold*abs(ends(2) - ends(1)) .and. [piece%first_turns .and. i &
        == piece%first%interval, piece%last_turns .and. i == piece%last%interval]
      if (.not. any(beside)) then
        call expect(self%solver_t, self%span, self%missed, h0, s, position, state)
        call self%attempt(h0, state, mesh, event)
        if (event%converged) then
          s = coordinate_of(self%problem, self%meshes, mesh, state)
          event%converged = s >= minval(ends) - slack .and. s <= maxval(ends) + slack
        end if
      end if
    end associate
    if (.not. event%converged) then
      call self%span%solve_at_h0(self%solver_t, h0, found)
      state = found%state
      event%converged = found%converged
    end if
    call remember(position, state, mesh, jumped, predicted=state%iterations == 1)
  end subroutine solve_on_piece

end module path_stepper
