!> Equilibria at given loads, as rows of a table and numbers of the summary.
module fixed_load_rows
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use path_readings, only: path_readings_t
  use reported_place, only: of_h0, of_displacement, of_radius
  use places, only: places_t, readings_t
  use tables, only: cells
  use results, only: results_t
  use summary, only: summary_t
  implicit none
  private
  public :: write_fixed_loads, summarise_fixed_loads

contains

  !> Writes the rows of fixed_load.csv: load by load, in the order of the path.
  subroutine write_fixed_loads(problem, readings, places, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(results_t), intent(inout) :: results
    type(readings_t) :: h0, displacement, radius
    integer :: i

    h0 = places%read_numbers(problem, 'fixed_load', of_h0)
    displacement = places%read_numbers(problem, 'fixed_load', of_displacement)
    radius = places%read_numbers(problem, 'fixed_load', of_radius)
    do i = 1, size(readings%loaded)
      associate (loaded => readings%loaded(i))
        call results%row(cells([loaded%wanted*problem%load, h0%value(i), &
          displacement%value(i), radius%value(i)]) // merge(',1', ',0', loaded%stable), &
          [h0%error(i), displacement%error(i), radius%error(i)])
      end associate
    end do
  end subroutine write_fixed_loads

  !> Adds, for each load, the number of equilibria and of stable ones, and the stable one with the
  !> smallest h0: the contact, if there is one.
  subroutine summarise_fixed_loads(problem, loads, readings, places, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: loads(:)
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    integer :: held(size(loads)), stable(size(loads)), nearest(size(loads)), i

    associate (loaded => readings%loaded)
      do i = 1, size(loads)
        associate (same => loaded%number == i)
          held(i) = count(same)
          stable(i) = count(same .and. loaded%stable)
          ! On the path the stable one with the smallest h0 is the last.
          nearest(i) = findloc(same .and. loaded%stable, .true., 1, back=.true.)
        end associate
      end do
    end associate
    call summary%set('fixed_load', loads)
    call summary%set('fixed_load_equilibria', held)
    call summary%set('fixed_load_stable', stable)
    call set('fixed_load_h0', of_h0)
    call set('fixed_load_displacement', of_displacement)
    call set('fixed_load_contact_radius', of_radius)

  contains

    subroutine set(key, quantity)
      character(len=*), intent(in) :: key
      integer, intent(in) :: quantity
      type(readings_t) :: found
      real(wp), dimension(size(loads)) :: value, error
      integer :: i

      found = places%read_numbers(problem, 'fixed_load', quantity)
      value = nan
      error = nan
      do i = 1, size(loads)
        if (nearest(i) == 0) cycle
        value(i) = found%value(nearest(i))
        error(i) = found%error(nearest(i))
      end do
      call summary%set(key, value, error)
    end subroutine set

  end subroutine summarise_fixed_loads

end module fixed_load_rows
