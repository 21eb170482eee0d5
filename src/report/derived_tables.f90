!> The tables beside the curve, in `write_derived_tables` one statement each.
module derived_tables
  ! First what uses most: compiler note 12.
  use scene_groups, only: scene_t
  use dimensionless_problem, only: problem_t
  use experiment_request, only: sensitivity_t
  use h0_range, only: path_start
  use experiment_result, only: experiment_result_t
  use summary, only: summary_t
  use results, only: results_t
  use classical_rows, only: write_classical
  use approximation_tables, only: write_approximations
  use device_rows, only: device_columns, jump_columns, write_device, write_jumps
  use fixed_load_rows, only: fixed_load_columns, write_fixed_loads
  use table_rows, only: table_columns, write_contact_table
  use sensitivity_rows, only: sensitivity_columns, curve_sensitivity_columns, write_sensitivity, &
    write_curve_sensitivity
  implicit none
  private
  public :: write_derived_tables, write_path_tables, write_sensitivities, theory_columns

  !> Columns of classical.csv and approximations.csv.
  character(len=*), parameter :: theory_columns(*) = [character(len=96) :: &
    'theory [] where the row comes from', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'displacement [m] separation on the axis less h0', &
    'load [N] negative: tension', &
    'contact_radius [m] NaN where the theory does not give one']

contains

  !> Writes those that the scene asks for.
  subroutine write_derived_tables(scene, problem, results)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    type(results_t), intent(inout) :: results

    if (allocated(scene%classical)) then
      call results%begin_table('classical.csv', theory_columns)
      call write_classical(problem, scene%classical, path_start(scene, problem), results)
      call results%end_table()
    end if
    if (.not. allocated(scene%approximations)) return
    call results%begin_table('approximations.csv', theory_columns)
    call write_approximations(problem, scene%approximations, path_start(scene, problem), results)
    call results%end_table()
  end subroutine write_derived_tables

  !> Writes those that are read from the path.
  subroutine write_path_tables(problem, outcome, results)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(results_t), intent(inout) :: results

    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      if (allocated(readings%device)) then
        call results%begin_table('device.csv', device_columns)
        call write_device(problem, readings, results)
        call results%end_table()
        call results%begin_table('device_jumps.csv', jump_columns)
        call write_jumps(problem, readings, outcome%places, results)
        call results%end_table()
      end if
      if (allocated(readings%loaded)) then
        call results%begin_table('fixed_load.csv', fixed_load_columns)
        call write_fixed_loads(problem, readings, outcome%places, results)
        call results%end_table()
      end if
      if (.not. allocated(readings%prescribed)) return
      call results%begin_table('table.csv', table_columns)
      call write_contact_table(problem, readings, results)
      call results%end_table()
    end associate
  end subroutine write_path_tables

  !> Writes the derivatives of what is in the summary and read from the path.
  subroutine write_sensitivities(sensitivity, problem, outcome, summary, results)
    type(sensitivity_t), intent(in) :: sensitivity
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(in) :: summary
    type(results_t), intent(inout) :: results

    if (.not. (allocated(outcome%readings) .or. allocated(outcome%timed))) return
    call results%begin_table('sensitivity.csv', sensitivity_columns)
    call write_sensitivity(problem, sensitivity%varied, summary, outcome%places, results)
    call results%end_table()
    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      if (.not. allocated(readings%rate)) return
      call results%begin_table('curve_sensitivity.csv', curve_sensitivity_columns)
      call write_curve_sensitivity(problem, sensitivity%varied, readings, results)
      call results%end_table()
    end associate
  end subroutine write_sensitivities

end module derived_tables
