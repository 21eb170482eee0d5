!> Bodies driven through springs: the path against the position of the drive, the ways in and out
!> with their jumps, and what they leave in the summary.
module device_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use path_curve, only: curve_t, curve_node_t
  use driven_pieces, only: drive_t
  use driven_cycle, only: driven_t, leg_t, nodes_on
  use reported, only: of_h0, of_load, of_energy, of_radius, of_position
  use places, only: places_t, readings_t
  use path_readings, only: path_readings_t
  use results, only: results_t
  use tables, only: cells
  use summary, only: summary_t
  implicit none
  private
  public :: device_columns, jump_columns, write_device, write_jumps, summarise_device

  !> Columns of device.csv and of device_jumps.csv.
  character(len=*), parameter :: device_columns(*) = [character(len=96) :: &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] path: all equilibria; approach and retreat: what the drive goes through', &
    'z [m] position of the drive, h0 - load/stiffness; NaN under a dead load', &
    'h0 [m] separation that undeformed bodies would have on the axis', &
    'load [N] negative: tension', &
    'contact_radius [m] where the separation is 1.1 times that of zero force; 0 without contact', &
    'stable [] 1: stable at this z; 0: unstable, or where a jump starts']
  character(len=*), parameter :: jump_columns(*) = [character(len=96) :: &
    'stiffness [N/m] of the spring; 0: dead load; Infinity: h0 is prescribed', &
    'direction [] approach or retreat', &
    'z [m] position of the drive; NaN under a dead load', &
    'h0 [m] before the jump', &
    'load [N] before the jump', &
    'contact_radius [m] before the jump', &
    'h0_after [m] NaN where no stable state is known, here and below', &
    'load_after [N] after the jump', &
    'contact_radius_after [m] after the jump', &
    'energy [J] lost in the jump', &
    'z_error [m] estimated error of z', &
    'load_error [N] estimated error of load', &
    'load_after_error [N] estimated error of load_after']
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
      associate (driven => readings%device(i), curve => readings%curve)
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
      type(curve_node_t) :: node
      integer :: j, n, modes

      n = size(readings%curve%interval)
      do j = 1, n + 1
        node = readings%curve%begin_of(min(j, n))
        if (j > n) node = readings%curve%end_of(n)
        modes = maxval(readings%curve%interval(max(1, j - 1):min(j, n))%modes)
        call add(driven, 'path', node%h0, node%load, node%radius, modes == 0 .and. &
          dot_product(driven%drive%weights, [node%h0_slope, node%load_slope]) < 0)
      end do
    end subroutine add_path

    !> One leg; where a jump starts it is not stable any more.
    subroutine add_leg(driven, leg)
      type(driven_t), intent(in) :: driven
      type(leg_t), intent(in) :: leg
      character(len=:), allocatable :: direction
      type(curve_node_t), allocatable :: nodes(:)
      integer :: j

      direction = direction_of(leg%inward)
      call add(driven, direction, leg%from%h0, leg%from%load, leg%from%radius, .true.)
      nodes = nodes_on(readings%curve, leg)
      do j = 1, size(nodes)
        call add(driven, direction, nodes(j)%h0, nodes(j)%load, nodes(j)%radius, .true.)
      end do
      call add(driven, direction, leg%to%h0, leg%to%load, leg%to%radius, &
        .not. driven%jumps_after(leg))
    end subroutine add_leg

    subroutine add(driven, direction, h0, load, radius, stable)
      type(driven_t), intent(in) :: driven
      character(len=*), intent(in) :: direction
      real(wp), intent(in) :: h0, load, radius
      logical, intent(in) :: stable

      call results%row(cells([driven%stiffness]) // ',' // direction, &
        [z_of(problem, driven%drive, h0, load), problem%law%separation_of(h0), &
        load*problem%load, radius*problem%lateral], [stable])
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

  pure function direction_of(inward) result(direction)
    logical, intent(in) :: inward
    character(len=:), allocatable :: direction

    direction = 'retreat'
    if (inward) direction = 'approach'
  end function direction_of

  !> Position of the drive [m].
  pure real(wp) function z_of(problem, drive, h0, load) result(z)
    type(problem_t), intent(in) :: problem
    type(drive_t), intent(in) :: drive
    real(wp), intent(in) :: h0, load

    z = ieee_value(z, ieee_quiet_nan)
    if (drive%weights(1) > 0) z = problem%law%separation_of(h0 + drive%weights(2)*load)
  end function z_of

  !> What the drives leave in the summary besides what is read at places, an element for each
  !> stiffness.
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
        'that catches the bodies after a jump; see device_jumps.csv')
      if (any(uncertainty(device) > known_energy*abs(device%energy_lost))) &
        call summary%warn('device: the energy lost in jumps is not the area of the cycle; ' // &
        'a smaller accuracy may help')
    end associate
  end subroutine summarise_device

  !> How well the energy lost is known: the two routes to it share the states where jumps start and
  !> end, but one takes the energy of these and the other the load on the way between them.
  elemental real(wp) function uncertainty(driven)
    type(driven_t), intent(in) :: driven

    uncertainty = abs(driven%energy_lost - driven%cycle_energy) + driven%uncertainty
  end function uncertainty

end module device_rows
