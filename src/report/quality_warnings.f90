!> What the user has to know of the numbers in a summary: whether the mesh resolves the neck, and
!> whether they are as good as the deck asks for.
module quality_warnings
  use kinds, only: wp
  use scene_groups, only: scene_t
  use mending, only: too_much
  use experiment_result, only: experiment_result_t
  use outcome_quality, only: quality_t
  use summary, only: summary_t
  implicit none
  private
  public :: judge_resolution, judge_accuracy, judge_stopping, short_number

  !> Nodes may lie this many necks apart at the contact edge: beyond it the edge is pinned between
  !> them. To a mesh that moves with the edge, whose panels meet there, that does not happen: some
  !> two nodes in a neck make a polynomial of it.
  real(wp), parameter :: resolved_spacing = 0.2_wp, resolved_locked = 0.4_wp

  !> Relative error above which the numbers of a grid that the deck has chosen get a warning; it is
  !> chosen to show such errors.
  real(wp), parameter :: meaningless = 0.1_wp
  !> An estimate carries a margin of two and more; only beyond this many times the accuracy is it
  !> clear that the accuracy is missed.
  real(wp), parameter :: clearly = 3
  !> A residual not worth a warning.
  real(wp), parameter :: usual_residual = 1.0e-8_wp

contains

  !> Whether the neck is resolved, and what to do if not. locked: on a mesh locked to the edge.
  subroutine judge_resolution(locked, quality, summary)
    logical, intent(in) :: locked
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary
    character(len=:), allocatable :: advice
    logical :: resolved

    associate (spacing => quality%spacing)
      if (.not. spacing > 0) return
      resolved = spacing <= merge(resolved_locked, resolved_spacing, locked)
      call summary%set('resolved', resolved)
      if (resolved) return
      if (locked) then
        advice = '; ask for a higher accuracy'
      else
        advice = ', which is then pinned between them; use '// &
          short_number(spacing/resolved_spacing)//' times as many nodes or grid = ''panels'''
      end if
      call summary%warn('under-resolved: nodes are '//short_number(spacing)// &
        ' neck widths apart at the contact edge'//advice)
    end associate
  end subroutine judge_resolution

  !> Whether the numbers are as good as the deck asks for; on a grid that the deck has chosen,
  !> whether they are any good. And whether residuals count as converged because rounding allows no
  !> better, though they may show in a displacement of one of the law's lengths.
  subroutine judge_accuracy(scene, outcome, quality, summary)
    type(scene_t), intent(in) :: scene
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary
    real(wp) :: enough

    associate (tolerance => outcome%chosen%options%tolerance)
      if (summary%is_true('converged') .and. .not. outcome%chosen%options%stop_on_change .and. &
        quality%residual > &
        max(tolerance, scene%numerics%accuracy, usual_residual)) &
        call summary%warn('rounding leaves residuals of up to '// &
        short_number(quality%residual)// &
        ' lengths of the force law, above the tolerance of '//short_number(tolerance))
    end associate
    if (outcome%left_out > too_much*scene%numerics%accuracy) &
      call summary%warn( &
      'the mesh does not resolve the force law: '//short_number(outcome%left_out)// &
      ' of the load is left out between nodes; smoother forces are resolved')
    if (.not. allocated(outcome%error_estimate)) return
    enough = clearly*scene%numerics%accuracy
    if (outcome%chosen%is_fixed()) enough = max(enough, meaningless)
    if (outcome%error_estimate >= 1) then
      call summary%warn('the error could not be estimated: a finer mesh has no such states, or '// &
        'these did not converge; the numbers may mean nothing')
    else if (outcome%error_estimate > enough) then
      call summary%warn('the error is estimated as '//short_number(outcome%error_estimate)// &
        ', above the accuracy of '//short_number(scene%numerics%accuracy)//' asked for')
    end if
  end subroutine judge_accuracy

  !> Whether equations that were not asked to hold hold all the same.
  subroutine judge_stopping(outcome, quality, summary)
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary

    if (.not. outcome%chosen%options%stop_on_change) return
    call summary%warn('the iteration was stopped on a small change of the displacement, '// &
      'which is not convergence: the largest residual left is '// &
      short_number(quality%residual)//' lengths of the force law')
    call summary%set('converged', .not. quality%early .and. &
      quality%residual <= outcome%chosen%options%tolerance)
  end subroutine judge_stopping

  !> A number for a message, to three digits.
  pure function short_number(x) result(text)
    real(wp), intent(in) :: x
    character(len=:), allocatable :: text
    character(len=24) :: buffer

    write (buffer, '(g12.3)') x
    text = trim(adjustl(buffer))
  end function short_number

end module quality_warnings
