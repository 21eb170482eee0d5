!> Results of the experiments of a scene, in the units of `dimensionless_problem`. The places of
!> their numbers (springs, given loads, energies, some rows of the table of stable states) are
!> entered into the table of places, under the names in `result_rows`.
module experiment_result
  use kinds, only: wp
  use numerics_choice, only: choice_t
  use equilibrium, only: cost_t
  use records, only: quality_t, branch_t
  use path, only: path_t
  use places, only: places_t
  use reported_numbers, only: of_table
  use path_readings, only: path_readings_t
  use timed_record, only: timed_result_t
  use path_point, only: path_point_t, h0_alone, load_alone
  use driven_pieces, only: jump_t, leg_t, walk_t
  use piece_search, only: state_driven
  use device, only: driven_t, driven_leg_t, states_on
  use stepper, only: stepper_t, known_path_t
  use reported_place, only: place_t, point_of_path, place_on_curve, of_h0
  implicit none
  private
  public :: experiment_result_t, enter_readings, enter_energy, enter_table, enter_turns

  type :: experiment_result_t
    type(choice_t) :: chosen
    type(path_t), allocatable :: path
    type(path_readings_t), allocatable :: readings
    type(timed_result_t), allocatable :: timed
    type(branch_t), allocatable :: stepped_path, loading, unloading(:)
    !> The places at which numbers are reported.
    type(places_t) :: places
    !> Whether all requested derivatives exist.
    logical :: differentiated = .true.
    !> Largest estimated relative error of the reported numbers.
    real(wp), allocatable :: error_estimate
    !> Largest part of the load that the nodes of the path's meshes miss (`mesh_refinement`).
    real(wp) :: left_out = 0
    type(cost_t) :: cost
    integer :: nodes = 0
  contains
    procedure :: quality
  end type experiment_result_t

  !> Numbers of each drive that may not exist.
  character(len=*), parameter :: of_each_way(*) = [character(len=18) :: 'device_jump_in', &
    'device_landing_in', 'device_jump_out', 'device_landing_out']
  !> Number of rows of each leg of a table whose errors are estimated, and of intervals between
  !> rows.
  integer, parameter :: judged_rows = 16

contains

  !> The quality of the rows of all experiments together.
  pure type(quality_t) function quality(self)
    class(experiment_result_t), intent(in) :: self
    integer :: k

    if (allocated(self%path)) call quality%join(self%path%quality)
    if (allocated(self%stepped_path)) call quality%join(self%stepped_path%quality)
    if (allocated(self%loading)) call quality%join(self%loading%quality)
    if (allocated(self%readings)) call quality%join(self%readings%quality)
    if (allocated(self%timed)) call quality%join(self%timed%quality)
    if (.not. allocated(self%unloading)) return
    do k = 1, size(self%unloading)
      call quality%join(self%unloading(k)%quality)
    end do
  end function quality

  !> Enters the results that follow from the path: jumps and energies of drives, states under given
  !> loads.
  subroutine enter_readings(readings, places)
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(inout) :: places
    integer :: i

    if (allocated(readings%device)) then
      do i = 1, size(readings%device)
        call enter_driven(i, readings%device(i), places)
      end do
    end if
    if (.not. allocated(readings%loaded)) return
    do i = 1, size(readings%loaded)
      call places%enter('fixed_load', i, place_on_curve(readings%loaded(i), load_alone))
    end do
  end subroutine enter_readings

  !> Enters all jumps of drive i, the first jump of each direction, and the energy of the jumps.
  subroutine enter_driven(i, driven, places)
    integer, intent(in) :: i
    type(driven_t), intent(in) :: driven
    type(places_t), intent(inout) :: places
    type(place_t), allocatable :: before, after
    character(len=3) :: way
    integer :: k

    call places%enter('device_energy', i, factor=0.0_wp)
    do k = 1, size(driven%jumped)
      associate (jump => driven%jumped(k), drive => driven%drive%weights)
        before = place_on_curve(jump%before, drive)
        ! Q of the drive turns here, or h0 does at a fold before Q turns: it is the one with the
        ! smaller derivative along the path.
        before%turn_of = merge(drive, h0_alone, abs(jump%before%tangent%of(drive)) <= &
          abs(jump%before%tangent%of(h0_alone)))
        if (allocated(after)) deallocate (after)
        if (jump%landed) then
          after = place_on_curve(jump%after, drive)
          call places%keep(before, after%after)
          call places%enter('device_energy', i, before)
          call places%enter('device_energy', i, after, -1.0_wp)
        else
          call places%enter('device_energy', i)
        end if
        ! If `after` is not allocated, it counts as absent.
        call places%add('jump_before', before)
        call places%add('jump_after', after)
        way = merge('in ', 'out', jump%inward)
        if (places%has('device_jump_' // way, i)) cycle
        call places%enter('device_jump_' // way, i, before)
        call places%enter('device_landing_' // way, i, after)
      end associate
    end do
    do k = 1, size(of_each_way)
      if (.not. places%has(of_each_way(k), i)) call places%enter(of_each_way(k), i)
    end do
  end subroutine enter_driven

  !> Enters the energy that a cycle dissipates. The cycle is the path from large separation through
  !> all its jumps, or a loading and the first unloading, if these begin and end on the outermost
  !> piece.
  subroutine enter_energy(known, outcome)
    type(known_path_t), intent(in) :: known
    type(experiment_result_t), intent(inout) :: outcome
    type(walk_t) :: inward, outward
    type(leg_t), allocatable :: leg(:)
    type(jump_t) :: jump
    real(wp) :: lowest
    integer, allocatable :: fold(:)
    integer :: turned, i

    turned = 0
    lowest = -huge(1.0_wp)
    if (allocated(outcome%path)) then
      if (outcome%path%first_piece == 1 .and. allocated(outcome%path%finish)) then
        turned = outcome%path%last_piece
        lowest = outcome%path%finish%at(of_h0)
      end if
    else if (allocated(outcome%loading) .and. allocated(outcome%unloading)) then
      associate (there => outcome%loading, back => outcome%unloading(1))
        if (there%first_piece == 1 .and. back%last_piece == 1) turned = back%first_piece
      end associate
    end if
    if (turned < 2) return
    ! A jump that ends beyond the piece in which the bodies turn belongs to another cycle.
    inward = known%stable%way_along(1, .true., until=turned)
    outward = known%stable%way_along(turned, .false., until=1)
    if (.not. (inward%arrives .and. outward%arrives)) return
    allocate (fold(0))
    leg = [inward%leg, outward%leg]
    do i = 1, size(leg)
      if (.not. leg(i)%jumps) cycle
      jump = known%stable%jump_from(leg(i)%piece, leg(i)%inward)
      if (.not. jump%landed .or. jump%before%state%h0 < lowest) return
      fold = [fold, jump%fold()]
    end do
    do i = 1, size(fold)
      call outcome%places%enter('energy_lost', 1, point_of_path(fold(i)))
      call outcome%places%enter('energy_lost', 1, point_of_path(fold(i), landing=.true.), -1.0_wp)
    end do
  end subroutine enter_energy

  !> Enters all turns of h0 and of the load on the path up to the end of its last stable piece.
  subroutine enter_turns(known, places)
    type(known_path_t), intent(in) :: known
    type(places_t), intent(inout) :: places
    integer :: i

    do i = 1, min(known%path%last, known%path%held)
      associate (point => known%path%point(i))
        if (point%fold .or. point%load_extremum) call places%add('turns', point_of_path(i))
      end associate
    end do
  end subroutine enter_turns

  !> Enters some rows of each leg of the table as places. If `like` is present, they are the states
  !> at the h0 of its rows.
  subroutine enter_table(steps, readings, places, like)
    class(stepper_t), intent(inout) :: steps
    type(path_readings_t), intent(inout) :: readings
    type(places_t), intent(inout) :: places
    type(places_t), intent(in), optional :: like
    type(path_point_t), allocatable :: nodes(:)
    type(path_point_t) :: state
    real(wp), allocatable :: suspect(:)
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
        call places%enter(of_table, (i - 1)*judged_rows + k, place_on_curve(nodes(row), h0_alone))
      end do
      suspect = bends(nodes)
      do k = 1, min(judged_rows, size(suspect))
        row = maxloc(suspect, 1)
        suspect(row) = -1
        call hold(readings%prescribed%leg(i), nodes(row), nodes(row + 1))
      end do
    end do
    if (.not. present(like)) return
    call places%forget(of_table)
    do i = 1, size(like%entry)
      associate (entry => like%entry(i), leg => readings%prescribed%leg)
        if (entry%name /= of_table) cycle
        k = 1 + (entry%element - 1)/judged_rows
        if (k > size(leg)) cycle
        associate (driven => readings%prescribed)
          call state_driven(steps%solver_t, steps%known%path, driven%drive, &
            driven%piece(leg(k)%piece), like%place(entry%place)%at(of_h0), state)
        end associate
        if (state%converged) &
          call places%enter(of_table, entry%element, place_on_curve(state, h0_alone))
      end associate
    end do

  contains

    !> Compares the interpolation with the state in the middle between a row and the next.
    subroutine hold(leg, row, next)
      type(driven_leg_t), intent(in) :: leg
      type(path_point_t), intent(in) :: row, next
      type(path_point_t) :: middle

      associate (driven => readings%prescribed, width => next%state%h0 - row%state%h0)
        if (.not. abs(width) > 0) return
        call state_driven(steps%solver_t, steps%known%path, driven%drive, &
          driven%piece(leg%piece), 0.5_wp*(row%state%h0 + next%state%h0), middle)
        if (middle%converged) readings%table_interpolation_error = &
          max(readings%table_interpolation_error, abs(middle%state%load - &
          0.5_wp*(row%state%load + next%state%load) - width/8*(row%tangent%load/row%tangent%h0 - &
          next%tangent%load/next%tangent%h0)))
      end associate
    end subroutine hold

  end subroutine enter_table

  !> The error of cubic interpolation between each row and the next, up to a common factor: the
  !> fourth power of the width, times an estimate of the fourth derivative. The estimate is the
  !> larger one of the changes of the third derivative to both neighbours, each over the distance.
  pure function bends(rows) result(bend)
    type(path_point_t), intent(in) :: rows(:)
    real(wp), dimension(size(rows) - 1) :: bend, width, third
    real(wp), dimension(size(rows)) :: slope, change
    integer :: n

    n = size(rows)
    width = rows(2:)%state%h0 - rows(:n - 1)%state%h0
    slope = rows%tangent%load/rows%tangent%h0
    third = 0
    where (abs(width) > 0) third = (slope(:n - 1) + slope(2:) - &
      2*(rows(2:)%state%load - rows(:n - 1)%state%load)/width)/width**2
    change = 0
    change(2:n - 1) = abs(third(2:) - third(:n - 2))/ &
      max(abs(rows(3:)%state%h0 - rows(:n - 2)%state%h0), tiny(1.0_wp))
    bend = width**4*max(change(:n - 1), change(2:))
  end function bends

end module experiment_result
