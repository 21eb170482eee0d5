!> Steps in time near folds and across folds, where h0 does not determine the state. The step
!> follows the path of the equilibria with the present memory, along the coordinate of the path,
!> until the drive has the given position. A jump is such a step of any length; it ends in a stable
!> state, where h0 increases with the position of the drive.
module time_jump
  use kinds, only: wp
  use contact_state, only: state_t, regrid
  use controls, only: control_t
  use path_coordinate, only: path_control, coordinate_of
  use root_finding, only: root_search_t, new_root_search
  use next_mesh, only: radius_for
  use time_instant, only: instant_t, extrapolate
  use time_stepper, only: time_stepper_t, expected_scale
  implicit none
  private
  public :: step_along

  !> First, longest and shortest step of the coordinate. Factors by which a step is longer after a
  !> solution, and shorter after a failure. Largest number of steps along a path.
  real(wp), parameter :: first = 0.01_wp, longest = 0.15_wp, shortest = 1.0e-6_wp, &
    longer = 1.5_wp, shorter = 0.4_wp
  integer, parameter :: most_steps = 1000
  !> If the drive is farther from its position than this distance (in lengths L) plus the largest
  !> elongation of the spring so far, the path is assumed to go to infinity.
  real(wp), parameter :: too_far = 1.0e4_wp
  !> Tolerated error of the position of the drive (in lengths L), unless the residuals of the states
  !> are larger. Additional tolerance of the position for each unit of the spring's compliance,
  !> since the load has rounding errors. Largest number of states solved in the search for this
  !> position.
  real(wp), parameter :: left_over = 1.0e-9_wp, left_over_load = 1.0e-13_wp
  integer, parameter :: most_rounds = 30

contains

  !> A step from an instant to a later time, and to the position of the drive at this time, along
  !> the path inward or outward (`inwards`). If the path in this direction does not reach the
  !> position, the step goes in the other direction. The coordinate of the path changes by at most
  !> `farthest`; if `farthest` is huge, the step is a jump.
  subroutine step_along(steps, from, time, position, inwards, farthest, to, done)
    class(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: time, position, farthest
    logical, intent(in) :: inwards
    type(instant_t), intent(out) :: to
    logical, intent(out) :: done
    logical :: jumps

    call steps%prepare(from, time)
    jumps = farthest >= huge(1.0_wp)
    call go(steps, from, position, inwards, jumps, farthest, to, done)
    if (.not. done) call go(steps, from, position, .not. inwards, jumps, farthest, to, done)
    if (.not. done) return
    to%time = time
    to%position = position
    call steps%frozen%forget()
    call steps%remember(from, to)
  end subroutine step_along

  !> Follows the path in one direction.
  subroutine go(steps, from, position, inwards, jumps, farthest, to, done)
    class(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(in) :: from
    real(wp), intent(in) :: position, farthest
    logical, intent(in) :: inwards, jumps
    type(instant_t), intent(out) :: to
    logical, intent(out) :: done
    type(instant_t) :: last
    real(wp) :: s, s_last, missing, missing_last, ds, way, elongation
    integer :: i, mesh
    logical :: found

    done = .false.
    to = from
    s = coordinate_of(steps%problem, steps%meshes, to%mesh, to%state)
    call solve_at(s, to, found)
    if (.not. found) return
    last = to
    s_last = s
    missing = off(steps, to, position)
    ds = first
    way = 0
    elongation = 0
    do i = 1, most_steps
      elongation = max(elongation, steps%compliance*abs(to%state%load))
      if (way > farthest .or. ds < shortest .or. abs(missing) > too_far + elongation) return
      missing_last = missing
      call advance(merge(ds, -ds, inwards), to)
      if (.not. found) then
        ds = shorter*ds
        cycle
      end if
      way = way + ds
      missing = off(steps, to, position)
      if (passed()) exit
      ds = min(longest, longer*ds)
      mesh = steps%mesh_for(to%mesh, to%state)
      if (mesh == to%mesh) cycle
      call change_mesh(to, found)
      if (.not. found) cycle
      last = to
      s = coordinate_of(steps%problem, steps%meshes, to%mesh, to%state)
      s_last = s
      missing_last = missing
      missing = off(steps, to, position)
      if (.not. passed()) cycle
      ! The position lies between the two positions that one state has on the two meshes.
      call steps%frozen%forget()
      call steps%solve(steps%control_at(position, mesh, to%state), to%state, done)
      return
    end do
    call find_between(to)

  contains

    !> Whether the drive has passed its position. A jump ends only where the bodies are stable.
    pure logical function passed()
      passed = (missing < 0) .neqv. (missing_last < 0)
      if (jumps) passed = passed .and. (inwards .eqv. missing < 0)
    end function passed

    !> The distance of the drive in the state of an instant from a given position.
    pure real(wp) function off(steps, at, position)
      class(time_stepper_t), intent(in) :: steps
      type(instant_t), intent(in) :: at
      real(wp), intent(in) :: position

      off = at%state%h0 - steps%compliance*at%state%load - position
    end function off

    !> Solves for the state at a coordinate, with the state of the instant as the guess.
    subroutine solve_at(s, at, found)
      real(wp), intent(in) :: s
      type(instant_t), intent(inout) :: at
      logical, intent(out) :: found
      type(control_t) :: control
      type(state_t) :: state

      control = path_control(steps%problem, steps%meshes, at%mesh, s)
      call steps%place_rise(at%mesh, expected_scale(control, at%state))
      state = at%state
      call steps%solve(control, state, found)
      if (.not. found) call steps%frozen%forget()
      if (found) at%state = state
    end subroutine solve_at

    !> Continues the path by a step `ds` of the coordinate, inward if `ds` is positive.
    subroutine advance(ds, at)
      real(wp), intent(in) :: ds
      type(instant_t), intent(inout) :: at
      type(instant_t) :: next
      real(wp) :: to

      next = at
      to = s + ds
      if (last%mesh == at%mesh .and. abs(s - s_last) > 0) call extrapolate(steps%problem%shape, &
        steps%meshes%grid(at%mesh), last%state, at%state, (to - s)/(s - s_last), next%state)
      call solve_at(to, next, found)
      if (.not. found) return
      last = at
      s_last = s
      at = next
      s = to
    end subroutine advance

    !> Finds the state at which the drive has a given position, between two states. at: on entry the
    !> second state, on return the result.
    subroutine find_between(at)
      type(instant_t), intent(inout) :: at
      type(root_search_t) :: search
      real(wp) :: here, left
      logical :: solved
      integer :: round

      search = new_root_search(s_last, missing_last, s, missing)
      left = missing
      done = .false.
      do round = 1, most_rounds
        done = abs(left) < max(left_over, steps%options%tolerance) + &
          left_over_load*steps%compliance
        if (done .or. .not. search%is_open()) exit
        here = search%place()
        at%state = last%state
        call solve_at(here, at, solved)
        if (.not. solved) return
        left = off(steps, at, position)
        call search%note(here, left)
      end do
    end subroutine find_between

    !> Moves a state of the path to another mesh, with the same coordinate.
    subroutine change_mesh(at, done)
      type(instant_t), intent(inout) :: at
      logical, intent(out) :: done
      type(instant_t) :: moved
      real(wp) :: scale

      scale = radius_for(steps%equations_t, at%mesh, mesh, at%state)
      done = scale > 0
      if (.not. done) return
      moved = at
      moved%mesh = mesh
      moved%state = regrid(steps%problem%shape, at%state, steps%meshes%grid(at%mesh), &
        steps%meshes%grid(mesh), scale)
      call steps%frozen%forget()
      call solve_at(coordinate_of(steps%problem, steps%meshes, mesh, moved%state), moved, done)
      if (done) at = moved
    end subroutine change_mesh

  end subroutine go

end module time_jump
