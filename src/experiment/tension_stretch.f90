!> The search for the largest tension on one stretch of a branch whose path is not known: states
!> between its steps are solved.
module tension_stretch
  use kinds, only: wp
  use path_point, only: load_alone
  use branch_tangent, only: find_load_slope
  use root_finding, only: root_search_t, new_root_search
  use largest_tension, only: lower
  use stepper, only: stepper_t, branch_point_t, step_result_t, error_of_h0
  use reported_place, only: place_t, place_of_state, of_h0
  implicit none
  private
  public :: stretch_t, found_tension_t, leaps

  !> A part of a branch without a jump: its state of largest tension so far, and the state before
  !> it. The tension is largest between the values of h0 `before` and `after`: those of the
  !> neighbours of that state, or that of a jump.
  type :: stretch_t
    type(branch_point_t) :: lowest, previous
    real(wp) :: before = 0, after = 0
    logical :: open = .false.
    !> Whether the contact edge jumped from node to node, or may have jumped.
    logical :: jagged = .false.
    !> Whether states beyond `before` or `after` did not converge.
    logical :: lost_before = .false., lost_after = .false.
  end type stretch_t

  type :: found_tension_t
    !> The largest tension so far; not allocated if there is no attraction.
    type(place_t), allocatable :: lowest
    !> Whether tension grows from there towards states that did not converge.
    logical :: beside_lost = .false.
  contains
    procedure :: note_jump
    procedure :: refine
    procedure, private :: note_place
    procedure, private :: descend
    procedure, private :: find_root
    procedure, private :: search_jump_by_jump
  end type found_tension_t

  !> Largest number of halvings of a stretch until the slope of the load has both signs, and the
  !> smallest part of the stretch. If they are exhausted, the tension is largest at an end of the
  !> stretch: a jump, whose load is known, or an end of the experiment. Number of states of the
  !> search for the root.
  integer, parameter :: most_halvings = 12, most_rounds = 12
  real(wp), parameter :: enough = 1.0e-3_wp
  !> Steps short enough for every jump of the contact edge to be located, in the law's lengths.
  real(wp), parameter :: short_step = 0.1_wp

contains

  !> Replaces the place of largest tension by another if its tension is larger. lost: whether the
  !> tension grows from there towards states that did not converge.
  subroutine note_place(self, place, lost)
    class(found_tension_t), intent(inout) :: self
    type(place_t), intent(in) :: place
    logical, intent(in), optional :: lost
    logical :: lowered

    call lower(self%lowest, place, lowered)
    if (.not. lowered) return
    self%beside_lost = .false.
    if (present(lost)) self%beside_lost = lost
  end subroutine note_place

  !> Considers the last state before a jump or slip, which may have the largest tension.
  subroutine note_jump(self, event)
    class(found_tension_t), intent(inout) :: self
    type(step_result_t), intent(in) :: event

    call self%note_place(event%before)
  end subroutine note_jump

  !> Searches for the largest tension between stretch%before and stretch%after, where the slope
  !> dF/dh0 is zero. (From loads alone the place would be known only to the square root of their
  !> error.)
  subroutine refine(self, steps, stretch)
    class(found_tension_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_point_t) :: best
    type(place_t) :: place
    real(wp) :: slope, bound
    logical :: lost

    best = stretch%lowest
    associate (h0 => best%state%h0, before => stretch%before, after => stretch%after)
      ! The paper's rule stops at an uncertain point, so a further state would be of no use.
      if (steps%options%stop_on_change) then
        place = place_of_state(best%mesh, best%state)
        place%left(of_h0) = max(abs(before - h0), abs(after - h0))
        call self%note_place(place)
        return
      end if
      if (stretch%jagged) then
        call self%search_jump_by_jump(steps, stretch)
        return
      end if
      call find_load_slope(steps, best%state, slope)
      bound = merge(min(before, after), max(before, after), slope > 0)
      lost = stretch%lost_after .and. abs(bound - after) <= 0 .or. &
        stretch%lost_before .and. abs(bound - before) <= 0
      call self%descend(steps, sign(1.0_wp, after - before), bound, slope, lost, best)
    end associate
  end subroutine refine

  !> Moves from a state towards lower loads and `bound`, by halving the distance, until the slope
  !> has the other sign. lost: whether states beyond the bound did not converge; onward: the sense
  !> of the branch.
  subroutine descend(self, steps, onward, bound, slope, lost, best)
    class(found_tension_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: onward
    real(wp), intent(inout) :: bound, slope
    logical, intent(inout) :: lost
    type(branch_point_t), intent(inout) :: best
    type(branch_point_t) :: trial
    type(step_result_t) :: event
    type(place_t) :: place
    real(wp) :: ahead, width
    integer :: round

    width = abs(bound - best%state%h0)
    ahead = slope
    do round = 1, most_halvings
      if (.not. abs(slope) > 0) exit
      ! Between such close steps rounding hides any extremum.
      if (.not. abs(bound - best%state%h0) > max(enough*width, &
        error_of_h0*max(1.0_wp, abs(bound)))) exit
      trial = best
      call steps%step_to(0.5_wp*(best%state%h0 + bound), trial, event)
      if (leaps(event) .or. .not. event%converged) then
        ! The stretch ends at the jump, before which its tension may be largest.
        lost = .not. leaps(event)
        bound = merge(event%before%at(of_h0), 0.5_wp*(best%state%h0 + bound), leaps(event))
        if ((bound - best%state%h0)*onward > 0) call self%note_jump(event)
        cycle
      end if
      call find_load_slope(steps, trial%state, ahead)
      if (ahead*slope < 0) then
        call self%find_root(steps, best, slope, trial, ahead)
        return
      else if (trial%state%load > best%state%load) then
        bound = trial%state%h0
        lost = .false.
      else
        best = trial
        slope = ahead
      end if
    end do
    place = place_of_state(best%mesh, best%state)
    place%left(of_h0) = abs(bound - best%state%h0)
    call self%note_place(place, lost)
  end subroutine descend

  !> Finds the root of the slope between two states of a stretch without jumps.
  subroutine find_root(self, steps, low, low_slope, high, high_slope)
    class(found_tension_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    type(branch_point_t), intent(in) :: low, high
    real(wp), intent(in) :: low_slope, high_slope
    type(branch_point_t) :: trial
    type(step_result_t) :: event
    type(root_search_t) :: search
    type(place_t) :: place
    real(wp) :: slope, last_slope, last, bend
    integer :: round

    search = new_root_search(low%state%h0, low_slope, high%state%h0, high_slope)
    last = low%state%h0
    last_slope = low_slope
    bend = (high_slope - low_slope)/(high%state%h0 - low%state%h0)
    trial = low
    slope = low_slope
    do round = 1, most_rounds
      if (.not. search%is_open()) exit
      call steps%step_to(search%place(), trial, event)
      ! A jump between two states of one branch means that an iteration failed.
      if (leaps(event) .or. .not. event%converged) exit
      call find_load_slope(steps, trial%state, slope)
      if (abs(trial%state%h0 - last) > 0) bend = (slope - last_slope)/(trial%state%h0 - last)
      if (abs(slope) <= max(error_of_h0, steps%options%tolerance)*abs(bend)) exit
      call search%note(trial%state%h0, slope)
      last = trial%state%h0
      last_slope = slope
    end do
    place = place_of_state(trial%mesh, trial%state)
    if (leaps(event) .or. .not. event%converged) then
      place = place_of_state(low%mesh, low%state)
      if (high%state%load < low%state%load) place = place_of_state(high%mesh, high%state)
      place%left(of_h0) = abs(high%state%h0 - low%state%h0)
    else
      place%turn_of = load_alone
      place%left(of_h0) = min(abs(slope/bend), abs(high%state%h0 - low%state%h0))
    end if
    call self%note_place(place)
  end subroutine find_root

  !> Repeats the steps from stretch%before (from the lowest state if a jump came before it) to
  !> stretch%after and locates every slip of the contact edge, since the tension is largest just
  !> before one.
  subroutine search_jump_by_jump(self, steps, stretch)
    class(found_tension_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_point_t) :: position, best
    type(step_result_t) :: event
    real(wp) :: start, reached
    type(place_t) :: place
    logical :: lost
    integer :: i, count

    best = stretch%lowest
    position = stretch%lowest
    if (allocated(stretch%previous%state%gap)) then
      if (abs(stretch%previous%state%h0 - stretch%before) <= 0.0_wp) position = stretch%previous
    end if
    start = position%state%h0
    reached = start
    count = ceiling(abs(stretch%after - start)/short_step)
    do i = 1, count
      call steps%step_to(start + (stretch%after - start)*i/count, position, event)
      if (.not. event%converged .or. event%ending%early()) exit
      call self%note_jump(event)
      if (position%state%load < best%state%load) best = position
      reached = position%state%h0
    end do
    place = place_of_state(best%mesh, best%state)
    lost = abs(best%state%h0 - reached) <= 0 .and. stretch%lost_after
    if (.not. lost) place%left(of_h0) = short_step
    call self%note_place(place, lost)
  end subroutine search_jump_by_jump

  !> Whether the bodies jumped in a step, or the contact edge slipped.
  pure logical function leaps(event)
    type(step_result_t), intent(in) :: event

    leaps = event%jumped .or. event%slipped
  end function leaps

end module tension_stretch
