!> Stable states of approach and retreat at prescribed h0, as the table that discrete-element and
!> finite-element programs need: load, contact radius and stiffness against indentation.
module table_rows
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t, surface_energy
  use maugis, only: maugis_units_t, maugis_units
  use curve_states, only: path_state_t
  use path_readings, only: path_readings_t
  use device, only: states_on
  use results, only: results_t
  use tables, only: direction_of
  implicit none
  private
  public :: write_contact_table

contains

  !> Writes the rows of table.csv.
  subroutine write_contact_table(problem, readings, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(results_t), intent(inout) :: results
    type(path_state_t), allocatable :: states(:)
    integer :: i, j

    associate (driven => readings%prescribed)
      do i = 1, size(driven%leg)
        associate (leg => driven%leg(i))
          states = states_on(readings%node, leg)
          do j = 1, size(states)
            call add(leg%inward, states(j), leg%jumps .and. j == size(states))
          end do
        end associate
      end do
    end associate

  contains

    subroutine add(inward, state, at_jump)
      logical, intent(in) :: inward, at_jump
      type(path_state_t), intent(in) :: state
      type(maugis_units_t) :: unit
      real(wp) :: si(4)

      si = [-problem%law%separation_of(state%h0), state%load*problem%load, &
        state%radius*problem%lateral, nan]
      if (.not. at_jump) &
        si(4) = -state%slopes(2)/state%slopes(1)*problem%load/problem%length
      unit = maugis_units(problem%radius, problem%stiffness, surface_energy(problem))
      ! Other shapes have no radius on the axis.
      if (.not. problem%shape%parabolic) unit = maugis_units_t(nan, nan, nan)
      call results%row(direction_of(inward), [si, &
        si(1)/unit%displacement, si(2)/unit%load, si(3)/unit%radius, &
        si(4)*unit%displacement/unit%load])
    end subroutine add

  end subroutine write_contact_table

end module table_rows
