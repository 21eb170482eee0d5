!> Bodies driven through springs: the path against the position of the drive, the ways in and out
!> with their jumps, and what they leave in the summary.
module device_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use curve_states, only: curve_state_t
  use driven_pieces, only: drive_t, jump_t
  use device, only: driven_t, leg_t, nodes_on
  use reading_numbers, only: error_of, state_errors
  use place_sensitivity, only: of_load
  use reading_sensitivities, only: weights_of
  use path_readings, only: path_readings_t
  use results, only: results_t
  use tables, only: cells
  use summary, only: summary_t
  implicit none
  private
  public :: write_device, write_jumps, summarise_device

  !> An energy is worth having where the two routes to it differ by less than this part.
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

    !> The whole path.
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

    !> One leg; where a jump starts it is not stable any more.
    subroutine add_leg(driven, leg)
      type(driven_t), intent(in) :: driven
      type(leg_t), intent(in) :: leg
      character(len=:), allocatable :: direction
      type(curve_state_t), allocatable :: nodes(:)
      integer :: j

      direction = direction_of(leg%inward)
      call add(driven, direction, leg%from, .true.)
      nodes = nodes_on(readings%node, leg)
      do j = 1, size(nodes)
        call add(driven, direction, nodes(j), .true.)
      end do
      call add(driven, direction, leg%to, .not. leg%jumps)
    end subroutine add_leg

    subroutine add(driven, direction, state, stable)
      type(driven_t), intent(in) :: driven
      character(len=*), intent(in) :: direction
      type(curve_state_t), intent(in) :: state
      logical, intent(in) :: stable

      call results%row(cells([driven%stiffness]) // ',' // direction, &
        [z_of(problem, driven%drive, state), si_of(problem, state)], [stable])
    end subroutine add

  end subroutine write_device

  !> Writes the rows of device_jumps.csv.
  subroutine write_jumps(problem, readings, results)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(results_t), intent(inout) :: results
    real(wp) :: after(3)
    integer :: i, k

    do i = 1, size(readings%device)
      do k = 1, size(readings%device(i)%jump)
        associate (driven => readings%device(i), jump => readings%device(i)%jump(k))
          after = ieee_value(1.0_wp, ieee_quiet_nan)
          if (jump%landed) after = si_of(problem, jump%after)
          call results%row(cells([driven%stiffness]) // ',' // direction_of(jump%inward), &
            [z_of(problem, driven%drive, jump%before), &
            si_of(problem, jump%before), after, jump%energy*problem%load*problem%length, &
            jump_errors(problem, readings, driven, jump)])
        end associate
      end do
    end do
  end subroutine write_jumps

  pure function direction_of(inward) result(direction)
    logical, intent(in) :: inward
    character(len=:), allocatable :: direction

    direction = 'retreat'
    if (inward) direction = 'approach'
  end function direction_of

  !> h0, load and contact radius in SI units.
  pure function si_of(problem, state) result(values)
    type(problem_t), intent(in) :: problem
    type(curve_state_t), intent(in) :: state
    real(wp) :: values(3)

    values = [problem%law%separation_of(state%h0), state%load*problem%load, &
      state%radius*problem%lateral]
  end function si_of

  !> Position of the drive [m].
  pure real(wp) function z_of(problem, drive, state) result(z)
    type(problem_t), intent(in) :: problem
    type(drive_t), intent(in) :: drive
    type(curve_state_t), intent(in) :: state

    z = ieee_value(z, ieee_quiet_nan)
    if (drive%weights(1) > 0) z = problem%law%separation_of(drive%position(state))
  end function z_of

  !> What the drives leave in the summary, an element for each stiffness: the first jump of each
  !> way, and the energy; with derivatives by so many parameters.
  subroutine summarise_device(problem, readings, parameters, summary)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    integer, intent(in) :: parameters
    type(summary_t), intent(inout) :: summary
    real(wp) :: unit
    integer :: i

    unit = problem%load*problem%length
    associate (device => readings%device)
      call summary%set('device_stiffness', device%stiffness)
      call take_jumps('device_jump_in', .true.)
      call take_jumps('device_jump_out', .false.)
      call summary%set('device_energy_lost', device%energy_lost*unit)
      call summary%set('device_energy_lost_error', [(unit*error_of(readings%margin, &
        device(i)%energy_lost, device(i)%fine_energy_lost) + unit*device(i)%uncertainty, &
        i=1, size(device))])
      call summary%set_rate('device_energy_lost', reshape([(energy_rates(device(i), parameters), &
        i=1, size(device))], [parameters, size(device)]))
      call summary%set('device_cycle_energy', device%cycle_energy*unit)
      call summary%set('device_cycle_energy_error', [(unit*error_of(readings%margin, &
        device(i)%cycle_energy, device(i)%fine_cycle_energy) + unit*uncertainty(device(i)), &
        i=1, size(device))])
      call summary%set('device_energy_uncertainty', [(unit*max(uncertainty(device(i)), &
        error_of(readings%margin, device(i)%energy_lost, device(i)%fine_energy_lost)), &
        i=1, size(device))])
      if (.not. all(device%caught)) call summary%warn('device: no stable state is known ' // &
        'that catches the bodies after a jump; see device_jumps.csv')
      if (any(uncertainty(device) > known_energy*abs(device%energy_lost))) &
        call summary%warn('device: the energy lost in jumps is not the area of the cycle; ' // &
        'a smaller accuracy may help')
    end associate

  contains

    subroutine take_jumps(name, inward)
      character(len=*), intent(in) :: name
      logical, intent(in) :: inward
      real(wp), dimension(size(readings%device)) :: z, before, after, z_error, before_error, &
        after_error
      real(wp), dimension(parameters, size(readings%device)) :: z_rate, before_rate, after_rate
      integer :: k, first

      z = ieee_value(1.0_wp, ieee_quiet_nan)
      before = z
      after = z
      z_error = z
      before_error = z
      after_error = z
      z_rate = z(1)
      before_rate = z_rate
      after_rate = z_rate
      do k = 1, size(readings%device)
        associate (driven => readings%device(k))
          first = findloc(driven%jump%inward, inward, 1)
          if (first == 0) cycle
          associate (jump => driven%jump(first))
            z(k) = z_of(problem, driven%drive, jump%before)
            before(k) = jump%before%load*problem%load
            if (jump%landed) after(k) = jump%after%load*problem%load
            associate (errors => jump_errors(problem, readings, driven, jump))
              z_error(k) = errors(1)
              before_error(k) = errors(2)
              if (jump%landed) after_error(k) = errors(3)
            end associate
            if (allocated(jump%before%rate)) then
              before_rate(:, k) = jump%before%rate(of_load, :)
              if (driven%drive%weights(1) > 0) z_rate(:, k) = &
                matmul(weights_of(problem, driven%drive), jump%before%rate(:2, :))
            end if
            if (allocated(jump%after%rate)) after_rate(:, k) = jump%after%rate(of_load, :)
          end associate
        end associate
      end do
      call summary%set(name // '_z', z)
      call summary%set(name // '_load', before)
      call summary%set(name // '_load_after', after)
      call summary%set(name // '_z_error', z_error)
      call summary%set(name // '_load_error', before_error)
      call summary%set(name // '_load_after_error', after_error)
      call summary%set_rate(name // '_z', z_rate)
      call summary%set_rate(name // '_load', before_rate)
      call summary%set_rate(name // '_load_after', after_rate)
    end subroutine take_jumps

  end subroutine summarise_device

  !> Errors of the position [m] and of the loads [N] before and after a jump.
  pure function jump_errors(problem, readings, driven, jump) result(errors)
    type(problem_t), intent(in) :: problem
    type(path_readings_t), intent(in) :: readings
    type(driven_t), intent(in) :: driven
    type(jump_t), intent(in) :: jump
    real(wp) :: errors(3)

    associate (before => state_errors(readings%margin, jump%before), &
      after => state_errors(readings%margin, jump%after), drive => driven%drive)
      errors = [before%h0, before%load, after%load]
      if (allocated(jump%before%fine)) then
        errors(1) = error_of(readings%margin, drive%position(jump%before), &
          dot_product(drive%weights, [jump%before%fine%h0, jump%before%fine%load]))
      else
        errors(1) = max(abs(drive%position(jump%before)), 1.0_wp)
      end if
    end associate
    errors = errors*[problem%length, problem%load, problem%load]
    if (.not. driven%drive%weights(1) > 0) errors(1) = ieee_value(1.0_wp, ieee_quiet_nan)
  end function jump_errors

  !> Derivatives of the energy lost by each parameter; NaN where a jump has none.
  pure function energy_rates(driven, parameters) result(rate)
    type(driven_t), intent(in) :: driven
    integer, intent(in) :: parameters
    real(wp) :: rate(parameters)
    integer :: i

    rate = 0
    do i = 1, size(driven%jump)
      if (allocated(driven%jump(i)%energy_rate)) then
        rate = rate + driven%jump(i)%energy_rate
      else
        rate = ieee_value(rate, ieee_quiet_nan)
      end if
    end do
  end function energy_rates

  !> How well the energy lost is known: the two routes to it share the states where jumps start and
  !> end, but one takes the energy of these and the other the load on the way between them.
  elemental real(wp) function uncertainty(driven)
    type(driven_t), intent(in) :: driven

    uncertainty = abs(driven%energy_lost - driven%cycle_energy) + driven%uncertainty
  end function uncertainty

end module device_rows
