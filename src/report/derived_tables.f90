!> The tables beside the curve, each written by one statement.
module derived_tables
  ! The module with most dependencies is first: compiler note 12.
  use results, only: results_t
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t, calm_gap
  use experiment_request, only: sensitivity_t
  use experiment_result, only: experiment_result_t
  use path_demand, only: path_start
  use summary, only: summary_t
  use classical_rows, only: write_classical
  use approximation_tables, only: write_approximations
  use device_rows, only: write_device, write_jumps, write_contact_table
  use fixed_load_rows, only: write_fixed_loads
  use sensitivity_rows, only: write_sensitivity, write_curve_sensitivity
  implicit none
  private
  public :: write_derived_tables, write_path_tables, write_sensitivities

contains

  !> Writes the tables of theories that the scene asks for.
  subroutine write_derived_tables(scene, problem, results, summary)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(results_t), intent(inout) :: results
    type(summary_t), intent(inout) :: summary

    if (allocated(scene%classical)) then
      call results%begin_table('classical.csv')
      call write_classical(problem, scene%classical, path_start(scene, problem), results, summary)
    end if
    if (.not. allocated(scene%approximations)) return
    call results%begin_table('approximations.csv')
    ! Bodies are nearly undeformed only before the path comes to contact.
    call write_approximations(problem, scene%approximations, max(path_start(scene, problem), &
      problem%law%separation_of(calm_gap(problem))), results)
  end subroutine write_derived_tables

  !> Writes the tables that are read from the path.
  subroutine write_path_tables(problem, outcome, results)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(results_t), intent(inout) :: results

    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      if (allocated(readings%device)) then
        call results%begin_table('device.csv')
        call write_device(problem, readings, results)
        call results%begin_table('device_jumps.csv')
        call write_jumps(problem, readings, outcome%places, results)
      end if
      if (allocated(readings%loaded)) then
        call results%begin_table('fixed_load.csv')
        call write_fixed_loads(problem, readings, outcome%places, results)
      end if
      if (.not. allocated(readings%prescribed)) return
      call results%begin_table('table.csv')
      call write_contact_table(problem, readings, results)
    end associate
  end subroutine write_path_tables

  !> Writes the derivatives of the summary's numbers and of the curve.
  subroutine write_sensitivities(sensitivity, problem, outcome, summary, results)
    type(sensitivity_t), intent(in) :: sensitivity
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(in) :: summary
    type(results_t), intent(inout) :: results

    if (.not. (allocated(outcome%readings) .or. allocated(outcome%timed))) return
    call results%begin_table('sensitivity.csv')
    call write_sensitivity(problem, sensitivity%varied, summary, outcome%places, results)
    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      if (.not. allocated(readings%rate)) return
      call results%begin_table('curve_sensitivity.csv')
      call write_curve_sensitivity(problem, sensitivity%varied, readings, results)
    end associate
  end subroutine write_sensitivities

end module derived_tables
