!> The h0-stepped experiment: loading, and an unloading from each turning point, the deformation
!> carried over from step to step.
module cycle
  use kinds, only: wp
  use equilibrium, only: state_t, residual_floor
  use interpolation, only: interpolated_maximum
  use quasi_static, only: quasi_static_t, position_t, event_t, witness_t, add_witness, &
    end_t, end_of
  use records, only: observer_t, record_of, stable_yes, stable_unasked
  implicit none
  private
  public :: plan_t, branch_t, run_branch

  !> The values of h0 to go through, and those whose profile is wanted; in the law's lengths.
  type :: plan_t
    character(len=:), allocatable :: name
    real(wp), allocatable :: h0(:)
    logical, allocatable :: profile(:)
    !> There is one state for every h0, so that each is known to be stable.
    logical :: unique = .false.
  end type plan_t

  !> What a branch showed, in the units of `problem`. Unallocated: there was none.
  type :: branch_t
    !> Largest tension (a negative load) and where.
    real(wp), allocatable :: load, load_h0
    !> The first jump: h0, the load just before it, and how well h0 is known.
    real(wp), allocatable :: jump_h0, jump_load
    real(wp) :: jump_uncertainty = 0
    !> The last equilibrium; no state that did not converge counts as one.
    type(end_t), allocatable :: finish
    real(wp) :: worst_residual = 0, worst_spacing = 0
    !> Where the reported numbers come from: the ends and the middle, the jump, the largest tension.
    type(witness_t), allocatable :: witness(:)
    integer :: states = 0, unconverged = 0
    !> First h0 that did not converge, and why the branch ended early; empty if it did not.
    real(wp) :: first_unconverged = 0
    character(len=160) :: reason = ''
  end type branch_t

  !> A stretch of a branch without a jump: its state of largest tension so far, the one before it,
  !> and the values of h0 between which the largest tension of all lies (the neighbours of that
  !> state, or a jump).
  type :: stretch_t
    type(position_t) :: lowest, previous
    real(wp) :: before = 0, after = 0
    logical :: open = .false.
    !> The contact edge jumped from node to node on the way, or may have.
    logical :: jagged = .false.
  end type stretch_t

  !> Stretches of a branch that are searched at once; of what an unresolved contact edge, jumping
  !> from node to node, adds to them only the one of largest tension is searched, at the end.
  integer, parameter :: searched_at_once = 3

  !> Rounds of refinement of the maximum tension, and the relative change of load that ends them.
  !> An extremum at an end of the stretch is approached to this fraction of the bracket: it is a
  !> jump, whose load is known, or an end of the experiment.
  integer, parameter :: most_rounds = 15
  real(wp), parameter :: load_tolerance = 1.0e-10_wp, enough = 1.0e-3_wp
  !> Smallest bracket that is searched, relative or in the law's lengths.
  real(wp), parameter :: closest = 1.0e-9_wp
  !> Steps short enough for every jump of the contact edge to be located, in the law's lengths.
  real(wp), parameter :: short_step = 0.1_wp

contains

  !> Goes through plan%h0. A new experiment (fresh) begins by an approach from afar at the first
  !> value; otherwise it goes on from `position`. Positions at the steps nearest to the values `keep`
  !> are handed back in `kept`: a plan takes values that differ by a rounded step for the same.
  subroutine run_branch(steps, plan, fresh, position, observer, keep, kept, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(plan_t), intent(in) :: plan
    logical, intent(in) :: fresh
    type(position_t), intent(inout) :: position
    class(observer_t), intent(inout) :: observer
    real(wp), intent(in) :: keep(:)
    type(position_t), intent(out) :: kept(:)
    type(branch_t), intent(out) :: branch
    type(stretch_t) :: stretch, deferred
    type(position_t) :: previous
    type(event_t) :: event
    real(wp) :: last_h0
    integer :: i, k, ended, place(size(keep))

    ended = 0
    do k = 1, size(keep)
      place(k) = minloc(abs(plan%h0 - keep(k)), 1)
    end do
    allocate (branch%witness(0))
    last_h0 = plan%h0(1)
    if (.not. fresh) last_h0 = position%state%h0
    do i = 1, size(plan%h0)
      previous = position
      if (fresh .and. i == 1) then
        call steps%begin(plan%h0(i), position, event)
      else
        call steps%go(plan%h0(i), position, event)
      end if
      steps%cost%states = steps%cost%states + 1
      call note(branch, steps, position, event, plan%h0(i))
      if (event%reason /= '') exit
      if (event%converged) branch%finish = end_of(position%state)
      call observer%take(record_of(plan%name, steps%problem, steps%grid(position), position%state, &
        merge(stable_yes, stable_unasked, plan%unique), holds(steps, position%state)), &
        steps%problem, &
        steps%grid(position), position%state, plan%profile(i))
      if (any(i == [1, (1 + size(plan%h0))/2, size(plan%h0)])) &
        call add_witness(branch%witness, steps%witness(position))
      if (allocated(event%fold)) call add_witness(branch%witness, event%fold)
      do k = 1, size(keep)
        if (place(k) == i) kept(k) = position
      end do

      if (.not. event%converged) then
        ! Shown as it is, but neither a tension nor a place to search from.
        call end_stretch(steps, stretch, last_h0, ended, deferred, branch)
      else if (event%jumped .or. .not. stretch%open) then
        if (event%jumped) then
          last_h0 = event%jump_h0
          ! On the way in the tension grows up to the jump itself.
          if (plan%h0(i) < event%jump_h0 .and. stretch%open) &
            stretch%open = event%jump_load >= stretch%lowest%state%load
        end if
        call end_stretch(steps, stretch, last_h0, ended, deferred, branch)
        stretch = stretch_t(position, previous, last_h0, plan%h0(i), .true.)
      else if (position%state%load < stretch%lowest%state%load) then
        stretch = stretch_t(position, previous, last_h0, plan%h0(i), .true., stretch%jagged)
      else if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) then
        stretch%after = plan%h0(i)
      end if
      if (.not. event%jumped .and. event%jump_uncertainty > 0) stretch%jagged = .true.
      last_h0 = plan%h0(i)
    end do
    call end_stretch(steps, stretch, last_h0, ended, deferred, branch)
    if (deferred%open) call refine(steps, deferred, branch)
  end subroutine run_branch

  !> Whether a state is an equilibrium, which the paper's stopping rule does not say.
  pure logical function holds(steps, state)
    class(quasi_static_t), intent(in) :: steps
    type(state_t), intent(in) :: state

    holds = state%residual <= max(steps%options%tolerance, residual_floor(steps%problem, state))
  end function holds

  !> Keeps the worst and the first of what happened.
  subroutine note(branch, steps, position, event, h0)
    type(branch_t), intent(inout) :: branch
    class(quasi_static_t), intent(in) :: steps
    type(position_t), intent(in) :: position
    type(event_t), intent(in) :: event
    real(wp), intent(in) :: h0

    if (event%jumped .and. .not. allocated(branch%jump_h0)) then
      branch%jump_h0 = event%jump_h0
      branch%jump_load = event%jump_load
      branch%jump_uncertainty = event%jump_uncertainty
    end if
    ! The last state before a jump may be the branch's largest tension.
    if (event%jumped .and. event%jump_load < 0) call lower(branch, event%jump_load, event%jump_h0)
    branch%reason = event%reason
    if (event%reason /= '') return
    branch%states = branch%states + 1
    if (.not. event%converged) then
      if (branch%unconverged == 0) branch%first_unconverged = h0
      branch%unconverged = branch%unconverged + 1
    end if
    branch%worst_residual = max(branch%worst_residual, position%state%residual)
    if (position%state%axis_gap < steps%problem%law%edge_gap) &
      branch%worst_spacing = max(branch%worst_spacing, steps%spacing_over_neck(position))
  end subroutine note

  !> Lets a load at h0 be the branch's largest tension if it is.
  subroutine lower(branch, load, h0)
    type(branch_t), intent(inout) :: branch
    real(wp), intent(in) :: load, h0

    if (allocated(branch%load)) then
      if (load >= branch%load) return
    end if
    branch%load = load
    branch%load_h0 = h0
  end subroutine lower

  !> Refines the largest tension of a stretch that ends at `finish`, or keeps it for later as
  !> `deferred`, which is the best of those. ended counts the stretches.
  subroutine end_stretch(steps, stretch, finish, ended, deferred, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(stretch_t), intent(inout) :: stretch, deferred
    real(wp), intent(in) :: finish
    integer, intent(inout) :: ended
    type(branch_t), intent(inout) :: branch

    if (.not. stretch%open) return
    stretch%open = .false.
    if (stretch%lowest%state%load < 0) then
      call lower(branch, stretch%lowest%state%load, stretch%lowest%state%h0)
    else if (.not. steps%problem%law%adhesion > 0) then
      return
    end if
    if (abs(stretch%after - stretch%lowest%state%h0) <= 0.0_wp) stretch%after = finish
    ended = ended + 1
    if (ended <= searched_at_once) then
      call refine(steps, stretch, branch)
    else if (.not. deferred%open) then
      deferred = stretch
      deferred%open = .true.
    else if (stretch%lowest%state%load < deferred%lowest%state%load) then
      deferred = stretch
      deferred%open = .true.
    end if
  end subroutine end_stretch

  !> Searches the largest tension between stretch%before and stretch%after: the polynomial through
  !> the states nearest to the lowest is searched, the state there computed and added, and so on;
  !> where that leads nowhere the larger side is halved, for on a coarse path the extremum may lie
  !> on either.
  subroutine refine(steps, stretch, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_t), intent(inout) :: branch
    type(position_t) :: best, trial
    type(event_t) :: event
    real(wp), allocatable :: h0(:), load(:)
    real(wp) :: low, high, left, right, next, width, gained
    integer :: round

    best = stretch%lowest
    h0 = [best%state%h0]
    load = [best%state%load]
    low = min(stretch%before, stretch%after)
    high = max(stretch%before, stretch%after)
    width = high - low
    ! Between steps as close as this there is nothing to find that rounding would not hide.
    if (.not. width > closest*max(1.0_wp, abs(low), abs(high))) return
    ! Nor between states that the paper's rule has stopped anywhere: what is computed there is one
    ! more of them, and not of this experiment.
    if (steps%options%stop_on_change .and. steps%options%method == 'mixing') return
    if (stretch%jagged) then
      call search_jump_by_jump(steps, stretch, branch)
      return
    end if
    do round = 1, most_rounds
      left = max(low, maxval([low, pack(h0, h0 < best%state%h0)]))
      right = min(high, minval([high, pack(h0, h0 > best%state%h0)]))
      next = interpolated_maximum(h0, -load, left, right)
      if (size(h0) < 3 .or. minval(abs(h0 - next)) <= 1.0e-3_wp*(right - left)) then
        ! The polynomial has nothing to add: is the extremum there, or has one side not been looked
        ! at?
        if (any(h0 < best%state%h0) .and. any(h0 > best%state%h0) .and. &
          right - left < enough*width) exit
        next = merge(0.5_wp*(left + best%state%h0), 0.5_wp*(right + best%state%h0), &
          best%state%h0 - left > right - best%state%h0)
      end if
      trial = best
      call steps%go(next, trial, event)
      if (event%jumped .or. .not. event%converged) then
        ! The stretch does not reach there, but to the jump, where its tension may be largest.
        if (event%jumped) next = event%jump_h0
        if (next < best%state%h0) low = next
        if (next > best%state%h0) high = next
        if (event%jumped .and. (next - best%state%h0)*(stretch%after - stretch%before) > 0 .and. &
          event%jump_load < 0) call lower(branch, event%jump_load, next)
        cycle
      end if
      h0 = [h0, next]
      load = [load, trial%state%load]
      gained = best%state%load - trial%state%load
      if (gained > 0) best = trial
      if (size(h0) > 3 .and. abs(gained) <= load_tolerance*abs(best%state%load)) exit
      call keep_nearest(h0, load)
    end do
    if (best%state%load < 0) then
      call lower(branch, best%state%load, best%state%h0)
      call add_witness(branch%witness, steps%witness(best))
    end if
  end subroutine refine

  !> Goes once more from stretch%before to stretch%after, or from the lowest state where a jump came
  !> before it, with every jump of the contact edge located: the tension is largest just before one.
  subroutine search_jump_by_jump(steps, stretch, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(stretch_t), intent(in) :: stretch
    type(branch_t), intent(inout) :: branch
    type(position_t) :: position, best
    type(event_t) :: event
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
      call steps%go(start + (stretch%after - start)*i/count, position, event)
      if (.not. event%converged .or. event%reason /= '') exit
      if (event%jumped .and. event%jump_load < 0) &
        call lower(branch, event%jump_load, event%jump_h0)
      if (position%state%load < best%state%load) best = position
    end do
    if (best%state%load < 0) then
      call lower(branch, best%state%load, best%state%h0)
      call add_witness(branch%witness, steps%witness(best))
    end if
  end subroutine search_jump_by_jump

  !> Drops values until the five nearest to the lowest load are left.
  pure subroutine keep_nearest(h0, load)
    real(wp), allocatable, intent(inout) :: h0(:), load(:)
    integer :: farthest

    do while (size(h0) > 5)
      farthest = maxloc(abs(h0 - h0(minloc(load, 1))), 1)
      h0 = [h0(:farthest - 1), h0(farthest + 1:)]
      load = [load(:farthest - 1), load(farthest + 1:)]
    end do
  end subroutine keep_nearest

end module cycle
