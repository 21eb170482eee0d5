!> The tables beside the curve, in `write_derived_tables` one statement each.
module derived_tables
  use dimensionless_problem, only: problem_t
  use experiment_request, only: sensitivity_t
  use h0_range, only: path_start
  use scene_groups, only: scene_t
  use experiment_result, only: experiment_result_t
  use records, only: theory_row_t
  use namelist_writer, only: line_t
  use tables, only: cells
  use summary, only: summary_t
  use results, only: results_t
  use classical_rows, only: rows_of_classical
  use approximation_tables, only: approximation_rows
  use device_rows, only: device_columns, jump_columns, device_lines, jump_lines
  use fixed_load_rows, only: fixed_load_columns, fixed_load_lines
  use table_rows, only: table_columns, table_lines
  use sensitivity_rows, only: sensitivity_columns, curve_sensitivity_columns, sensitivity_lines, &
    curve_sensitivity_lines
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

    if (allocated(scene%classical)) call results%write_table('classical.csv', theory_columns, &
      theory_lines(rows_of_classical(problem, scene%classical, path_start(scene, problem))))
    if (allocated(scene%approximations)) call results%write_table('approximations.csv', &
      theory_columns, &
      theory_lines(approximation_rows(problem, scene%approximations, path_start(scene, problem))))
  end subroutine write_derived_tables

  !> Writes those that are read from the path.
  subroutine write_path_tables(problem, outcome, results)
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(results_t), intent(inout) :: results

    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      if (allocated(readings%device)) then
        call results%write_table('device.csv', device_columns, device_lines(problem, readings))
        call results%write_table('device_jumps.csv', jump_columns, jump_lines(problem, readings))
      end if
      if (allocated(readings%loaded)) call results%write_table('fixed_load.csv', &
        fixed_load_columns, fixed_load_lines(problem, readings%loaded))
      if (allocated(readings%prescribed)) call results%write_table('table.csv', table_columns, &
        table_lines(problem, readings))
    end associate
  end subroutine write_path_tables

  !> Writes the derivatives of what is in the summary and read from the path.
  subroutine write_sensitivities(sensitivity, problem, outcome, summary, results)
    type(sensitivity_t), intent(in) :: sensitivity
    type(problem_t), intent(in) :: problem
    type(experiment_result_t), intent(in) :: outcome
    type(summary_t), intent(in) :: summary
    type(results_t), intent(inout) :: results

    if (.not. allocated(outcome%readings)) return
    associate (readings => outcome%readings)
      call results%write_table('sensitivity.csv', sensitivity_columns, &
        sensitivity_lines(problem, sensitivity%varied, summary, readings))
      if (allocated(readings%rate)) call results%write_table('curve_sensitivity.csv', &
        curve_sensitivity_columns, curve_sensitivity_lines(problem, sensitivity%varied, readings))
    end associate
  end subroutine write_sensitivities

  !> Rows of a theory as lines of its table.
  pure function theory_lines(rows) result(lines)
    type(theory_row_t), intent(in) :: rows(:)
    type(line_t), allocatable :: lines(:)
    integer :: i

    allocate (lines(size(rows)))
    do i = 1, size(rows)
      lines(i)%text = rows(i)%theory // ',' // cells([rows(i)%h0, rows(i)%displacement, &
        rows(i)%load, rows(i)%contact_radius])
    end do
  end function theory_lines

end module derived_tables
