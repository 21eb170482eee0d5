!> Equilibria under given loads, as rows of a table and numbers of the summary.
module fixed_load_rows
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use path_readings, only: path_readings_t, loaded_state_t
  use reading_numbers, only: state_errors
  use tables, only: cells
  use results, only: results_t
  use summary, only: summary_t
  implicit none
  private
  public :: write_fixed_loads, summarise_fixed_loads


contains

  !> Writes the rows of fixed_load.csv: load by load, each from afar inward.
  subroutine write_fixed_loads(problem, readings, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(results_t), intent(inout) :: results
    integer :: i

    do i = 1, size(readings%loaded)
      associate (loaded => readings%loaded(i), state => readings%loaded(i)%state, &
        errors => state_errors(readings%margin, readings%loaded(i)%state))
        call results%row(cells([loaded%wanted*problem%load, &
          problem%law%separation_of(state%h0), (state%axis_gap - state%h0)*problem%length, &
          state%radius*problem%lateral]) // merge(',1', ',0', loaded%stable), &
          [errors%h0*problem%length, errors%displacement*problem%length, &
          errors%radius*problem%lateral])
      end associate
    end do
  end subroutine write_fixed_loads

  !> How many equilibria each load has, and how many of them are stable.
  subroutine summarise_fixed_loads(problem, loads, loaded, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: loads(:)
    type(loaded_state_t), intent(in) :: loaded(:)
    type(summary_t), intent(inout) :: summary
    integer :: held(size(loads)), stable(size(loads))
    integer :: i

    do i = 1, size(loads)
      associate (same => abs(loaded%wanted - loads(i)/problem%load) <= 0)
        held(i) = count(same)
        stable(i) = count(same .and. loaded%stable)
      end associate
    end do
    call summary%set('fixed_load', loads)
    call summary%set('fixed_load_equilibria', held)
    call summary%set('fixed_load_stable', stable)
  end subroutine summarise_fixed_loads

end module fixed_load_rows
