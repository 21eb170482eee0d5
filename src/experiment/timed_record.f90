!> The results of a drive: its rows, the reported numbers, and their quality.
module timed_record
  use kinds, only: wp, nan
  use equilibrium, only: holds
  use mesh_plan, only: approach
  use reported_place, only: place_t, measured_load => of_load, of_h0, of_displacement, of_energy, &
    measured_suction => of_suction
  use places, only: places_t
  use records, only: record_t, quality_t, record_of, stable_unasked
  use motion, only: motion_t, names_of_ways
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  implicit none
  private
  public :: timed_result_t, pass_t, accept, take_row, note, lose, most_steps, of_tension, &
    of_tension_h0, of_end_h0, of_end_load, of_end_displacement, of_dissipation, of_suction, &
    enter_numbers

  !> The numbers of a pass.
  integer, parameter :: of_tension = 1, of_tension_h0 = 2, of_end_h0 = 3, of_end_load = 4, &
    of_end_displacement = 5, of_dissipation = 6, of_suction = 7, numbers = 7

  !> Largest number of steps of a pass.
  integer, parameter :: most_steps = 40000

  !> The results of a pass. Numbers are in units of the problem; balance: the dissipated energy that
  !> follows from the work of the drive, minus the sum over dashpots and jumps.
  type :: timed_result_t
    real(wp) :: number(numbers) = 0, balance = 0
    integer :: steps = 0, jumps = 0
    !> Number of passes; the steps of each are half as long as those of the one before.
    integer :: passes = 0
    !> Where the suction of a fluid is largest: the time [s], h0 and the distance from the axis.
    real(wp) :: suction_at(3) = 0
    type(quality_t) :: quality
    real(wp) :: memory_tail = 0, largest_load = 0
    !> Whether a start was found, whether the motion was lost, whether the reason was the number of
    !> steps or jumps, and the time [s] of the loss.
    logical :: begun = .false., lost = .false., too_many = .false.
    real(wp) :: lost_at = 0
    !> Whether the tension is largest at the end of the drive.
    logical :: still_held = .false.
    !> Estimated relative change of the largest tension by the deformation of the bodies at their
    !> start (`frozen_start`).
    real(wp) :: of_start = 0
  end type timed_result_t

  !> A pass: its results, and its rows, whose times count from the beginning of a segment. Its
  !> present state: the last three loads, the segment and the time [s] at which it began, the length
  !> of the next step [s], and the row of the previous pass whose step is halved.
  type :: pass_t
    type(timed_result_t) :: result
    integer :: held = 0, way = 0, halved = 1
    real(wp) :: began = 0, step = 0
    !> The load to which deviations of loads are compared, units of the problem.
    real(wp) :: load_unit = 0
    !> Deviation of the last attempted step, if it was too large; otherwise 0.
    real(wp) :: missed = 0
    !> Numbers of steps and of jumps at which a pass is given up.
    integer :: most = most_steps, most_jumps = 50
    real(wp) :: recent(3, 3) = 0
    integer :: recently = 0
    !> The longest step [s] to be tried, and the number of steps since the last rejected one.
    real(wp) :: longest = huge(1.0_wp)
    integer :: since = 0
    !> Whether the bodies approached each other in their last motion.
    logical :: inwards = .true.
    real(wp) :: work = 0, inside = 0, begun_with = 0
    !> The number of the pass, the motion of the drive, the length of steps [s] if the deck gives
    !> it, and the present instant.
    integer :: number = 1
    type(motion_t) :: drive
    real(wp), allocatable :: time_step
    type(instant_t) :: at
    type(record_t), allocatable :: row(:)
  end type pass_t

  !> A relative change of gap or radius that exceeds rounding.
  real(wp), parameter :: moves = 1.0e-6_wp

contains

  !> Marks the pass as lost: there were too many steps or jumps, or no further state was found.
  subroutine lose(now)
    type(pass_t), intent(inout) :: now

    now%result%lost = .true.
    now%result%too_many = now%held > now%most .or. now%result%jumps > now%most_jumps
    now%result%lost_at = now%began + now%at%time
  end subroutine lose

  !> Makes the next instant the present one. smooth: there was no jump; otherwise the change of the
  !> bodies' energy that dashpots have not dissipated is dissipated in the jump.
  subroutine accept(steps, next, smooth, now)
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(in) :: next
    logical, intent(in) :: smooth
    type(pass_t), intent(inout) :: now
    real(wp) :: work, nearer

    associate (at => now%at)
      work = -0.5_wp*(at%state%load + next%state%load)*(next%position - at%position)
      ! Where a drive turns, the load of a fluid jumps.
      if (allocated(steps%drainage) .and. at%since_turn == 0) &
        work = -next%state%load*(next%position - at%position)
      now%work = now%work + work
      if (smooth) then
        now%inside = now%inside + next%dissipated
      else
        now%inside = now%inside + work + steps%energy(at) - steps%energy(next)
      end if
      nearer = (at%state%axis_gap - next%state%axis_gap)/abs(at%state%axis_gap)
      if (min(at%mesh, next%mesh) > approach) nearer = next%state%scale/at%state%scale - 1
      if (abs(nearer) > moves) now%inwards = nearer > 0
    end associate
    steps%before = now%at
    now%at = next
    call take_row(now)
    call note(steps, now)
  end subroutine accept

  !> Stores the last three loads, and the largest tension: that of the parabola through them if the
  !> load in the middle is the lowest.
  subroutine take_row(now)
    type(pass_t), intent(inout) :: now
    real(wp) :: slope(2), curvature, away, least, h0

    now%recent(:, :2) = now%recent(:, 2:)
    now%recent(:, 3) = [now%at%time, now%at%state%load, now%at%state%h0]
    now%recently = min(3, now%recently + 1)
    least = now%recent(2, 3)
    h0 = now%recent(3, 3)
    associate (t => now%recent(1, :), f => now%recent(2, :), h => now%recent(3, :))
      if (now%recently == 3 .and. f(2) < min(f(1), f(3)) .and. t(3) > t(2) .and. t(2) > t(1)) then
        slope = (f(2:) - f(:2))/(t(2:) - t(:2))
        curvature = (slope(2) - slope(1))/(t(3) - t(1))
        away = -0.5_wp*(slope(1)/curvature + (t(2) - t(1)))
        least = f(2) + away*(slope(1) + curvature*(t(2) - t(1))) + curvature*away**2
        slope = (h(2:) - h(:2))/(t(2:) - t(:2))
        h0 = h(2) + away*merge(slope(1), slope(2), away < 0)
      end if
    end associate
    if (-least <= now%result%number(of_tension)) return
    now%result%number(of_tension) = -least
    now%result%number(of_tension_h0) = h0
  end subroutine take_row

  !> Adds an instant to the rows, and its quality to that of the pass.
  subroutine note(steps, now)
    type(time_stepper_t), intent(in) :: steps
    type(pass_t), intent(inout) :: now
    integer :: k

    call make_room(now)
    now%held = now%held + 1
    associate (row => now%row(now%held), result => now%result, problem => steps%problem, &
      at => now%at, grid => steps%meshes%grid(now%at%mesh))
      row = record_of(trim(names_of_ways(now%way)), problem, grid, at%state, stable_unasked, &
        holds(problem, steps%options%tolerance, at%state))
      row%time = at%time
      if (steps%compliance > 0) row%z = problem%law%separation_of(at%position)
      call result%quality%cover(row, problem, grid, at%state, &
        at%state%axis_gap < problem%law%edge_gap)
      result%steps = now%held - 1
      result%largest_load = max(result%largest_load, abs(at%state%load))
      if (at%suction > result%number(of_suction)) then
        result%number(of_suction) = at%suction
        result%suction_at = [now%began + at%time, at%state%h0, at%suction_at]
      end if
      do k = 1, size(at%memory, 2)
        result%memory_tail = max(result%memory_tail, &
          maxval(steps%material%panel_tails(at%memory(:, k))))
      end do
    end associate
  end subroutine note

  !> Makes room for a further row.
  subroutine make_room(now)
    type(pass_t), intent(inout) :: now
    type(record_t), allocatable :: longer(:)

    if (.not. allocated(now%row)) allocate (now%row(1024))
    if (now%held < size(now%row)) return
    allocate (longer(2*now%held))
    longer(:now%held) = now%row(:now%held)
    call move_alloc(longer, now%row)
  end subroutine make_room

  !> Enters the numbers of a pass. The errors of loads are relative to the largest load. Those of
  !> the energy are relative to the energy or to the largest load times the law's length, whichever
  !> is larger. Those of the suction are relative to the suction or to the accuracy times the law's
  !> pressure, below which a suction has no effect.
  subroutine enter_numbers(result, accuracy, with_work, with_suction, places)
    type(timed_result_t), intent(in) :: result
    real(wp), intent(in) :: accuracy
    logical, intent(in) :: with_work, with_suction
    type(places_t), intent(out) :: places
    type(place_t) :: place

    place%in_time = .true.
    place%scale([measured_load, of_energy]) = result%largest_load
    place%scale(measured_suction) = accuracy
    place%at = nan
    associate (number => result%number)
      place%at([of_h0, measured_load, of_displacement]) = &
        number([of_end_h0, of_end_load, of_end_displacement])
      call places%enter('end', 1, place)
      place%at = nan
      if (number(of_tension) > 0) then
        ! The load has an extremum there, other than at the end of the drive.
        place%turn_of = [0.0_wp, 1.0_wp]
        place%at([of_h0, measured_load]) = [number(of_tension_h0), -number(of_tension)]
        call places%enter('max_tension', 1, place)
        if (with_work) call places%enter('effective_work', 1, place)
        place%turn_of = 0
      end if
      ! The following numbers have no h0 and no load.
      place%at([of_h0, measured_load]) = [nan, 0.0_wp]
      if (with_suction) then
        place%at(measured_suction) = number(of_suction)
        call places%enter('max_suction', 1, place)
        place%at(measured_suction) = nan
      end if
      place%at(of_energy) = number(of_dissipation)
      place%left(of_energy) = abs(result%balance)
      call places%enter('energy_dissipated', 1, place)
    end associate
  end subroutine enter_numbers

end module timed_record
