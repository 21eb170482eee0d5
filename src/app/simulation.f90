!> One deck from scene to results: the effects that the scene calls for, and no others.
module simulation
  use kinds, only: wp, long
  use failure, only: failure_t
  use build_info, only: version, compiler, blas, options
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use text, only: brief
  use experiment_result, only: experiment_result_t
  use experiment, only: run_experiment, path_start
  use resumable_stepper, only: resumable_stepper_t
  use scene_problem, only: problem_of
  use h0_schedule, only: states_planned
  use sweeps, only: run_sweep
  use preflight, only: preflight_t, preflight_of
  use blas_threads, only: thread_count
  use linear_algebra, only: claim_buffers
  use classical_rows, only: rows_of_classical
  use approximation_tables, only: approximation_rows
  use records, only: observer_t
  use stability_records, only: stability_recorder_t
  use summarise, only: summary_of
  use summary, only: summary_t
  use results, only: results_t, journal_of
  use publication, only: mend
  use run_identity, only: identity_of
  use finished_run, only: find_finished
  use progress, only: duration
  use files, only: write_stderr, file_exists
  use clock, only: seconds
  implicit none
  private
  public :: run_scene

contains

  !> Computes a scene and writes its results into the folder `out_dir`. converged: false where a
  !> calculation failed; what was computed is kept and the summary says what failed. error: there are
  !> no results, or they could not be written. resume: what an interrupted run has left in the folder
  !> is gone on with, and finished results are left as they are.
  subroutine run_scene(scene, out_dir, quiet, resume, converged, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: out_dir
    logical, intent(in) :: quiet, resume
    logical, intent(out) :: converged
    type(failure_t), allocatable, intent(out) :: error
    type(results_t), target :: results
    type(stability_recorder_t), target :: recorder
    type(resumable_stepper_t), target :: keeper
    class(observer_t), pointer :: observer
    type(problem_t) :: problem
    type(experiment_result_t) :: outcome
    type(summary_t) :: summary
    character(len=:), allocatable :: name, resolved
    type(preflight_t) :: expected
    real(wp) :: began
    integer :: i, failed
    logical :: curve, left_over, finished, mended

    began = seconds()
    converged = .false.
    name = out_dir(index(out_dir, '/', .true.) + 1:)
    resolved = scene%deck%resolved()
    call mend(out_dir, mended, error)
    if (allocated(error)) return
    if (mended) call say(out_dir//': put results in place that an interrupted run had completed', &
      quiet)
    left_over = file_exists(journal_of(out_dir))
    if (resume .and. .not. left_over) then
      call find_finished(out_dir, resolved, version, finished, converged)
      if (finished) then
        call say(out_dir//': complete since an earlier run; nothing to do', quiet)
        if (.not. converged) call say(out_dir//': its summary says what failed then', quiet)
        return
      end if
      call say(out_dir//': no interrupted run to go on with; starting from the beginning', quiet)
    end if
    problem = problem_of(scene)
    ! The cases of a sweep leave their summaries, not their curves.
    curve = .not. allocated(scene%sweep) .and. (allocated(scene%loading) .or. allocated(scene%path))
    call results%open(out_dir, scene%title, version, problem, curve, &
      curve .and. allocated(scene%profiles), curve .and. allocated(scene%stability), &
      ! Each case of a sweep has one thread, however many there are.
      identity_of(resolved, merge(0, thread_count(), allocated(scene%sweep))), resume, error)
    if (allocated(error)) return
    if (.not. results%lock%is_held()) call say(out_dir//': warning: folders cannot be locked '// &
      'here; let no other run write into this one', quiet)
    if (left_over .and. resume) then
      call say(out_dir//': going on with what was interrupted after '// &
        duration(results%journal%earlier), quiet)
    else if (left_over) then
      call say(out_dir//': starting over; --resume would have gone on with what was interrupted', &
        quiet)
    end if
    observer => results
    if (allocated(scene%stability)) then
      recorder%next => results
      recorder%journal => results%journal
      recorder%accuracy = scene%numerics%accuracy
      observer => recorder
    end if
    failed = 0
    expected = preflight_of(scene)
    if (expected%too_large == '' .and. .not. problem%rigid) call claim_buffers()
    if (expected%long /= '') call say(out_dir//': '//expected%long, quiet)
    if (allocated(scene%sweep) .and. expected%too_large == '') then
      call results%progress%start(size(scene%sweep%values), name, quiet)
      call run_sweep(scene, results, failed, outcome%cost)
    else if (expected%too_large == '') then
      call results%progress%start(states_planned(scene), name, quiet)
      keeper%journal => results%journal
      call run_experiment(scene, problem, observer, outcome, keeper)
    end if
    call results%progress%finish()
    outcome%cost%factorisations = outcome%cost%factorisations + recorder%cost%factorisations

    if (allocated(scene%classical)) call results%write_theory('classical.csv', &
      rows_of_classical(problem, scene%classical, path_start(scene, problem)))
    if (allocated(scene%approximations)) call results%write_theory('approximations.csv', &
      approximation_rows(problem, scene%approximations, path_start(scene, problem)))
    summary = summary_of(scene, problem, outcome)
    if (expected%too_large /= '') then
      call summary%set('converged', .false.)
      call summary%warn(expected%too_large)
    end if
    if (failed > 0) then
      call summary%set('converged', .false.)
      call summary%warn(number(failed)//' of '//number(size(scene%sweep%values))// &
        ' cases failed: their rows in sweep.csv say converged = 0')
    end if
    if (recorder%uncertain > 0) call summary%warn('the smallest eigenvalue of '// &
      number(recorder%uncertain)//' states could not be verified: their rows have NaN')
    if (recorder%contradicted > 0) call summary%warn('the eigenvalue of '// &
      number(recorder%contradicted)//' states contradicts their column stable')
    call summary%set('version', version)
    call summary%set('compiler', compiler)
    call summary%set('blas', blas)
    call summary%set('build_options', options)
    call summary%set('threads', int(thread_count(), long))
    call summary%set('wall_seconds', results%journal%earlier + seconds() - began)
    call results%write_summary(summary, outcome%cost, scene%deck)
    call results%finish(error)
    if (allocated(error)) then
      error%message = error%message//'; then go on with --resume'
      return
    end if
    if (allocated(summary%warnings)) then
      do i = 1, size(summary%warnings)
        call say(out_dir//': warning: '//summary%warnings(i)%text, quiet)
      end do
    end if
    if (summary%has('grid')) call say(out_dir//': grid '//summary%text('grid')//', method '// &
      summary%text('method')//': '//summary%text('chosen_because'), quiet)
    call say(report(out_dir, summary, outcome), quiet)
    converged = summary%is_true('converged')
  end subroutine run_scene

  !> A count for a message.
  pure function number(k) result(text)
    integer, intent(in) :: k
    character(len=:), allocatable :: text

    text = brief(real(k, wp))
  end function number

  !> What was found, in a line.
  function report(out_dir, summary, outcome) result(text)
    character(len=*), intent(in) :: out_dir
    type(summary_t), intent(in) :: summary
    type(experiment_result_t), intent(in) :: outcome
    character(len=:), allocatable :: text
    character(len=160) :: buffer
    real(wp) :: took

    took = summary%number('wall_seconds')
    write (buffer, '(i0, a, f0.2, a)') outcome%cost%states, ' states in ', took, &
      ' s'
    if (took < 1) write (buffer, '(i0, a, f5.3, a)') outcome%cost%states, &
      ' states in ', took, ' s'
    text = trim(buffer)
    if (summary%has('max_tension')) then
      write (buffer, '(a, es11.4, a, es12.4, a)') ', largest tension', &
        summary%number('max_tension'), ' N at h0 =', summary%number('max_tension_h0'), ' m'
      text = text//trim(buffer)
    end if
    text = out_dir//': '//text
  end function report

  !> A line to standard error.
  subroutine say(text, quiet)
    character(len=*), intent(in) :: text
    logical, intent(in) :: quiet

    if (.not. quiet) call write_stderr(text//new_line('a'))
  end subroutine say

end module simulation
