!> From what the experiments found to what the user is told: SI units, and a warning for all that
!> is not as it should be.
module summarise
  use kinds, only: wp, long
  use numerics_choice, only: grid_names, unchosen, edge_locked
  use dimensionless_problem, only: problem_t, adhesion_strength, tabor_parameter, &
    surface_energy
  use classical, only: jkr_pull_off, dmt_pull_off
  use convex_contact, only: jkr_like_pull_off
  use scene_groups, only: scene_t
  use experiment_result, only: experiment_result_t
  use reported, only: reported_t
  use force_entries, only: take_forces
  use result_rows, only: rows
  use summary, only: summary_t
  use summary_entries, only: h0_of, load_of, load_error_of, rates_of_one
  use branch_summary, only: summarise_branches
  use path_summary, only: summarise_path
  use classical_rows, only: summarise_classical
  use approximation_tables, only: summarise_approximations
  use device_rows, only: summarise_device
  use fixed_load_rows, only: summarise_fixed_loads
  use regime_rows, only: summarise_regime
  use rate_entries, only: summarise_timed
  use validity, only: judge_law, judge_extent, extent_of
  use layer_entries, only: summarise_layers, judge_layers
  use quality_warnings, only: judge_resolution, judge_accuracy, judge_stopping
  implicit none
  private
  public :: summary_of, describe_problem

contains

  !> The summary of a run: a line for each experiment and table.
  function summary_of(scene, problem, outcome) result(summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t) :: summary

    call summary%set('title', scene%title)
    call summary%set('converged', .true.)
    call describe_problem(scene, problem, summary)
    if (allocated(scene%sensitivity) .and. .not. allocated(scene%drive)) &
      call rate_description(scene, summary)
    call judge_law(problem, summary)
    if (allocated(scene%classical)) call summarise_classical(problem, scene%classical, summary)
    if (allocated(scene%approximations)) call summarise_approximations(problem, summary)
    if (outcome%chosen%grid == unchosen) return
    call describe_numerics(outcome, summary)
    call summarise_branches(scene, problem, outcome, summary)
    if (allocated(outcome%timed)) &
      call summarise_timed(scene, problem, outcome%timed, summary)
    if (allocated(outcome%path)) call summarise_path(problem, outcome%path, summary)
    if (allocated(outcome%readings)) call take_readings(scene, problem, outcome, summary)
    if (scene%regime) call summarise_regime(problem, outcome, summary)
    call take_energy(problem, outcome, summary)
    call take_end(problem, outcome, summary)
    call judge_extent(problem, outcome, summary)
    call judge_layers(problem, extent_of(outcome), summary)
    if (.not. outcome%differentiated) &
      call summary%fail_with('sensitivity: not all derivatives were found')
    call judge_resolution(outcome%chosen%grid == edge_locked, summary)
    call judge_accuracy(scene, outcome, summary)
    call judge_stopping(outcome, ended_as_planned(outcome), summary)
  end function summary_of

  !> The numerics that were chosen.
  subroutine describe_numerics(outcome, summary)
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    call summary%set('grid', trim(grid_names(outcome%chosen%grid)))
    call summary%set('method', outcome%chosen%method)
    call summary%set('chosen_because', outcome%chosen%because)
    call summary%set('nodes', int(outcome%nodes, long))
    call summary%set('worst_residual', 0.0_wp)
    if (allocated(outcome%error_estimate)) &
      call summary%set('error_estimate', outcome%error_estimate)
  end subroutine describe_numerics

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
  subroutine describe_problem(scene, problem, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (problem%law%adhesion > 0) then
      if (problem%law%work > 0) then
        call summary%set('surface_energy', surface_energy(problem))
        call take_pull_offs(problem, summary)
      end if
      if (.not. problem%rigid) then
        call summary%set('sigma', adhesion_strength(problem))
        if (problem%shape%exponent > 0) call summary%set('tabor', tabor_parameter(problem))
      end if
    else if (problem%law%coupling_name /= '' .and. .not. problem%rigid) then
      call summary%set(trim(problem%law%coupling_name), problem%coupling)
    end if
    call summarise_layers(problem, summary)
    if (problem%law%rest_gap > 0) &
      call summary%set('rest_gap', problem%law%separation_of(problem%law%rest_gap))
    if (.not. problem%law%of_paper) call take_forces(problem, summary)
  end subroutine describe_problem

  !> Derivatives of what follows from the deck alone, by differences.
  subroutine rate_description(scene, summary)
    type(scene_t), intent(in) :: scene
    type(summary_t), intent(inout) :: summary
    type(summary_t) :: trial
    real(wp), allocatable :: rate(:, :), all_rates(:, :)
    integer :: i, j, k

    associate (varied => scene%sensitivity%varied)
      allocate (all_rates(size(varied), size(rows)), source=0.0_wp)
      do j = 1, size(varied)
        do k = 1, size(varied(j)%problem)
          trial = summary_t()
          call describe_problem(scene, varied(j)%problem(k), trial)
          do i = 1, size(rows)
            ! Of differences, so that what does not depend on a parameter has no derivative.
            all_rates(j, i) = all_rates(j, i) + varied(j)%weight(k)* &
              (trial%number(trim(rows(i)%key)) - summary%number(trim(rows(i)%key)))
          end do
        end do
      end do
    end associate
    do i = 1, size(rows)
      if (size(summary%numbers(trim(rows(i)%key))) /= 1) cycle
      rate = all_rates(:, i:i)
      call summary%set_rate(trim(rows(i)%key), rate)
    end do
  end subroutine rate_description

  !> What was read from the path.
  subroutine take_readings(scene, problem, outcome, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary
    integer :: parameters

    associate (readings => outcome%readings)
      call summary%set('path_traced_h0', problem%law%separation_of(readings%traced_from))
      if (readings%undeformed_from > readings%traced_from) call summary%set( &
        'path_undeformed_h0', problem%law%separation_of(readings%undeformed_from))
      if (.not. readings%solved) &
        call summary%fail_with('not all that is read from the path was solved')
      parameters = 0
      if (allocated(scene%sensitivity)) parameters = size(scene%sensitivity%varied)
      if (allocated(readings%device)) &
        call summarise_device(problem, readings, parameters, summary)
      if (allocated(readings%table_error)) then
        call summary%set('table_load_error', readings%table_error*problem%load)
        call summary%set('table_interpolation_error', &
          readings%table_interpolation_error*problem%load)
      end if
      if (allocated(readings%loaded)) call summarise_fixed_loads(problem, scene%fixed_load%load, &
        readings%loaded, summary)
    end associate
  end subroutine take_readings

  !> Pull-offs of the theories. Of other shapes than the parabola that of JKR theory depends on the
  !> stiffness, and that of rigid bodies on more of the law than its surface energy.
  subroutine take_pull_offs(problem, summary)
    type(problem_t), intent(in) :: problem
    type(summary_t), intent(inout) :: summary

    if (.not. problem%body%is_homogeneous()) then
      ! JKR of layered bodies is with &classical.
      if (problem%shape%parabolic) call summary%set('dmt_pull_off', &
        -dmt_pull_off(problem%radius, surface_energy(problem)))
    else if (problem%shape%parabolic) then
      call summary%set('jkr_pull_off', -jkr_pull_off(problem%radius, surface_energy(problem)))
      call summary%set('dmt_pull_off', -dmt_pull_off(problem%radius, surface_energy(problem)))
    else if (.not. problem%rigid) then
      call summary%set('jkr_pull_off', -jkr_like_pull_off(problem)*problem%load)
    end if
  end subroutine take_pull_offs

  !> The energy lost in the cycle.
  subroutine take_energy(problem, outcome, summary)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(inout) :: summary

    if (.not. allocated(outcome%energy_lost)) return
    call summary%set('energy_lost', outcome%energy_lost*problem%load*problem%length)
    call summary%set('energy_lost_uncertainty', &
      outcome%energy_uncertainty*problem%load*problem%length)
    if (allocated(outcome%energy_rate)) call summary%set_rate('energy_lost', &
      reshape(outcome%energy_rate, [size(outcome%energy_rate), 1]))
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
    call summary%set('end_h0', h0_of(problem, at))
    call summary%set('end_displacement', at%displacement*problem%length)
    call summary%set('end_load', load_of(problem, at))
    associate (rates => rates_of_one(at))
      call summary%set_rate('end_displacement', rates%displacement)
      call summary%set_rate('end_load', rates%load)
    end associate
    if (.not. allocated(at%error)) return
    call summary%set('end_displacement_error', at%error%displacement*problem%length)
    call summary%set('end_load_error', load_error_of(problem, at))
  end subroutine take_end

end module summarise
