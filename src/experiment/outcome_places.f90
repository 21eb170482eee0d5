!> The one walk through what the experiments found: it enters the places that numbers are reported
!> of into the table, under the names that `result_rows` has.
module outcome_places
  use kinds, only: wp
  use contact_state, only: state_t
  use potential_energy, only: energy_of
  use path_tangent, only: h0_alone => of_h0, load_alone => of_load
  use path_coordinate, only: coordinate_of
  use known_path, only: landing_t, landing_over
  use hysteresis, only: folds_of_cycle
  use curve_states, only: curve_state_t
  use driven_cycle, only: driven_t
  use path_readings, only: path_readings_t
  use stepper, only: stepper_t
  use path_stepper, only: path_stepper_t
  use reported, only: reported_t, reported_state, of_h0, of_load, of_energy
  use places, only: places_t
  use stepped_branch, only: branch_t
  use path, only: path_t
  use experiment_result, only: experiment_result_t
  implicit none
  private
  public :: enter_path, enter_cycle, enter_branch, enter_readings, enter_energy, keep_extrema

  !> Part of the terms of the slope of a drive's position that cancellation leaves at a turn.
  real(wp), parameter :: turning = 1.0e-6_wp
  !> Numbers that each drive has or not.
  character(len=*), parameter :: of_each_way(*) = [character(len=18) :: 'device_jump_in', &
    'device_landing_in', 'device_jump_out', 'device_landing_out']

contains

  !> Keeps all folds and extrema of the path that the steps have traced. Not every one need be
  !> shown.
  subroutine keep_extrema(steps, places)
    class(path_stepper_t), intent(in) :: steps
    type(places_t), intent(inout) :: places
    type(reported_t) :: place
    integer :: i, k

    do i = 1, steps%known%path%held
      associate (point => steps%known%path%point(i))
        if (.not. (point%fold .or. point%load_extremum)) cycle
      end associate
      place%point = i
      call places%keep(located(steps, place, places), k)
    end do
  end subroutine keep_extrema

  !> Enters a path; its folds are exact.
  subroutine enter_path(steps, path, places)
    class(path_stepper_t), intent(in) :: steps
    type(path_t), intent(in) :: path
    type(places_t), intent(inout) :: places
    integer :: n

    call enter_list(steps, 'folds', path%fold, places)
    call enter_list(steps, 'load_folds', path%extremum, places)
    call enter_list(steps, 'profiles', path%profile, places)
    n = size(path%fold)
    if (n > 0) then
      ! What a stretch of the path begins with may be another fold.
      if (path%first_piece == 1) call enter_one(steps, 'jump_in', 1, path%fold(1), places)
      if (path%unstable_after(n) == 0) call enter_one(steps, 'jump_out', 1, path%fold(n), places)
    end if
    if (allocated(path%lowest)) then
      call enter_one(steps, 'path_tension', 1, path%lowest, places)
      call enter_tension(steps, path%lowest, places)
    end if
    if (.not. allocated(path%finish)) return
    if (.not. path%fallen) call enter_one(steps, 'path_end', 1, path%finish, places)
    if (path%fallen) then
      ! How a fall ends is of no interest and on no mesh.
      call places%enter('end', 1, reported_t(at=path%finish%at))
    else
      call enter_one(steps, 'end', 1, path%finish, places)
    end if
  end subroutine enter_path

  !> Enters a cycle. Rigid bodies need no steps.
  subroutine enter_cycle(outcome, places, steps)
    type(experiment_result_t), intent(in) :: outcome
    type(places_t), intent(inout) :: places
    class(stepper_t), intent(in), optional :: steps
    integer :: k

    if (allocated(outcome%loading)) then
      call enter_branch(outcome%loading, places, 'end', steps)
      if (allocated(outcome%loading%jump) .and. .not. places%has('jump_in')) &
        call enter_one(steps, 'jump_in', 1, outcome%loading%jump, places)
    end if
    if (.not. allocated(outcome%unloading)) return
    do k = 1, size(outcome%unloading)
      associate (branch => outcome%unloading(k))
        call enter_branch(branch, places, 'samples', steps)
        call enter_or_not('unload_max_tension', branch%lowest)
        call enter_or_not('unload_jump_out', branch%jump)
        if (allocated(branch%jump) .and. .not. places%has('jump_out')) &
          call enter_one(steps, 'jump_out', 1, branch%jump, places)
      end associate
    end do

  contains

    subroutine enter_or_not(name, place)
      character(len=*), intent(in) :: name
      type(reported_t), intent(in), optional :: place

      if (present(place)) then
        call enter_one(steps, name, k, place, places)
      else
        call places%enter_nothing(name, k)
      end if
    end subroutine enter_or_not

  end subroutine enter_cycle

  !> Enters what every branch has; finish: the name under which its last state is entered.
  subroutine enter_branch(branch, places, finish, steps)
    type(branch_t), intent(in) :: branch
    type(places_t), intent(inout) :: places
    character(len=*), intent(in) :: finish
    class(stepper_t), intent(in), optional :: steps

    if (allocated(branch%lowest)) call enter_tension(steps, branch%lowest, places)
    if (allocated(branch%finish)) then
      if (finish == 'end') call places%forget(finish)
      call enter_one(steps, finish, 1, branch%finish, places)
    end if
    if (allocated(branch%profile)) call enter_list(steps, 'profiles', branch%profile, places)
    if (allocated(branch%sample)) call enter_list(steps, 'samples', branch%sample, places)
  end subroutine enter_branch

  !> Enters what was read from the path: jumps and energies of drives, states under given loads.
  subroutine enter_readings(readings, places)
    type(path_readings_t), intent(in) :: readings
    type(places_t), intent(inout) :: places
    integer :: i, jumps

    jumps = 0
    if (allocated(readings%device)) then
      do i = 1, size(readings%device)
        call enter_driven(readings%device(i))
      end do
    end if
    if (.not. allocated(readings%loaded)) return
    do i = 1, size(readings%loaded)
      call places%enter('fixed_load', i, of_curve(readings, readings%loaded(i)%state, load_alone, &
        with_radius=.true.))
    end do

  contains

    subroutine enter_driven(driven)
      type(driven_t), intent(in) :: driven
      type(reported_t) :: before, after
      character(len=3) :: way
      integer :: k

      call places%enter_nothing('device_energy', i, 0.0_wp)
      do k = 1, size(driven%jump)
        associate (jump => driven%jump(k))
          jumps = jumps + 1
          way = merge('in ', 'out', jump%inward)
          before = of_curve(readings, jump%before, driven%drive%weights)
          ! Before the drive turns round h0 may.
          before%turn_of = merge(before%drive, h0_alone, &
            abs(dot_product(before%drive, jump%before%slopes)) <= &
            turning*sum(abs(before%drive*jump%before%slopes)))
          call enter_first('device_jump_' // way, 'jump_before', before, .true.)
          if (jump%landed) then
            after = of_curve(readings, jump%after, driven%drive%weights)
            call places%keep(before, after%after)
            call places%enter('device_energy', i, before)
            call places%enter('device_energy', i, after, -1.0_wp)
          else
            call places%enter_nothing('device_energy', i)
          end if
          call enter_first('device_landing_' // way, 'jump_after', after, jump%landed)
        end associate
      end do
      do k = 1, size(of_each_way)
        if (.not. places%has(of_each_way(k), i)) call places%enter_nothing(of_each_way(k), i)
      end do
    end subroutine enter_driven

    !> Enters a place of a jump, for its row and, if it is the first of its way, for the summary.
    subroutine enter_first(of_way, of_row, place, there)
      character(len=*), intent(in) :: of_way, of_row
      type(reported_t), intent(in) :: place
      logical, intent(in) :: there
      logical :: is_first

      is_first = .not. places%has(of_way, i)
      if (there) then
        call places%enter(of_row, jumps, place)
        if (is_first) call places%enter(of_way, i, place)
      else
        call places%enter_nothing(of_row, jumps)
        if (is_first) call places%enter_nothing(of_way, i)
      end if
    end subroutine enter_first

  end subroutine enter_readings

  !> Enters the energy that a cycle loses: that of a path that goes from afar through all its jumps,
  !> or of a loading and the first unloading that come back to where they began.
  subroutine enter_energy(steps, outcome, places)
    class(path_stepper_t), intent(in) :: steps
    type(experiment_result_t), intent(in) :: outcome
    type(places_t), intent(inout) :: places
    type(reported_t) :: before, after
    integer, allocatable :: fold(:)
    real(wp) :: lowest
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
    fold = folds_of_cycle(steps%known, turned, lowest)
    do i = 1, size(fold)
      before%point = fold(i)
      after%point = fold(i)
      after%landing = .true.
      call enter_one(steps, 'energy_lost', 1, before, places)
      call enter_one(steps, 'energy_lost', 1, after, places, -1.0_wp)
    end do
  end subroutine enter_energy

  subroutine enter_list(steps, name, list, places)
    class(stepper_t), intent(in), optional :: steps
    character(len=*), intent(in) :: name
    type(reported_t), intent(in) :: list(:)
    type(places_t), intent(inout) :: places
    type(reported_t) :: place
    integer :: i, k

    k = 0
    if (name == 'profiles' .or. name == 'samples') k = places%elements(name)
    do i = 1, size(list)
      place = list(i)
      place%with_profile = name == 'profiles'
      call enter_one(steps, name, k + i, place, places)
    end do
  end subroutine enter_list

  !> Keeps the largest tension.
  subroutine enter_tension(steps, lowest, places)
    class(stepper_t), intent(in), optional :: steps
    type(reported_t), intent(in) :: lowest
    type(places_t), intent(inout) :: places
    type(reported_t) :: before

    before = places%place_of('max_tension')
    if (.not. lowest%at(of_load) < before%at(of_load)) return
    call places%forget('max_tension')
    call enter_one(steps, 'max_tension', 1, lowest, places)
  end subroutine enter_tension

  subroutine enter_one(steps, name, element, place, places, factor)
    class(stepper_t), intent(in), optional :: steps
    character(len=*), intent(in) :: name
    integer, intent(in) :: element
    type(reported_t), intent(in) :: place
    type(places_t), intent(inout) :: places
    real(wp), intent(in), optional :: factor

    call places%enter(name, element, located(steps, place, places), factor)
  end subroutine enter_one

  !> A place that an experiment has found, with the equilibrium on the path that it is, if the path
  !> is known.
  recursive function located(steps, found, places) result(place)
    class(stepper_t), intent(in), optional :: steps
    type(reported_t), intent(in) :: found
    type(places_t), intent(inout) :: places
    type(reported_t) :: place, before
    integer :: k
    logical :: inside

    place = found
    if (.not. present(steps)) return
    select type (steps)
    class is (path_stepper_t)
      if (place%landing) then
        before%point = place%point
        call places%keep(located(steps, before, places), place%after)
        call landing_over(steps%known, place%point, k, inside)
        if (inside) then
          call take_landing(steps%known%inward(k))
        else
          call take_landing(steps%known%outward(k))
        end if
      else if (place%point > 0) then
        associate (point => steps%known%path%point(place%point))
          call take(point%mesh, point%coordinate, point%state)
          place%drive = merge(h0_alone, load_alone, point%fold)
          place%turn_of = place%drive
        end associate
      else if (place%has_state()) then
        place%s = coordinate_of(steps%problem, place%mesh, place%state)
      end if
      if (place%has_state()) call energy_of(steps%equations_t, place%mesh, place%state, &
        place%at(of_energy), place%left(of_energy))
    end select

  contains

    subroutine take_landing(landing)
      type(landing_t), intent(in) :: landing

      if (landing%converged) call take(landing%mesh, landing%coordinate, landing%state)
      place%judged = .not. landing%converged
      place%known = landing%converged
    end subroutine take_landing

    subroutine take(mesh, s, state)
      integer, intent(in) :: mesh
      real(wp), intent(in) :: s
      type(state_t), intent(in) :: state
      type(reported_t) :: here

      here = reported_state(mesh, state)
      place%mesh = mesh
      place%s = s
      place%state = state
      place%at = here%at
    end subroutine take

  end function located

  !> A state of the curve as a place; its D has the given weights.
  function of_curve(readings, state, weights, with_radius) result(place)
    type(path_readings_t), intent(in) :: readings
    type(curve_state_t), intent(in) :: state
    real(wp), intent(in) :: weights(2)
    logical, intent(in), optional :: with_radius
    type(reported_t) :: place

    associate (node => readings%curve%begin_of(state%interval))
      place%mesh = node%mesh
    end associate
    place%s = state%x
    place%state = state%state
    place%drive = weights
    if (present(with_radius)) place%with_radius = with_radius
    place%at = [state%h0, state%load, state%axis_gap - state%h0, state%energy, state%radius, &
      place%state%scale]
    place%left(of_energy) = state%uncertainty
  end function of_curve

end module outcome_places
