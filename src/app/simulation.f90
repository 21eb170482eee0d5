!> Computes one deck, from the scene to the results. Features that the scene does not use cost no
!> time.
module simulation
  use kinds, only: wp, long
  use failure, only: failure_t, bad_input
  use build_info, only: version, compiler, blas, options
  use dimensionless_problem, only: problem_t, calm_gap
  use scene_groups, only: scene_t
  use text, only: brief, counted
  use experiment_result, only: experiment_result_t
  use experiment, only: run_experiment
  use scene_problem, only: problem_of
  use h0_schedule, only: states_planned
  use number_rates, only: rate_numbers
  use sweeps, only: run_sweep
  use case_columns, only: left_out
  use sweep_case, only: sweep_tally_t
  use ranks, only: crew_t
  use preflight, only: check_room, large_results
  use forecast, only: advice_t, advice_on
  use machine, only: thread_count
  use linear_algebra, only: claim_buffers
  use equilibrium, only: cost_t
  use classical_rows, only: write_classical
  use approximation_tables, only: write_approximations
  use reading_rows, only: write_path_tables
  use sensitivity_rows, only: write_sensitivities
  use path_demand, only: path_start
  use stability_records, only: stability_recorder_t
  use summarise, only: summary_of
  use problem_numbers, only: describe_problem
  use summary, only: summary_t
  use result_folder, only: journal_of, to_stream
  use publication, only: clear_unfinished
  use results, only: results_t
  use run_identity, only: identity_of, find_finished
  use progress, only: duration
  use run_messages, only: destination_t, tell
  use files, only: file_exists
  use clock, only: seconds
  use namelist_writer, only: line_t
  use fit_run, only: fit_outcome_t
  use fit_columns, only: verdicts
  use measured_fit, only: fit_measured
  use fit_warnings, only: doubts_of
  use fit_rows, only: write_fit_rows, fit_text, report_joint
  use fit_words, only: words_of_fit
  use joint_fit, only: joint_fit_t
  implicit none
  private
  public :: run_scene

contains

  !> Computes a scene and writes its results into the folder `out_dir`; with `handed_over` it then
  !> also writes them to standard output. If memory or disk space does not suffice, the folder is
  !> not changed. converged: .false. if a calculation failed; the results are kept, and the summary
  !> says what failed. error: there are no results, or they could not be written. resume: an
  !> interrupted sweep in the folder is continued, and finished results are left as they are. crew:
  !> the processes that compute a sweep. job: the number of the scene for these processes.
  subroutine run_scene(scene, out_dir, handed_over, quiet, verbose, resume, crew, job, &
    converged, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: out_dir
    logical, intent(in) :: handed_over, quiet, verbose, resume
    type(crew_t), intent(inout) :: crew
    integer, intent(in) :: job
    logical, intent(out) :: converged
    type(failure_t), allocatable, intent(out) :: error
    type(destination_t) :: destination
    type(results_t), target :: results
    type(problem_t) :: problem
    type(summary_t) :: summary
    type(cost_t) :: cost
    real(wp) :: began
    logical :: finished

    began = seconds()
    converged = .false.
    destination = destination_t(out_dir, quiet, verbose, out_dir == to_stream)
    results%folder%handed_over = handed_over
    if (destination%to_stream) then
      destination%folder = 'snapin'
    else
      call take_up_earlier()
      if (finished .or. allocated(error)) return
    end if
    call check_room(scene, out_dir, error)
    if (allocated(error)) return
    problem = problem_of(scene)
    if (.not. quiet) call warn_before()
    call open_folder()
    if (allocated(error)) return
    call compute()
    ! The theories are computed with the deck's own numbers, which are no case of a sweep.
    if (.not. allocated(scene%sweep)) call write_theories()
    if (allocated(scene%fit) .and. .not. allocated(scene%sweep)) call report_fit()
    call summary%set('version', version)
    call summary%set('compiler', compiler)
    call summary%set('blas', blas)
    call summary%set('build_options', options)
    call summary%set('threads', int(thread_count(), long))
    call summary%set('wall_seconds', results%folder%journal%earlier + seconds() - began)
    call summary%take_cost(cost)
    call results%write_summary(summary, scene%deck)
    call results%finish(error)
    if (allocated(error)) then
      if (error%kind /= bad_input .and. .not. destination%to_stream) &
        error%message = error%message // merge('; then go on with --resume', &
        '; then run it again       ', allocated(scene%sweep))
      return
    end if
    call tell(scene, destination, summary, cost)
    converged = summary%is_true('converged')

  contains

    !> If `resume` is given and the folder has a finished run, finished = .true., and nothing is
    !> computed; `converged` is then that of the finished run.
    subroutine take_up_earlier()
      finished = .false.
      if (.not. resume .or. file_exists(journal_of(destination%folder))) return
      if (file_exists(destination%folder // '/.')) then
        call results%folder%lock%take(destination%folder, error)
        if (allocated(error)) return
        call find_finished(destination%folder, scene%deck%resolved(), finished, converged)
        if (finished) call clear_unfinished(results%folder%lock, error)
        if (finished .and. handed_over .and. .not. allocated(error)) &
          call results%folder%hand_over(error)
        call results%folder%lock%release()
        if (allocated(error)) return
      end if
      if (finished) then
        call destination%say('complete since an earlier run; nothing to do')
        if (.not. converged) call destination%say('its summary says what failed')
      else
        call destination%say('no interrupted run to continue; starting from the beginning')
      end if
    end subroutine take_up_earlier

    !> Warns of numerical choices that will fail or take long, before the computation starts.
    subroutine warn_before()
      type(advice_t), allocatable :: advice(:)
      integer :: i

      advice = advice_on(scene, problem)
      do i = 1, size(advice)
        call destination%say('warning: ' // advice(i)%text)
      end do
    end subroutine warn_before

    !> Locks the folder for this run and begins its tables.
    subroutine open_folder()
      logical :: left_over

      left_over = file_exists(journal_of(out_dir))
      call results%open(out_dir, scene, version, problem, &
        identity_of(scene%deck%resolved()), resume .and. allocated(scene%sweep) .and. &
        .not. is_joint(), error)
      if (allocated(error)) return
      if (destination%to_stream) return
      if (.not. results%folder%lock%is_held()) call destination%say('warning: folders cannot ' // &
        'be locked here; let no other run write into this one')
      if (results%folder%journal%inherited > 0) then
        call destination%say('continuing a run that was interrupted after '// &
          duration(results%folder%journal%earlier))
      else if (left_over .and. .not. allocated(scene%sweep)) then
        call destination%say('an earlier run was interrupted; it is run again from the beginning')
      else if (left_over .and. resume) then
        call destination%say('the interrupted run left nothing to continue; ' // &
          'starting from the beginning')
      else if (left_over) then
        call destination%say( &
          'starting over; --resume continues an interrupted run of the same deck')
      end if
    end subroutine open_folder

    !> Runs the experiments or the sweep, whose records are written to the results.
    subroutine compute()
      type(experiment_result_t) :: outcome
      character(len=:), allocatable :: name
      type(sweep_tally_t) :: tally
      type(joint_fit_t) :: joint

      name = destination%folder(index(destination%folder, '/', .true.) + 1:)
      if (.not. problem%rigid) call claim_buffers()
      if (large_results(scene) /= '') call destination%say(large_results(scene))
      if (allocated(scene%sweep)) then
        call results%progress%start(scene%sweep%cases(), name, destination%quiet)
        if (crew%workers > 0) call destination%say('processes that compute: '//brief(crew%workers))
        call run_sweep(scene, crew, job, results, tally, joint)
        cost = tally%cost
        summary = summary_of(scene, problem, outcome)
        if (tally%failed > 0) call summary%fail_with(brief(tally%failed)//' of '// &
          counted(scene%sweep%cases(), 'case')// &
          ' failed: rows of sweep.csv with converged = 0 say why')
        if (tally%warned > 0) call summary%warn(brief(tally%warned)//' of '// &
          counted(scene%sweep%cases(), 'case')//' gave a warning; the first, case '// &
          brief(tally%first_warned)//': '//trim(tally%warning))
        if (allocated(scene%fit)) call summary%note(told_of(tally))
        if (is_joint()) call report_joint(joint, scene%title, results, summary)
        if (left_out(scene) /= '') call summary%note('sweep: '//left_out(scene))
      else
        call results%progress%start(states_planned(scene), name, destination%quiet)
        call run_observed()
      end if
    end subroutine compute

    !> Whether curves are fitted together. In this case no row is useful without all others.
    pure logical function is_joint()
      is_joint = allocated(scene%fit)
      if (is_joint) is_joint = scene%fit%is_joint()
    end function is_joint

    !> A text with the number of fits of a sweep that have each verdict.
    function told_of(tally) result(text)
      type(sweep_tally_t), intent(in) :: tally
      character(len=:), allocatable :: text
      integer :: i

      text = counted(scene%sweep%cases(), 'curve') // ': '
      do i = 1, size(verdicts)
        if (i > 1) text = text // ', '
        text = text // brief(tally%verdict(i)) // ' ' // trim(verdicts(i))
      end do
    end function told_of

    !> Runs the experiments. Each state is written to the results, with its eigenvalue if the scene
    !> asks for it.
    subroutine run_observed()
      type(experiment_result_t) :: outcome
      type(stability_recorder_t) :: recorder

      if (scene%has_eigenvalues()) then
        recorder%next => results
        recorder%accuracy = scene%numerics%accuracy
        call run_experiment(scene, problem, recorder, outcome)
      else
        call run_experiment(scene, problem, results, outcome)
      end if
      if (allocated(outcome%readings)) &
        call write_path_tables(problem, outcome%readings, outcome%places, results)
      if (allocated(scene%varied)) call rate_numbers(scene, results, outcome)
      summary = summary_of(scene, problem, outcome)
      ! An unallocated error estimate counts as an absent argument.
      if (scene%has_eigenvalues()) call recorder%warn(summary, outcome%error_estimate)
      if (allocated(scene%varied)) &
        call write_sensitivities(scene%varied, problem, outcome, summary, results)
      cost = outcome%cost
      cost%factorisations = cost%factorisations + recorder%cost%factorisations
    end subroutine run_observed

    !> Writes the tables of closed forms.
    subroutine write_theories()
      if (allocated(scene%classical)) call write_classical(problem, scene%classical, &
        path_start(scene, problem), results, summary)
      ! The approximation assumes nearly undeformed bodies, as on the path before contact.
      if (allocated(scene%approximations)) call write_approximations(problem, &
        scene%approximations, max(path_start(scene, problem), &
        problem%law%separation_of(calm_gap(problem))), results)
    end subroutine write_theories

    !> Makes the fit of &fit and writes its files and messages. If there is no fit, the summary
    !> gives the reason.
    subroutine report_fit()
      type(fit_outcome_t) :: outcome
      type(line_t), allocatable :: doubts(:), lines(:)
      integer :: i

      call destination%say('fit: ' // scene%measured%understood)
      call fit_measured(scene, problem, .true., results, outcome)
      call results%progress%finish()
      if (allocated(outcome%trouble)) then
        call summary%fail_with('no fit: ' // outcome%trouble)
        return
      end if
      call results%begin_table('fit.csv')
      call write_fit_rows(outcome, results)
      call results%write_text('fit.nml', fit_text(outcome, scene%title))
      if (allocated(outcome%problem)) call describe_problem(outcome%problem, summary)
      doubts = doubts_of(outcome)
      if (.not. outcome%fitted%found) call summary%set('converged', .false.)
      do i = 1, size(doubts)
        call summary%warn('fit: ' // doubts(i)%text)
      end do
      lines = words_of_fit(outcome, doubts)
      do i = 1, size(lines)
        call destination%say('fit: ' // lines(i)%text)
      end do
    end subroutine report_fit

  end subroutine run_scene

end module simulation
