!> The experiments that are read from the equilibrium path: springs and dead loads, fixed loads, and
!> a table of stable states.
module path_readings
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use kinds, only: wp
  use listener, only: listener_t
  use experiment_request, only: request_t
  use path_curve, only: curve_t, new_curve
  use path_sensitivity, only: rate_t
  use curve_states, only: curve_solver_t
  use driven_pieces, only: drive_t, through_spring
  use driven_cycle, only: driven_t
  use device, only: drive_bodies
  use fixed_loads, only: loaded_state_t, find_loaded
  use path_demand, only: farthest_wanted
  use path_stepper, only: path_stepper_t
  use dimensionless_problem, only: contact_level_of
  implicit none
  private
  public :: path_readings_t, read_path

  !> In the units of `dimensionless_problem`.
  type :: path_readings_t
    type(curve_t) :: curve
    !> A drive for each stiffness; and at prescribed h0, for the table.
    type(driven_t), allocatable :: device(:), prescribed
    type(loaded_state_t), allocatable :: loaded(:)
    !> Derivatives at the curve's nodes by each parameter of &sensitivity, (parameters, nodes).
    type(rate_t), allocatable :: rate(:, :)
    !> h0 from which the path was traced, and from which bodies are taken as undeformed until there.
    real(wp) :: traced_from = 0, undeformed_from = 0
    !> Of the table, the largest error of a load between rows by cubic polynomials.
    real(wp) :: table_interpolation_error = 0
    !> Whether the curve exists and everything on it was solved.
    logical :: solved = .true.
  end type path_readings_t

contains

  !> Reads what is asked for from the path that `steps` knows.
  subroutine read_path(request, steps, listener, readings)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout) :: steps
    class(listener_t), intent(inout) :: listener
    type(path_readings_t), allocatable, intent(out) :: readings
    type(curve_solver_t) :: solver
    integer :: i

    allocate (readings)
    call listener%hear('reading the path')
    solver%options = steps%options
    call new_curve(steps%equations_t, steps%known, farthest_wanted(request, steps%problem), &
      contact_level_of(steps%problem), solver%curve, readings%solved)
    if (readings%solved) then
      if (allocated(request%device)) call run_device(request, steps, solver, readings)
      if (allocated(request%fixed_load)) then
        allocate (readings%loaded(0))
        do i = 1, size(request%fixed_load%load)
          call find_loaded(solver, steps%equations_t, steps%known, &
            request%fixed_load%load(i)/steps%problem%load, readings%loaded, readings%solved)
        end do
      end if
      if (request%table) then
        allocate (readings%prescribed)
        call drive_between(request, steps, solver, through_spring(), readings%prescribed)
        readings%solved = readings%solved .and. readings%prescribed%solved
      end if
    end if
    readings%curve = solver%curve
    if (size(solver%curve%node) > 0) then
      readings%traced_from = steps%known%path%point(1)%state%h0
      readings%undeformed_from = solver%curve%node(1)%h0
    end if
    steps%cost%states = steps%cost%states + solver%solved
  end subroutine read_path

  !> &device: one drive for each stiffness, or at prescribed h0.
  subroutine run_device(request, steps, solver, readings)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout) :: steps
    type(curve_solver_t), intent(inout) :: solver
    type(path_readings_t), intent(inout) :: readings
    integer :: i

    associate (device => request%device, problem => steps%problem)
      allocate (readings%device(max(1, size(device%stiffness))))
      do i = 1, size(readings%device)
        if (size(device%stiffness) == 0) then
          call drive_between(request, steps, solver, through_spring(), readings%device(i), &
            device%z_start, device%z_end)
          readings%device(i)%stiffness = ieee_value(1.0_wp, ieee_positive_inf)
        else
          call drive_between(request, steps, solver, &
            through_spring(device%stiffness(i)*problem%length/problem%load), readings%device(i), &
            device%z_start, device%z_end)
          readings%device(i)%stiffness = device%stiffness(i)
        end if
        readings%solved = readings%solved .and. readings%device(i)%solved
      end do
    end associate
  end subroutine run_device

  !> Drives the bodies between positions [m]; a dead load has none.
  subroutine drive_between(request, steps, solver, drive, driven, z_start, z_end)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout) :: steps
    type(curve_solver_t), intent(inout) :: solver
    type(drive_t), intent(in) :: drive
    type(driven_t), intent(out) :: driven
    real(wp), allocatable, intent(in), optional :: z_start, z_end
    real(wp), allocatable :: start, finish

    associate (law => steps%problem%law)
      if (present(z_start) .and. drive%weights(1) > 0) then
        if (allocated(z_start)) start = law%gap_of(z_start)
        if (allocated(z_end)) finish = law%gap_of(z_end)
      end if
      call drive_bodies(solver, steps%equations_t, steps%known, drive, &
        law%gap_of(request%path%h0_end), start, finish, driven)
    end associate
  end subroutine drive_between

end module path_readings
