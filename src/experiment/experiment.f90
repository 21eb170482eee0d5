!> Runs the requested experiments of the elastic problem: the equilibrium path, and the cycle that
!> is stepped in h0. A run is a function from the problem and the numerics to named numbers
!> (`one_run`). The error of a number is estimated from its difference to that of another run. If an
!> error exceeds the accuracy of the deck, the finer run becomes the result. Effects that are not
!> requested are not set up.
module experiment
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use experiment_request, only: request_t
  use numerics_choice, only: choose, more_digits, with_fewer_nodes, with_less_extent
  use mesh_digits, only: most_digits
  use mesh_store, only: mesh_store_t
  use locked_stepper, only: locked_stepper_t, unique_stepper_t
  use path_stepper, only: path_stepper_t
  use fixed_stepper, only: fixed_stepper_t
  use rigid_bodies, only: run_rigid
  use experiment_result, only: experiment_result_t
  use one_run, only: begin_locked, begin_fixed, run_once
  use reported_numbers, only: run_numbers_t, largest_error, chance, chance_on_grids
  use path_sensitivity, only: rates_along
  use timed_run, only: run_timed
  use records, only: observer_t
  use clock, only: seconds
  implicit none
  private
  public :: run_experiment

  !> The coupling for rigid bodies, so small that they do not deform noticeably even under the
  !> pressure of a fluid, which may be much larger than that of the law.
  real(wp), parameter :: unyielding = 1.0e-18_wp

  !> Largest number of runs with more digits. If a run with more digits does not reduce the largest
  !> error to the fraction `helped`, the error has another cause, such as rounding. Then no further
  !> run is made, unless one of the two runs lacks some numbers.
  integer, parameter :: most_rounds = 4
  real(wp), parameter :: helped = 0.5_wp
  !> Least number of digits of the run for comparison under a law with a step: with fewer, the nodes
  !> of both runs may miss the same part of the step, which moves folds.
  real(wp), parameter :: digits_at_steps = 9.5_wp

contains

  !> Runs the path and the cycle; does nothing if neither is requested. store: earlier meshes that
  !> are locked to the contact edge. like: the outcome of a similar scene; then there is one run
  !> with the numerics of that outcome, its numbers have no errors from other runs, and its cost is
  !> added to that of `like`.
  subroutine run_experiment(request, problem, observer, outcome, store, like)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(out) :: outcome
    type(mesh_store_t), intent(inout), optional :: store
    type(experiment_result_t), intent(in), optional :: like
    ! Not allocatable steppers: compiler note 3.
    type(path_stepper_t), target :: along_path(2)
    type(unique_stepper_t), target :: one_by_one(2)
    type(fixed_stepper_t) :: at_nodes
    logical :: fixed

    if (.not. request%finds_states()) return
    if (present(like)) outcome%cost = like%cost
    if (allocated(request%drive)) then
      call run_driven(request, problem, observer, outcome, like)
      return
    end if
    outcome%chosen = choose(request, problem)
    if (present(like)) then
      outcome%chosen%digits = like%chosen%digits
      outcome%chosen%accuracy = like%chosen%accuracy
      outcome%chosen%options = like%chosen%options
    end if
    if (problem%rigid) then
      call run_rigid(request, problem, observer, outcome)
      return
    end if
    fixed = outcome%chosen%is_fixed()
    if (allocated(request%path) .or. .not. fixed) then
      if (problem%law%adhesion > 0) then
        call run_locked(along_path(1), along_path(2), request, problem, observer, outcome, store, &
          present(like))
      else
        call run_locked(one_by_one(1), one_by_one(2), request, problem, observer, outcome, store, &
          present(like))
      end if
    end if
    if (allocated(request%loading) .and. fixed) &
      call run_fixed(at_nodes, request, problem, observer, outcome, present(like))
  end subroutine run_experiment

  !> Runs the drive in time; like: see `run_experiment`. Rigid bodies are replaced by bodies that
  !> are too stiff for a noticeable deformation.
  subroutine run_driven(request, problem, observer, outcome, like)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(experiment_result_t), intent(in), optional :: like
    type(problem_t) :: driven
    integer, allocatable :: passes

    if (present(like)) passes = like%timed%passes
    driven = problem
    driven%rigid = .false.
    if (problem%rigid) driven%coupling = unyielding
    outcome%chosen = choose(request, driven)
    allocate (outcome%timed)
    call run_timed(request, driven, outcome%chosen, observer, outcome%timed, outcome%places, &
      outcome%error_estimate, outcome%cost, outcome%nodes, passes)
  end subroutine run_driven

  !> Runs the experiments on meshes locked to the contact edge, as accurately as the deck asks for.
  !> Rows are made for the result alone. one, other: steppers of the same type. once: there is one
  !> run with the numerics of the outcome, without rows.
  subroutine run_locked(one, other, request, problem, observer, outcome, store, once)
    class(locked_stepper_t), intent(inout), target :: one, other
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(mesh_store_t), intent(inout), optional :: store
    logical, intent(in) :: once
    class(locked_stepper_t), pointer :: steps
    type(experiment_result_t) :: ahead, nothing
    type(run_numbers_t) :: others(1)
    real(wp) :: began

    if (once) then
      one%cost = outcome%cost
      call begin_locked(one, request, problem, outcome%chosen, observer, store)
      call run_once(one, request, .true., .not. outcome%chosen%is_fixed(), .false., observer, &
        outcome)
      outcome%cost = one%cost
      return
    end if
    call agree(one, other, request, problem, observer, outcome, ahead, steps, store)
    began = seconds()
    outcome%places = nothing%places
    call run_once(steps, request, .true., .not. outcome%chosen%is_fixed(), .true., observer, &
      outcome, ahead%places)
    others(1)%number = ahead%places%numbers()
    call outcome%places%judge_by(others, chance)
    outcome%error_estimate = largest_error(outcome%places%number)
    steps%cost%solve_seconds = steps%cost%solve_seconds + seconds() - began
    outcome%nodes = outcome%nodes + sum(steps%meshes%grid%nodes)
    if (allocated(request%varied) .and. allocated(outcome%readings)) then
      call observer%hear('differentiating')
      if (outcome%readings%solved) call rates_along(steps%equations_t, steps%known%path, &
        request%varied, 0.0_wp, outcome%readings%rate, outcome%differentiated)
    end if
    outcome%cost = steps%cost
  end subroutine run_locked

  !> Runs a scene with more and more digits until the numbers of two successive runs agree within
  !> the accuracy. The coarser of these two, `outcome`, is the result; `ahead` is the other one.
  !> steps: the stepper of the result, one of the two given.
  subroutine agree(one, other, request, problem, observer, outcome, ahead, steps, store)
    class(locked_stepper_t), intent(inout), target :: one, other
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(experiment_result_t), intent(out) :: ahead
    class(locked_stepper_t), pointer, intent(out) :: steps
    type(mesh_store_t), intent(inout), optional :: store
    class(locked_stepper_t), pointer :: finer, former
    type(experiment_result_t) :: nothing
    type(run_numbers_t) :: others(1)
    type(observer_t) :: silent
    real(wp) :: began, first, more, error, before
    logical :: with_cycle
    integer :: round

    with_cycle = .not. outcome%chosen%is_fixed()
    steps => one
    finer => other
    before = huge(before)
    more = 0
    first = outcome%chosen%digits
    began = seconds()
    call begin_locked(steps, request, problem, outcome%chosen, observer, store)
    call run_once(steps, request, .true., with_cycle, .false., silent, outcome)
    steps%cost%solve_seconds = seconds() - began
    do round = 1, most_rounds
      began = seconds()
      call observer%hear('estimating errors')
      finer%cost = steps%cost
      more = more + more_digits
      if (problem%law%step_width > 0) more = max(more, digits_at_steps - first)
      ahead = nothing
      ahead%chosen = choose(request, problem, more)
      ! Panels that proved good enough are kept, so that errors decrease with the number of nodes.
      call begin_locked(finer, request, problem, ahead%chosen, observer, store, steps%meshes, &
        keep=before < 1)
      call run_once(finer, request, .true., with_cycle, .false., silent, ahead, outcome%places)
      others(1)%number = ahead%places%numbers()
      call outcome%places%judge_by(others, chance)
      error = largest_error(outcome%places%number)
      finer%cost%estimate_seconds = finer%cost%estimate_seconds + seconds() - began
      finer%cost%states = steps%cost%states
      steps%cost = finer%cost
      if (error <= request%numerics%accuracy .or. error < 1 .and. error > helped*before .or. &
        round == most_rounds .or. ahead%chosen%digits > most_digits) exit
      before = error
      former => steps
      steps => finer
      finer => former
      outcome = ahead
    end do
  end subroutine agree

  !> Runs the cycle on a grid that is fixed in space, then on a coarser and on a smaller grid; their
  !> errors are added, so that they cannot cancel. outcome: contains the numbers of the path
  !> already. once: without the other grids.
  subroutine run_fixed(steps, request, problem, observer, outcome, once)
    type(fixed_stepper_t), intent(inout) :: steps
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    class(observer_t), intent(inout) :: observer
    type(experiment_result_t), intent(inout) :: outcome
    logical, intent(in) :: once
    type(fixed_stepper_t) :: coarse
    type(experiment_result_t) :: of_path, ahead
    type(run_numbers_t) :: others(2)
    type(observer_t) :: silent
    real(wp) :: began
    integer :: k, runs

    of_path%places = outcome%places
    began = seconds()
    steps%cost = outcome%cost
    call begin_fixed(steps, problem, outcome%chosen)
    call run_once(steps, request, .false., .true., .true., observer, outcome)
    outcome%cost = steps%cost
    if (once) return
    steps%cost%solve_seconds = steps%cost%solve_seconds + seconds() - began
    outcome%nodes = outcome%nodes + sum(steps%meshes%grid%nodes)
    began = seconds()
    call observer%hear('estimating errors')
    ! Without any equilibrium there are no numbers.
    runs = merge(size(others), 0, allocated(outcome%loading%finish))
    do k = 1, runs
      ahead = of_path
      ahead%chosen = with_fewer_nodes(outcome%chosen)
      if (k == 2) ahead%chosen = with_less_extent(outcome%chosen)
      coarse%cost = steps%cost
      call begin_fixed(coarse, problem, ahead%chosen)
      call run_once(coarse, request, .false., .true., .true., silent, ahead, outcome%places)
      others(k)%number = ahead%places%numbers()
      coarse%cost%states = steps%cost%states
      steps%cost = coarse%cost
    end do
    call outcome%places%judge_by(others(:runs), chance_on_grids)
    ! On the other grids the cycle may not return to its beginning, where the energy is known.
    outcome%error_estimate = largest_error(pack(outcome%places%number, &
      outcome%places%number%name /= 'energy_lost'))
    steps%cost%estimate_seconds = steps%cost%estimate_seconds + seconds() - began
    outcome%cost = steps%cost
  end subroutine run_fixed

end module experiment
