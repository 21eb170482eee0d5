!> A quasi-static experiment under a law that attracts. All equilibria lie on one path, which is
!> traced before the experiment. The path gives the stable piece on which an experiment is, the ends
!> of this piece, the landings of jumps, and the largest tension.
!>
!> The iteration solves the states; its result is accepted if it is the state on the path. Usually
!> one correction of the predicted state and a check are enough, with one factorisation for many
!> steps; near a fold the state is found by a search along the path.
module path_stepper
  use kinds, only: wp
  use listener, only: listener_t
  use contact_state, only: state_t
  use locked_stepper, only: locked_stepper_t
  use path_coordinate, only: coordinate_of
  use ending, only: fallen_before, beyond_path
  use path_span, only: path_span_t, new_path_span
  use prediction, only: missed_t, expect
  use path_end, only: demand_t
  use numerics_choice, only: choice_t
  use tracing, only: trace
  use known_path, only: known_path_t, landing_t, know_pieces, interval_at
  use stepper, only: branch_point_t, step_result_t, extreme_t, remember
  implicit none
  private
  public :: path_stepper_t

  type, extends(locked_stepper_t) :: path_stepper_t
    !> The path, after `know_path` has traced it.
    type(known_path_t) :: known
    !> The span of the path at the last step, and its errors at previous states.
    type(path_span_t), private :: span
    type(missed_t), private :: missed
  contains
    procedure :: approach_to
    procedure :: step_to
    procedure :: know_path
    procedure, private :: step_over
    procedure, private :: solve_on_piece
  end type path_stepper_t

  !> Near a fold h0 is proportional to the square of the coordinate, and iterations at fixed h0 do
  !> not converge: fraction of the interval next to a fold in which a state is found by a search
  !> along the path.
  real(wp), parameter :: beside_fold = 0.3_wp
  !> Change of the path's coordinate by which a state may lie outside its interval: meshes with
  !> different numbers of nodes differ by their errors.
  real(wp), parameter :: slack = 1.0e-3_wp

contains

  !> Traces the path from chosen%high, or from where the bodies hardly deform, until it is stable at
  !> chosen%low; into_contact: until the bodies are also in contact, at chosen%ends_at; accuracy,
  !> demand: see `trace`; with `demand` the points define a smooth curve. To be called before the
  !> first step. The listener receives messages about the progress.
  subroutine know_path(self, chosen, into_contact, accuracy, listener, demand)
    class(path_stepper_t), intent(inout) :: self
    type(choice_t), intent(in) :: chosen
    real(wp), intent(in) :: accuracy
    logical, intent(in) :: into_contact
    class(listener_t), intent(inout) :: listener
    type(demand_t), intent(in), optional :: demand
    type(known_path_t) :: nothing
    type(branch_point_t) :: position
    type(step_result_t) :: event

    self%known = nothing
    call self%operator%forget()
    call self%begin_afar(chosen%high, position, event)
    if (.not. event%ending%early()) then
      call trace(self%solver_t, position%state, chosen%low, into_contact, accuracy, listener, &
        self%known, demand, chosen%ends_at)
      call know_pieces(self%solver_t, self%known)
    else
      self%known%ending = event%ending
      allocate (self%known%piece(0))
    end if
    call self%frozen%forget()
    self%span%point = 0
  end subroutine know_path

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
    event%fold = 0
    if (allocated(event%lowest)) event%lowest = extreme_t(position%state%load, h0)
  end subroutine approach_to

  !> Moves to h0 along the stable pieces of the path, with all jumps, and records the first jump and
  !> the largest tension.
  subroutine step_to(self, h0, position, event)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(extreme_t) :: lowest
    real(wp) :: from

    lowest%load = huge(1.0_wp)
    if (size(self%known%piece) == 0) event%ending = self%known%ending
    if (event%ending%early()) return
    from = h0
    if (position%number > 0) from = position%state%h0
    do while (h0 > self%known%piece(position%piece)%first%h0 .or. &
      h0 < self%known%piece(position%piece)%last%h0)
      call self%step_over(h0 < self%known%piece(position%piece)%last%h0, from, position, lowest, &
        event)
      if (.not. event%ending%early()) cycle
      if (event%jumped) event%lowest = lowest
      return
    end do
    call lower_over(self%known, position%piece, from, h0, lowest)
    call self%solve_on_piece(h0, position, event)
    if (event%converged .and. position%state%load < lowest%load) &
      lowest = extreme_t(position%state%load, h0)
    event%lowest = lowest
  end subroutine step_to

  !> Leaves the position's piece over the fold at its inner or outer end, and lands. from: the h0 at
  !> which the motion on this piece began; on return that of the fold.
  subroutine step_over(self, inward, from, position, lowest, event)
    class(path_stepper_t), intent(in) :: self
    logical, intent(in) :: inward
    real(wp), intent(inout) :: from
    type(branch_point_t), intent(inout) :: position
    type(extreme_t), intent(inout) :: lowest
    type(step_result_t), intent(inout) :: event
    type(landing_t) :: landing

    if (inward) then
      landing = self%known%inward(position%piece)
    else
      landing = self%known%outward(position%piece)
    end if
    if (landing%fold > 0) then
      associate (fold => self%known%path%point(landing%fold)%state)
        call lower_over(self%known, position%piece, from, fold%h0, lowest)
        if (.not. event%jumped) then
          event%jumped = .true.
          event%jump_h0 = fold%h0
          event%jump_load = fold%load
          event%fold = landing%fold
        end if
        from = fold%h0
      end associate
    end if
    if (landing%piece == 0) then
      event%ending = self%known%ending
      if (.not. event%ending%early()) event%ending%cause = beyond_path
      return
    end if
    if (landing%after%load < lowest%load) &
      lowest = extreme_t(landing%after%load, from, landing%fold, .true.)
    position%piece = landing%piece
    position%held = 0
  end subroutine step_over

  !> Replaces the largest tension by the largest one among the load extrema and folds of a piece
  !> with h0 between two values if that is larger.
  pure subroutine lower_over(known, piece, from, to, lowest)
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: piece
    real(wp), intent(in) :: from, to
    type(extreme_t), intent(inout) :: lowest
    integer :: i

    do i = known%piece(piece)%first%interval, known%piece(piece)%last%interval + 1
      associate (point => known%path%point(i), state => known%path%point(i)%state)
        if (.not. (point%load_extremum .or. point%fold)) cycle
        if ((state%h0 - from)*(state%h0 - to) > 0) cycle
        if (state%load < lowest%load) lowest = extreme_t(state%load, state%h0, i)
      end associate
    end do
  end subroutine lower_over

  !> Solves the state at h0 on the position's piece: by iteration at fixed h0 or, if this does not
  !> converge to the state on the path, or near a fold, by a search along the path.
  subroutine solve_on_piece(self, h0, position, event)
    class(path_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(state_t) :: state
    real(wp) :: s
    integer :: i, mesh
    logical :: jumped, beside(2)

    jumped = event%jumped
    i = interval_at(self%known, position%piece, h0)
    if (self%span%point /= i) then
      self%span = new_path_span(self%known%path, i)
      call self%missed%clear()
    end if
    mesh = self%span%mesh
    associate (ends => self%span%ends, piece => self%known%piece(position%piece))
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
    if (.not. event%converged) call self%span%solve_at_h0(self%solver_t, h0, state, event%converged)
    call remember(position, state, mesh, jumped, foretold=state%iterations == 1)
  end subroutine solve_on_piece

end module path_stepper
