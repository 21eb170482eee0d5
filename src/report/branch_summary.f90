!> What branches stepped in h0 leave in the summary: a cycle, or a path that has no folds.
module branch_summary
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use text, only: brief
  use experiment_result, only: experiment_result_t
  use reported, only: reported_t
  use stepped_branch, only: branch_t
  use ending_text, only: text_of
  use summary, only: summary_t
  use summary_entries, only: take_jump, take_profiles, raise_tension, widen_spacing, &
    h0_of, load_of, h0_error_of, load_error_of, rates_of
  use quality_warnings, only: short_number
  implicit none
  private
  public :: summarise_branches

contains

  !> Enters the branches that the outcome has.
  subroutine summarise_branches(scene, problem, outcome, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    integer :: k

    if (allocated(outcome%stepped_path)) &
      call take_branch(problem, 'path', outcome%stepped_path, summary)
    if (allocated(outcome%loading)) then
      call take_branch(problem, 'loading', outcome%loading, summary)
      if (allocated(outcome%loading%jump)) call take_jump(problem, 'jump_in', &
        outcome%loading%jump, outcome%loading%jump_uncertainty, summary)
    end if
    if (.not. allocated(outcome%unloading)) return
    do k = 1, size(outcome%unloading)
      call take_branch(problem, 'unloading_'//brief(real(k, wp)), outcome%unloading(k), summary)
    end do
    call take_unloading(scene, problem, outcome%unloading, summary)
  end subroutine summarise_branches

  !> Largest tension, residual and trouble of a branch of the cycle.
  subroutine take_branch(problem, name, branch, summary)
    type(problem_t), intent(in) :: problem
    character(len=*), intent(in) :: name
    type(branch_t), intent(in) :: branch
    type(summary_t), intent(inout) :: summary

    if (allocated(branch%lowest)) call raise_tension(problem, branch%lowest, summary)
    if (allocated(branch%profile)) call take_profiles(branch%profile, summary)
    call summary%set('worst_residual', max(summary%number('worst_residual'), &
        branch%worst_residual))
    call widen_spacing(summary, branch%worst_spacing)
    if (branch%unconverged > 0) &
      call summary%fail_with(name//': '//brief(real(branch%unconverged, wp))//' of '// &
        brief(real(branch%states, wp))//' states did not converge, the first at h0 = '// &
        short_number(problem%law%separation_of(branch%first_unconverged))// &
        ' m; the largest residual is '// &
        short_number(branch%worst_residual)//' lengths of the force law')
    if (branch%ending%early()) &
      call summary%fail_with(name//' ended early: '//trim(text_of(branch%ending)))
  end subroutine take_branch

  !> One value an unloading: its largest tension, and where it jumps apart.
  subroutine take_unloading(scene, problem, branches, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(branch_t), intent(in) :: branches(:)
    type(summary_t), intent(inout) :: summary
    real(wp), dimension(size(branches)) :: tension, tension_h0, tension_error, tension_h0_error, &
      jump_h0, jump_h0_error
    type(reported_t), dimension(size(branches)) :: lowest, jump
    integer :: k

    do k = 1, size(branches)
      tension(k) = -load_of(problem, branches(k)%lowest)
      tension_h0(k) = h0_of(problem, branches(k)%lowest)
      tension_error(k) = load_error_of(problem, branches(k)%lowest)
      tension_h0_error(k) = h0_error_of(problem, branches(k)%lowest)
      jump_h0(k) = h0_of(problem, branches(k)%jump)
      jump_h0_error(k) = h0_error_of(problem, branches(k)%jump)
      if (allocated(branches(k)%lowest)) lowest(k) = branches(k)%lowest
      if (allocated(branches(k)%jump)) jump(k) = branches(k)%jump
      if (.not. allocated(branches(k)%jump) .or. summary%has('jump_out_h0')) cycle
      call take_jump(problem, 'jump_out', branches(k)%jump, branches(k)%jump_uncertainty, summary)
    end do
    call summary%set('unload_from', scene%unloading%from)
    call summary%set('unload_max_tension', tension)
    call summary%set('unload_max_tension_h0', tension_h0)
    call summary%set('unload_jump_out_h0', jump_h0)
    associate (of_tension => rates_of(lowest), of_jump => rates_of(jump))
      call summary%set_rate('unload_max_tension', -of_tension%load)
      call summary%set_rate('unload_max_tension_h0', of_tension%h0)
      call summary%set_rate('unload_jump_out_h0', of_jump%h0)
    end associate
    call summary%set('unload_max_tension_error', tension_error)
    call summary%set('unload_max_tension_h0_error', tension_h0_error)
    call summary%set('unload_jump_out_h0_error', jump_h0_error)
  end subroutine take_unloading

end module branch_summary
