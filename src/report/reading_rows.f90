!> Tables that are derived from the path, and their numbers in the summary. They describe cycles
!> with springs or at prescribed h0, with their jumps, and equilibria at given loads.
module reading_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t, surface_energy
  use maugis, only: maugis_units_t, maugis_units
  use path_point, only: path_point_t
  use device, only: driven_t, states_on
  use reported_place, only: of_h0, of_load, of_energy, of_radius, of_position, of_displacement
  use places, only: places_t
  use reported_values, only: readings_t, read_numbers
  use path_readings, only: path_readings_t, is_stable_under_load
  use results, only: results_t
  use tables, only: cells, direction_of
  use summary, only: summary_t
  implicit none
  private
  public :: write_path_tables, summarise_device, summarise_fixed_loads

  !> Relative difference of the two energies of a cycle above which there is a warning.
  real(wp), parameter :: known_energy = 1.0e-4_wp

contains

  !> Writes the tables that are derived from the path.
  subroutine write_path_tables(problem, readings, places, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(results_t), intent(inout) :: results

    if (allocated(readings%device)) then
      call write_device()
      call write_jumps()
    end if
    if (allocated(readings%loaded)) call write_fixed_loads()
    if (allocated(readings%prescribed)) call write_contact_table()

  contains

    !> For each spring, writes the whole path, then the branches of approach and retract. The state
    !> from which a jump starts is marked as not stable.
    subroutine write_device()
      type(path_point_t), allocatable :: states(:)
      integer :: i, j, k

      call results%begin_table('device.csv')
      do i = 1, size(readings%device)
        associate (driven => readings%device(i))
          do j = 1, size(readings%node)
            associate (node => readings%node(j))
              ! A point from which no segment of the path leads on is repeated on the next mesh,
              ! unless it is the last one.
              if (node%leads_on .or. j == size(readings%node)) call add_driven(driven, 'path', &
                node, node%modes == 0 .and. node%tangent%of(driven%drive%weights) < 0)
            end associate
          end do
          do k = 1, size(driven%leg)
            states = states_on(readings%node, driven%leg(k))
            do j = 1, size(states)
              call add_driven(driven, direction_of(driven%leg(k)%inward), states(j), &
                .not. (driven%leg(k)%jumps .and. j == size(states)))
            end do
          end do
        end associate
      end do
    end subroutine write_device

    subroutine add_driven(driven, direction, point, stable)
      type(driven_t), intent(in) :: driven
      character(len=*), intent(in) :: direction
      type(path_point_t), intent(in) :: point
      logical, intent(in) :: stable
      real(wp) :: z

      z = nan
      if (driven%drive%weights(1) > 0) z = problem%law%separation_of(driven%drive%position(point))
      call results%row(cells([driven%stiffness]) // ',' // direction, [z, &
        problem%law%separation_of(point%state%h0), point%state%load*problem%load, &
        point%radius*problem%lateral], [stable])
    end subroutine add_driven

    subroutine write_jumps()
      integer, parameter :: of_both(*) = [of_position, of_h0, of_load, of_radius]
      type(readings_t) :: before(size(of_both)), after(size(of_both))
      integer :: i, j, k, n

      call results%begin_table('device_jumps.csv')
      n = 0
      do k = 1, size(of_both)
        before(k) = read_numbers(places, problem, 'jump_before', of_both(k))
        after(k) = read_numbers(places, problem, 'jump_after', of_both(k))
      end do
      do i = 1, size(readings%device)
        do j = 1, size(readings%device(i)%jumped)
          n = n + 1
          associate (jump => readings%device(i)%jumped(j))
            call results%row(cells([readings%device(i)%stiffness]) // ',' // &
              direction_of(jump%inward), [(before(k)%value(n), k=1, size(of_both)), &
              (after(k)%value(n), k=2, size(of_both)), jump%energy*problem%load*problem%length, &
              before(1)%error(n), before(3)%error(n), after(3)%error(n)])
          end associate
        end do
      end do
    end subroutine write_jumps

    !> Writes the equilibria load by load, each in the order of the path.
    subroutine write_fixed_loads()
      type(readings_t) :: h0, displacement, radius
      integer :: i

      call results%begin_table('fixed_load.csv')
      h0 = read_numbers(places, problem, 'fixed_load', of_h0)
      displacement = read_numbers(places, problem, 'fixed_load', of_displacement)
      radius = read_numbers(places, problem, 'fixed_load', of_radius)
      do i = 1, size(readings%loaded)
        call results%row(cells([readings%load(readings%load_of(i))*problem%load, h0%value(i), &
          displacement%value(i), radius%value(i)]) // &
          merge(',1', ',0', is_stable_under_load(readings%loaded(i))), &
          [h0%error(i), displacement%error(i), radius%error(i)])
      end do
    end subroutine write_fixed_loads

    !> Writes the table of stable states of approach and retract at prescribed h0, in a form that
    !> discrete-element and finite-element programs can use.
    subroutine write_contact_table()
      type(path_point_t), allocatable :: states(:)
      type(maugis_units_t) :: unit
      real(wp) :: si(4)
      integer :: i, j

      call results%begin_table('table.csv')
      ! Shapes other than these have no radius on the axis, and laws without a work of adhesion have
      ! no theory of adhesion.
      unit = maugis_units_t(nan, nan, nan)
      if (problem%shape%parabolic .and. problem%law%work > 0) &
        unit = maugis_units(problem%radius, problem%stiffness, surface_energy(problem))
      do i = 1, size(readings%prescribed%leg)
        associate (leg => readings%prescribed%leg(i))
          states = states_on(readings%node, leg)
          do j = 1, size(states)
            associate (state => states(j)%state, tangent => states(j)%tangent)
              si = [-problem%law%separation_of(state%h0), state%load*problem%load, &
                states(j)%radius*problem%lateral, nan]
              if (.not. (leg%jumps .and. j == size(states))) &
                si(4) = -tangent%load/tangent%h0*problem%load/problem%length
            end associate
            call results%row(direction_of(leg%inward), [si, si(1)/unit%displacement, &
              si(2)/unit%load, si(3)/unit%radius, si(4)*unit%displacement/unit%load])
          end do
        end associate
      end do
    end subroutine write_contact_table

  end subroutine write_path_tables

  !> Adds the numbers of springs that belong to no solution point, with one element for each spring
  !> constant.
  subroutine summarise_device(problem, readings, places, summary)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    type(readings_t) :: lost

    lost = read_numbers(places, problem, 'device_energy', of_energy)
    associate (device => readings%device, unit => problem%load*problem%length)
      call summary%set('device_stiffness', device%stiffness)
      call summary%set('device_cycle_energy', device%cycle_energy*unit, &
        lost%error + uncertainty(device)*unit)
      call summary%set('device_energy_uncertainty', larger(uncertainty(device)*unit, lost%error))
      if (.not. all(device%caught)) call summary%warn('device: no stable state is known ' // &
        'that catches the bodies after a jump; its load_after is NaN')
      if (any(is_doubtful(device))) &
        call summary%warn('device: the energy lost in jumps is not the area of the cycle; ' // &
        'a smaller accuracy may help')
    end associate
  end subroutine summarise_device

  !> Uncertainty of the energy lost. It is the difference between two ways to compute this energy:
  !> from the energies before and after jumps, and from the load between the jumps.
  elemental real(wp) function uncertainty(driven)
    type(driven_t), intent(in) :: driven

    uncertainty = abs(driven%energy_lost - driven%cycle_energy) + driven%uncertainty
  end function uncertainty

  !> Whether the two ways give different energies. Under a dead load bodies may separate for good;
  !> then neither energy exists.
  elemental logical function is_doubtful(driven)
    type(driven_t), intent(in) :: driven

    is_doubtful = .false.
    if (ieee_is_nan(driven%energy_lost) .or. ieee_is_nan(driven%cycle_energy)) return
    is_doubtful = uncertainty(driven) > known_energy*abs(driven%energy_lost)
  end function is_doubtful

  !> The larger of two numbers, without regard to `other` if this is NaN; NaN if `one` is NaN.
  elemental real(wp) function larger(one, other)
    real(wp), intent(in) :: one, other

    larger = one
    if (ieee_is_nan(one)) return
    larger = other
    if (.not. ieee_is_nan(other)) larger = max(one, other)
  end function larger

  !> Adds, for each load, the number of equilibria and of stable equilibria, and the stable one with
  !> the smallest h0. The latter is the contact, if there is a contact. loads: in N.
  subroutine summarise_fixed_loads(problem, loads, readings, places, summary)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: loads(:)
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    integer :: held(size(loads)), stable(size(loads)), nearest(size(loads)), i

    associate (is_stable => is_stable_under_load(readings%loaded))
      do i = 1, size(loads)
        associate (same => readings%load_of == i)
          held(i) = count(same)
          stable(i) = count(same .and. is_stable)
          ! On the path the last stable equilibrium of a load has the smallest h0.
          nearest(i) = findloc(same .and. is_stable, .true., 1, back=.true.)
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

      found = read_numbers(places, problem, 'fixed_load', quantity)
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

end module reading_rows
