!> Traces the equilibrium path: a continuation advances step by step and from mesh to mesh, and its
!> states become points of the path.
module tracing
  use kinds, only: wp
  use progress_observer, only: progress_observer_t
  use contact_state, only: state_t, undeformed_state
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use solver_options, only: usual_tolerance
  use mesh_plan, only: approach
  use contact_scales, only: largest_radius, lost_in_rounding
  use path_coordinate, only: h0_control
  use continuation, only: continuation_t
  use mesh_passage, only: has_come_to_next, pass_to_next
  use ending, only: ending_t, beyond_rounding, no_equilibrium, path_lost
  use traced_path, only: traced_path_t, tracing_t
  use path_end, only: demand_t, touches, outer_end, astray, collapsed
  use path_growth, only: append, add_extrema
  use mesh_insertion, only: inserted_mesh_t, inserted_mesh
  use mesh_refinement, only: mesh_refiner_t, new_mesh_refiner, left_on_path, left_in_state
  implicit none
  private
  public :: trace

  !> Number of points beyond which a path is given up.
  integer, parameter :: longest = 3000
  !> If the nodes miss this part of the load, a mesh is refined before the path has reached the end
  !> of the mesh, since later states would be useless. Number of steps between these checks.
  real(wp), parameter :: most_adrift = 0.1_wp
  integer, parameter :: steps_a_check = 8
  !> Number of steps between messages to the observer: a message takes a tenth of the time of a
  !> step.
  integer, parameter :: steps_a_message = 8
  !> Largest residual of points that define a smooth curve, in the law's lengths; for other points
  !> it is `usual_tolerance`, even if the deck allows larger residuals for the experiment's states.
  !> Extrapolation amplifies the residual a hundred times. If the result exceeded the permitted
  !> difference between guess and state, no step would be short enough.
  real(wp), parameter :: curve_tolerance = 1.0e-10_wp

contains

  !> Traces the path from a state at large separation, on the mesh for the approach, until it is
  !> stable at h0_low. into_contact: the bodies must also be in contact at the end; an outer contact
  !> at h0_end (at h0_low if h0_end is absent) is enough. Meshes that miss too much of the load for
  !> the accuracy are refined. demand: if present, the path goes as far as the demand says, and its
  !> points are close enough for a smooth curve.
  subroutine trace(solver, start, h0_low, into_contact, accuracy, observer, known, demand, h0_end)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: start
    real(wp), intent(in) :: h0_low, accuracy
    logical, intent(in) :: into_contact
    class(progress_observer_t), intent(inout) :: observer
    class(tracing_t), intent(inout) :: known
    type(demand_t), intent(in), optional :: demand
    real(wp), intent(in), optional :: h0_end
    type(continuation_t) :: walker
    type(mesh_refiner_t) :: refiner
    character(len=40) :: so_far
    logical :: lost, blind, finished, refined
    type(ending_t) :: going_on
    real(wp) :: tolerance, contact_at
    integer :: steps

    contact_at = h0_low
    if (present(h0_end)) contact_at = h0_end
    ! Where rounding hides the contact, the path is useful up to its first fold only.
    blind = lost_in_rounding(solver%problem, &
      largest_radius(solver%problem, h0_low, solver%meshes%level))
    tolerance = solver%options%tolerance
    solver%options%tolerance = min(tolerance, &
      merge(curve_tolerance, usual_tolerance, present(demand)))
    finished = .false.
    steps = 0
    if (present(demand)) call walker%follow_closely(demand%looser)
    call walker%take(solver, start, approach, lost)
    if (lost) known%ending%cause = path_lost
    refiner = new_mesh_refiner(accuracy, solver%problem%law)
    walker%most = refiner%most
    do while (.not. (known%ending%early() .or. finished))
      call extend(known%path, walker, solver, lost)
      if (lost) lost = .not. has_come_to_next(walker, solver%equations_t)
      steps = steps + 1
      if (mod(steps, steps_a_message) == 0) then
        write (so_far, '(a, i0, a)') 'tracing the path: ', known%path%held, ' states'
        call observer%hear(trim(so_far))
      end if
      refined = .false.
      if (.not. lost) call examine_mesh()
      if (.not. (lost .or. refined)) call pass_on(known%path, walker, solver, lost)
      call note_ending()
      finished = goes_far_enough()
      if (.not. refined .and. (finished .or. known%ending%early())) &
        call refiner%refine(solver%equations_t, known%path, walker%mesh, .false., lost, refined)
      if (.not. refined) cycle
      known%ending = going_on
      finished = .false.
      call go_back(solver, start, walker%mesh, known%path, walker, lost)
      if (lost) known%ending%cause = path_lost
    end do
    solver%options%tolerance = tolerance
    if (.not. known%fallen) known%left_out = left_on_path(solver%equations_t, known%path)
    if (present(demand)) call known%path%begin_undeformed(solver%problem, demand%farthest)
    known%path%last = known%path%held

  contains

    !> Refines the present mesh if it misses too much of the load, or inserts a mesh after it.
    subroutine examine_mesh()
      type(inserted_mesh_t) :: further
      logical :: adrift, leaving

      if (.not. walker%stuck) further = inserted_mesh(solver%equations_t, walker%arc_t, accuracy)
      adrift = mod(steps, steps_a_check) == 0
      if (adrift) adrift = left_in_state(solver%equations_t, walker%mesh, &
        walker%point(walker%held)%state) > most_adrift
      leaving = has_come_to_next(walker, solver%equations_t)
      ! This mesh was examined when the next one was inserted. The path may stay on it for some
      ! steps; if it were refined again, the path would reach the inserted one earlier each time.
      if (leaving) leaving = .not. solver%meshes%inserted(walker%mesh + 1)
      if (further%wanted .or. adrift .or. leaving) call refiner%refine(solver%equations_t, &
        known%path, walker%mesh, .not. adrift, .false., refined)
      if (further%wanted .and. .not. refined) then
        call solver%meshes%insert(walker%mesh, further%locked, further%reach(1), further%reach(2))
        call solver%operator%forget()
      end if
    end subroutine examine_mesh

    !> Sets the cause if the path ends here although it does not go far enough.
    subroutine note_ending()
      known%fallen = collapsed(solver%problem, known%path, lost)
      lost = lost .or. known%path%held >= longest .or. astray(solver%equations_t, known%path)
      if (known%fallen) then
        known%ending%cause = no_equilibrium
      else if (lost) then
        known%ending%cause = path_lost
      else if (blind .and. any(known%path%point(:known%path%held)%fold)) then
        known%ending%cause = beyond_rounding
      end if
    end subroutine note_ending

    !> Whether the path has the end that is asked for.
    logical function goes_far_enough() result(enough)
      associate (last => known%path%point(known%path%held))
        enough = last%modes == 0 .and. last%state%h0 <= h0_low .and. last%tangent%h0 < 0
        if (enough .and. present(demand)) enough = demand%is_met(solver%equations_t, known%path)
        if (enough .and. into_contact) then
          enough = touches(solver%equations_t, last)
          if (.not. enough) enough = outer_end(solver, known%path, contact_at) > 0
        end if
      end associate
    end function goes_far_enough

  end subroutine trace

  !> Returns to the entry of the path into a refined mesh, or to the start of the path.
  subroutine go_back(solver, start, mesh, path, walker, lost)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: start
    integer, intent(in) :: mesh
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    logical, intent(out) :: lost
    type(state_t) :: state
    logical :: done

    path%held = count(path%point(:path%held)%mesh < mesh)
    call walker%forget()
    call solver%frozen%forget()
    if (path%held > 0) then
      ! The path passed to the refined mesh between its last two points; now it may pass later.
      path%point(path%held - 1)%leads_on = .true.
      call stand_at_end(path, walker)
      call pass_on(path, walker, solver, lost)
      return
    end if
    associate (shape => solver%problem%shape)
      state = undeformed_state(shape, solver%meshes%grid(approach), start%h0, start%scale)
      ! The state keeps the h0 of the start, at which an experiment may begin.
      call solver%correct(h0_control(shape, solver%meshes, approach, start%h0), state, done)
    end associate
    lost = .not. done
    if (done) call walker%take(solver, state, approach, lost)
  end subroutine go_back

  !> Gives a continuation without states the last states of a path.
  subroutine stand_at_end(path, walker)
    type(traced_path_t), intent(in) :: path
    type(continuation_t), intent(inout) :: walker
    integer :: i

    walker%mesh = path%point(path%held)%mesh
    do i = path%held, 1, -1
      associate (point => path%point(i))
        if (point%mesh /= walker%mesh .or. walker%is_full()) exit
        if (point%fold .or. point%load_extremum) cycle
        call walker%add(point)
      end associate
    end do
    if (walker%held > 1) &
      walker%step = walker%point(walker%held)%coordinate - walker%point(walker%held - 1)%coordinate
  end subroutine stand_at_end

  !> Advances the continuation by a step and appends the new point. A new path begins with the
  !> newest state of the continuation. lost: no step, however small, converged.
  subroutine extend(path, walker, solver, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost

    if (path%held == 0) call append(path, walker%arc_t)
    call walker%advance(solver, lost)
    if (.not. lost) call append(path, walker%arc_t)
  end subroutine extend

  !> Lets the continuation pass to the next mesh if it has reached it, and adds the extrema that it
  !> has passed. lost: a solve failed.
  subroutine pass_on(path, walker, solver, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost

    call change_mesh(path, walker, solver, lost)
    if (.not. lost) call add_extrema(path, walker%arc_t, solver, lost)
  end subroutine pass_on

  !> Lets the continuation change its mesh. The last two points are appended again on the next mesh,
  !> and the path continues between them.
  subroutine change_mesh(path, walker, solver, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    integer :: mesh

    mesh = walker%mesh
    call pass_to_next(walker, solver, lost)
    lost = lost .or. walker%stuck
    if (lost .or. walker%mesh == mesh) return
    path%point(path%held - 1)%leads_on = .false.
    call append(path, walker%arc_t, 1)
    call append(path, walker%arc_t)
  end subroutine change_mesh

end module tracing
