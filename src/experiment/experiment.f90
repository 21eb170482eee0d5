!> Runs the requested experiments of the elastic problem: the equilibrium path, the cycle stepped in
!> h0. Effects that are not requested are not set up.
module experiment
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use experiment_request, only: request_t
  use numerics_choice, only: choice_t, choose, fixed_mesh
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use ending, only: turn_not_reached
  use stepper, only: stepper_t, keeping_stepper_t, branch_point_t
  use locked_stepper, only: locked_stepper_t, unique_stepper_t
  use path_stepper, only: path_stepper_t
  use fixed_stepper, only: fixed_stepper_t
  use rigid_bodies, only: run_rigid
  use stepped_branch, only: h0_schedule_t, run_branch
  use path_demand, only: path_start
  use h0_schedule, only: path_plan, loading_plan, unloading_plan
  use experiment_result, only: experiment_result_t, enter_readings, enter_energy, enter_table
  use exact_path, only: trace_exactly
  use finer_solver, only: finer_t
  use place_errors, only: judge_places, conclude
  use place_rates, only: rate_places
  use path, only: follow_path
  use path_readings, only: read_path
  use timed_run, only: run_timed
  use journal, only: journal_t
  use records, only: observer_t
  use clock, only: seconds
  use machine, only: use_threads_for
  implicit none
  private
  public :: run_experiment, prepare

  !> The coupling for rigid bodies: it is so small that the bodies do not deform noticeably, even
  !> under the pressure of a fluid, which may be much larger than that of the law.
  real(wp), parameter :: unyielding = 1.0e-18_wp

contains

  !> Runs the path and the cycle; does nothing if neither is requested. keeper: stores the cycle's
  !> steps, and has the steps of an earlier run. store: a store of edge-locked meshes.
  subroutine run_experiment(request, problem, observer, outcome, keeper, store)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(out) :: outcome
    class(keeping_stepper_t), intent(inout), optional :: keeper
    type(mesh_store_t), intent(inout), optional :: store
    ! Not one allocatable stepper: compiler note 3.
    type(path_stepper_t), target :: along_path
    type(unique_stepper_t), target :: one_by_one
    type(fixed_stepper_t), target :: at_nodes
    logical :: fixed

    if (.not. request%finds_states()) return
    if (allocated(request%drive)) then
      call run_driven(request, problem, observer, outcome, keeper)
      return
    end if
    outcome%chosen = choose(request, problem)
    if (problem%rigid) then
      call run_rigid(request, problem, observer, outcome)
      call conclude(outcome%places, outcome%error_estimate)
      return
    end if
    fixed = outcome%chosen%is_fixed()
    if (allocated(request%path) .or. .not. fixed) then
      if (problem%law%adhesion > 0) then
        call run_with(along_path, request, problem, .not. fixed, observer, outcome, keeper, store)
      else
        call run_with(one_by_one, request, problem, .not. fixed, observer, outcome, keeper, store)
      end if
    end if
    if (allocated(request%loading) .and. fixed) &
      call run_with(at_nodes, request, problem, .true., observer, outcome, keeper)
  end subroutine run_experiment

  !> Runs the drive in time. Rigid bodies are replaced by bodies that are too stiff for a noticeable
  !> deformation.
  subroutine run_driven(request, problem, observer, outcome, keeper)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    class(keeping_stepper_t), intent(in), optional :: keeper
    type(problem_t) :: driven
    type(journal_t), pointer :: journal

    driven = problem
    driven%rigid = .false.
    if (problem%rigid) driven%coupling = unyielding
    outcome%chosen = choose(request, driven)
    nullify (journal)
    if (present(keeper)) journal => keeper%journal
    allocate (outcome%timed)
    call run_timed(request, driven, outcome%chosen, journal, observer, outcome%timed, &
      outcome%cost, outcome%nodes)
    if (outcome%timed%begun) outcome%error_estimate = outcome%timed%estimate
  end subroutine run_driven

  !> Runs the path, and the cycle if `with_cycle` and the scene has one, with a stepper. A stepper
  !> on a mesh fixed in space runs the cycle only.
  subroutine run_with(steps, request, problem, with_cycle, observer, outcome, keeper, store)
    class(stepper_t), intent(inout), target :: steps
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: with_cycle
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    class(keeping_stepper_t), intent(inout), target, optional :: keeper
    type(mesh_store_t), intent(inout), target, optional :: store
    type(finer_t) :: fine
    type(branch_point_t) :: position
    real(wp) :: began, judged

    call prepare(steps, problem, outcome%chosen)
    steps%cost = outcome%cost
    call lay_out(outcome%chosen)
    began = seconds()
    judged = steps%cost%estimate_seconds
    select type (steps)
    class is (path_stepper_t)
      call trace_exactly(request, steps, outcome%chosen, observer, fine, outcome%places, store)
      outcome%left_out = steps%known%left_out
      if (allocated(request%path)) call run_path(steps)
      if (request%reads_path()) then
        call read_path(request, steps, observer, outcome%readings)
        call enter_readings(outcome%readings, outcome%places)
      end if
    class is (unique_stepper_t)
      call fine%lay_out(steps, outcome%chosen, store)
      ! There is one state for every h0, so h0 is stepped.
      if (allocated(request%path)) then
        allocate (outcome%stepped_path)
        call run_branch(steps, path_plan(request, steps%problem%law, steps%far_away()), .true., &
          position, observer, outcome%stepped_path, outcome%places)
      end if
    end select
    outcome%nodes = outcome%nodes + sum(steps%meshes%grid%nodes)
    if (allocated(request%loading) .and. with_cycle) call run_cycle(steps)
    ! The time for judging folds and extrema is counted separately.
    steps%cost%solve_seconds = steps%cost%solve_seconds + seconds() - began - &
      (steps%cost%estimate_seconds - judged)
    began = seconds()
    call observer%hear('estimating errors')
    select type (steps)
    class is (path_stepper_t)
      call enter_energy(steps%known, outcome)
      if (request%table) call enter_table(steps, outcome%readings, outcome%places)
    class is (fixed_stepper_t)
      call fine%lay_out_fixed(steps, outcome%chosen)
    end select
    call judge_places(fine, steps, outcome%places, .false.)
    call conclude(outcome%places, outcome%error_estimate)
    steps%cost%estimate_seconds = steps%cost%estimate_seconds + seconds() - began
    select type (steps)
    class is (path_stepper_t)
      if (allocated(request%varied)) &
        call rate_places(request%varied, steps, observer, outcome)
    end select
    outcome%cost = steps%cost

  contains

    subroutine lay_out(chosen)
      type(choice_t), intent(in) :: chosen
      real(wp) :: began

      began = seconds()
      select type (steps)
      class is (locked_stepper_t)
        ! The path is not solved by mixing, which cannot find unstable states.
        if (steps%problem%law%adhesion > 0) steps%options%mixing = .false.
        ! Kernels are made by small products, and cases of a sweep make them at the same time.
        call use_threads_for(1)
        steps%meshes = new_mesh_family(steps%problem, chosen%high, chosen%low, chosen%digits, &
          store=store)
      class default
        allocate (steps%meshes%grid(1))
        steps%meshes%grid(1) = fixed_mesh(chosen, steps%problem)
      end select
      steps%cost%kernel_seconds = steps%cost%kernel_seconds + seconds() - began
      steps%cost%kernel_entries = steps%cost%kernel_entries + &
        sum(steps%meshes%grid%kernel_entries())
      call use_threads_for(maxval(steps%meshes%grid%nodes))
    end subroutine lay_out

    subroutine run_path(steps)
      class(path_stepper_t), intent(inout) :: steps
      real(wp), allocatable :: profiles(:), start

      associate (law => steps%problem%law)
        allocate (profiles(0))
        if (allocated(request%profile_h0)) profiles = law%gap_of(request%profile_h0)
        allocate (outcome%path)
        if (allocated(request%path%h0_start) .or. request%reads_path()) then
          start = law%gap_of(path_start(request, steps%problem))
          ! The path may have been traced farther than the part that is shown.
          if (.not. allocated(request%path%h0_start)) start = max(start, steps%far_away())
        end if
        ! A start that is not allocated counts as absent.
        call follow_path(steps, law%gap_of(request%path%h0_end), profiles, observer, outcome%path, &
          outcome%places, start)
      end associate
    end subroutine run_path

    !> Runs the loading, then an unloading from each turning point; a keeper stores the steps.
    subroutine run_cycle(solving)
      class(stepper_t), intent(inout), target :: solving
      class(stepper_t), pointer :: steps
      type(h0_schedule_t) :: plan
      type(branch_point_t) :: position
      type(branch_point_t), allocatable :: turning(:)
      real(wp), allocatable :: from(:)
      integer :: k

      steps => solving
      if (present(keeper)) then
        call keeper%keep_steps_of(solving)
        steps => keeper
      end if
      allocate (from(0))
      if (allocated(request%unloading)) from = steps%problem%law%gap_of(request%unloading%from)
      allocate (turning(size(from)))
      allocate (outcome%loading)
      plan = loading_plan(request, steps%problem%law, from)
      call run_branch(steps, plan, .true., position, observer, outcome%loading, outcome%places, &
        from, turning)
      ! If the path has the jumps, they are exact.
      if (allocated(outcome%loading%jump) .and. .not. outcome%places%has('jump_in')) &
        call outcome%places%enter('jump_in', 1, outcome%loading%jump)
      if (allocated(request%unloading)) allocate (outcome%unloading(size(from)))
      do k = 1, size(from)
        associate (branch => outcome%unloading(k), places => outcome%places)
          if (allocated(turning(k)%state%gap)) then
            position = turning(k)
            plan = unloading_plan(request, steps%problem%law, k)
            call run_branch(steps, plan, .false., position, observer, branch, places)
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
      if (.not. present(keeper)) return
      solving%cost%states = solving%cost%states + keeper%cost%states
      solving%cost%solve_seconds = solving%cost%solve_seconds + keeper%earlier_seconds
    end subroutine run_cycle

  end subroutine run_with

  !> Sets the parts that both kinds of steppers have.
  subroutine prepare(steps, problem, chosen)
    class(stepper_t), intent(inout) :: steps
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen

    steps%problem = problem
    steps%options = chosen%options
  end subroutine prepare

end module experiment
