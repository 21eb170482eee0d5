!> Errors of what is read from the path: the same is read from a path on finer meshes, traced once,
!> place by place. Differences, raised by the margin of the error estimate (`result_errors`), are
!> the errors.
module reading_errors
  use kinds, only: wp
  use clock, only: seconds
  use listener, only: listener_t
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use curve_states, only: curve_state_t, reading_t, reading_of
  use driven_pieces, only: state_driven
  use device, only: driven_t, leg_t, nodes_on
  use experiment_request, only: request_t
  use experiment_result, only: experiment_result_t
  use path_demand, only: farthest_wanted
  use path_stepper, only: path_stepper_t
  use path_readings, only: path_readings_t, read_path
  use result_errors, only: judge_t, more_digits
  use error_estimate, only: rounding
  implicit none
  private
  public :: judge_readings

  !> Places of a table at which its rows, and what lies between, are held against the finer path.
  integer, parameter :: table_places = 16

contains

  !> Judges what was read from the path of `steps`, for H0 from high to low; the largest relative
  !> error joins that of the outcome. store: of meshes.
  subroutine judge_readings(request, steps, judge, high, low, listener, outcome, store)
    class(request_t), intent(in) :: request
    class(path_stepper_t), intent(inout) :: steps
    type(judge_t), intent(in) :: judge
    real(wp), intent(in) :: high, low
    class(listener_t), intent(inout) :: listener
    type(experiment_result_t), intent(inout) :: outcome
    type(mesh_store_t), intent(inout), optional :: store
    type(path_stepper_t) :: finer
    type(path_readings_t), allocatable :: fine
    real(wp) :: largest, began

    began = seconds()
    call listener%hear('judging what is read from the path')
    finer%problem = steps%problem
    finer%options = steps%options
    finer%meshes = new_mesh_family(steps%problem, high, low, steps%meshes%digits + more_digits, &
      store=store, coarser=steps%meshes)
    call finer%know_path(high, low, allocated(request%path), listener, &
      farthest_wanted(request, steps%problem))
    call read_path(request, finer, listener, fine)
    associate (own => outcome%readings)
      own%margin = judge%fine%margin
      largest = 0
      call pair_all(own, fine)
      if (allocated(own%device)) call raise_by_drives(steps, own, own%device, largest)
      if (allocated(own%loaded)) call raise_by_loads(own, largest)
      if (allocated(own%prescribed)) call judge_table(finer, fine, own, largest)
    end associate
    if (.not. allocated(outcome%error_estimate)) outcome%error_estimate = rounding
    outcome%error_estimate = max(outcome%error_estimate, largest)
    steps%cost%kernel_entries = steps%cost%kernel_entries + sum(finer%meshes%grid%kernel_entries())
    steps%cost%factorisations = steps%cost%factorisations + finer%cost%factorisations
    steps%cost%operator_products = steps%cost%operator_products + finer%cost%operator_products
    steps%cost%operator_columns = steps%cost%operator_columns + finer%cost%operator_columns
    steps%cost%pressure_evaluations = steps%cost%pressure_evaluations + &
      finer%cost%pressure_evaluations
    steps%cost%iterations = steps%cost%iterations + finer%cost%iterations
    steps%cost%estimate_seconds = steps%cost%estimate_seconds + seconds() - began
  end subroutine judge_readings

  !> Gives each state that was read what the finer path has at the same place, where it has that.
  subroutine pair_all(own, fine)
    type(path_readings_t), intent(inout) :: own
    type(path_readings_t), intent(in) :: fine
    integer :: i, k, at

    if (allocated(own%device) .and. allocated(fine%device)) then
      do i = 1, size(own%device)
        call pair_driven(own%device(i), fine%device(i))
      end do
    end if
    if (allocated(own%prescribed) .and. allocated(fine%prescribed)) &
      call pair_driven(own%prescribed, fine%prescribed)
    if (.not. (allocated(own%loaded) .and. allocated(fine%loaded))) return
    do i = 1, size(own%loaded)
      associate (same => abs(fine%loaded%wanted - own%loaded(i)%wanted) <= 0)
        if (count(same) /= count(abs(own%loaded%wanted - own%loaded(i)%wanted) <= 0)) cycle
        ! As many before it under the same load.
        k = count(abs(own%loaded(:i)%wanted - own%loaded(i)%wanted) <= 0)
        at = findloc(same, .true., 1) - 1 + k
        own%loaded(i)%state%fine = reading_of(fine%loaded(at)%state)
      end associate
    end do
  end subroutine pair_all

  !> The jumps of a drive, where the finer path has the same.
  subroutine pair_driven(own, fine)
    type(driven_t), intent(inout) :: own
    type(driven_t), intent(in) :: fine
    integer :: i

    if (size(own%jump) /= size(fine%jump)) return
    if (.not. all((own%jump%inward .eqv. fine%jump%inward) .and. &
      (own%jump%landed .eqv. fine%jump%landed))) return
    do i = 1, size(own%jump)
      own%jump(i)%before%fine = reading_of(fine%jump(i)%before)
      own%jump(i)%after%fine = reading_of(fine%jump(i)%after)
    end do
    own%fine_energy_lost = fine%energy_lost
    own%fine_cycle_energy = fine%cycle_energy
  end subroutine pair_driven

  !> The largest error of positions and loads at the jumps of drives, relative.
  subroutine raise_by_drives(steps, own, device, largest)
    class(path_stepper_t), intent(in) :: steps
    type(path_readings_t), intent(in) :: own
    type(driven_t), intent(in) :: device(:)
    real(wp), intent(inout) :: largest
    integer :: i, k

    do i = 1, size(device)
      do k = 1, size(device(i)%jump)
        associate (jump => device(i)%jump(k), drive => device(i)%drive)
          if (.not. allocated(jump%before%fine)) then
            largest = max(largest, 1.0_wp)
            cycle
          end if
          if (drive%weights(1) > 0) call raise(drive%position(jump%before), dot_product( &
            drive%weights, [jump%before%fine%h0, jump%before%fine%load]), 1.0_wp)
          call raise(jump%before%load, jump%before%fine%load, tiny(1.0_wp))
          if (jump%landed) call raise(jump%after%load, jump%after%fine%load, tiny(1.0_wp))
        end associate
      end do
    end do

  contains

    subroutine raise(value, fine, least)
      real(wp), intent(in) :: value, fine, least

      largest = max(largest, own%margin*abs(value - fine)/max(abs(value), least))
    end subroutine raise

  end subroutine raise_by_drives

  !> The largest relative error of h0, displacement and contact radius under fixed loads.
  pure subroutine raise_by_loads(own, largest)
    type(path_readings_t), intent(in) :: own
    real(wp), intent(inout) :: largest
    integer :: i

    do i = 1, size(own%loaded)
      associate (state => own%loaded(i)%state)
        if (.not. allocated(state%fine)) then
          largest = max(largest, 1.0_wp)
          cycle
        end if
        associate (here => reading_of(state), there => state%fine)
          largest = max(largest, own%margin*maxval(abs([here%h0 - there%h0, &
            here%displacement - there%displacement])/ &
            max(1.0_wp, abs([here%h0, here%displacement]))))
          if (here%radius > 0) &
            largest = max(largest, own%margin*abs(here%radius/there%radius - 1))
        end associate
      end associate
    end do
  end subroutine raise_by_loads

  !> Rows of the table, and cubic polynomials between neighbours with their slopes, held against
  !> states of the finer path at the same h0. Errors count against the largest load of the leg.
  subroutine judge_table(finer, fine, own, largest)
    class(path_stepper_t), intent(inout) :: finer
    type(path_readings_t), intent(in) :: fine
    type(path_readings_t), intent(inout) :: own
    real(wp), intent(inout) :: largest
    type(curve_state_t), allocatable :: nodes(:)
    real(wp) :: scale
    integer :: i, k, place

    own%table_error = 0
    own%table_interpolation_error = 0
    if (.not. allocated(fine%prescribed)) then
      largest = max(largest, 1.0_wp)
      return
    end if
    if (size(fine%prescribed%leg) /= size(own%prescribed%leg)) then
      largest = max(largest, 1.0_wp)
      return
    end if
    scale = 0
    do i = 1, size(own%prescribed%leg)
      nodes = nodes_on(own%node, own%prescribed%leg(i))
      if (size(nodes) < 2) cycle
      scale = max(scale, maxval(abs(nodes%load)))
      do k = 1, table_places
        place = 1 + (k - 1)*(size(nodes) - 2)/(table_places - 1)
        if (k > 1 .and. place == 1 + (k - 2)*(size(nodes) - 2)/(table_places - 1)) cycle
        call hold(i, nodes(place), nodes(place + 1))
      end do
    end do
    if (scale > 0) largest = max(largest, own%table_error/scale)

  contains

    !> Holds a row, and the middle between it and the next, against the finer path.
    subroutine hold(leg, row, next)
      integer, intent(in) :: leg
      type(curve_state_t), intent(in) :: row, next
      real(wp) :: load

      if (at(leg, row%h0, load)) own%table_error = &
        max(own%table_error, own%margin*abs(load - row%load))
      associate (width => next%h0 - row%h0)
        if (.not. abs(width) > 0) return
        if (at(leg, 0.5_wp*(row%h0 + next%h0), load)) own%table_interpolation_error = &
          max(own%table_interpolation_error, abs(load - 0.5_wp*(row%load + next%load) - &
          width/8*(row%slopes(2)/row%slopes(1) - next%slopes(2)/next%slopes(1))))
      end associate
    end subroutine hold

    !> The load at h0 on a leg of the finer path, if it is there.
    logical function at(leg, h0, load)
      integer, intent(in) :: leg
      real(wp), intent(in) :: h0
      real(wp), intent(out) :: load
      type(curve_state_t) :: state

      at = .false.
      load = 0
      associate (piece => fine%prescribed%piece(fine%prescribed%leg(leg)%piece))
        if (.not. (h0 < piece%first%h0 .and. h0 > piece%last%h0)) return
        call state_driven(finer%solver_t, finer%known%path, fine%prescribed%drive, piece, h0, state)
      end associate
      at = state%converged
      load = state%load
    end function at

  end subroutine judge_table

end module reading_errors
