!> Places at which a table of stable states is judged: some of its rows; and the error of cubic
!> interpolation with slopes between rows.
module table_places
  use kinds, only: wp
  use curve_states, only: path_state_t
  use driven_pieces, only: state_driven
  use device, only: leg_t, states_on
  use path_stepper, only: path_stepper_t
  use path_readings, only: path_readings_t
  use reported_place, only: place_t, place_of_state, of_load
  use traced_path, only: no_mesh
  use places, only: places_t
  implicit none
  private
  public :: enter_table

  !> Number of rows of a leg that are judged.
  integer, parameter :: judged_rows = 16

contains

  !> Enters rows of the table as places.
  subroutine enter_table(steps, readings, places)
    class(path_stepper_t), intent(inout) :: steps
    type(path_readings_t), intent(inout) :: readings
    type(places_t), intent(inout) :: places
    type(path_state_t), allocatable :: nodes(:)
    integer :: i, k, row, last

    if (.not. allocated(readings%prescribed)) return
    do i = 1, size(readings%prescribed%leg)
      nodes = states_on(readings%node, readings%prescribed%leg(i))
      nodes = nodes(2:size(nodes) - 1)
      if (size(nodes) < 2) cycle
      last = 0
      do k = 1, judged_rows
        row = 1 + (k - 1)*(size(nodes) - 2)/(judged_rows - 1)
        if (row == last) cycle
        last = row
        call places%enter('table', places%elements('table') + 1, place_of(nodes(row)))
        call hold(readings%prescribed%leg(i), nodes(row), nodes(row + 1))
      end do
    end do

  contains

    !> Compares the interpolation with the state in the middle between a row and the next.
    subroutine hold(leg, row, next)
      type(leg_t), intent(in) :: leg
      type(path_state_t), intent(in) :: row, next
      type(path_state_t) :: state

      associate (driven => readings%prescribed, width => next%h0 - row%h0)
        if (.not. abs(width) > 0) return
        call state_driven(steps%solver_t, steps%known%path, driven%drive, &
          driven%piece(leg%piece), 0.5_wp*(row%h0 + next%h0), state)
        if (state%converged) readings%table_interpolation_error = &
          max(readings%table_interpolation_error, abs(state%load - 0.5_wp*(row%load + next%load) - &
          width/8*(row%slopes(2)/row%slopes(1) - next%slopes(2)/next%slopes(1))))
      end associate
    end subroutine hold

  end subroutine enter_table

  !> A point of the path as a place at its h0.
  pure type(place_t) function place_of(point) result(place)
    type(path_state_t), intent(in) :: point

    if (point%mesh == no_mesh) then
      place%mesh = no_mesh
      place%at(:of_load) = [point%h0, point%load]
    else
      place = place_of_state(point%mesh, point%state)
    end if
    place%s = point%x
  end function place_of

end module table_places
