!> One branch of an experiment that is stepped in h0; each step begins with the deformation of the
!> previous step.
module stepped_branch
  use kinds, only: wp
  use equilibrium, only: holds
  use h0_schedule, only: h0_schedule_t
  use stepper, only: stepper_t, branch_point_t, step_result_t
  use largest_tension, only: lower, lower_on_way
  use tension_search, only: tension_search_t
  use reported_place, only: place_of_state
  use places, only: places_t
  use records, only: observer_t, record_t, branch_t, record_of, stable_yes, stable_unasked
  implicit none
  private
  public :: run_branch, enter_ends

contains

  !> Steps through plan%h0. A new experiment (fresh) begins with an approach from large separation
  !> to the first value; otherwise the branch begins at `position`. `kept` returns the positions at
  !> the steps nearest to the values `keep` (a plan merges values that differ by less than a rounded
  !> step). The states with a requested profile become places of the table; without a known path, so
  !> do the samples.
  subroutine run_branch(steps, plan, fresh, position, observer, branch, places, keep, kept)
    class(stepper_t), intent(inout), target :: steps
    type(h0_schedule_t), intent(in) :: plan
    logical, intent(in) :: fresh
    type(branch_point_t), intent(inout) :: position
    class(observer_t), intent(inout) :: observer
    type(branch_t), intent(out) :: branch
    type(places_t), intent(inout) :: places
    real(wp), intent(in), optional :: keep(:)
    type(branch_point_t), intent(out), optional :: kept(:)
    type(tension_search_t) :: search
    type(branch_point_t) :: previous, last
    type(step_result_t) :: event
    real(wp) :: began, reached, last_h0, ends(2)
    integer, allocatable :: place(:)
    integer :: i, k

    ends = huge(ends)
    allocate (place(0))
    if (present(keep)) place = [(minloc(abs(plan%h0 - keep(k)), 1), k=1, size(keep))]
    last_h0 = plan%h0(1)
    reached = last_h0
    if (.not. fresh) then
      last_h0 = position%state%h0
      branch%first_piece = position%piece
    end if
    began = last_h0
    do i = 1, size(plan%h0)
      if (position%piece == 0) previous = position
      if (fresh .and. i == 1) then
        call steps%approach_to(plan%h0(i), position, event)
        branch%first_piece = position%piece
        if (event%ending%early()) branch%first_piece = 0
      else
        call steps%step_to(plan%h0(i), position, event)
      end if
      steps%cost%states = steps%cost%states + 1
      call note(plan%h0(i))
      call search%note_jump(event)
      reached = plan%h0(i)
      if (event%ending%early()) exit
      call show_row(plan%profile(i))
      if (event%converged) call keep_state(plan%profile(i), plan%sample(i))
      do k = 1, size(place)
        if (place(k) == i) kept(k) = position
      end do
      if (position%piece == 0) &
        call search%note_state(steps, last_h0, plan%h0(i), previous, position, event)
      last_h0 = plan%h0(i)
    end do
    if (allocated(last%state%gap)) branch%finish = place_of_state(last%mesh, last%state)
    if (branch%states > 0 .and. .not. event%converged) call doubt(farthest_known(), last_h0)
    if (branch%first_piece > 0) then
      call lower_on_way(steps%known%path, steps%known%stable, branch%first_piece, began, reached, &
        branch%lowest)
      if (allocated(branch%finish)) call lower(branch%lowest, branch%finish)
    else
      call search%finish(steps, last_h0)
      if (allocated(search%lowest)) then
        branch%lowest = search%lowest
        branch%lowest_beside_lost = search%beside_lost
      end if
    end if
    call branch%compare_ends(ends(1), ends(2))
    call enter_ends(branch, fresh, places)

  contains

    !> Records the first jump, the largest tension and what did not converge.
    subroutine note(h0)
      real(wp), intent(in) :: h0

      if (event%jumped .and. .not. allocated(branch%jump)) then
        branch%jump = event%jump
      end if
      branch%ending = event%ending
      if (event%ending%early()) return
      branch%states = branch%states + 1
      if (event%unsure) call doubt(event%unsure_from, h0)
      if (.not. event%converged) then
        if (branch%unconverged == 0) branch%first_unconverged = h0
        branch%unconverged = branch%unconverged + 1
      end if
    end subroutine note

    !> Gives the present state to the observer.
    subroutine show_row(with_profile)
      logical, intent(in) :: with_profile
      type(record_t) :: record

      associate (state => position%state)
        record = record_of(plan%name, steps%problem, steps%grid(position), state, &
          merge(stable_yes, stable_unasked, plan%unique), &
          holds(steps%problem, steps%options%tolerance, state))
        call branch%quality%cover(record, steps%problem, steps%grid(position), state, &
          state%axis_gap < steps%problem%law%edge_gap)
        call observer%take(record, steps%problem, steps%grid(position), state, with_profile)
      end associate
    end subroutine show_row

    !> Keeps the present state, an equilibrium, as the last one, and enters its places.
    subroutine keep_state(with_profile, is_sample)
      logical, intent(in) :: with_profile, is_sample

      call last%state%become(position%state)
      last%mesh = position%mesh
      branch%last_piece = position%piece
      ends(2) = position%state%h0
      if (.not. ends(1) < huge(ends)) then
        ends(1) = ends(2)
        if (position%piece > 0) &
          call lower(branch%lowest, place_of_state(position%mesh, position%state))
      end if
      if (with_profile) call places%add('profiles', place_of_state(last%mesh, last%state))
      if (position%piece == 0 .and. is_sample) &
        call places%add('samples', place_of_state(last%mesh, last%state))
    end subroutine keep_state

    !> Records a part of the branch in which the bodies may have jumped.
    subroutine doubt(from, to)
      real(wp), intent(in) :: from, to

      if (branch%unsure .or. abs(to - from) <= 0) return
      branch%unsure = .true.
      branch%unsure_between = [from, to]
    end subroutine doubt

    !> The h0 of the last state that converged, or the first h0.
    real(wp) function farthest_known()
      farthest_known = plan%h0(1)
      if (allocated(last%state%gap)) farthest_known = last%state%h0
    end function farthest_known

  end subroutine run_branch

  !> Enters the largest tension and the last state of a branch; fresh: of a new experiment.
  subroutine enter_ends(branch, fresh, places)
    type(branch_t), intent(in) :: branch
    logical, intent(in) :: fresh
    type(places_t), intent(inout) :: places

    if (allocated(branch%lowest)) call places%enter_tension(branch%lowest)
    if (.not. allocated(branch%finish)) return
    if (fresh) call places%forget('end')
    call places%add(merge('end    ', 'samples', fresh), branch%finish)
  end subroutine enter_ends

end module stepped_branch
