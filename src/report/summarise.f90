!> From what the experiments found to what the user is told: SI units, and a warning for all that
!> is not as it should be.
module summarise
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, tabor_parameter, surface_energy, largest_tension
  use classical, only: jkr_pull_off, dmt_pull_off
  use maugis, only: maugis_lambda, maugis_pull_off
  use approximation_tables, only: jump_t, jumps_t, jumps_of
  use scene_groups, only: scene_t
  use text, only: brief
  use experiment_result, only: experiment_result_t
  use reported, only: reported_t
  use stepped_branch, only: branch_t
  use summary, only: summary_t
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

    summary%title = scene%title
    summary%converged = .true.
    call describe(scene, problem, summary)
    if (allocated(outcome%chosen%grid)) then
      summary%grid = outcome%chosen%grid
      summary%method = trim(outcome%chosen%options%method)
      summary%chosen_because = outcome%chosen%because
      summary%nodes = outcome%nodes
      summary%worst_residual = 0
      if (allocated(outcome%error_estimate)) summary%error_estimate = outcome%error_estimate
    end if
    if (allocated(outcome%stepped_path)) &
      call take_branch(problem, 'path', outcome%stepped_path, summary)
    if (allocated(outcome%loading)) then
      call take_branch(problem, 'loading', outcome%loading, summary)
      if (allocated(outcome%loading%jump)) call take_jump_in(problem, outcome%loading%jump, &
        summary, outcome%loading%jump_uncertainty)
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
        short_number(summary%worst_residual)// &
        ' lengths of the force law')
      ! Equations that were not asked to hold may hold all the same.
      summary%converged = ended_as_planned(outcome) .and. &
        summary%worst_residual <= outcome%chosen%options%tolerance
    end if
  end function summary_of

  !> Whether every branch came to its end.
  pure logical function ended_as_planned(outcome) result(ended)
    type(experiment_result_t), intent(in) :: outcome

    ended = .true.
    if (allocated(outcome%path)) ended = outcome%path%reason == ''
    if (allocated(outcome%stepped_path)) ended = ended .and. outcome%stepped_path%reason == ''
    if (allocated(outcome%loading)) ended = ended .and. outcome%loading%reason == ''
    if (allocated(outcome%unloading)) ended = ended .and. all(outcome%unloading%reason == '')
  end function ended_as_planned

  !> What follows from the deck alone.
  subroutine describe(scene, problem, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%adhesion > 0) then
      summary%surface_energy = surface_energy(problem)
      summary%jkr_pull_off = -jkr_pull_off(problem%radius, summary%surface_energy)
      summary%dmt_pull_off = -dmt_pull_off(problem%radius, summary%surface_energy)
      if (.not. problem%rigid) then
        summary%sigma = problem%coupling*problem%law%adhesion
        summary%tabor = tabor_parameter(problem)
      end if
    else if (scene%force%law == 'exponential' .and. .not. problem%rigid) then
      summary%big_lambda = problem%coupling
    end if
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
    summary%maugis_lambda = maugis_lambda(problem%radius, problem%stiffness, gamma, strength)
    summary%maugis_pull_off = -maugis_pull_off(problem%radius, problem%stiffness, gamma, strength)
  end subroutine take_maugis

  !> Where approaching bodies jump in the approximation of slow deformation.
  subroutine estimate_jumps(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary
    type(jumps_t) :: jumps

    jumps = jumps_of(problem)
    call take(jumps%criterion, summary%jump_criterion_29_h0, summary%jump_criterion_29_load)
    call take(jumps%equation_37, summary%jump_equation_37_h0, summary%jump_equation_37_load)
    if (allocated(jumps%equation_37)) summary%jump_equation_37_gap = jumps%equation_37%gap
    call take(jumps%fold_attraction, summary%fold_attractive_only_h0, &
      summary%fold_attractive_only_load)
    if (allocated(jumps%fold)) then
      ! That of a law without a closed form has another name, in approximations.csv alone.
      if (jumps%fold%theory == 'fold_closed_form') &
        call take(jumps%fold, summary%fold_closed_form_h0, summary%fold_closed_form_load)
    end if

  contains

    subroutine take(jump, h0, load)
      type(jump_t), allocatable, intent(in) :: jump
      real(wp), allocatable, intent(inout) :: h0, load

      if (.not. allocated(jump)) return
      h0 = jump%h0
      load = jump%load
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
    summary%worst_residual = max(summary%worst_residual, branch%worst_residual)
    call widen_spacing(summary, branch%worst_spacing)
    if (branch%unconverged > 0) then
      summary%converged = .false.
      call summary%warn(name//': '//brief(real(branch%unconverged, wp))//' of '// &
        brief(real(branch%states, wp))//' states did not converge, the first at h0 = '// &
        short_number(branch%first_unconverged*problem%length)//' m; the largest residual is '// &
        short_number(branch%worst_residual)//' lengths of the force law')
    end if
    if (branch%reason /= '') then
      summary%converged = .false.
      call summary%warn(name//' ended early: '//trim(branch%reason))
    end if
  end subroutine take_branch

  subroutine take_unloading(scene, problem, branches, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(branch_t), intent(in) :: branches(:)
    type(summary_t), intent(inout) :: summary
    real(wp) :: nothing
    integer :: k

    nothing = ieee_value(nothing, ieee_quiet_nan)
    summary%unload_from = scene%unloading%from
    allocate (summary%unload_max_tension(size(branches)), source=nothing)
    summary%unload_max_tension_h0 = summary%unload_max_tension
    summary%unload_jump_out_h0 = summary%unload_max_tension
    summary%unload_max_tension_error = summary%unload_max_tension
    summary%unload_max_tension_h0_error = summary%unload_max_tension
    summary%unload_jump_out_h0_error = summary%unload_max_tension
    do k = 1, size(branches)
      if (allocated(branches(k)%lowest)) then
        associate (lowest => branches(k)%lowest)
          summary%unload_max_tension(k) = -lowest%load*problem%load
          summary%unload_max_tension_h0(k) = lowest%h0*problem%length
          if (allocated(lowest%error)) then
            summary%unload_max_tension_error(k) = lowest%error%load*problem%load
            if (.not. lowest%searched) &
              summary%unload_max_tension_h0_error(k) = lowest%error%h0*problem%length
          end if
        end associate
      end if
      if (.not. allocated(branches(k)%jump)) cycle
      associate (jump => branches(k)%jump)
        summary%unload_jump_out_h0(k) = jump%h0*problem%length
        if (allocated(jump%error)) &
          summary%unload_jump_out_h0_error(k) = jump%error%h0*problem%length
      end associate
      if (.not. allocated(summary%jump_out_h0)) &
        call take_jump_out(problem, branches(k)%jump, summary, branches(k)%jump_uncertainty)
    end do
  end subroutine take_unloading

  !> A jump into contact; uncertainty: how well its h0 is known where it was bracketed.
  subroutine take_jump_in(problem, jump, summary, uncertainty)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: jump
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in) :: uncertainty

    summary%jump_in_h0 = jump%h0*problem%length
    summary%jump_in_load = jump%load*problem%load
    if (allocated(summary%jump_in_uncertainty)) deallocate (summary%jump_in_uncertainty)
    if (uncertainty > 0) summary%jump_in_uncertainty = uncertainty*problem%length
    if (.not. allocated(jump%error)) return
    summary%jump_in_h0_error = jump%error%h0*problem%length
    summary%jump_in_load_error = jump%error%load*problem%load
  end subroutine take_jump_in

  !> The same for a jump out of contact.
  subroutine take_jump_out(problem, jump, summary, uncertainty)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: jump
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in) :: uncertainty

    summary%jump_out_h0 = jump%h0*problem%length
    summary%jump_out_load = jump%load*problem%load
    if (allocated(summary%jump_out_uncertainty)) deallocate (summary%jump_out_uncertainty)
    if (uncertainty > 0) summary%jump_out_uncertainty = uncertainty*problem%length
    if (.not. allocated(jump%error)) return
    summary%jump_out_h0_error = jump%error%h0*problem%length
    summary%jump_out_load_error = jump%error%load*problem%load
  end subroutine take_jump_out

  !> Errors of profiles, added to those of other branches.
  subroutine take_profiles(profile, summary)
    type(reported_t), intent(in) :: profile(:)
    type(summary_t), intent(inout) :: summary
    integer :: k

    if (.not. allocated(summary%profiles_error)) allocate (summary%profiles_error(0))
    do k = 1, size(profile)
      if (allocated(profile(k)%error)) &
        summary%profiles_error = [summary%profiles_error, profile(k)%error%profile]
    end do
    if (size(summary%profiles_error) == 0) deallocate (summary%profiles_error)
  end subroutine take_profiles

  subroutine take_path(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    associate (path => outcome%path)
      summary%worst_residual = max(summary%worst_residual, path%worst_residual)
      call widen_spacing(summary, path%worst_spacing)
      if (path%reason /= '') then
        summary%converged = .false.
        call summary%warn('path: '//trim(path%reason))
      end if
      if (path%fallen) call summary%warn('path: nothing keeps the bodies apart under this law: '// &
        'the path ends in their fall onto each other, and there is no state in contact')
      if (allocated(path%lowest)) then
        if (path%lowest%load < 0) call raise_tension(problem, path%lowest, summary)
      end if
      call take_profiles(path%profile, summary)
      summary%folds_h0 = path%fold%h0*problem%length
      summary%folds_load = path%fold%load*problem%load
      summary%folds_stable = merge(1, 0, path%unstable_after == 0)
      summary%load_folds_h0 = path%extremum%h0*problem%length
      summary%load_folds_load = path%extremum%load*problem%load
      allocate (summary%folds_h0_error(0), summary%folds_load_error(0), &
        summary%load_folds_h0_error(0), summary%load_folds_load_error(0))
      call add_errors(path%fold, summary%folds_h0_error, summary%folds_load_error)
      call add_errors(path%extremum, summary%load_folds_h0_error, summary%load_folds_load_error)
      associate (n => size(path%fold))
        if (n == 0) return
        ! What a stretch of the path begins with may be another fold.
        if (path%first_piece == 1) call take_jump_in(problem, path%fold(1), summary, 0.0_wp)
        if (path%unstable_after(n) == 0) &
          call take_jump_out(problem, path%fold(n), summary, 0.0_wp)
      end associate
    end associate

  contains

    subroutine add_errors(list, h0_error, load_error)
      type(reported_t), intent(in) :: list(:)
      real(wp), allocatable, intent(inout) :: h0_error(:), load_error(:)
      integer :: k

      do k = 1, size(list)
        if (.not. allocated(list(k)%error)) cycle
        h0_error = [h0_error, list(k)%error%h0*problem%length]
        load_error = [load_error, list(k)%error%load*problem%load]
      end do
    end subroutine add_errors

  end subroutine take_path

  !> The energy lost in the cycle.
  subroutine take_energy(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    if (.not. allocated(outcome%energy_lost)) return
    summary%energy_lost = outcome%energy_lost*problem%load*problem%length
    summary%energy_lost_uncertainty = outcome%energy_uncertainty*problem%load*problem%length
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
    summary%end_h0 = at%h0*problem%length
    summary%end_displacement = at%displacement*problem%length
    summary%end_load = at%load*problem%load
    if (.not. allocated(at%error)) return
    summary%end_displacement_error = at%error%displacement*problem%length
    summary%end_load_error = at%error%load*problem%load
  end subroutine take_end

  !> Keeps the largest tension, positive.
  subroutine raise_tension(problem, lowest, summary)
    type(problem_t), intent(in) :: problem
    type(reported_t), intent(in) :: lowest
    type(summary_t), intent(inout) :: summary

    if (allocated(summary%max_tension)) then
      if (-lowest%load*problem%load <= summary%max_tension) return
      if (allocated(summary%max_tension_error)) deallocate (summary%max_tension_error)
      if (allocated(summary%max_tension_h0_error)) deallocate (summary%max_tension_h0_error)
    end if
    summary%max_tension = -lowest%load*problem%load
    summary%max_tension_h0 = lowest%h0*problem%length
    if (.not. allocated(lowest%error)) return
    summary%max_tension_error = lowest%error%load*problem%load
    if (.not. lowest%searched) &
      summary%max_tension_h0_error = lowest%error%h0*problem%length
  end subroutine raise_tension

  subroutine widen_spacing(summary, spacing)
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in) :: spacing

    if (.not. spacing > 0) return
    if (.not. allocated(summary%spacing_over_neck)) summary%spacing_over_neck = 0
    summary%spacing_over_neck = max(summary%spacing_over_neck, spacing)
  end subroutine widen_spacing

end module summarise
