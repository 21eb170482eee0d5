!> The experiments that are evaluated on the equilibrium path: springs and dead loads, fixed loads,
!> and a table of stable states.
module path_readings
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use kinds, only: wp
  use progress_observer, only: progress_observer_t
  use experiment_request, only: request_t
  use path_sensitivity, only: rate_t
  use driven_pieces, only: drive_t, through_spring
  use path_point, only: path_point_t, load_alone
  use curve_states, only: read_points, states_where
  use dimensionless_problem, only: problem_t
  use records, only: quality_t
  use device, only: driven_t, states_on, drive_bodies
  use stepper, only: stepper_t
  use path_end, only: outer_end
  implicit none
  private
  public :: path_readings_t, read_path, is_stable_under_load

  !> The results of these experiments, in the units of `dimensionless_problem`.
  type :: path_readings_t
    !> The points of the path.
    type(path_point_t), allocatable :: node(:)
    !> A drive for each stiffness; and one at prescribed h0, for the table.
    type(driven_t), allocatable :: device(:), prescribed
    !> The equilibria under given loads; for each of them the index of its load; the list of loads.
    type(path_point_t), allocatable :: loaded(:)
    integer, allocatable :: load_of(:)
    real(wp), allocatable :: load(:)
    !> Derivatives at the nodes by each parameter of &sensitivity, (parameters, nodes).
    type(rate_t), allocatable :: rate(:, :)
    !> The path was traced from the h0 `traced_from`. Between the larger h0 `undeformed_from` and
    !> this one the bodies count as undeformed. -huge: there is no such h0.
    real(wp) :: traced_from = -huge(1.0_wp), undeformed_from = -huge(1.0_wp)
    !> For the table, the largest error of cubic interpolation of the load between rows.
    real(wp) :: table_interpolation_error = 0
    !> The strains of the states of springs and loads, which may be beyond the path's rows.
    type(quality_t) :: quality
    !> Whether the path has more than one point and all its states were solved.
    logical :: solved = .true.
  end type path_readings_t

contains

  !> Evaluates the requested experiments on the path of `steps`.
  subroutine read_path(request, steps, observer, readings)
    class(request_t), intent(in) :: request
    class(stepper_t), intent(inout) :: steps
    class(progress_observer_t), intent(inout) :: observer
    type(path_readings_t), allocatable, intent(out) :: readings

    allocate (readings)
    call observer%hear('reading the path')
    associate (path => steps%known%path)
      readings%solved = path%held > 1
      allocate (readings%node(0))
      if (.not. readings%solved) return
      readings%node = read_points(steps%solver_t, path)
      readings%traced_from = path%point(path%undeformed + 1)%state%h0
      readings%undeformed_from = path%point(1)%state%h0
      if (allocated(request%device)) call run_device()
      if (allocated(request%fixed_loads)) call find_loaded(request%fixed_loads/ &
        steps%problem%load)
      if (request%table) call make_table()
    end associate
    if (allocated(readings%loaded)) steps%cost%states = steps%cost%states + size(readings%loaded)

  contains

    !> &table: moves bodies at prescribed h0 to the end of the path that is shown; springs may need
    !> a longer path.
    subroutine make_table()
      integer :: whole, last

      whole = steps%known%path%last
      last = outer_end(steps%solver_t, steps%known%path, steps%problem%law%gap_of( &
        request%path%h0_end))
      if (last > 0) steps%known%path%last = last + 1
      allocate (readings%prescribed)
      call drive_between(drive_t(), readings%prescribed)
      readings%solved = readings%solved .and. readings%prescribed%solved
      steps%known%path%last = whole
    end subroutine make_table

    !> &fixed_load: finds all equilibria under each load.
    subroutine find_loaded(load)
      real(wp), intent(in) :: load(:)
      type(path_point_t), allocatable :: states(:)
      integer :: i
      logical :: solved

      allocate (readings%loaded(0), readings%load_of(0))
      readings%load = load
      do i = 1, size(load)
        call states_where(steps%solver_t, steps%known%path, load_alone, load(i), states, solved)
        call cover(states, steps%problem, readings%quality)
        readings%solved = readings%solved .and. solved
        readings%loaded = [readings%loaded, states]
        readings%load_of = [readings%load_of, spread(i, 1, size(states))]
      end do
    end subroutine find_loaded

    pure subroutine cover(states, problem, quality)
      type(path_point_t), intent(in) :: states(:)
      type(problem_t), intent(in) :: problem
      type(quality_t), intent(inout) :: quality
      integer :: i

      do i = 1, size(states)
        associate (state => states(i)%state)
          call quality%cover_extent(states(i)%radius*problem%lateral, &
            problem%law%separation_of(state%h0), state%load*problem%load, state)
        end associate
      end do
    end subroutine cover

    !> &device: moves one drive for each stiffness, or one at prescribed h0.
    subroutine run_device()
      real(wp), allocatable :: stiffness(:)
      integer :: i, k

      associate (device => request%device, problem => steps%problem)
        stiffness = device%stiffness
        ! Without springs h0 is prescribed, as by a rigid spring.
        if (size(stiffness) == 0) stiffness = [ieee_value(1.0_wp, ieee_positive_inf)]
        allocate (readings%device(size(stiffness)))
        do i = 1, size(stiffness)
          call drive_between(through_spring(stiffness(i)*problem%length/problem%load), &
            readings%device(i), device%z_start, device%z_end)
          readings%device(i)%stiffness = stiffness(i)
          readings%solved = readings%solved .and. readings%device(i)%solved
          ! The path extends beyond the states of the drive by a part of its last step.
          do k = 1, size(readings%device(i)%leg)
            call cover(states_on(readings%node, readings%device(i)%leg(k)), problem, &
              readings%quality)
          end do
        end do
      end associate
    end subroutine run_device

    !> Drives the bodies between positions [m]; a dead load has no positions.
    subroutine drive_between(drive, driven, z_start, z_end)
      type(drive_t), intent(in) :: drive
      type(driven_t), intent(out) :: driven
      real(wp), allocatable, intent(in), optional :: z_start, z_end
      real(wp), allocatable :: start, finish

      associate (law => steps%problem%law)
        if (present(z_start) .and. drive%weights(1) > 0) then
          if (allocated(z_start)) start = law%gap_of(z_start)
          if (allocated(z_end)) finish = law%gap_of(z_end)
        end if
        call drive_bodies(steps%solver_t, steps%known%path, drive, &
          law%gap_of(request%path%h0_end), start, finish, driven)
        ! The states at the ends of the legs.
        steps%cost%states = steps%cost%states + 2*size(driven%leg)
      end associate
    end subroutine drive_between

  end subroutine read_path

  !> Whether an equilibrium is stable at fixed load: no mode is unstable at fixed h0, and dF/dh0 is
  !> negative. On the path followed inward, h0 decreases where states are stable at fixed h0.
  elemental logical function is_stable_under_load(point)
    type(path_point_t), intent(in) :: point

    is_stable_under_load = point%modes == 0 .and. point%tangent%load > 0
  end function is_stable_under_load

end module path_readings
