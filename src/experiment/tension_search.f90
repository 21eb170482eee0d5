!> The search for the largest tension on a branch whose path is not known: further states between
!> its steps are solved. (On edge-locked meshes the traced path has the largest tension.)
module tension_search
  use kinds, only: wp
  use reported_place, only: of_h0, of_load
  use stepper, only: stepper_t, branch_point_t, step_result_t
  use tension_stretch, only: found_tension_t, stretch_t, leaps
  implicit none
  private
  public :: tension_search_t

  type, extends(found_tension_t) :: tension_search_t
    type(stretch_t), private :: stretch, deferred
    !> Whether the last state did not converge.
    logical, private :: lost = .false.
    integer, private :: ended = 0
  contains
    procedure :: note_state
    procedure :: finish
    procedure, private :: end_stretch
  end type tension_search_t

  !> Number of stretches of a branch that are searched immediately. Further ones are due to an
  !> unresolved contact edge that slips from node to node; of these only the one of largest tension
  !> is searched, at the end.
  integer, parameter :: searched_at_once = 3

contains

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
        stretch%lost_after = .true.
        call self%end_stretch(steps, h0)
      else if (leaps(event) .or. .not. stretch%open) then
        began = last_h0
        if (leaps(event)) then
          began = event%before%at(of_h0)
          ! During loading the tension increases up to the jump itself.
          if (h0 < began .and. stretch%open) &
            stretch%open = event%before%at(of_load) >= stretch%lowest%state%load
        end if
        call self%end_stretch(steps, began)
        stretch = stretch_t(position, previous, began, h0, .true., lost_before=self%lost)
      else if (position%state%load < stretch%lowest%state%load) then
        stretch = stretch_t(position, previous, last_h0, h0, .true., stretch%jagged)
      else if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) then
        stretch%after = h0
      end if
      stretch%jagged = stretch%jagged .or. event%jagged
    end associate
    self%lost = .not. event%converged
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
    if (.not. (stretch%lowest%state%load < 0 .or. steps%problem%law%adhesion > 0)) return
    if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) then
      stretch%after = finish
    else
      stretch%lost_after = .false.
    end if
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

end module tension_search
