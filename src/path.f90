!> The whole equilibrium path, from bodies far apart to a contact at a given h0: stable and unstable
!> states, every fold in h0, every extremum of the load.
module path
  use kinds, only: wp
  use problem, only: spacing_over_neck
  use equilibrium, only: state_t, lost_in_rounding
  use edge_locked, only: contact, largest_radius
  use tracer, only: tracer_t, new_tracer, inward, path_control
  use trail, only: trail_t, extend, collapsed, polish_extremum, of_load
  use hysteresis, only: energy_lost
  use quasi_static, only: position_t, event_t, witness_t, add_witness, end_t, end_of, &
    beyond_rounding
  use locked_steps, only: locked_steps_t, fold_witness
  use records, only: observer_t, record_of, stable_yes, stable_no
  implicit none
  private
  public :: path_t, trace_path

  !> What the path shows, in the units of `problem`, in the order from afar inward.
  type :: path_t
    integer :: states = 0
    !> Folds in h0, and the number of unstable modes after each; extrema of the load.
    real(wp), allocatable :: fold_h0(:), fold_load(:)
    integer, allocatable :: unstable_after(:)
    real(wp), allocatable :: extremum_h0(:), extremum_load(:)
    !> Where the bodies jump at controlled h0; unallocated where they do not.
    real(wp), allocatable :: jump_in_h0, jump_in_load, jump_out_h0, jump_out_load
    !> Lost in a cycle of approach and separation at controlled h0; unallocated without jumps.
    real(wp), allocatable :: energy_lost
    !> What its integration leaves open, and the work that it is a difference of.
    real(wp) :: energy_uncertainty = 0, energy_turned_over = 0
    !> Largest tension, the pull-off at controlled load.
    real(wp), allocatable :: load, load_h0
    !> The last state, if it is stable.
    type(end_t), allocatable :: finish
    !> The folds, the largest tension and the end.
    type(witness_t), allocatable :: witness(:)
    real(wp) :: worst_residual = 0, worst_spacing = 0
    !> Whether it ends in the fall of bodies that nothing keeps apart.
    logical :: fallen = .false.
    !> Why the path ends before its end; empty where it does not.
    character(len=160) :: reason = ''
  end type path_t

  !> Relative change of the path's coordinate in a step; small enough for a smooth curve.
  real(wp), parameter :: path_step = 0.12_wp
  integer, parameter :: longest = 5000

contains

  !> Traces from h0_start or from where the bodies hardly deform, whichever is farther, to the
  !> contact at h0_end. Profiles are handed to the observer where the path crosses the values
  !> `profiles`.
  subroutine trace_path(steps, h0_start, h0_end, profiles, observer, path)
    class(locked_steps_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_start, h0_end, profiles(:)
    class(observer_t), intent(inout) :: observer
    type(path_t), intent(out) :: path
    type(tracer_t) :: walker
    type(trail_t) :: trail
    type(position_t) :: position
    type(event_t) :: event
    logical :: lost

    if (lost_in_rounding(steps%problem, &
      largest_radius(steps%problem, h0_end, steps%pair%level))) then
      path%reason = beyond_rounding
      return
    end if
    call steps%begin_afar(h0_start, position, event)
    if (event%reason /= '') then
      path%reason = event%reason
      return
    end if
    walker = new_tracer(steps%problem, position%state, position%mesh, inward, path_step)
    do
      call extend(trail, walker, steps%problem, steps%pair, steps%options, steps%options, lost, &
        steps%cost)
      if (lost) path%reason = 'the equilibrium path was lost: no step, however small, converged'
      if (lost .or. trail%held >= longest) exit
      ! Without repulsion the path ends in the bodies' collapse onto each other.
      path%fallen = collapsed(steps%problem, trail)
      if (path%fallen) exit
      associate (last => trail%held)
        if (trail%mesh(last) == contact .and. trail%unstable(last) == 0 .and. &
          trail%state(last)%h0 <= h0_end) exit
      end associate
    end do
    if (path%reason == '' .and. steps%problem%law%edge_gap > 0) &
      call end_at(steps, h0_end, trail)
    call collect(steps, trail, path)
    call hand_over(steps, trail, profiles, observer, path)
    path%states = trail%held
    steps%cost%states = steps%cost%states + trail%held
  end subroutine trace_path

  !> Replaces the last states, beyond h0_end, by the one at h0_end.
  subroutine end_at(steps, h0_end, trail)
    class(locked_steps_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_end
    type(trail_t), intent(inout) :: trail
    type(state_t) :: state
    logical :: converged
    integer :: last

    last = trail%held
    do while (last > 1)
      if (trail%state(last - 1)%h0 >= h0_end .or. trail%unstable(last - 1) > 0 .or. &
        trail%fold(last - 1) .or. trail%mesh(last - 1) /= trail%mesh(last)) exit
      last = last - 1
    end do
    if (trail%state(last - 1)%h0 < h0_end .or. trail%state(last)%h0 > h0_end) return
    call steps%land(h0_end, trail, last, state, converged)
    if (.not. converged) return
    trail%held = last
    trail%state(last) = state
    trail%coordinate(last) = log(state%scale)
  end subroutine end_at

  !> Folds, extrema of the load and jumps of a trail.
  subroutine collect(steps, trail, path)
    class(locked_steps_t), intent(inout) :: steps
    type(trail_t), intent(in) :: trail
    type(path_t), intent(inout) :: path
    type(state_t) :: state
    type(witness_t) :: lowest, finish
    integer, allocatable :: fold(:)
    real(wp) :: s
    integer :: i, j, first
    logical :: lost

    fold = pack([(j, j=1, trail%held)], trail%fold(:trail%held))
    path%fold_h0 = trail%state(fold)%h0
    path%fold_load = trail%state(fold)%load
    do j = 1, size(fold)
      call add_witness(path%witness, fold_witness(steps, trail, fold(j)))
    end do
    finish = fold_witness(steps, trail, trail%held)
    finish%displacement = .true.
    ! How a fall ends is of no interest and on no mesh.
    if (.not. path%fallen) call add_witness(path%witness, finish)
    if (trail%unstable(trail%held) == 0) path%finish = end_of(trail%state(trail%held))
    path%unstable_after = trail%unstable(min(fold + 1, trail%held))
    if (size(fold) > 0) then
      path%jump_in_h0 = path%fold_h0(1)
      path%jump_in_load = path%fold_load(1)
      if (path%unstable_after(size(fold)) == 0) then
        path%jump_out_h0 = path%fold_h0(size(fold))
        path%jump_out_load = path%fold_load(size(fold))
        ! A path that ends above the jump in lacks a part of the retreat.
        if (trail%state(trail%held)%h0 <= path%jump_in_h0) then
          path%energy_lost = 0
          call energy_lost(trail, path%energy_lost, path%energy_uncertainty, &
            path%energy_turned_over)
        end if
      end if
    end if
    allocate (path%extremum_h0(0), path%extremum_load(0))
    do i = 2, trail%held - 1
      associate (load => trail%state(i - 1:i + 1)%load)
        if ((load(2) - load(1))*(load(3) - load(2)) >= 0) cycle
      end associate
      if (any(trail%mesh(i - 1:i + 1) /= trail%mesh(i))) cycle
      first = i - 1
      do while (first > max(1, i - 3))
        if (trail%mesh(first - 1) /= trail%mesh(i)) exit
        first = first - 1
      end do
      call polish_extremum(steps%problem, steps%pair, trail%mesh(i), of_load, &
        trail%coordinate(first:i + 1), trail%state(first:i + 1), steps%options, s, state, lost, &
        steps%cost)
      if (lost) cycle
      path%extremum_h0 = [path%extremum_h0, state%h0]
      if (all(state%load < path%extremum_load)) lowest = witness_t(mesh=trail%mesh(i), &
        control=path_control(steps%problem, trail%mesh(i), s), state=state)
      path%extremum_load = [path%extremum_load, state%load]
    end do
    i = minloc(trail%state(:trail%held)%load, 1)
    path%load = trail%state(i)%load
    path%load_h0 = trail%state(i)%h0
    if (size(path%extremum_load) > 0) then
      i = minloc(path%extremum_load, 1)
      if (path%extremum_load(i) <= path%load) then
        path%load = path%extremum_load(i)
        path%load_h0 = path%extremum_h0(i)
        call add_witness(path%witness, lowest)
      end if
    end if
    path%worst_residual = maxval(trail%state(:trail%held)%residual)
    do i = 1, trail%held
      if (trail%mesh(i) == contact) path%worst_spacing = max(path%worst_spacing, &
        spacing_over_neck(steps%problem, trail%state(i)%scale*steps%pair%grid(contact)%spacing))
    end do
  end subroutine collect

  !> Gives all states to the observer, and the profiles where pieces of the path cross their h0.
  subroutine hand_over(steps, trail, profiles, observer, path)
    class(locked_steps_t), intent(inout) :: steps
    type(trail_t), intent(in) :: trail
    real(wp), intent(in) :: profiles(:)
    class(observer_t), intent(inout) :: observer
    type(path_t), intent(inout) :: path
    type(state_t) :: state
    real(wp), allocatable :: crossed(:)
    integer :: i, k
    logical :: converged

    do i = 1, trail%held
      if (i > 1) then
        associate (a => trail%state(i - 1)%h0, b => trail%state(i)%h0)
          crossed = pack(profiles, (profiles - a)*(profiles - b) < 0)
        end associate
        do k = 1, size(crossed)
          call steps%land(crossed(k), trail, i, state, converged)
          path%worst_residual = max(path%worst_residual, state%residual)
          if (.not. converged .and. path%reason == '') &
            path%reason = 'a state whose profile is asked for did not converge'
          call give(trail%mesh(i), state, stability(i), converged, .true.)
        end do
      end if
      call give(trail%mesh(i), trail%state(i), stability(i), .true., &
        any(profiles == trail%state(i)%h0))
    end do

  contains

    integer function stability(i)
      integer, intent(in) :: i

      stability = merge(stable_yes, stable_no, trail%unstable(i) == 0 .and. .not. trail%fold(i))
    end function stability

    subroutine give(mesh, state, stable, converged, profile)
      integer, intent(in) :: mesh, stable
      type(state_t), intent(in) :: state
      logical, intent(in) :: converged, profile

      call observer%take(record_of('path', steps%problem, steps%pair%grid(mesh), state, stable, &
        converged), steps%problem, steps%pair%grid(mesh), state, profile)
    end subroutine give

  end subroutine hand_over

end module path
