!> One run of a scene's experiments with one stepper and one choice of numerics: from the problem
!> and its meshes to named numbers (the places of `experiment_result_t`), and to rows if they are
!> wanted.
module one_run
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, long
  use clock, only: seconds
  use machine, only: use_threads_for
  use dimensionless_problem, only: problem_t
  use experiment_request, only: request_t
  use numerics_choice, only: choice_t, fixed_mesh
  use mesh_family, only: mesh_family_t
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use ending, only: turn_not_reached, path_lost
  use stepper, only: stepper_t, branch_point_t, step_result_t
  use fixed_branch, only: change, same_state
  use locked_stepper, only: locked_stepper_t, unique_stepper_t
  use path_stepper, only: path_stepper_t
  use path_demand, only: path_start, demand_of
  use path_end, only: demand_t
  use path, only: follow_path
  use path_readings, only: read_path
  use stepped_branch, only: branch_t, run_branch
  use h0_schedule, only: h0_schedule_t, path_plan, loading_plan, unloading_plan, thinned
  use experiment_result, only: experiment_result_t, enter_readings, enter_energy, enter_table, &
    enter_turns
  use reported_place, only: place_t, place_without_state, of_energy
  use places, only: places_t
  use located_places, only: locate_places
  use records, only: observer_t
  implicit none
  private
  public :: begin_run, run_once

contains

  !> Lays out the meshes of a run and, under a law that attracts, traces the path. coarser: the
  !> meshes of a run with fewer digits; keep: see `new_mesh_family`.
  subroutine begin_run(steps, request, problem, chosen, observer, store, coarser, keep)
    class(stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    class(observer_t), intent(inout) :: observer
    type(mesh_store_t), intent(inout), optional :: store
    type(mesh_family_t), intent(in), optional :: coarser
    logical, intent(in), optional :: keep
    type(demand_t), allocatable :: demand

    call steps%set_up(problem, chosen%options)
    call steps%operator%forget()
    call steps%frozen%forget()
    call lay_out(.true.)
    select type (steps)
    class is (path_stepper_t)
      if (request%reads_path()) allocate (demand, source=demand_of(request, problem))
      call trace()
      ! The radius to which meshes are locked may decrease.
      if (steps%known%ending%cause == path_lost .and. steps%meshes%fronts) then
        call lay_out(.false.)
        call trace()
      end if
    end select

  contains

    subroutine lay_out(fronts)
      logical, intent(in) :: fronts
      real(wp) :: began

      began = seconds()
      select type (steps)
      class is (locked_stepper_t)
        ! The path is not solved by mixing, which cannot find unstable states.
        if (problem%law%adhesion > 0) steps%options%mixing = .false.
        ! Kernels are made by small products, and cases of a sweep make them at the same time.
        call use_threads_for(1)
        steps%meshes = new_mesh_family(problem, chosen%high, chosen%low, chosen%digits, &
          store=store, coarser=coarser, keep=keep, fronts=fronts)
      class default
        if (allocated(steps%meshes%grid)) deallocate (steps%meshes%grid)
        allocate (steps%meshes%grid(1))
        steps%meshes%grid(1) = fixed_mesh(chosen, problem)
      end select
      steps%cost%kernel_seconds = steps%cost%kernel_seconds + seconds() - began
      steps%cost%kernel_entries = steps%cost%kernel_entries + &
        sum(steps%meshes%grid%kernel_entries())
      call use_threads_for(maxval(steps%meshes%grid%nodes))
    end subroutine lay_out

    subroutine trace()
      select type (steps)
      class is (path_stepper_t)
        call steps%know_path(chosen%high, chosen%low, chosen%ends_at, allocated(request%path), &
          chosen%accuracy, observer, demand)
      end select
    end subroutine trace

  end subroutine begin_run

  !> Runs the path, and the cycle if the scene has one and `with_cycle`. rows: whether all rows are
  !> wanted, or only those from which numbers are taken. outcome: may have the numbers of other
  !> steppers, which are not computed again. like: the numbers of a run with which this one is
  !> compared.
  subroutine run_once(steps, request, with_cycle, rows, observer, outcome, like)
    class(stepper_t), intent(inout), target :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: with_cycle, rows
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(places_t), intent(in), optional :: like

    integer(long) :: states

    states = steps%cost%states
    select type (steps)
    class is (path_stepper_t)
      outcome%left_out = steps%known%left_out
      if (allocated(request%path)) call run_path(steps, request, rows, observer, outcome)
      if (.not. rows) steps%cost%states = states
      if (request%reads_path()) then
        if (.not. allocated(outcome%readings)) &
          call read_path(request, steps, observer, outcome%readings)
        call enter_readings(outcome%readings, outcome%places)
      end if
      states = steps%cost%states
    class is (unique_stepper_t)
      ! There is one state for every h0, so h0 is stepped.
      if (allocated(request%path)) call run_path_in_steps(steps, request, rows, observer, outcome)
    end select
    if (allocated(request%loading) .and. with_cycle) &
      call run_cycle(steps, request, rows, observer, outcome)
    ! Only rows count as states of the experiment.
    if (.not. rows) steps%cost%states = states
    select type (steps)
    class is (path_stepper_t)
      call enter_energy(steps%known, outcome)
      call enter_turns(steps%known, outcome%places)
      if (request%table) call enter_table(steps, outcome%readings, outcome%places, like)
    end select
    call locate_places(steps, outcome%places, like)
  end subroutine run_once

  subroutine run_path(steps, request, rows, observer, outcome)
    class(path_stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: rows
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    real(wp), allocatable :: profiles(:), start

    associate (law => steps%problem%law)
      allocate (profiles(0))
      if (allocated(request%profile_h0)) profiles = law%gap_of(request%profile_h0)
      if (allocated(outcome%path)) deallocate (outcome%path)
      allocate (outcome%path)
      if (allocated(request%path%h0_start) .or. request%reads_path()) then
        start = law%gap_of(path_start(request, steps%problem))
        ! The path may have been traced farther than the part that is shown.
        if (.not. allocated(request%path%h0_start)) start = max(start, steps%far_away())
      end if
      ! A start that is not allocated counts as absent.
      call follow_path(steps, law%gap_of(request%path%h0_end), profiles, rows, observer, &
        outcome%path, outcome%places, start)
    end associate
  end subroutine run_path

  subroutine run_path_in_steps(steps, request, rows, observer, outcome)
    class(unique_stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: rows
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(h0_schedule_t) :: plan
    type(branch_point_t) :: position

    plan = path_plan(request, steps%problem%law, steps%far_away())
    if (.not. rows) plan = thinned(plan, plan%h0(:0))
    if (allocated(outcome%stepped_path)) deallocate (outcome%stepped_path)
    allocate (outcome%stepped_path)
    call run_branch(steps, plan, .true., position, observer, outcome%stepped_path, outcome%places)
  end subroutine run_path_in_steps

  !> Runs the loading, then an unloading from each turning point.
  subroutine run_cycle(steps, request, rows, observer, outcome)
    class(stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: rows
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(h0_schedule_t) :: plan
    type(branch_point_t) :: position
    type(branch_point_t), allocatable :: turning(:)
    real(wp), allocatable :: from(:)
    real(wp) :: start
    integer :: k

    allocate (from(0))
    if (allocated(request%unloading)) from = steps%problem%law%gap_of(request%unloading%from)
    ! The last one is the state at which loading begins.
    allocate (turning(size(from) + 1))
    if (allocated(outcome%loading)) deallocate (outcome%loading)
    if (allocated(outcome%unloading)) deallocate (outcome%unloading)
    allocate (outcome%loading)
    plan = loading_plan(request, steps%problem%law, from)
    if (.not. rows) plan = thinned(plan, from)
    start = plan%h0(1)
    call run_branch(steps, plan, .true., position, observer, outcome%loading, outcome%places, &
      [from, start], turning)
    ! If the path has the jumps, they are exact.
    if (allocated(outcome%loading%jump) .and. .not. outcome%places%has('jump_in')) &
      call outcome%places%enter('jump_in', 1, outcome%loading%jump)
    if (allocated(request%unloading)) allocate (outcome%unloading(size(from)))
    do k = 1, size(from)
      associate (branch => outcome%unloading(k), places => outcome%places)
        if (allocated(turning(k)%state%gap)) then
          position = turning(k)
          plan = unloading_plan(request, steps%problem%law, k)
          if (.not. rows) plan = thinned(plan, plan%h0(:0))
          call run_branch(steps, plan, .false., position, observer, branch, places)
          if (k == 1) call enter_energy_of(steps, turning(size(turning)), position, branch, places)
        else
          branch%ending%cause = turn_not_reached
        end if
        ! An argument that is not allocated counts as absent.
        call places%enter('unload_max_tension', k, branch%lowest)
        call places%enter('unload_jump_out', k, branch%jump)
        if (allocated(branch%jump) .and. .not. places%has('jump_out')) &
          call places%enter('jump_out', 1, branch%jump)
      end associate
    end do
  end subroutine run_cycle

  !> Enters the energy that was lost in jumps between the start of a loading and the position at the
  !> end of an unloading on a mesh fixed in space, if the branch leads from there back to the start.
  subroutine enter_energy_of(steps, start, position, unloading, places)
    class(stepper_t), intent(inout) :: steps
    type(branch_point_t), intent(in) :: start
    type(branch_point_t), intent(inout) :: position
    type(branch_t), intent(in) :: unloading
    type(places_t), intent(inout) :: places
    type(step_result_t) :: event
    type(place_t) :: place

    ! With a path, the energy is that of the path. Without a jump none is lost; NaN means unknown.
    if (places%has('energy_lost') .or. ieee_is_nan(position%lost)) return
    if (.not. abs(position%lost) > 0) return
    if (unloading%ending%early() .or. .not. allocated(start%state%gap)) return
    if (abs(position%state%h0 - start%state%h0) > 0) then
      call steps%step_to(start%state%h0, position, event)
      if (event%jumped .or. .not. event%converged) return
    end if
    if (.not. change(start%state, position%state) <= same_state) return
    place = place_without_state(0.0_wp, 0.0_wp)
    place%at(of_energy) = position%lost
    place%left(of_energy) = position%lost_error
    call places%enter('energy_lost', 1, place)
  end subroutine enter_energy_of

end module one_run
