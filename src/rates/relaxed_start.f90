!> The initial state of a drive in time: relaxed bodies after a slow approach from a large distance.
module relaxed_start
  use kinds, only: wp
  use contact_state, only: state_t, regrid
  use controls, only: control_t
  use path_coordinate, only: coordinate_of, begin_afar
  use drainage, only: drainage_t
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  implicit none
  private
  public :: begin_at_rest, load_at_rest, longest_step

  !> Step of the approach to the initial state, relative to the gap; ratio of the shortest step to
  !> the longest. Factors by which a step is longer after a solution, and shorter after a failure.
  real(wp), parameter :: part_of_gap = 0.1_wp, least_part = 1.0e-4_wp, longer = 1.5_wp, &
    shorter = 0.3_wp

contains

  !> The equilibrium of relaxed bodies at a position, reached by a slow approach from a large
  !> distance. found = .false.: the bodies snap in before they reach the position.
  subroutine begin_at_rest(steps, position, at, found)
    type(time_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: position
    type(instant_t), intent(out) :: at
    logical, intent(out) :: found
    type(state_t) :: state
    type(drainage_t), allocatable :: fluid
    real(wp) :: next, step

    if (allocated(steps%earlier)) deallocate (steps%earlier)
    ! A fluid at rest exerts no pressure.
    if (allocated(steps%drainage)) call move_alloc(steps%drainage, fluid)
    steps%problem%coupling = steps%instant*steps%creep%relaxed()
    call begin_afar(steps%problem, steps%meshes, position, at%mesh, state)
    at%position = state%h0
    call solve_relaxed(steps, at%position, state, at, found)
    step = 1
    do while (found .and. at%position > position)
      next = max(position, at%position - step*longest_step(steps, at))
      state = at%state
      call solve_relaxed(steps, next, state, at, found)
      if (found) then
        step = min(1.0_wp, longer*step)
      else
        step = shorter*step
        found = step > least_part
        if (.not. found) exit
      end if
    end do
    if (found) then
      call steps%set_memory(at)
      if (allocated(fluid) .and. size(steps%creep%time) > 0) then
        ! Solve for the same state as a step of zero duration, with the delayed deformation from the
        ! material's mesh. The deformations computed on the two meshes differ slightly. This
        ! difference is not a motion, and the fluid must not resist it.
        call steps%prepare(at, at%time)
        call steps%place_rise(at%mesh, at%state%scale)
        call steps%frozen%forget()
        call steps%solve(steps%control_at(at%position, at%mesh, at%state), at%state, found)
        call steps%frozen%forget()
      end if
    end if
    if (allocated(fluid)) call move_alloc(fluid, steps%drainage)
    if (found) steps%before = at
  end subroutine begin_at_rest

  !> The longest step of the position (in lengths L) over which states are similar: a fraction of
  !> the gap. Without adhesion deep contacts are similar too; the step is then a fraction of the
  !> distance from the first noticeable deformation.
  pure real(wp) function longest_step(steps, at) result(longest)
    type(time_stepper_t), intent(in) :: steps
    type(instant_t), intent(in) :: at

    longest = at%state%axis_gap
    if (.not. steps%meshes%traceable) longest = abs(at%position - steps%meshes%level)
    longest = part_of_gap*max(longest, 1.0_wp)
  end function longest_step

  !> The load of relaxed bodies at a position after a slow approach. If a state on the way is not
  !> found, the result is the load at the last position before this state.
  real(wp) function load_at_rest(steps, position) result(load)
    type(time_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: position
    type(instant_t) :: at
    logical :: found

    call begin_at_rest(steps, position, at, found)
    load = 0
    if (allocated(at%state%gap)) load = at%state%load
    call steps%frozen%forget()
  end function load_at_rest

  !> Solves for relaxed bodies at a position, starting from the guess `state`. found: a solution
  !> exists near the state of `at`, on the path; this solution then replaces the state of `at`.
  subroutine solve_relaxed(steps, position, state, at, found)
    type(time_stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: position
    type(state_t), intent(inout) :: state
    type(instant_t), intent(inout) :: at
    logical, intent(out) :: found
    type(control_t) :: control

    control = steps%control_at(position, at%mesh, state)
    if (abs(control%scale - state%scale) > 0) state = regrid(steps%problem%shape, state, &
      steps%meshes%grid(at%mesh), steps%meshes%grid(at%mesh), control%scale)
    call steps%solve(control, state, found)
    if (found .and. allocated(at%state%gap) .and. steps%meshes%traceable) found = &
      abs(coordinate_of(steps%problem, steps%meshes, at%mesh, state) - &
      coordinate_of(steps%problem, steps%meshes, at%mesh, at%state)) < steps%farthest
    if (.not. found) return
    at%state = state
    at%position = position
  end subroutine solve_relaxed

end module relaxed_start
