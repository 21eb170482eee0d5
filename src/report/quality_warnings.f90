!> Warnings about the numbers in a summary: whether the mesh resolves the neck, and whether the
!> numbers have the accuracy that the deck asks for.
module quality_warnings
  use kinds, only: wp
  use scene_groups, only: scene_t
  use text, only: rounded
  use mending, only: too_much
  use experiment_result, only: experiment_result_t
  use records, only: quality_t
  use summary, only: summary_t
  implicit none
  private
  public :: judge_resolution, judge_accuracy, judge_stopping

  !> Largest spacing of nodes at the contact edge, in neck widths: with a wider spacing the edge is
  !> pinned between the nodes. On a mesh that moves with the edge it is not pinned; there two nodes
  !> in a neck make a polynomial of it.
  real(wp), parameter :: resolved_spacing = 0.2_wp, resolved_locked = 0.4_wp

  !> Relative error above which the numbers on a grid of the deck's choice get a warning. Such grids
  !> are chosen to show these errors.
  real(wp), parameter :: meaningless = 0.1_wp
  !> Ratio of estimated error and accuracy above which there is a warning: an estimate has a margin
  !> of a factor of two or more.
  real(wp), parameter :: clearly = 3
  !> Residual below which there is no warning.
  real(wp), parameter :: usual_residual = 1.0e-8_wp

contains

  !> Warns of a neck that is not resolved, with advice. locked: the mesh is locked to the edge.
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
          rounded(spacing/resolved_spacing)//' times as many nodes or grid = ''panels'''
      end if
      call summary%warn('under-resolved: nodes are '//rounded(spacing)// &
        ' neck widths apart at the contact edge'//advice)
    end associate
  end subroutine judge_resolution

  !> Warns if the numbers do not have the accuracy that the deck asks for, or on a grid of the
  !> deck's choice if they are meaningless. Warns also of residuals that rounding keeps above the
  !> tolerance, if they matter for displacements of the law's length.
  subroutine judge_accuracy(scene, outcome, quality, summary)
    type(scene_t), intent(in) :: scene
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary
    real(wp) :: enough

    associate (tolerance => outcome%chosen%options%tolerance)
      if (summary%is_true('converged') .and. .not. outcome%chosen%options%stop_on_change .and. &
        quality%residual > max(tolerance, scene%numerics%accuracy, usual_residual)) &
        call summary%warn('rounding leaves residuals of up to '//rounded(quality%residual)// &
        ' lengths of the force law, above the tolerance of '//rounded(tolerance))
    end associate
    if (outcome%left_out > too_much*scene%numerics%accuracy) &
      call summary%warn('the mesh does not resolve the force law: '//rounded(outcome%left_out)// &
      ' of the load is left out between nodes; smoother forces are resolved')
    if (.not. allocated(outcome%error_estimate)) return
    enough = clearly*scene%numerics%accuracy
    if (outcome%chosen%is_fixed()) enough = max(enough, meaningless)
    if (outcome%error_estimate >= 1) then
      call summary%warn('the error could not be estimated: a finer mesh has no such states, or '// &
        'these did not converge; the numbers may mean nothing')
    else if (outcome%error_estimate > enough) then
      call summary%warn('the error is estimated as '//rounded(outcome%error_estimate)// &
        ', above the accuracy of '//rounded(scene%numerics%accuracy)//' asked for')
    end if
  end subroutine judge_accuracy

  !> Warns if the iteration stopped on a small change, and checks whether the equations hold anyway.
  subroutine judge_stopping(outcome, quality, summary)
    type(experiment_result_t), intent(in) :: outcome
    type(quality_t), intent(in) :: quality
    type(summary_t), intent(inout) :: summary

    if (.not. outcome%chosen%options%stop_on_change) return
    call summary%warn('the iteration was stopped on a small change of the displacement, '// &
      'which is not convergence: the largest residual left is '// &
      rounded(quality%residual)//' lengths of the force law')
    call summary%set('converged', .not. quality%early .and. &
      quality%residual <= outcome%chosen%options%tolerance)
  end subroutine judge_stopping

end module quality_warnings
