!> The h0-stepped experiment: loading, and an unloading from each turning point, the deformation carried
!> over from step to step.
module cycle
  use kinds, only: wp
  use equilibrium, only: state_t
  use quadrature, only: interpolated_maximum
  use quasi_static, only: quasi_static_t, position_t, event_t, witness_t
  use records, only: observer_t, record_of, stable_yes, stable_unasked
  implicit none
  private
  public :: plan_t, branch_t, run_branch

  !> The values of h0 to go through, and those whose profile is wanted; in the law's lengths.
  type :: plan_t
    character(len=:), allocatable :: name
    real(wp), allocatable :: h0(:)
    logical, allocatable :: profile(:)
  end type plan_t

  !> What a branch showed, in the units of `problem`. Unallocated: there was none.
  type :: branch_t
    !> Largest tension (a negative load) and where.
    real(wp), allocatable :: load, load_h0
    !> The first jump: h0, the load just before it, and how well h0 is known.
    real(wp), allocatable :: jump_h0, jump_load
    real(wp) :: jump_uncertainty = 0
    real(wp) :: worst_residual = 0, worst_spacing = 0
    !> Where the reported numbers come from: the ends and the middle, the jump, the largest tension.
    type(witness_t), allocatable :: witness(:)
    integer :: states = 0, unconverged = 0
    !> First h0 that did not converge, and why the branch ended early; empty if it did not.
    real(wp) :: first_unconverged = 0
    character(len=160) :: reason = ''
  end type branch_t

  !> Rounds of refinement of the maximum tension, and the relative change of load that ends them.
  integer, parameter :: most_rounds = 8
  real(wp), parameter :: load_tolerance = 1.0e-10_wp

contains

  !> Goes through plan%h0. A new experiment (fresh) begins by an approach from afar at the first
  !> value; otherwise it goes on from `position`. Positions at the values `keep` (ascending or
  !> descending like plan%h0) are handed back in `kept`.
  subroutine run_branch(steps, plan, fresh, position, observer, keep, kept, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(plan_t), intent(in) :: plan
    logical, intent(in) :: fresh
    type(position_t), intent(inout) :: position
    class(observer_t), intent(inout) :: observer
    real(wp), intent(in) :: keep(:)
    type(position_t), intent(out) :: kept(:)
    type(branch_t), intent(out) :: branch
    type(position_t) :: last(3)
    type(event_t) :: event
    integer :: i, k, smooth

    smooth = 0
    allocate (branch%witness(0))
    do i = 1, size(plan%h0)
      if (fresh .and. i == 1) then
        call steps%begin(plan%h0(i), position, event)
      else
        call steps%go(plan%h0(i), position, event)
      end if
      steps%cost%states = steps%cost%states + 1
      call note(branch, steps, position, event, plan%h0(i))
      if (event%reason /= '') exit
      call observer%take(record_of(plan%name, steps%problem, steps%grid(position), position%state, &
        merge(stable_yes, stable_unasked, event%certain), event%converged), steps%problem, &
        steps%grid(position), position%state, plan%profile(i))
      if (any(i == [1, (1 + size(plan%h0))/2, size(plan%h0)])) &
        branch%witness = [branch%witness, steps%witness(position)]
      if (allocated(event%fold)) branch%witness = [branch%witness, event%fold]
      do k = 1, size(keep)
        if (abs(keep(k) - plan%h0(i)) <= 1.0e-9_wp*max(1.0_wp, abs(keep(k)))) kept(k) = position
      end do

      last = [last(2:3), position]
      smooth = smooth + 1
      if (event%jumped .or. .not. event%converged) smooth = 1
      if (position%state%load < 0) call lower(branch, position%state)
      if (smooth >= 3) then
        if (last(2)%state%load < min(last(1)%state%load, last(3)%state%load) .and. &
          last(2)%state%load < 0) call refine(steps, last, branch)
      end if
    end do
  end subroutine run_branch

  !> Keeps the worst and the first of what happened.
  subroutine note(branch, steps, position, event, h0)
    type(branch_t), intent(inout) :: branch
    class(quasi_static_t), intent(in) :: steps
    type(position_t), intent(in) :: position
    type(event_t), intent(in) :: event
    real(wp), intent(in) :: h0

    branch%reason = event%reason
    if (event%reason /= '') return
    branch%states = branch%states + 1
    if (event%jumped .and. .not. allocated(branch%jump_h0)) then
      branch%jump_h0 = event%jump_h0
      branch%jump_load = event%jump_load
      branch%jump_uncertainty = event%jump_uncertainty
      if (event%jump_load < 0) then
        if (.not. allocated(branch%load)) then
          branch%load = event%jump_load
          branch%load_h0 = event%jump_h0
        else if (event%jump_load < branch%load) then
          branch%load = event%jump_load
          branch%load_h0 = event%jump_h0
        end if
      end if
    end if
    if (.not. event%converged) then
      if (branch%unconverged == 0) branch%first_unconverged = h0
      branch%unconverged = branch%unconverged + 1
    end if
    branch%worst_residual = max(branch%worst_residual, position%state%residual)
    if (position%state%axis_gap < steps%problem%law%edge_gap) &
      branch%worst_spacing = max(branch%worst_spacing, steps%spacing_over_neck(position))
  end subroutine note

  !> Lets a state be the branch's largest tension if it is.
  subroutine lower(branch, state)
    type(branch_t), intent(inout) :: branch
    type(state_t), intent(in) :: state

    if (allocated(branch%load)) then
      if (state%load >= branch%load) return
    end if
    branch%load = state%load
    branch%load_h0 = state%h0
  end subroutine lower

  !> The largest tension between three neighbouring states of which the middle one has the largest: the
  !> polynomial through them is searched, the state there computed and added, and so on.
  subroutine refine(steps, last, branch)
    class(quasi_static_t), intent(inout) :: steps
    type(position_t), intent(in) :: last(3)
    type(branch_t), intent(inout) :: branch
    type(position_t) :: trial
    type(event_t) :: event
    real(wp), allocatable :: h0(:), load(:)
    real(wp) :: next, before
    type(witness_t) :: lowest
    integer :: round, best

    lowest = steps%witness(last(2))
    h0 = last%state%h0
    load = last%state%load
    before = load(2)
    do round = 1, most_rounds
      best = minloc(load, 1)
      next = interpolated_maximum(h0, -load, minval(h0(:3)), maxval(h0(:3)))
      if (minval(abs(h0 - next)) <= 1.0e-7_wp*abs(last(3)%state%h0 - last(1)%state%h0)) exit
      trial = last(2)
      call steps%go(next, trial, event)
      if (event%jumped .or. .not. event%converged) exit
      h0 = [h0, next]
      load = [load, trial%state%load]
      if (trial%state%load < minval(load(:size(load) - 1))) lowest = steps%witness(trial)
      call lower(branch, trial%state)
      if (abs(trial%state%load - before) <= load_tolerance*abs(before)) exit
      before = trial%state%load
      if (size(h0) > 5) then
        h0 = [h0(:3), h0(5:)]
        load = [load(:3), load(5:)]
      end if
    end do
    branch%witness = [branch%witness, lowest]
  end subroutine refine

end module cycle
