!> One pass of a drive through its motion: step by step, with what is read on the way. Steps follow
!> what the load does, how far the contact edge moves, or the deck; a pass after one that came to
!> its end halves the steps of that.
module timed_pass
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, spacing_over_neck
  use equilibrium, only: holds
  use edge_locked, only: approach, contact
  use records, only: record_t, extent_t, record_of, stable_unasked
  use listener, only: listener_t
  use experiment_request, only: request_t
  use motion, only: motion_t, names_of_ways
  use time_stepper, only: time_stepper_t, instant_t
  use time_jump, only: step_along
  implicit none
  private
  public :: timed_result_t, pass_t, go_through, most_steps, numbers, of_tension, of_tension_h0, &
    of_end_h0, of_end_load, of_end_displacement, of_dissipation

  !> The numbers that are reported.
  integer, parameter :: of_tension = 1, of_tension_h0 = 2, of_end_h0 = 3, of_end_load = 4, &
    of_end_displacement = 5, of_dissipation = 6, numbers = 6

  !> Most steps of a pass.
  integer, parameter :: most_steps = 40000

  !> What a pass through the motion has shown. Numbers in units of the problem; balance: what is
  !> dissipated by the work of the drive, less what dashpots and jumps take.
  type :: timed_result_t
    real(wp) :: number(numbers) = 0, error(numbers) = huge(1.0_wp)
    real(wp) :: balance = 0
    !> By how much the largest tension is above that of any row.
    real(wp) :: lifted = 0
    !> The largest error of a load over the largest load.
    real(wp) :: estimate = 0
    integer :: steps = 0, jumps = 0
    type(extent_t) :: extent
    real(wp) :: worst_residual = 0, worst_spacing = 0, memory_tail = 0, largest_load = 0
    !> The time [s] at which the bodies were lost, if they were; or no start was found.
    logical :: begun = .false., lost = .false.
    real(wp) :: lost_at = 0
  end type timed_result_t

  !> A pass: its rows, and the times of its steps and the last three loads.
  type :: pass_t
    type(timed_result_t) :: result
    type(record_t), allocatable :: row(:)
    real(wp), allocatable :: time(:)
    integer, allocatable :: way(:)
    integer :: held = 0
    !> Steps and jumps at which it is given up.
    integer :: most = most_steps, most_jumps = 50
    real(wp) :: recent(3, 3) = 0
    integer :: recently = 0
    !> The longest step [s] to be tried, and how many steps were taken since one was too long.
    real(wp) :: longest = huge(1.0_wp)
    integer :: since = 0
    !> Whether the bodies were coming nearer to each other when they last moved.
    logical :: inwards = .true.
    real(wp) :: work = 0, inside = 0
  end type pass_t

  !> contact radius over the width of the neck. Longest and first step, parts of a way.
  real(wp), parameter :: bend = 2.0e-3_wp, edge_moves = 1, longest_part = 0.05_wp, &
    first_part = 1.0e-3_wp
  !> Steps after one that was too long before longer ones are tried again.
  integer, parameter :: patience = 3
  !> A relative change of gap or radius that is no rounding.
  real(wp), parameter :: moves = 1.0e-6_wp
  !> The shortest step over the shortest time of retardation, and way over the law's length.
  real(wp), parameter :: shortest_part = 1.0e-3_wp, shortest_way = 1.0e-6_wp

contains

  !> One pass. It chooses its steps, or halves those of the one before, if there is one.
  subroutine go_through(request, drive, pass, before, steps, listener, now)
    class(request_t), intent(in) :: request
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: pass
    type(pass_t), intent(in) :: before
    type(time_stepper_t), intent(inout) :: steps
    class(listener_t), intent(inout) :: listener
    type(pass_t), intent(inout) :: now
    type(instant_t) :: at
    real(wp) :: begun_with
    integer :: way

    ! A pass that halves steps and needs far more than twice as many, or has many more jumps, goes
    ! to and fro in what is not resolved.
    if (before%held > 0) then
      now%most = 6*before%held + 2000
      now%most_jumps = before%result%jumps + 10
    end if
    call steps%begin(drive%position(0), at, now%result%begun)
    now%result%lost = .not. now%result%begun
    if (now%result%lost) return
    begun_with = steps%energy(at)
    call note(steps, 1, at, now)
    do way = 1, 3
      if (now%result%lost .or. .not. drive%time(way) > drive%time(way - 1)) cycle
      now%recently = 0
      call take_row(at, now)
      ! What moved before does not tell how things move now.
      steps%before = at
      if (before%held == 0) then
        call choose_steps(request, drive, way, pass, steps, listener, at, now)
      else
        call halve_steps(drive, way, pass, before, steps, listener, at, now)
      end if
    end do
    associate (result => now%result, problem => steps%problem)
      result%number(of_end_h0) = at%state%h0
      result%number(of_end_load) = at%state%load
      result%number(of_end_displacement) = at%state%axis_gap - at%state%h0
      result%number(of_dissipation) = now%work - (steps%energy(at) - begun_with)
      result%balance = result%number(of_dissipation) - now%inside
    end associate
  end subroutine go_through

  !> Steps of the first pass through a way.
  subroutine choose_steps(request, drive, way, pass, steps, listener, at, now)
    class(request_t), intent(in) :: request
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: way, pass
    type(time_stepper_t), intent(inout) :: steps
    class(listener_t), intent(inout) :: listener
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    type(instant_t) :: from
    real(wp) :: step, whole, end, moved, shortest_step

    whole = drive%time(way) - drive%time(way - 1)
    step = first_part*whole
    shortest_step = max(1.0e-8_wp*whole, min(1.0e-5_wp*whole, 1.0e-4_wp*steps%creep%shortest()))
    do while (at%time < drive%time(way) .and. .not. now%result%lost)
      if (allocated(request%drive%time_step)) step = 2*request%drive%time_step
      end = at%time + step
      if (end + 0.01_wp*step > drive%time(way)) end = drive%time(way)
      from = at
      call go_to(drive, way, end, steps, at, now)
      call tell(drive, pass, at, listener)
      moved = missed(steps, from, at, now)
      step = (at%time - from%time)*min(2.0_wp, max(0.3_wp, 0.9_wp/sqrt(moved)))
      step = min(max(step, shortest_step), longest_part*whole)
      if (now%held > most_steps) call lose(at, now)
    end do
  end subroutine choose_steps

  !> What a step asks to be: below 1 it may be longer, above 1 it has to be shorter.
  real(wp) function missed(steps, from, at, now)
    type(time_stepper_t), intent(in) :: steps
    type(instant_t), intent(in) :: from, at
    type(pass_t), intent(in) :: now
    real(wp) :: line

    missed = 0.05_wp
    associate (r => now%recent)
      if (now%recently >= 3 .and. r(1, 2) > r(1, 1) .and. now%result%largest_load > 0) then
        line = r(2, 2) + (r(2, 2) - r(2, 1))*(r(1, 3) - r(1, 2))/(r(1, 2) - r(1, 1))
        missed = max(missed, abs(r(2, 3) - line)/(bend*load_unit(steps%problem, now)))
      else
        missed = 1
      end if
    end associate
    if (from%mesh >= contact .and. at%mesh >= contact .and. steps%meshes%traceable) missed = &
      max(missed, (abs(at%state%scale - from%state%scale)/ &
      (edge_moves*steps%finest(from%state%scale)))**2)
  end function missed

  !> The load that others are compared with: a pull-off, or the largest met.
  real(wp) function load_unit(problem, now)
    type(problem_t), intent(in) :: problem
    type(pass_t), intent(in) :: now

    load_unit = max(now%result%largest_load, tiny(1.0_wp))
    if (problem%law%adhesion > 0) load_unit = pi*problem%law%adhesion
  end function load_unit

  !> Steps of a pass through a way: the halves of those before.
  subroutine halve_steps(drive, way, pass, before, steps, listener, at, now)
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: way, pass
    type(pass_t), intent(in) :: before
    type(time_stepper_t), intent(inout) :: steps
    class(listener_t), intent(inout) :: listener
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    integer :: i

    do i = 2, before%held
      if (before%way(i) /= way .or. now%result%lost) cycle
      if (.not. before%time(i) > at%time) cycle
      call go_to(drive, way, 0.5_wp*(at%time + before%time(i)), steps, at, now)
      if (.not. now%result%lost) call go_to(drive, way, before%time(i), steps, at, now)
      call tell(drive, pass, at, listener)
    end do
  end subroutine halve_steps

  !> Goes to a time of a way, in shorter steps where bodies move too far in one, and over jumps that
  !> take no time.
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

    associate (from => drive%position(way - 1), to => drive%position(way))
      way_speed = abs(to - from)/(drive%time(way) - drive%time(way - 1))
    end associate
    least = shortest_part*steps%creep%shortest()
    if (way_speed > 0) least = min(least, shortest_way/way_speed)
    ! Bodies that do not attract never jump.
    if (.not. steps%meshes%traceable) least = shortest_way*least
    do while (at%time < time)
      try = min(now%longest, time - at%time)
      if (at%time + 1.01_wp*try > time) try = time - at%time
      when = min(at%time + try, time)
      call steps%step(at, when, drive%at(way, when), next, done)
      smooth = done
      if (.not. done .and. steps%meshes%traceable) call step_along(steps, at, when, &
        drive%at(way, when), now%inwards, steps%farthest, next, done)
      if (done) then
        call accept(steps, way, next, smooth, at, now)
        now%since = now%since + 1
        if (now%since > patience) now%longest = max(now%longest, 2*try)
        cycle
      end if
      steps%cost%rejected_steps = steps%cost%rejected_steps + 1
      now%longest = 0.5_wp*try
      now%since = 0
      if (now%longest > least .and. at%time + now%longest > at%time) cycle
      try = min(max(now%longest, least), time - at%time)
      if (steps%meshes%traceable) call step_along(steps, at, at%time, &
        drive%at(way, at%time + try), now%inwards, huge(1.0_wp), next, done)
      if (.not. done .or. now%held > now%most .or. now%result%jumps > now%most_jumps) then
        call lose(at, now)
        return
      end if
      next%time = at%time + try
      now%result%jumps = now%result%jumps + 1
      now%recently = 0
      call accept(steps, way, next, .false., at, now)
      steps%before = at
      now%longest = least
      now%since = patience
    end do
  end subroutine go_to

  !> Gives the pass up.
  subroutine lose(at, now)
    type(instant_t), intent(in) :: at
    type(pass_t), intent(inout) :: now

    now%result%lost = .true.
    now%result%lost_at = at%time
  end subroutine lose

  !> Notes whether the bodies come nearer to each other, if they move by more than rounding.
  subroutine note_sense(from, to, inwards)
    type(instant_t), intent(in) :: from, to
    logical, intent(inout) :: inwards
    real(wp) :: nearer

    nearer = (from%state%axis_gap - to%state%axis_gap)/abs(from%state%axis_gap)
    if (min(from%mesh, to%mesh) > approach) nearer = to%state%scale/from%state%scale - 1
    if (abs(nearer) > moves) inwards = nearer > 0
  end subroutine note_sense

  !> Makes the next instant the present one. smooth: nothing has jumped; else what the bodies hold
  !> less, and dashpots have not taken, is lost in the jump.
  subroutine accept(steps, way, next, smooth, at, now)
    type(time_stepper_t), intent(inout) :: steps
    integer, intent(in) :: way
    type(instant_t), intent(in) :: next
    logical, intent(in) :: smooth
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    real(wp) :: work

    work = -0.5_wp*(at%state%load + next%state%load)*(next%position - at%position)
    now%work = now%work + work
    if (smooth) then
      now%inside = now%inside + next%dissipated
    else
      now%inside = now%inside + work + steps%energy(at) - steps%energy(next)
    end if
    call note_sense(at, next, now%inwards)
    steps%before = at
    at = next
    call take_row(at, now)
    call note(steps, way, at, now)
  end subroutine accept

  !> Keeps the last three loads, and the largest tension: of the parabola through them where the
  !> middle one is the largest.
  subroutine take_row(at, now)
    type(instant_t), intent(in) :: at
    type(pass_t), intent(inout) :: now
    real(wp) :: slope(2), curvature, away, least, h0

    now%recent(:, :2) = now%recent(:, 2:)
    now%recent(:, 3) = [at%time, at%state%load, at%state%h0]
    now%recently = min(3, now%recently + 1)
    least = at%state%load
    h0 = at%state%h0
    associate (t => now%recent(1, :), f => now%recent(2, :), h => now%recent(3, :))
      if (now%recently == 3 .and. f(2) < min(f(1), f(3)) .and. t(3) > t(2) .and. t(2) > t(1)) then
        slope = (f(2:) - f(:2))/(t(2:) - t(:2))
        curvature = (slope(2) - slope(1))/(t(3) - t(1))
        away = -0.5_wp*(slope(1)/curvature - (t(2) - t(1)))
        least = f(2) + away*(slope(1) + curvature*(t(2) - t(1))) + curvature*away**2
        slope = (h(2:) - h(:2))/(t(2:) - t(:2))
        h0 = h(2) + away*merge(slope(1), slope(2), away < 0)
      end if
    end associate
    if (-least <= now%result%number(of_tension)) return
    now%result%lifted = minval(now%recent(2, 4 - now%recently:)) - least
    now%result%number(of_tension) = -least
    now%result%number(of_tension_h0) = h0
  end subroutine take_row

  !> Adds an instant to the rows, and its qualities to those of the pass.
  subroutine note(steps, way, at, now)
    type(time_stepper_t), intent(in) :: steps
    integer, intent(in) :: way
    type(instant_t), intent(in) :: at
    type(pass_t), intent(inout) :: now
    type(pass_t) :: longer
    integer :: k

    if (.not. allocated(now%row)) allocate (now%row(1024), now%time(1024), now%way(1024))
    if (now%held == size(now%row)) then
      allocate (longer%row(2*now%held), longer%time(2*now%held), longer%way(2*now%held))
      longer%row(:now%held) = now%row
      longer%time(:now%held) = now%time
      longer%way(:now%held) = now%way
      call move_alloc(longer%row, now%row)
      call move_alloc(longer%time, now%time)
      call move_alloc(longer%way, now%way)
    end if
    now%held = now%held + 1
    now%time(now%held) = at%time
    now%way(now%held) = way
    associate (row => now%row(now%held), result => now%result, problem => steps%problem, &
      grid => steps%meshes%grid(at%mesh))
      row = record_of(trim(names_of_ways(way)), problem, grid, at%state, stable_unasked, &
        holds(problem, steps%options%tolerance, at%state))
      row%time = at%time
      if (steps%compliance > 0) row%z = problem%law%separation_of(at%position)
      call result%extent%cover(row, at%state)
      result%steps = now%held - 1
      result%worst_residual = max(result%worst_residual, at%state%residual)
      result%largest_load = max(result%largest_load, abs(at%state%load))
      if (at%state%axis_gap < problem%law%edge_gap) result%worst_spacing = max( &
        result%worst_spacing, spacing_over_neck(problem, at%state%scale*grid%spacing))
      do k = 1, size(at%memory, 2)
        result%memory_tail = max(result%memory_tail, &
          maxval(steps%material%panel_tails(at%memory(:, k))))
      end do
    end associate
  end subroutine note

  !> Says how far a pass has come, ten times or so in a way.
  subroutine tell(drive, pass, at, listener)
    type(motion_t), intent(in) :: drive
    integer, intent(in) :: pass
    type(instant_t), intent(in) :: at
    class(listener_t), intent(inout) :: listener
    character(len=60) :: so_far

    write (so_far, '(a, i0, a, i0, a)') 'drive, pass ', pass, ': ', &
      nint(100*at%time/drive%time(3)), ' %'
    call listener%hear(trim(so_far))
  end subroutine tell

end module timed_pass
