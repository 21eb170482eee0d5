!> One pass of a drive through its motion, step by step, with its results. The deck gives the time
!> step, or it follows from the change of the load and, for viscoelastic bodies, from the motion of
!> the contact edge. A pass after a complete one halves its steps.
module timed_pass
  use kinds, only: wp, pi
  use mesh_plan, only: contact
  use progress_observer, only: progress_observer_t
  use motion, only: motion_t, names_of_ways
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  use time_jump, only: step_along
  use relaxed_start, only: begin_at_rest, load_at_rest, longest_step
  use squeeze_film_steps, only: step_drained, longer, safety, remainder
  use timed_record, only: pass_t, accept, take_row, note, lose, most_steps, &
    of_tension, of_end_h0, of_end_load, of_end_displacement, of_dissipation
  implicit none
  private
  public :: go_through

  !> Largest deviation of the load from a line in a step, over the unit of load; largest motion of
  !> the contact edge in a step of viscoelastic bodies, over the smallest feature there. Longest and
  !> first step, as fractions of a segment (approach, dwell or retract).
  real(wp), parameter :: bend = 8.0e-3_wp, edge_moves = 2, longest_part = 0.05_wp, &
    first_part = 1.0e-3_wp
  !> Smallest ratio of a step to the previous one; deviation from a line that is neglected.
  real(wp), parameter :: least_ratio = 0.3_wp, straight = 0.05_wp
  !> The shortest chosen step over the shortest retardation time, and its limits as fractions of a
  !> segment.
  real(wp), parameter :: shortest_chosen = 1.0e-4_wp, shortest_of_way(2) = [1.0e-8_wp, 1.0e-5_wp]
  !> Number of steps after a rejected one before longer steps are tried again.
  integer, parameter :: patience = 3
  !> A step is not divided further below these limits: its duration over the shortest retardation
  !> time; the motion of the drive in it over the law's length; its duration in roundings of the
  !> time.
  real(wp), parameter :: shortest_part = 1.0e-3_wp, shortest_way = 1.0e-6_wp, roundings = 4

contains

  !> One pass. It chooses its steps, or halves those of the previous pass if there is one.
  subroutine go_through(before, steps, observer, now)
    type(pass_t), intent(in) :: before
    type(time_stepper_t), intent(inout) :: steps
    class(progress_observer_t), intent(inout) :: observer
    type(pass_t), intent(inout) :: now
    integer :: way

    ! If a pass that halves steps needs far more than twice as many, or has many more jumps, it
    ! oscillates in details that are not resolved.
    if (before%held > 0 .and. .not. allocated(steps%drainage)) then
      now%most = 6*before%held + 2000
      now%most_jumps = before%result%jumps + 10
    end if
    now%load_unit = unit_of_load(now%drive, before, steps)
    call begin_at_rest(steps, now%drive%position(0), now%at, now%result%begun)
    now%result%lost = .not. now%result%begun
    if (now%result%lost) return
    now%begun_with = steps%energy(now%at)
    now%way = 1
    call note(steps, now)
    do way = 1, 3
      if (now%result%lost .or. .not. now%drive%lasts(way) > 0) cycle
      now%way = way
      now%began = now%drive%began(way)
      now%step = 0
      now%at%time = 0
      now%recently = 0
      ! The motion before a turn does not predict the motion after it; rates and loads of a fluid
      ! jump.
      steps%before = now%at
      ! If the drive turns close to a fold, a path also leads inward from there, along unstable
      ! states. The third segment is the retract and must lead outward.
      if (way == 3) now%inwards = .false.
      now%at%since_turn = 0
      if (.not. allocated(steps%drainage)) call take_row(now)
      do while (now%at%time < now%drive%lasts(way) .and. .not. now%result%lost)
        if (allocated(steps%drainage)) then
          call step_drained(longest_part, steps, now)
        else if (before%held == 0) then
          call choose_step()
        else
          call halve_step()
        end if
        call tell()
      end do
    end do
    associate (result => now%result, at => now%at)
      result%passes = now%number
      result%still_held = -at%state%load >= result%number(of_tension)
      result%number(of_end_h0) = at%state%h0
      result%number(of_end_load) = at%state%load
      result%number(of_end_displacement) = at%state%axis_gap - at%state%h0
      result%number(of_dissipation) = now%work - (steps%energy(at) - now%begun_with)
      result%balance = result%number(of_dissipation) - now%inside
    end associate

  contains

    !> A step of the first pass.
    subroutine choose_step()
      type(instant_t) :: from
      real(wp) :: whole, end, moved, shortest, way_length

      whole = now%drive%lasts(now%way)
      shortest = max(shortest_of_way(1)*whole, min(shortest_of_way(2)*whole, &
        shortest_chosen*steps%creep%shortest()))
      if (.not. now%step > 0) now%step = first_part*whole
      ! Without adhesion, a long step may lead from a load of zero far into contact.
      way_length = now%drive%length_of(now%way)
      if (.not. steps%meshes%traceable .and. way_length > 0) now%step = min(now%step, &
        longest_step(steps, now%at)*whole/way_length)
      if (allocated(now%time_step)) now%step = 2*now%time_step
      end = now%at%time + now%step
      if (end + remainder*now%step > whole) end = whole
      from = now%at
      call go_to(end)
      moved = missed(steps, from, now)
      now%step = (now%at%time - from%time)* &
        min(longer, max(least_ratio, safety/sqrt(moved)))
      now%step = min(max(now%step, shortest), longest_part*whole)
      if (now%held > most_steps) call lose(now)
    end subroutine choose_step

    !> Deviation of a step over the allowed deviation: below 1 the step may be longer, above 1 it
    !> must be shorter.
    real(wp) function missed(steps, from, now)
      type(time_stepper_t), intent(in) :: steps
      type(instant_t), intent(in) :: from
      type(pass_t), intent(in) :: now
      real(wp) :: line, unit

      missed = straight
      ! Viscoelastic bodies in motion are stiffer than relaxed ones.
      unit = now%load_unit
      if (.not. steps%meshes%traceable) unit = max(unit, now%result%largest_load)
      associate (r => now%recent)
        if (now%recently < 3 .or. .not. r(1, 2) > r(1, 1)) then
          missed = 1
        else
          line = r(2, 2) + (r(2, 2) - r(2, 1))*(r(1, 3) - r(1, 2))/(r(1, 2) - r(1, 1))
          missed = max(missed, abs(r(2, 3) - line)/(bend*unit))
        end if
      end associate
      ! Elastic bodies do not remember where their edge was.
      if (size(steps%creep%time) == 0) return
      if (from%mesh >= contact .and. now%at%mesh >= contact .and. steps%meshes%traceable) missed = &
        max(missed, (abs(now%at%state%scale - from%state%scale)/ &
        (edge_moves*steps%finest(from%state%scale)))**2)
    end function missed

    !> The unit of load for the choice of steps: a pull-off or, without adhesion, the relaxed load
    !> at the lowest position, which the largest load of the drive exceeds. Loads of bodies far
    !> apart are small against it, so steps are long there.
    real(wp) function unit_of_load(drive, before, steps) result(unit)
      type(motion_t), intent(in) :: drive
      type(pass_t), intent(in) :: before
      type(time_stepper_t), intent(inout) :: steps

      unit = tiny(1.0_wp)
      if (steps%meshes%traceable) then
        unit = pi*steps%problem%law%adhesion
      else if (before%held == 0) then
        unit = max(unit, load_at_rest(steps, minval(drive%position)))
      end if
    end function unit_of_load

    !> Takes the halves of a step of the previous pass.
    subroutine halve_step()
      do while (before%row(now%halved)%branch /= names_of_ways(now%way) .or. &
        .not. before%row(now%halved)%time > now%at%time)
        now%halved = now%halved + 1
      end do
      associate (end => before%row(now%halved)%time)
        call go_to(0.5_wp*(now%at%time + end))
        if (.not. now%result%lost) call go_to(end)
      end associate
    end subroutine halve_step

    !> Moves to a time since the beginning of the segment, in shorter steps where bodies move too
    !> far in one step, and over instantaneous jumps.
    subroutine go_to(time)
      real(wp), intent(in) :: time
      type(instant_t) :: next
      real(wp) :: try, least, way_speed, when
      logical :: done, smooth

      way_speed = now%drive%length_of(now%way)/now%drive%lasts(now%way)
      least = shortest_part*steps%creep%shortest()
      if (way_speed > 0) least = min(least, shortest_way/way_speed)
      ! Bodies that do not attract each other never jump.
      if (.not. steps%meshes%traceable) least = shortest_way*least
      least = max(least, roundings*spacing(now%drive%lasts(now%way)))
      do while (now%at%time < time)
        try = min(now%longest, time - now%at%time)
        if (now%at%time + (1 + remainder)*try > time) try = time - now%at%time
        when = min(now%at%time + try, time)
        call steps%step(now%at, when, now%drive%at(now%way, when), next, done)
        smooth = done
        if (.not. done .and. steps%meshes%traceable) call step_along(steps, now%at, when, &
          now%drive%at(now%way, when), now%inwards, steps%farthest, next, done)
        if (done) then
          call accept(steps, next, smooth, now)
          now%since = now%since + 1
          if (now%since > patience) now%longest = max(now%longest, 2*try)
          cycle
        end if
        steps%cost%rejected_steps = steps%cost%rejected_steps + 1
        now%longest = 0.5_wp*try
        now%since = 0
        if (now%longest > least .and. now%at%time + now%longest > now%at%time) cycle
        try = min(max(now%longest, least), time - now%at%time)
        when = min(now%at%time + try, time)
        if (steps%meshes%traceable) call step_along(steps, now%at, when, now%drive%at(now%way, &
          when), now%inwards, huge(1.0_wp), next, done)
        if (.not. done .or. now%held > now%most .or. now%result%jumps > now%most_jumps) then
          call lose(now)
          return
        end if
        now%result%jumps = now%result%jumps + 1
        now%recently = 0
        call accept(steps, next, .false., now)
        steps%before = now%at
        now%longest = least
        now%since = patience
      end do
    end subroutine go_to

    subroutine tell()
      character(len=60) :: so_far

      write (so_far, '(a, i0, a, i0, a)') 'drive, pass ', now%number, ': ', &
        nint(100*(now%began + now%at%time)/(now%drive%began(3) + now%drive%lasts(3))), ' %'
      call observer%hear(trim(so_far))
    end subroutine tell

  end subroutine go_through

end module timed_pass
