!> One pass of a drive through its motion, step by step, with its readings. The steps follow the
!> change of the load and, of bodies with memory, the motion of the contact edge, or are those of
!> the deck; a pass after a complete one halves the steps of that pass.
module timed_pass
  use kinds, only: wp, pi
  use mesh_plan, only: contact
  use listener, only: listener_t
  use experiment_request, only: request_t
  use motion, only: motion_t, names_of_ways
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  use time_jump, only: step_along
  use rest, only: begin_at_rest, load_at_rest, longest_step
  use drained_way, only: step_drained
  use journal, only: journal_t
  use timed_journal, only: keep, recall
  use timed_record, only: pass_t, accept, take_row, note, lose, most_steps, &
    of_tension, of_work, of_end_h0, of_end_load, of_end_displacement, of_dissipation
  implicit none
  private
  public :: go_through

  !> Largest deviation of the load from a line in a step, over the unit of load; largest motion of
  !> the contact edge in a step of bodies with memory, over the smallest feature there. Longest and
  !> first step, as fractions of a way.
  real(wp), parameter :: bend = 8.0e-3_wp, edge_moves = 2, longest_part = 0.05_wp, &
    first_part = 1.0e-3_wp
  !> Number of steps after a rejected one before longer steps are tried again.
  integer, parameter :: patience = 3
  !> The shortest step over the shortest time of retardation, its motion over the law's length, and
  !> the step in roundings of the time, below which a step would not be one.
  real(wp), parameter :: shortest_part = 1.0e-3_wp, shortest_way = 1.0e-6_wp, roundings = 4

contains

  !> One pass. It chooses its steps, or halves those of the previous pass if there is one. The part
  !> of the pass that an earlier run stored in the journal is taken from there.
  subroutine go_through(request, drive, pass, before, steps, journal, listener, now)
    class(request_t), intent(in) :: request
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: pass
    type(pass_t), intent(in) :: before
    type(time_stepper_t), intent(inout) :: steps
    type(journal_t), pointer, intent(in) :: journal
    class(listener_t), intent(inout) :: listener
    type(pass_t), intent(inout) :: now
    type(instant_t) :: at
    integer :: way

    ! A pass that halves steps and needs far more than twice as many, or has many more jumps, moves
    ! back and forth in details that are not resolved.
    if (before%held > 0 .and. .not. allocated(steps%drainage)) then
      now%most = 6*before%held + 2000
      now%most_jumps = before%result%jumps + 10
    end if
    call recall(journal, steps, at, now)
    if (now%ended) return
    if (now%held == 0) then
      now%load_unit = unit_of_load(drive, before, steps)
      call begin_at_rest(steps, drive%position(0), at, now%result%begun)
      now%result%lost = .not. now%result%begun
      if (now%result%lost) return
      now%begun_with = steps%energy(at)
      now%way = 1
      call note(steps, at, now)
    end if
    do way = now%way, 3
      if (now%result%lost .or. .not. drive%lasts(way) > 0) cycle
      if (now%held == 1 .or. way > now%way) then
        now%way = way
        now%began = drive%began(way)
        now%step = 0
        at%time = 0
        now%recently = 0
        ! The motion before a turn does not predict the motion after it; rates and loads of a fluid
        ! jump.
        steps%before = at
        ! A path also leads inward from a turn close to a fold, along unstable states; the third way
        ! is back.
        if (way == 3) now%inwards = .false.
        at%since_turn = 0
        if (.not. allocated(steps%drainage)) call take_row(at, now)
      end if
      do while (at%time < drive%lasts(way) .and. .not. now%result%lost)
        if (allocated(steps%drainage)) then
          call step_drained(request, drive, way, pass, longest_part, steps, at, now)
        else if (before%held == 0) then
          call choose_step(request, drive, way, steps, at, now)
        else
          call halve_step(drive, way, before, steps, at, now)
        end if
        call tell(drive, pass, now%began + at%time, listener)
        call keep(journal, steps, at, now)
      end do
    end do
    associate (result => now%result, problem => steps%problem)
      result%number(of_work) = result%number(of_tension)/(1.5_wp*pi)
      result%still_held = -at%state%load >= result%number(of_tension)
      result%number(of_end_h0) = at%state%h0
      result%number(of_end_load) = at%state%load
      result%number(of_end_displacement) = at%state%axis_gap - at%state%h0
      result%number(of_dissipation) = now%work - (steps%energy(at) - now%begun_with)
      result%balance = result%number(of_dissipation) - now%inside
    end associate
    now%ended = .true.
    call keep(journal, steps, at, now)
  end subroutine go_through

  !> A step of the first pass.
  subroutine choose_step(request, drive, way, steps, at, now)
    class(request_t), intent(in) :: request
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: way
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    type(instant_t) :: from
    real(wp) :: whole, end, moved, shortest, way_length

    whole = drive%lasts(way)
    shortest = max(1.0e-8_wp*whole, min(1.0e-5_wp*whole, 1.0e-4_wp*steps%creep%shortest()))
    if (.not. now%step > 0) now%step = first_part*whole
    ! Without adhesion, a long step may lead from a load of zero far into contact.
    way_length = abs(drive%position(way) - drive%position(way - 1))
    if (.not. steps%meshes%traceable .and. way_length > 0) now%step = min(now%step, &
      longest_step(steps, at)*whole/way_length)
    if (allocated(request%drive%time_step)) now%step = 2*request%drive%time_step
    end = at%time + now%step
    if (end + 0.01_wp*now%step > whole) end = whole
    from = at
    call go_to(drive, way, end, steps, at, now)
    moved = missed(steps, from, at, now)
    now%step = (at%time - from%time)*min(2.0_wp, max(0.3_wp, 0.9_wp/sqrt(moved)))
    now%step = min(max(now%step, shortest), longest_part*whole)
    if (now%held > most_steps) call lose(at, now)
  end subroutine choose_step

  !> Deviation of a step over the allowed deviation: below 1 the step may be longer, above 1 it must
  !> be shorter.
  real(wp) function missed(steps, from, at, now)
    type(time_stepper_t), intent(in) :: steps
    type(instant_t), intent(in) :: from, at
    type(pass_t), intent(in) :: now
    real(wp) :: line, unit

    missed = 0.05_wp
    ! Creeping bodies are stiffer than bodies at rest.
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
    if (from%mesh >= contact .and. at%mesh >= contact .and. steps%meshes%traceable) missed = &
      max(missed, (abs(at%state%scale - from%state%scale)/ &
      (edge_moves*steps%finest(from%state%scale)))**2)
  end function missed

  !> The unit of load for the choice of steps: a pull-off or, without adhesion, the load at rest at
  !> the lowest position, which the largest load of the drive exceeds. Compared with it, the loads
  !> of bodies far apart are small from the beginning, and steps are long there.
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
  subroutine halve_step(drive, way, before, steps, at, now)
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: way
    type(pass_t), intent(in) :: before
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now

    do while (before%row(now%halved)%branch /= names_of_ways(way) .or. &
      .not. before%row(now%halved)%time > at%time)
      now%halved = now%halved + 1
    end do
    associate (end => before%row(now%halved)%time)
      call go_to(drive, way, 0.5_wp*(at%time + end), steps, at, now)
      if (.not. now%result%lost) call go_to(drive, way, end, steps, at, now)
    end associate
  end subroutine halve_step

  !> Moves to a time since the beginning of a way, in shorter steps where bodies move too far in one
  !> step, and over instantaneous jumps.
  subroutine go_to(drive, way, time, steps, at, now)
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: way
    real(wp), intent(in) :: time
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    type(instant_t) :: next
    real(wp) :: try, least, way_speed, when
    logical :: done, smooth

    way_speed = abs(drive%position(way) - drive%position(way - 1))/drive%lasts(way)
    least = shortest_part*steps%creep%shortest()
    if (way_speed > 0) least = min(least, shortest_way/way_speed)
    ! Bodies that do not attract each other never jump.
    if (.not. steps%meshes%traceable) least = shortest_way*least
    least = max(least, roundings*spacing(drive%lasts(way)))
    do while (at%time < time)
      try = min(now%longest, time - at%time)
      if (at%time + 1.01_wp*try > time) try = time - at%time
      when = min(at%time + try, time)
      call steps%step(at, when, drive%at(way, when), next, done)
      smooth = done
      if (.not. done .and. steps%meshes%traceable) call step_along(steps, at, when, &
        drive%at(way, when), now%inwards, steps%farthest, next, done)
      if (done) then
        call accept(steps, next, smooth, at, now)
        now%since = now%since + 1
        if (now%since > patience) now%longest = max(now%longest, 2*try)
        cycle
      end if
      steps%cost%rejected_steps = steps%cost%rejected_steps + 1
      now%longest = 0.5_wp*try
      now%since = 0
      if (now%longest > least .and. at%time + now%longest > at%time) cycle
      try = min(max(now%longest, least), time - at%time)
      when = min(at%time + try, time)
      if (steps%meshes%traceable) call step_along(steps, at, when, drive%at(way, when), &
        now%inwards, huge(1.0_wp), next, done)
      if (.not. done .or. now%held > now%most .or. now%result%jumps > now%most_jumps) then
        call lose(at, now)
        return
      end if
      now%result%jumps = now%result%jumps + 1
      now%recently = 0
      call accept(steps, next, .false., at, now)
      steps%before = at
      now%longest = least
      now%since = patience
    end do
  end subroutine go_to

  !> Sends messages about the progress of a pass.
  subroutine tell(drive, pass, time, listener)
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: pass
    real(wp), intent(in) :: time
    class(listener_t), intent(inout) :: listener
    character(len=60) :: so_far

    write (so_far, '(a, i0, a, i0, a)') 'drive, pass ', pass, ': ', &
      nint(100*time/(drive%began(3) + drive%lasts(3))), ' %'
    call listener%hear(trim(so_far))
  end subroutine tell

end module timed_pass
