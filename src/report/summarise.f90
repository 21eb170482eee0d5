!> From what the experiments found to what the user is told: SI units, and a warning for all that
!> is not as it should be.
module summarise
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp, long
  use dimensionless_problem, only: problem_t, tabor_parameter, surface_energy, largest_tension
  use classical, only: jkr_pull_off, dmt_pull_off
  use maugis, only: maugis_lambda, maugis_pull_off
  use approximation_tables, only: jump_t, jumps_t, jumps_of
  use scene_groups, only: scene_t
  use text, only: brief
  use experiment_result, only: experiment_result_t
  use reported, only: reported_t
  use stepped_branch, only: branch_t
  use ending_text, only: text_of
  use force_entries, only: take_forces
  use summary, only: summary_t
  use summary_entries, only: take_jump, take_profiles, raise_tension, widen_spacing
  use quality_warnings, only: judge_resolution, judge_accuracy, short_number
  implicit none
  private
  public :: summary_of

contains

  !> The summary of a run.
  function summary_of(scene, problem, outcome) result(summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t) :: summary
    integer :: k

    call summary%set('title', scene%title)
    call summary%set('converged', .true.)
    call describe(scene, problem, summary)
    if (allocated(outcome%chosen%grid)) then
      call summary%set('grid', outcome%chosen%grid)
      call summary%set('method', trim(outcome%chosen%options%method))
      call summary%set('chosen_because', outcome%chosen%because)
      call summary%set('nodes', int(outcome%nodes, long))
      call summary%set('worst_residual', 0.0_wp)
      if (allocated(outcome%error_estimate)) &
        call summary%set('error_estimate', outcome%error_estimate)
    end if
    if (allocated(outcome%stepped_path)) &
      call take_branch(problem, 'path', outcome%stepped_path, summary)
    if (allocated(outcome%loading)) then
      call take_branch(problem, 'loading', outcome%loading, summary)
      if (allocated(outcome%loading%jump)) call take_jump(problem, 'jump_in', &
        outcome%loading%jump, outcome%loading%jump_uncertainty, summary)
    end if
    if (allocated(outcome%unloading)) then
      do k = 1, size(outcome%unloading)
        call take_branch(problem, 'unloading_'//brief(real(k, wp)), outcome%unloading(k), summary)
      end do
      call take_unloading(scene, problem, outcome%unloading, summary)
    end if
    ! The path knows the same folds exactly.
    if (allocated(outcome%path)) call take_path(problem, outcome, summary)
    call take_energy(problem, outcome, summary)
    call take_end(problem, outcome, summary)
    if (.not. problem%rigid) call judge_resolution(summary)
    if (allocated(outcome%chosen%grid)) call judge_accuracy(scene, outcome, summary)
    if (outcome%chosen%options%stop_on_change .and. outcome%chosen%options%method == 'mixing') then
      call summary%warn('the iteration was stopped on a small change of the displacement, '// &
        'which is not convergence: the largest residual left is '// &
        short_number(summary%number('worst_residual'))// &
        ' lengths of the force law')
      ! Equations that were not asked to hold may hold all the same.
      call summary%set('converged', ended_as_planned(outcome) .and. &
        summary%number('worst_residual') <= outcome%chosen%options%tolerance)
    end if
  end function summary_of

  !> Whether every branch came to its end.
  pure logical function ended_as_planned(outcome) result(ended)
    type(experiment_result_t), intent(in) :: outcome
    logical :: early

    early = .false.
    if (allocated(outcome%path)) early = outcome%path%ending%early()
    if (allocated(outcome%stepped_path)) early = early .or. outcome%stepped_path%ending%early()
    if (allocated(outcome%loading)) early = early .or. outcome%loading%ending%early()
    if (allocated(outcome%unloading)) early = early .or. any(outcome%unloading%ending%early())
    ended = .not. early
  end function ended_as_planned

  !> What follows from the deck alone.
  subroutine describe(scene, problem, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%adhesion > 0) then
      if (problem%law%work > 0) then
        call summary%set('surface_energy', surface_energy(problem))
        call summary%set('jkr_pull_off', -jkr_pull_off(problem%radius, surface_energy(problem)))
        call summary%set('dmt_pull_off', -dmt_pull_off(problem%radius, surface_energy(problem)))
      end if
      if (.not. problem%rigid) then
        call summary%set('sigma', problem%coupling*problem%law%adhesion)
        call summary%set('tabor', tabor_parameter(problem))
      end if
    else if (problem%law%coupling_name /= '' .and. .not. problem%rigid) then
      call summary%set(trim(problem%law%coupling_name), problem%coupling)
    end if
    if (.not. problem%law%of_paper) call take_forces(problem, summary)
    if (allocated(scene%classical)) call take_maugis(problem, summary)
    if (allocated(scene%approximations)) call estimate_jumps(problem, summary)
  end subroutine describe

  !> Maugis-Dugdale theory with the law's surface energy and largest tension, where both exist.
  subroutine take_maugis(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    real(wp) :: gamma, strength

    gamma = surface_energy(problem)
    strength = largest_tension(problem)
    if (problem%rigid .or. .not. (gamma > 0 .and. strength > 0)) return
    call summary%set('maugis_lambda', &
      maugis_lambda(problem%radius, problem%stiffness, gamma, strength))
    call summary%set('maugis_pull_off', &
      -maugis_pull_off(problem%radius, problem%stiffness, gamma, strength))
  end subroutine take_maugis

  !> Where approaching bodies jump in the approximation of slow deformation.
  subroutine estimate_jumps(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(jumps_t) :: jumps

    jumps = jumps_of(problem)
    call take(jumps%criterion, 'jump_criterion_29')
    call take(jumps%equation_37, 'jump_equation_37')
    if (allocated(jumps%equation_37)) &
      call summary%set('jump_equation_37_gap', jumps%equation_37%gap)
    call take(jumps%fold_attraction, 'fold_attractive_only')
    if (allocated(jumps%fold)) then
      ! That of a law without a closed form has another name, in approximations.csv alone.
      if (jumps%fold%theory == 'fold_closed_form') &
        call take(jumps%fold, 'fold_closed_form')
    end if

  contains

    subroutine take(jump, key)
      type(jump_t), allocatable, intent(in) :: jump
      character(len=*), intent(in) :: key

      if (.not. allocated(jump)) return
      call summary%set(key//'_h0', jump%h0)
      call summary%set(key//'_load', jump%load)
    end subroutine take

  end subroutine estimate_jumps

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
    if (branch%unconverged > 0) then
      call summary%set('converged', .false.)
      call summary%warn(name//': '//brief(real(branch%unconverged, wp))//' of '// &
        brief(real(branch%states, wp))//' states did not converge, the first at h0 = '// &
        short_number(problem%law%separation_of(branch%first_unconverged))//' m; the largest residual is '// &
        short_number(branch%worst_residual)//' lengths of the force law')
    end if
    if (branch%ending%early()) then
      call summary%set('converged', .false.)
      call summary%warn(name//' ended early: '//trim(text_of(branch%ending)))
    end if
  end subroutine take_branch

  subroutine take_unloading(scene, problem, branches, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(branch_t), intent(in) :: branches(:)
    type(summary_t), intent(inout) :: summary
    real(wp), dimension(size(branches)) :: tension, tension_h0, tension_error, tension_h0_error, &
      jump_h0, jump_h0_error
    integer :: k

    tension = ieee_value(1.0_wp, ieee_quiet_nan)
    tension_h0 = tension
    tension_error = tension
    tension_h0_error = tension
    jump_h0 = tension
    jump_h0_error = tension
    do k = 1, size(branches)
      if (allocated(branches(k)%lowest)) then
        associate (lowest => branches(k)%lowest)
          tension(k) = -lowest%load*problem%load
          tension_h0(k) = problem%law%separation_of(lowest%h0)
          if (allocated(lowest%error)) then
            tension_error(k) = lowest%error%load*problem%load
            if (.not. lowest%searched) tension_h0_error(k) = lowest%error%h0*problem%length
          end if
        end associate
      end if
      if (.not. allocated(branches(k)%jump)) cycle
      associate (jump => branches(k)%jump)
        jump_h0(k) = problem%law%separation_of(jump%h0)
        if (allocated(jump%error)) jump_h0_error(k) = jump%error%h0*problem%length
      end associate
      if (.not. summary%has('jump_out_h0')) &
        call take_jump(problem, 'jump_out', branches(k)%jump, branches(k)%jump_uncertainty, summary)
    end do
    call summary%set('unload_from', scene%unloading%from)
    call summary%set('unload_max_tension', tension)
    call summary%set('unload_max_tension_h0', tension_h0)
    call summary%set('unload_jump_out_h0', jump_h0)
    call summary%set('unload_max_tension_error', tension_error)
    call summary%set('unload_max_tension_h0_error', tension_h0_error)
    call summary%set('unload_jump_out_h0_error', jump_h0_error)
  end subroutine take_unloading

  subroutine take_path(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    associate (path => outcome%path)
      call summary%set('worst_residual', max(summary%number('worst_residual'), &
        path%worst_residual))
      call widen_spacing(summary, path%worst_spacing)
      if (path%ending%early()) then
        call summary%set('converged', .false.)
        call summary%warn('path: '//trim(text_of(path%ending)))
      end if
      if (path%fallen) call summary%warn('path: nothing keeps the bodies apart under this law: '// &
        'the path ends in their fall onto each other, and there is no state in contact')
      if (allocated(path%lowest)) then
        if (path%lowest%load < 0) call raise_tension(problem, path%lowest, summary)
      end if
      call take_profiles(path%profile, summary)
      call summary%set('folds_stable', merge(1, 0, path%unstable_after == 0))
      call take_list('folds', path%fold)
      call take_list('load_folds', path%extremum)
      associate (n => size(path%fold))
        if (n == 0) return
        ! What a stretch of the path begins with may be another fold.
        if (path%first_piece == 1) &
          call take_jump(problem, 'jump_in', path%fold(1), 0.0_wp, summary)
        if (path%unstable_after(n) == 0) &
          call take_jump(problem, 'jump_out', path%fold(n), 0.0_wp, summary)
      end associate
    end associate

  contains

    subroutine take_list(name, list)
      character(len=*), intent(in) :: name
      type(reported_t), intent(in) :: list(:)
      real(wp) :: h0_error(size(list)), load_error(size(list))
      integer :: k

      call summary%set(name//'_h0', problem%law%separation_of(list%h0))
      call summary%set(name//'_load', list%load*problem%load)
      h0_error = ieee_value(1.0_wp, ieee_quiet_nan)
      load_error = h0_error
      do k = 1, size(list)
        if (.not. allocated(list(k)%error)) cycle
        h0_error(k) = list(k)%error%h0*problem%length
        load_error(k) = list(k)%error%load*problem%load
      end do
      call summary%set(name//'_h0_error', h0_error)
      call summary%set(name//'_load_error', load_error)
    end subroutine take_list

  end subroutine take_path

  !> The energy lost in the cycle.
  subroutine take_energy(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    if (.not. allocated(outcome%energy_lost)) return
    call summary%set('energy_lost', outcome%energy_lost*problem%load*problem%length)
    call summary%set('energy_lost_uncertainty', &
      outcome%energy_uncertainty*problem%load*problem%length)
  end subroutine take_energy

  !> Where the loading ends or, without one, the path.
  subroutine take_end(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    type(reported_t), allocatable :: at

    if (allocated(outcome%loading)) then
      if (allocated(outcome%loading%finish)) at = outcome%loading%finish
    else if (allocated(outcome%stepped_path)) then
      if (allocated(outcome%stepped_path%finish)) at = outcome%stepped_path%finish
    else if (allocated(outcome%path)) then
      if (allocated(outcome%path%finish)) at = outcome%path%finish
    end if
    if (.not. allocated(at)) return
    call summary%set('end_h0', problem%law%separation_of(at%h0))
    call summary%set('end_displacement', at%displacement*problem%length)
    call summary%set('end_load', at%load*problem%load)
    if (.not. allocated(at%error)) return
    call summary%set('end_displacement_error', at%error%displacement*problem%length)
    call summary%set('end_load_error', at%error%load*problem%load)
  end subroutine take_end

end module summarise
