!> The search for the largest tension on a branch whose path is not known: further states between
!> its steps are solved. (On edge-locked meshes the traced path has the largest tension.)
module tension_search
  use kinds, only: wp
  use interpolation, only: interpolated_maximum
  use stepper, only: stepper_t, branch_point_t, step_result_t
  use reported_place, only: place_t, place_of_state, place_without_state
  use largest_tension, only: lower
  implicit none
  private
  public :: tension_search_t, load_tolerance

  !> A part of a branch without a jump: its state of largest tension so far, the state before it,
  !> and the values of h0 between which the tension is largest (the neighbours of that state, or a
  !> jump).
  type :: stretch_t
    type(branch_point_t) :: lowest, previous
    real(wp) :: before = 0, after = 0
    logical :: open = .false.
    !> Whether the contact edge jumped from node to node, or may have jumped.
    logical :: jagged = .false.
  end type stretch_t

  type :: tension_search_t
    !> The largest tension so far; not allocated if there is no attraction.
    type(place_t), allocatable :: lowest
    type(stretch_t), private :: stretch, deferred
    integer, private :: ended = 0
  contains
    procedure :: note_jump
    procedure :: note_state
    procedure :: finish
    procedure, private :: end_stretch
    procedure, private :: refine
    procedure, private :: search_jump_by_jump
  end type tension_search_t

  !> Number of stretches of a branch that are searched immediately. Further stretches, which an
  !> unresolved contact edge causes by jumps from node to node, are not; only the one of largest
  !> tension is searched at the end.
  integer, parameter :: searched_at_once = 3

  !> Rounds of refinement of the largest tension, and the relative change of load that ends them. An
  !> extremum at an end of the stretch is approached to this fraction of the bracket, since the end
  !> is a jump, whose load is known, or an end of the experiment.
  integer, parameter :: most_rounds = 15
  real(wp), parameter :: load_tolerance = 1.0e-10_wp, enough = 1.0e-3_wp
  !> Smallest bracket of a search, relative or in the law's lengths.
  real(wp), parameter :: closest = 1.0e-9_wp
  !> Steps short enough for every jump of the contact edge to be located, in the law's lengths.
  real(wp), parameter :: short_step = 0.1_wp

contains

  !> Considers the last state before a jump or slip, which may have the largest tension.
  subroutine note_jump(self, event)
    class(tension_search_t), intent(inout) :: self
    type(step_result_t), intent(in) :: event

    call lower(self%lowest, place_without_state(event%before%h0, event%before%load))
  end subroutine note_jump

  !> Considers the step from `previous` at last_h0 to `position` at h0.
  subroutine note_state(self, steps, last_h0, h0, previous, position, event)
    class(tension_search_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: last_h0, h0
    type(branch_point_t), intent(in) :: previous, position
    type(step_result_t), intent(in) :: event
    real(wp) :: began

    associate (stretch => self%stretch)
      if (.not. event%converged) then
        ! The state has no reliable tension, and no search can start from it.
        call self%end_stretch(steps, last_h0)
      else if (leaps(event) .or. .not. stretch%open) then
        began = last_h0
        if (leaps(event)) then
          began = event%before%h0
          ! During loading the tension increases up to the jump itself.
          if (h0 < began .and. stretch%open) &
            stretch%open = event%before%load >= stretch%lowest%state%load
        end if
        call self%end_stretch(steps, began)
        stretch = stretch_t(position, previous, began, h0, .true.)
      else if (position%state%load < stretch%lowest%state%load) then
        stretch = stretch_t(position, previous, last_h0, h0, .true., stretch%jagged)
      else if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) then
        stretch%after = h0
      end if
      stretch%jagged = stretch%jagged .or. event%jagged
    end associate
  end subroutine note_state

  !> Ends the branch at last_h0.
  subroutine finish(self, steps, last_h0)
    class(tension_search_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: last_h0

    call self%end_stretch(steps, last_h0)
    if (self%deferred%open) call self%refine(steps, self%deferred)
  end subroutine finish

  !> Refines the largest tension of the stretch, which ends at `finish`, or stores the stretch as
  !> `deferred` if its tension is larger than that of the stored one.
  subroutine end_stretch(self, steps, finish)
    class(tension_search_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: finish
    type(stretch_t) :: stretch

    if (.not. self%stretch%open) return
    self%stretch%open = .false.
    stretch = self%stretch
    if (stretch%lowest%state%load < 0) then
      call lower(self%lowest, place_of_state(stretch%lowest%mesh, stretch%lowest%state))
    else if (.not. steps%problem%law%adhesion > 0) then
      return
    end if
    if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) stretch%after = finish
    self%ended = self%ended + 1
    if (self%ended <= searched_at_once) then
      call self%refine(steps, stretch)
      return
    end if
    if (self%deferred%open) then
      if (stretch%lowest%state%load >= self%deferred%lowest%state%load) return
    end if
    self%deferred = stretch
    self%deferred%open = .true.
  end subroutine end_stretch

  !> Searches for the largest tension between stretch%before and stretch%after. The extremum of the
  !> polynomial through the states nearest to the lowest one is solved and added, repeatedly. If
  !> this does not help, the larger side is halved, since on a coarse path the extremum may lie on
  !> either side.
  subroutine refine(self, steps, stretch)
    class(tension_search_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_point_t) :: best, trial
    type(step_result_t) :: event
    real(wp), allocatable :: h0(:), load(:)
    real(wp) :: low, high, left, right, next, width, gained
    integer :: round

    best = stretch%lowest
    h0 = [best%state%h0]
    load = [best%state%load]
    low = min(stretch%before, stretch%after)
    high = max(stretch%before, stretch%after)
    width = high - low
    ! Between such close steps rounding hides any extremum.
    if (.not. width > closest*max(1.0_wp, abs(low), abs(high))) return
    ! The paper's rule stops the iteration at an uncertain point, so a further state would be of no
    ! use.
    if (steps%options%stop_on_change) return
    if (stretch%jagged) then
      call self%search_jump_by_jump(steps, stretch)
      return
    end if
    do round = 1, most_rounds
      left = max(low, maxval([low, pack(h0, h0 < best%state%h0)]))
      right = min(high, minval([high, pack(h0, h0 > best%state%h0)]))
      next = interpolated_maximum(h0, -load, left, right)
      if (size(h0) < 3 .or. minval(abs(h0 - next)) <= 1.0e-3_wp*(right - left)) then
        ! The polynomial gives no new place: either the extremum is here, or one side was not
        ! sampled.
        if (any(h0 < best%state%h0) .and. any(h0 > best%state%h0) .and. &
          right - left < enough*width) exit
        next = merge(0.5_wp*(left + best%state%h0), 0.5_wp*(right + best%state%h0), &
          best%state%h0 - left > right - best%state%h0)
      end if
      trial = best
      call steps%step_to(next, trial, event)
      if (leaps(event) .or. .not. event%converged) then
        ! The stretch ends at the jump, before which its tension may be largest.
        if (leaps(event)) next = event%before%h0
        if (next < best%state%h0) low = next
        if (next > best%state%h0) high = next
        if ((next - best%state%h0)*(stretch%after - stretch%before) > 0) call self%note_jump(event)
        cycle
      end if
      h0 = [h0, next]
      load = [load, trial%state%load]
      gained = best%state%load - trial%state%load
      if (gained > 0) best = trial
      if (size(h0) > 3 .and. abs(gained) <= load_tolerance*abs(best%state%load)) exit
      call keep_nearest(h0, load)
    end do
    call lower(self%lowest, place_of_state(best%mesh, best%state))
  end subroutine refine

  !> Steps again from stretch%before to stretch%after, or from the lowest state if a jump came
  !> before it, and locates every jump of the contact edge: the tension is largest just before one
  !> of them.
  subroutine search_jump_by_jump(self, steps, stretch)
    class(tension_search_t), intent(inout) :: self
    class(stepper_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_point_t) :: position, best
    type(step_result_t) :: event
    real(wp) :: start
    integer :: i, count

    best = stretch%lowest
    position = stretch%lowest
    if (allocated(stretch%previous%state%gap)) then
      if (abs(stretch%previous%state%h0 - stretch%before) <= 0.0_wp) position = stretch%previous
    end if
    start = position%state%h0
    count = ceiling(abs(stretch%after - start)/short_step)
    do i = 1, count
      call steps%step_to(start + (stretch%after - start)*i/count, position, event)
      if (.not. event%converged .or. event%ending%early()) exit
      call self%note_jump(event)
      if (position%state%load < best%state%load) best = position
    end do
    call lower(self%lowest, place_of_state(best%mesh, best%state))
  end subroutine search_jump_by_jump

  !> Whether the bodies jumped in a step, or the contact edge slipped.
  pure logical function leaps(event)
    type(step_result_t), intent(in) :: event

    leaps = event%jumped .or. event%slipped
  end function leaps

  !> Removes values until the five nearest to the lowest load remain.
  pure subroutine keep_nearest(h0, load)
    real(wp), allocatable, intent(inout) :: h0(:), load(:)
    integer :: farthest

    do while (size(h0) > 5)
      farthest = maxloc(abs(h0 - h0(minloc(load, 1))), 1)
      h0 = [h0(:farthest - 1), h0(farthest + 1:)]
      load = [load(:farthest - 1), load(farthest + 1:)]
    end do
  end subroutine keep_nearest

end module tension_search
