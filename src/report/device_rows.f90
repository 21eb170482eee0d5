!> Bodies driven through springs, or at prescribed h0: the path against the position of the drive,
!> approaches and retreats with their jumps, and their numbers in the summary.
module device_rows
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t, surface_energy
  use maugis, only: maugis_units_t, maugis_units
  use curve_states, only: path_state_t
  use driven_pieces, only: drive_t
  use device, only: driven_t, leg_t, states_on
  use reported_place, only: of_h0, of_load, of_energy, of_radius, of_position
  use places, only: places_t, readings_t
  use path_readings, only: path_readings_t
  use results, only: results_t
  use tables, only: cells, direction_of
  use summary, only: summary_t
  implicit none
  private
  public :: write_device, write_jumps, write_contact_table, summarise_device

  !> Relative difference of the two energies of a cycle above which there is a warning.
  real(wp), parameter :: known_energy = 1.0e-4_wp

contains

  !> Writes the rows of device.csv.
  subroutine write_device(problem, readings, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(results_t), intent(inout) :: results
    integer :: i, k

    do i = 1, size(readings%device)
      associate (driven => readings%device(i))
        call add_path(driven)
        do k = 1, size(driven%leg)
          call add_leg(driven, driven%leg(k))
        end do
      end associate
    end do

  contains

    !> Adds the whole path.
    subroutine add_path(driven)
      type(driven_t), intent(in) :: driven
      integer :: j

      do j = 1, size(readings%node)
        associate (node => readings%node(j))
          if (.not. node%again) call add(driven, 'path', node, node%modes == 0 .and. &
            dot_product(driven%drive%weights, node%slopes) < 0)
        end associate
      end do
    end subroutine add_path

    !> Adds one leg; the state in which a jump starts is not stable.
    subroutine add_leg(driven, leg)
      type(driven_t), intent(in) :: driven
      type(leg_t), intent(in) :: leg
      type(path_state_t), allocatable :: states(:)
      integer :: j

      states = states_on(readings%node, leg)
      do j = 1, size(states)
        call add(driven, direction_of(leg%inward), states(j), &
          .not. (leg%jumps .and. j == size(states)))
      end do
    end subroutine add_leg

    subroutine add(driven, direction, state, stable)
      type(driven_t), intent(in) :: driven
      character(len=*), intent(in) :: direction
      type(path_state_t), intent(in) :: state
      logical, intent(in) :: stable

      call results%row(cells([driven%stiffness]) // ',' // direction, &
        [z_of(problem, driven%drive, state), problem%law%separation_of(state%h0), &
        state%load*problem%load, state%radius*problem%lateral], [stable])
    end subroutine add

  end subroutine write_device

  !> Writes the rows of device_jumps.csv.
  subroutine write_jumps(problem, readings, places, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(results_t), intent(inout) :: results
    integer, parameter :: of_both(*) = [of_position, of_h0, of_load, of_radius]
    type(readings_t) :: before(size(of_both)), after(size(of_both))
    integer :: i, j, k, n

    n = 0
    do k = 1, size(of_both)
      before(k) = places%read_numbers(problem, 'jump_before', of_both(k))
      after(k) = places%read_numbers(problem, 'jump_after', of_both(k))
    end do
    do i = 1, size(readings%device)
      do j = 1, size(readings%device(i)%jump)
        n = n + 1
        associate (jump => readings%device(i)%jump(j))
          call results%row(cells([readings%device(i)%stiffness]) // ',' // &
            direction_of(jump%inward), [(before(k)%value(n), k=1, size(of_both)), &
            (after(k)%value(n), k=2, size(of_both)), jump%energy*problem%load*problem%length, &
            before(1)%error(n), before(3)%error(n), after(3)%error(n)])
        end associate
      end do
    end do
  end subroutine write_jumps

  !> Writes the rows of table.csv: stable states of approach and retreat at prescribed h0, as
  !> discrete-element and finite-element programs need them.
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

  !> Position of the drive [m].
  pure real(wp) function z_of(problem, drive, state) result(z)
    type(problem_t), intent(in) :: problem
    type(drive_t), intent(in) :: drive
    type(path_state_t), intent(in) :: state

    z = nan
    if (drive%weights(1) > 0) z = problem%law%separation_of(drive%position(state))
  end function z_of

  !> Adds numbers of the drives that are not read at places, with one element for each stiffness.
  subroutine summarise_device(problem, readings, places, summary)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(in) :: places
    type(summary_t), intent(inout) :: summary
    type(readings_t) :: lost

    lost = places%read_numbers(problem, 'device_energy', of_energy)
    associate (device => readings%device, unit => problem%load*problem%length)
      call summary%set('device_stiffness', device%stiffness)
      call summary%set('device_cycle_energy', device%cycle_energy*unit, &
        lost%error + uncertainty(device)*unit)
      call summary%set('device_energy_uncertainty', max(uncertainty(device)*unit, lost%error))
      if (.not. all(device%caught)) call summary%warn('device: no stable state is known ' // &
        'that catches the bodies after a jump; its load_after is NaN')
      if (any(uncertainty(device) > known_energy*abs(device%energy_lost))) &
        call summary%warn('device: the energy lost in jumps is not the area of the cycle; ' // &
        'a smaller accuracy may help')
    end associate
  end subroutine summarise_device

  !> Uncertainty of the energy lost: the difference of two ways to find it, from the energies before
  !> and after jumps, and from the load between them.
  elemental real(wp) function uncertainty(driven)
    type(driven_t), intent(in) :: driven

    uncertainty = abs(driven%energy_lost - driven%cycle_energy) + driven%uncertainty
  end function uncertainty

end module device_rows
