!> Time steps over one segment of a drive (approach, dwell or retract) with a squeeze film between
!> the bodies. The fluid resists every motion, so that no motion is instantaneous: the time steps
!> resolve snap-in and snap-off.
module squeeze_film_steps
  use kinds, only: wp, pi
  use mesh_plan, only: approach
  use next_mesh, only: radius_for
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  use time_jump, only: step_along
  use timed_record, only: pass_t, accept, lose
  implicit none
  private
  public :: step_drained, longer, safety, remainder

  !> Largest deviation in a step from a straight line through the two previous instants: of the
  !> load, over the largest load or a pull-off, and of the gap on the axis, over the gap. Largest
  !> motion of the edge, over the smallest feature there. A step with more than `rejected` times
  !> these values is repeated as a shorter step. For a continuous load a third of the step has a
  !> third of the deviation. If the shorter step still has more than `no_less` times the deviation
  !> of the longer one, the load jumps, and the step is accepted.
  real(wp), parameter :: bend = 2.0e-3_wp, bend_of_gap = 1.0e-2_wp, edge_moves = 1, rejected = 4, &
    no_less = 0.5_wp
  !> Largest and smallest ratio of a step to the previous step.
  real(wp), parameter :: longer = 2, least_ratio = 0.2_wp
  !> The next step over the estimated step with the permitted deviation: after an accepted step, and
  !> for a step that is repeated. The ratio of a step to one that did not converge.
  real(wp), parameter :: safety = 0.9_wp, repeated = 0.7_wp, lost_step = 0.3_wp
  !> A remainder of the segment below this part of a step is added to the step.
  real(wp), parameter :: remainder = 0.01_wp
  !> The first step over the duration of a segment: the fluid's pressure jumps where the drive
  !> turns.
  real(wp), parameter :: first_drained = 1.0e-7_wp
  !> The shortest step in roundings of the time; largest change of the path's coordinate in such a
  !> step.
  real(wp), parameter :: roundings = 64, unfollowed = 3
  !> Fraction of a contact's radius by which the edge may move, even if the smallest feature is
  !> smaller.
  real(wp), parameter :: part_of_radius = 0.01_wp
  !> Rounding error of dH/dt, over the rounding error of H divided by the time step. The rate is
  !> that of a parabola through three gaps, each with an error of a few roundings.
  real(wp), parameter :: of_rate = 8

contains

  !> Takes a step from an instant, or chooses a shorter one for the next attempt. At snap-in the gap
  !> closes at a time that differs slightly from pass to pass, with ever shorter steps. Therefore
  !> each pass chooses its own steps, half as long as those of the previous pass. The length of a
  !> step follows from the motion and is at most `longest_part` of a segment. A time step that the
  !> deck gives is shortened only if it does not converge.
  subroutine step_drained(longest_part, steps, now)
    real(wp), intent(in) :: longest_part
    type(time_stepper_t), intent(inout) :: steps
    type(pass_t), intent(inout) :: now
    type(instant_t) :: next
    real(wp) :: shorter, first, longest, when, off, taken, least, farthest, whole
    logical :: follows, done, jumped

    whole = now%drive%lasts(now%way)
    shorter = 0.5_wp**(now%number - 2)
    follows = .not. allocated(now%time_step)
    first = max(first_drained*whole, now%drive%least)
    longest = shorter*max(longest_part*whole, first)
    if (.not. follows) longest = shorter*now%time_step
    if (.not. now%step > 0) now%step = shorter*first
    least = roundings*spacing(max(now%at%time, now%step))
    when = now%at%time + now%step
    if (when + remainder*now%step > whole) when = whole
    taken = when - now%at%time
    farthest = steps%farthest
    ! Motion within the rounding of the time is not resolved.
    if (taken <= 2*least) steps%farthest = unfollowed
    call steps%step(now%at, when, now%drive%at(now%way, when), next, done)
    steps%farthest = farthest
    if (.not. done .and. taken <= least) call step_along(steps, now%at, when, &
      now%drive%at(now%way, when), now%inwards, huge(1.0_wp), next, done)
    off = 1/longer**2
    if (done .and. follows) off = max(off, missed(steps, next, now)/shorter**2)
    ! The deviation from a line is not known yet.
    if (done .and. now%at%since_turn < 2) off = 1
    ! If shorter steps do not reduce the deviation, the load jumps, as where the drive turns.
    jumped = done .and. off >= rejected .and. now%missed > 0 .and. off > no_less*now%missed
    if (jumped) then
      off = 1
      next%since_turn = 0
    end if
    now%missed = 0
    if (done .and. (off < rejected .or. taken <= 2*least)) then
      call accept(steps, next, taken > 2*least .and. .not. jumped, now)
      now%step = min(longest, taken*min(longer, max(least_ratio, safety/sqrt(off))))
      if (now%held > now%most) call lose(now)
    else
      steps%cost%rejected_steps = steps%cost%rejected_steps + 1
      if (done) now%missed = off
      now%step = taken*merge(max(least_ratio, repeated/sqrt(off)), lost_step, done)
      if (.not. done .and. taken <= least) call lose(now)
    end if
    now%step = max(now%step, least)
  end subroutine step_drained

  !> Deviation of a step over the allowed deviation: below 1 the step may be longer, above 1 it must
  !> be shorter.
  real(wp) function missed(steps, next, now)
    type(time_stepper_t), intent(in) :: steps
    type(instant_t), intent(in) :: next
    type(pass_t), intent(in) :: now
    real(wp) :: ahead, unit, rounded, radius, finest

    radius = merge(now%at%state%scale, huge(1.0_wp), now%at%mesh > approach)
    finest = steps%finest(radius)
    if (now%at%mesh > approach) finest = max(finest, part_of_radius*radius)
    missed = (moved(steps, now%at, next)/(edge_moves*finest))**2
    ! The difference between two meshes at one state is no motion, and does not become smaller with
    ! the step.
    if (now%at%since_turn < 2 .or. next%mesh /= now%at%mesh) return
    ahead = (next%time - now%at%time)/(now%at%time - steps%before%time)
    unit = max(now%result%largest_load, abs(next%state%load), tiny(1.0_wp), &
      pi*steps%problem%law%adhesion)
    ! Rounding of the gap causes an error of its rate, and thus of the load of the film. Shorter
    ! steps increase this error.
    rounded = of_rate*epsilon(1.0_wp)/(next%time - now%at%time)*0.5_wp*pi*steps%drainage%strength
    associate (before => steps%before%state, last => now%at%state, new => next%state)
      missed = max(missed, (abs(new%load - last%load - ahead*(last%load - before%load)) - &
        rounded)/(bend*unit), abs(new%axis_gap - last%axis_gap - ahead*(last%axis_gap - &
        before%axis_gap))/(bend_of_gap*abs(last%axis_gap)))
    end associate
  end function missed

  !> The distance by which the edge of a contact about the axis moves; 0 for a contact that begins
  !> or ends away from the axis.
  real(wp) function moved(steps, at, next)
    type(time_stepper_t), intent(in) :: steps
    type(instant_t), intent(in) :: at, next
    real(wp) :: radius(2)

    moved = 0
    if (.not. steps%meshes%traceable .or. size(steps%meshes%grid) == approach) return
    associate (edge => steps%problem%law%edge_gap)
      if (.not. min(at%state%axis_gap, next%state%axis_gap) < edge) return
      radius = [edge_of(at), edge_of(next)]
      if (minval(radius) > 0 .and. max(at%state%axis_gap, next%state%axis_gap) > edge) return
      moved = abs(radius(2) - radius(1))
    end associate

  contains

    real(wp) function edge_of(one)
      type(instant_t), intent(in) :: one

      edge_of = radius_for(steps%equations_t, one%mesh, size(steps%meshes%grid), one%state)
    end function edge_of

  end function moved

end module squeeze_film_steps
