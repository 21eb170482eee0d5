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
  use path_coordinate, only: far_away
  use ending, only: path_lost
  use stepper, only: stepper_t, branch_point_t, step_result_t
  use fixed_branch, only: change, same_state
  use locked_stepper, only: locked_stepper_t
  use path_demand, only: path_start, demand_of
  use path_end, only: demand_t
  use path, only: follow_path
  use path_readings, only: read_path
  use stepped_branch, only: run_branch
  use h0_schedule, only: h0_schedule_t, path_plan, thinned
  use loading_cycle, only: branches_t, run_cycle
  use experiment_result, only: experiment_result_t, enter_readings, enter_energy, enter_table, &
    enter_turns
  use reported_place, only: place_t, place_without_state, of_energy
  use places, only: places_t
  use located_places, only: locate_places
  use records, only: observer_t, branch_t
  implicit none
  private
  public :: begin_locked, begin_fixed, run_once

  !> The branches of a cycle, stepped in h0.
  type, extends(branches_t) :: stepped_branches_t
    class(stepper_t), pointer :: steps => null()
    class(observer_t), pointer :: observer => null()
    !> The positions at the turning points of the loading and, last, at its start.
    type(branch_point_t), allocatable :: turning(:)
  contains
    procedure :: run_branch => run_stepped
  end type stepped_branches_t

contains

  !> Lays out the meshes of a run that are locked to the contact edge and, under a law that
  !> attracts, traces the path. coarser: the meshes of a run with fewer digits; keep: see
  !> `new_mesh_family`.
  subroutine begin_locked(steps, request, problem, chosen, observer, store, coarser, keep)
    class(locked_stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    class(observer_t), intent(inout) :: observer
    type(mesh_store_t), intent(inout), optional :: store
    type(mesh_family_t), intent(in), optional :: coarser
    logical, intent(in), optional :: keep
    type(demand_t), allocatable :: demand

    call begin(steps, problem, chosen)
    ! The path is not solved by mixing, which cannot find unstable states.
    if (problem%law%adhesion > 0) steps%options%mixing = .false.
    if (request%reads_path()) allocate (demand, source=demand_of(request, problem))
    call lay_out(fronts=.true.)
    if (.not. allocated(steps%known)) return
    ! The path is lost if the radius of the front to which meshes are locked decreases.
    if (steps%known%ending%cause == path_lost .and. steps%meshes%fronts) call lay_out(.false.)

  contains

    !> Lays out the meshes, and traces the path on them.
    subroutine lay_out(fronts)
      logical, intent(in) :: fronts
      real(wp) :: began

      began = seconds()
      ! Kernels are made by small products, and cases of a sweep make them at the same time.
      call use_threads_for(1)
      steps%meshes = new_mesh_family(problem, chosen%high, chosen%low, chosen%digits, &
        store=store, coarser=coarser, keep=keep, fronts=fronts)
      call count_kernels(steps, began)
      call steps%find_path(chosen%high, chosen%low, chosen%ends_at, allocated(request%path), &
        chosen%accuracy, observer, demand)
    end subroutine lay_out

  end subroutine begin_locked

  !> Makes the mesh of a run that is fixed in space.
  subroutine begin_fixed(steps, problem, chosen)
    class(stepper_t), intent(inout) :: steps
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    real(wp) :: began

    call begin(steps, problem, chosen)
    began = seconds()
    if (allocated(steps%meshes%grid)) deallocate (steps%meshes%grid)
    allocate (steps%meshes%grid(1))
    steps%meshes%grid(1) = fixed_mesh(chosen, problem)
    call count_kernels(steps, began)
  end subroutine begin_fixed

  !> Prepares a stepper for a problem.
  subroutine begin(steps, problem, chosen)
    class(stepper_t), intent(inout) :: steps
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen

    call steps%set_up(problem, chosen%options)
    call steps%operator%forget()
    call steps%frozen%forget()
  end subroutine begin

  !> Adds the cost of the kernels of new meshes, and sets the number of threads for them.
  subroutine count_kernels(steps, began)
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: began

    steps%cost%kernel_seconds = steps%cost%kernel_seconds + seconds() - began
    steps%cost%kernel_entries = steps%cost%kernel_entries + &
      sum(steps%meshes%grid%kernel_entries())
    call use_threads_for(maxval(steps%meshes%grid%nodes))
  end subroutine count_kernels

  !> Runs the path if `with_path`, and the cycle if `with_cycle`, as far as the scene has them.
  !> rows: whether all rows are wanted, or only those from which numbers are taken. outcome: may
  !> have the numbers of other steppers, which are not computed again. like: the numbers of a run
  !> with which this one is compared.
  subroutine run_once(steps, request, with_path, with_cycle, rows, observer, outcome, like)
    class(stepper_t), intent(inout), target :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: with_path, with_cycle, rows
    class(observer_t), intent(inout), target :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(places_t), intent(in), optional :: like
    type(stepped_branches_t) :: branches
    integer(long) :: states

    states = steps%cost%states
    if (allocated(steps%known)) then
      outcome%left_out = steps%known%left_out
      if (allocated(request%path)) call run_path(steps, request, rows, observer, outcome)
      if (.not. rows) steps%cost%states = states
      if (request%reads_path()) then
        if (.not. allocated(outcome%readings)) &
          call read_path(request, steps, observer, outcome%readings)
        call enter_readings(outcome%readings, outcome%places)
      end if
      states = steps%cost%states
    else if (with_path .and. allocated(request%path)) then
      ! There is one state for every h0, so h0 is stepped.
      call run_path_in_steps(steps, request, rows, observer, outcome)
    end if
    if (allocated(request%loading) .and. with_cycle) then
      branches%steps => steps
      branches%observer => observer
      call run_cycle(branches, request, steps%problem%law, rows, outcome%loading, &
        outcome%unloading, outcome%places)
    end if
    ! Only rows count as states of the experiment.
    if (.not. rows) steps%cost%states = states
    if (allocated(steps%known)) then
      call enter_energy(steps%known, outcome)
      call enter_turns(steps%known, outcome%places)
      if (request%table) call enter_table(steps, outcome%readings, outcome%places, like)
    end if
    call locate_places(steps, outcome%places, like)
  end subroutine run_once

  subroutine run_path(steps, request, rows, observer, outcome)
    class(stepper_t), intent(inout) :: steps
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
        if (.not. allocated(request%path%h0_start)) start = max(start, far_away(steps%problem, &
          steps%meshes))
      end if
      ! A start that is not allocated counts as absent.
      call follow_path(steps, law%gap_of(request%path%h0_end), profiles, rows, observer, &
        outcome%path, outcome%places, start)
    end associate
  end subroutine run_path

  subroutine run_path_in_steps(steps, request, rows, observer, outcome)
    class(stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    logical, intent(in) :: rows
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(h0_schedule_t) :: plan
    type(branch_point_t) :: position

    plan = path_plan(request, steps%problem%law, far_away(steps%problem, steps%meshes))
    if (.not. rows) plan = thinned(plan, plan%h0(:0))
    if (allocated(outcome%stepped_path)) deallocate (outcome%stepped_path)
    allocate (outcome%stepped_path)
    call run_branch(steps, plan, .true., position, observer, outcome%stepped_path, outcome%places)
  end subroutine run_path_in_steps

  !> Runs a branch of a cycle: see `loading_cycle`.
  subroutine run_stepped(self, plan, k, branch, places, reached)
    class(stepped_branches_t), intent(inout) :: self
    type(h0_schedule_t), intent(in) :: plan
    integer, intent(in) :: k
    type(branch_t), intent(out) :: branch
    type(places_t), intent(inout) :: places
    logical, intent(out) :: reached
    type(branch_point_t) :: position

    if (k == 0) then
      allocate (self%turning(size(self%from) + 1))
      call run_branch(self%steps, plan, .true., position, self%observer, branch, places, &
        [self%from, plan%h0(1)], self%turning)
      reached = .true.
      return
    end if
    reached = allocated(self%turning(k)%state%gap)
    if (.not. reached) return
    position = self%turning(k)
    call run_branch(self%steps, plan, .false., position, self%observer, branch, places)
    if (k == 1) call enter_energy_of(self%steps, self%turning(size(self%turning)), position, &
      branch, places)
  end subroutine run_stepped

  !> Enters the energy that was lost in jumps on a mesh fixed in space, from the start of a loading
  !> to `position`, the end of an unloading. It is entered if the branch leads from there back to
  !> the start.
  subroutine enter_energy_of(steps, start, position, unloading, places)
    class(stepper_t), intent(inout) :: steps
    type(branch_point_t), intent(in) :: start
    type(branch_point_t), intent(inout) :: position
    type(branch_t), intent(in) :: unloading
    type(places_t), intent(inout) :: places
    type(step_result_t) :: event
    type(place_t) :: place

    ! If there is a path, its energy has been entered. Without a jump no energy is lost; NaN means
    ! that the energy is not known.
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
