!> Whole experiments as f2py can see them: a force curve through given values of h0, and the
!> equilibrium path. Conventions as in `snapin_flat`, force laws as in `flat_numerics`.
!>
!> A state is a row of numbers: h0, h_centre, displacement, load, contact radius, stable,
!> residual and converged (`column_recorder`). A number that does not exist is NaN. `warnings` is
!> what the program would warn of, one a line; `reason`, why the experiment ended early, blank if it
!> did not.
!>
!> Nothing is kept from call to call. f2py holds Python's global lock, so that calls do not overlap;
!> they must not (no `threadsafe`): compiler note 5.
module flat_experiment
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: force_curve, equilibrium_path

contains

  !> The states at h0(:) [m], in that order, after an approach from afar to the first; h0 may turn
  !> round. rigid: 0 or 1. nodes, r_max [m]: 0 leaves them to the accuracy. jumps: h0 [m], load [N].
  !> highest: the largest tension [N] and its h0 [m]. Rows of states that were not reached are NaN.
  subroutine force_curve(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, &
    method, grid, accuracy, nodes, r_max, h0, states, jumps, jump_count, highest, error_estimate, &
    reached, reason, warnings, stat, message, n)
    use numerics_choice, only: choose, fixed_mesh
    use column_recorder, only: column_recorder_t
    use ending_text, only: text_of
    use stepped_branch, only: branch_t
    use edge_locked, only: new_mesh_pair
    use experiment, only: prepare
    use scene_problem, only: problem_of
    use experiment_result, only: experiment_result_t
    use result_errors, only: judge_fixed, judge_locked
    use failure, only: bad_input
    use fixed_stepper, only: fixed_stepper_t
    use locked_stepper, only: has_path, locked_stepper_t
    use path_stepper, only: path_stepper_t
    use unique_stepper, only: unique_stepper_t
    use blas_threads, only: use_threads_for
    use dimensionless_problem, only: problem_t
    use scene_groups, only: scene_t
    use summarise, only: summary_of
    character(len=*), intent(in) :: law, part, method, grid
    integer(c_int), intent(in) :: rigid, nodes, n
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness, accuracy, r_max
    real(c_double), intent(in) :: h0(n)
    real(c_double), intent(out) :: states(n, 8), jumps(n, 2), highest(2), error_estimate
    integer(c_int), intent(out) :: jump_count, reached, stat
    character(len=200), intent(out) :: reason, message
    character(len=2000), intent(out) :: warnings
    type(scene_t) :: scene
    type(problem_t) :: problem
    type(column_recorder_t) :: rows
    type(experiment_result_t) :: outcome
    type(path_stepper_t), target :: along_path
    type(unique_stepper_t), target :: one_by_one
    class(locked_stepper_t), pointer :: locked
    type(fixed_stepper_t) :: fixed
    type(branch_t), allocatable :: stretch(:)
    real(c_double) :: low, high
    integer :: k

    stat = 0
    message = ''
    reason = ''
    warnings = ''
    jump_count = 0
    jumps = nothing()
    highest = nothing()
    error_estimate = nothing()
    call make_scene(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, method, &
      grid, accuracy, nodes, r_max, scene)
    problem = problem_of(scene)
    low = minval(h0)/problem%length
    high = maxval(h0)/problem%length
    outcome%chosen = choose(scene%numerics, problem, low)
    if (outcome%chosen%grid == 'edge_locked') then
      if (nodes > 0 .or. r_max > 0) then
        stat = bad_input
        message = trim(merge('nodes', 'r_max', nodes > 0))//': only a grid that is fixed in '// &
          'space takes it: grid = "uniform", or method = "mixing"'
        call rows%give(states, reached)
        return
      end if
      ! Not allocatable: compiler note 4.
      if (has_path(problem)) then
        locked => along_path
      else
        locked => one_by_one
      end if
      call prepare(locked, problem, outcome%chosen, accuracy)
      locked%pair = new_mesh_pair(problem, high, low, outcome%chosen%digits)
      call use_threads_for(maxval(locked%pair%grid%nodes))
      select type (locked)
      class is (path_stepper_t)
        call locked%know_path(high, low, .false., rows)
      end select
      call run_stretches(locked, h0/problem%length, rows, stretch)
      outcome%unloading = stretch
      call judge_locked(locked, high, low, outcome)
    else
      call prepare(fixed, problem, outcome%chosen, accuracy)
      allocate (fixed%pair%grid(1))
      fixed%pair%grid(1) = fixed_mesh(outcome%chosen, problem, low)
      call use_threads_for(fixed%pair%grid(1)%nodes)
      call run_stretches(fixed, h0/problem%length, rows, stretch)
      outcome%unloading = stretch
      call judge_fixed(fixed, low, outcome)
    end if
    call move_alloc(outcome%unloading, stretch)

    do k = 1, size(stretch)
      if (.not. allocated(stretch(k)%jump)) cycle
      jump_count = jump_count + 1_c_int
      jumps(jump_count, :) = [stretch(k)%jump%h0*problem%length, stretch(k)%jump%load*problem%load]
    end do
    reason = text_of(stretch(size(stretch))%ending)
    call rows%give(states, reached)
    outcome%loading = as_one(stretch)
    call tell(summary_of(scene, problem, outcome), highest, error_estimate, warnings)
  end subroutine force_curve

  !> The whole path to the contact at h0_end [m], from h0_start [m] or, if that is not given
  !> (given: 0 or 1), from where the program lets it begin. Rows of `states` beyond `reached` are
  !> NaN, and so are those of `folds` (h0 [m], load [N]) beyond fold_count.
  subroutine equilibrium_path(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, &
    accuracy, h0_start, given, h0_end, states, folds, fold_count, highest, error_estimate, &
    reached, reason, warnings, stat, message, n)
    use column_recorder, only: column_recorder_t
    use ending_text, only: text_of
    use experiment, only: run_experiment
    use scene_problem, only: problem_of
    use failure, only: no_convergence
    use experiment_result, only: experiment_result_t
    use dimensionless_problem, only: problem_t
    use scene_groups, only: scene_t
    use summarise, only: summary_of
    use summary, only: summary_t
    character(len=*), intent(in) :: law, part
    integer(c_int), intent(in) :: rigid, given, n
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness, accuracy
    real(c_double), intent(in) :: h0_start, h0_end
    real(c_double), intent(out) :: states(n, 8), folds(n, 2), highest(2), error_estimate
    integer(c_int), intent(out) :: fold_count, reached, stat
    character(len=200), intent(out) :: reason, message
    character(len=2000), intent(out) :: warnings
    type(scene_t) :: scene
    type(problem_t) :: problem
    type(column_recorder_t) :: rows
    type(experiment_result_t) :: outcome
    type(summary_t) :: summary
    real(c_double), allocatable :: found(:)

    stat = 0
    message = ''
    fold_count = 0
    folds = nothing()
    reason = ''
    call make_scene(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, 'auto', &
      'auto', accuracy, 0_c_int, 0.0_c_double, scene)
    allocate (scene%path)
    scene%path%h0_end = h0_end
    if (given /= 0) scene%path%h0_start = h0_start
    problem = problem_of(scene)
    call run_experiment(scene, problem, rows, outcome)
    if (rows%held > n) then
      stat = no_convergence
      message = 'the path has more states than there is room for'
    end if
    call rows%give(states, reached)
    if (allocated(outcome%path)) reason = text_of(outcome%path%ending)
    if (allocated(outcome%stepped_path)) reason = text_of(outcome%stepped_path%ending)
    summary = summary_of(scene, problem, outcome)
    call tell(summary, highest, error_estimate, warnings)
    fold_count = int(min(int(n), size(summary%numbers('folds_h0'))), c_int)
    if (fold_count == 0) return
    found = summary%numbers('folds_h0')
    folds(:fold_count, 1) = found(:fold_count)
    found = summary%numbers('folds_load')
    folds(:fold_count, 2) = found(:fold_count)
  end subroutine equilibrium_path

  !> Goes through h0 (law's lengths) as through loadings and unloadings of a deck: a stretch goes
  !> one way, and a value that repeats the one before begins another. After one that ends early
  !> there is none.
  subroutine run_stretches(steps, h0, observer, stretch)
    use stepped_branch, only: branch_t, h0_schedule_t, run_branch
    use stepper, only: branch_point_t, stepper_t
    use records, only: observer_t
    class(stepper_t), intent(inout) :: steps
    real(c_double), intent(in) :: h0(:)
    class(observer_t), intent(inout) :: observer
    type(branch_t), allocatable, intent(out) :: stretch(:)
    type(branch_t) :: this
    type(branch_point_t) :: position, none(0)
    type(h0_schedule_t) :: plan
    real(c_double) :: nowhere(0)
    integer :: first, last

    plan%name = 'curve'
    allocate (stretch(0))
    first = 1
    do while (first <= size(h0))
      last = end_of_stretch(h0, first)
      plan%h0 = h0(first:last)
      plan%profile = spread(.false., 1, last - first + 1)
      call run_branch(steps, plan, first == 1, position, observer, nowhere, none, this)
      stretch = [stretch, this]
      if (this%ending%early()) exit
      first = last + 1
    end do
  end subroutine run_stretches

  !> Where the stretch that begins at `first` ends. The step into `first` tells its direction,
  !> unless there is none or it is zero.
  pure integer function end_of_stretch(h0, first) result(last)
    real(c_double), intent(in) :: h0(:)
    integer, intent(in) :: first
    real(c_double) :: direction, step

    direction = 0
    if (first > 1) direction = h0(first) - h0(first - 1)
    last = first
    do while (last < size(h0))
      step = h0(last + 1) - h0(last)
      if (abs(step) <= 0 .or. step < 0 .and. direction > 0 .or. step > 0 .and. direction < 0) exit
      direction = step
      last = last + 1
    end do
  end function end_of_stretch

  !> What stretches showed, for the summary. States that did not converge, and an early end, are
  !> told from the rows.
  pure function as_one(stretch) result(branch)
    use stepped_branch, only: branch_t
    type(branch_t), intent(in) :: stretch(:)
    type(branch_t) :: branch
    integer :: k

    branch%states = sum(stretch%states)
    branch%worst_residual = maxval(stretch%worst_residual)
    branch%worst_spacing = maxval(stretch%worst_spacing)
    do k = 1, size(stretch)
      if (.not. allocated(stretch(k)%lowest)) cycle
      if (allocated(branch%lowest)) then
        if (stretch(k)%lowest%load >= branch%lowest%load) cycle
      end if
      branch%lowest = stretch(k)%lowest
    end do
  end function as_one

  !> The scene with these bodies, force and numerics; numerics that have no argument have the
  !> defaults of a deck.
  subroutine make_scene(law, part, hamaker, z0, p0, decay_length, radius, stiffness, rigid, &
    method, grid, accuracy, nodes, r_max, scene)
    use law_by_name, only: make_law
    use scene_groups, only: bodies_t, scene_t
    character(len=*), intent(in) :: law, part, method, grid
    integer(c_int), intent(in) :: rigid, nodes
    real(c_double), intent(in) :: hamaker, z0, p0, decay_length, radius, stiffness, accuracy, r_max
    type(scene_t), intent(out) :: scene
    integer(c_int) :: stat
    character(len=200) :: message

    scene%title = ''
    scene%bodies = bodies_t(radius=radius, stiffness=stiffness, rigid=rigid /= 0)
    call make_law(law, part, hamaker, z0, p0, decay_length, scene%law, stat, message)
    associate (numerics => scene%numerics)
      numerics%method = trim(method)
      numerics%grid = trim(grid)
      numerics%accuracy = accuracy
      if (nodes > 0) numerics%nodes = nodes
      if (r_max > 0) numerics%r_max = r_max
      numerics%convergence = trim(default_of('convergence'))
      numerics%displacement_tolerance = default_number('displacement_tolerance')
      numerics%mixing_limit = default_number('mixing_limit')
      numerics%max_iterations = int(default_number('max_iterations'))
      numerics%anderson_depth = int(default_number('anderson_depth'))
    end associate
  end subroutine make_scene

  !> The default of a key of &numerics.
  pure function default_of(key) result(text)
    use deck_keys, only: key_spec
    use scene_keys, only: keys_of_scene
    character(len=*), intent(in) :: key
    character(len=32) :: text
    type(key_spec), allocatable :: keys(:)
    integer :: i

    text = ''
    keys = keys_of_scene()
    do i = 1, size(keys)
      if (keys(i)%group == 'numerics' .and. keys(i)%key == key) text = keys(i)%default
    end do
  end function default_of

  !> The same for a key that is a number.
  real(c_double) function default_number(key)
    character(len=*), intent(in) :: key
    character(len=32) :: text

    text = default_of(key)
    read (text, *) default_number
  end function default_number

  !> The numbers and warnings of a summary.
  subroutine tell(summary, highest, error_estimate, warnings)
    use summary, only: summary_t
    type(summary_t), intent(in) :: summary
    real(c_double), intent(out) :: highest(2), error_estimate
    character(len=*), intent(out) :: warnings
    integer :: i

    highest = nothing()
    error_estimate = nothing()
    warnings = ''
    if (summary%has('max_tension')) &
      highest = [summary%number('max_tension'), summary%number('max_tension_h0')]
    if (summary%has('error_estimate')) error_estimate = summary%number('error_estimate')
    if (.not. allocated(summary%warnings)) return
    do i = 1, size(summary%warnings)
      if (i > 1) warnings = trim(warnings)//new_line('a')
      warnings = trim(warnings)//summary%warnings(i)%text
    end do
  end subroutine tell

  !> Not a number.
  pure real(c_double) function nothing()
    use ieee_arithmetic, only: ieee_quiet_nan, ieee_value

    nothing = ieee_value(nothing, ieee_quiet_nan)
  end function nothing

end module flat_experiment
