!> Checks whether a measured curve can be fitted, and otherwise gives the reason with advice.
module measured_checks
  use kinds, only: wp
  use text, only: rounded
  use baseline, only: ways_in
  use measured_curve, only: measured_curve_t
  use measured_jumps, only: measured_jump_t, find_jump, off_baseline
  use noise, only: noise_t
  use significance, only: stands_out, surely
  use sample_lines, only: sample_line_t, line_through
  use contact_check, only: check_contact, steep
  implicit none
  private
  public :: check_measured, open_end, find_saturated

  !> Limits. nearest_part: the fraction of the travel that counts as an end. hardly: the fraction of
  !> a certain signal that counts as none.
  real(wp), parameter :: nearest_part = 0.05_wp, hardly = 0.2_wp
  integer, parameter :: parts = nint(1/nearest_part)

contains

  !> Checks a curve. trouble: the reason why the curve cannot be fitted, otherwise not allocated.
  !> stiffness: the slope of the spring, in units of signal over z.
  subroutine check_measured(measured, noise, stiffness, trouble)
    type(measured_curve_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    character(len=:), allocatable, intent(out) :: trouble
    type(measured_jump_t) :: jump(2), back(2)
    real(wp), allocatable :: left(:)
    real(wp) :: near, before, travel
    logical :: falls
    integer :: i

    left = off_baseline(measured)
    call check_contact(measured, left, noise, stiffness, trouble)
    ! Under a ripple, neither means nor lines through the far samples show small contacts.
    if (allocated(trouble) .or. measured%baseline%ripple) return
    call check_ways()
    if (allocated(trouble)) return
    call nearest()
    if (near >= 0 .or. near >= before .or. .not. falls) then
      ! If the rows are in reverse order of time, the contact is at the far end and appears
      ! repulsive relative to the line through the other samples.
      jump = jumps_in(left)
      back = jumps_in(-left)
      if (.not. maxval(abs(back%change)) > maxval(abs(jump%change))) return
      i = maxloc(abs(back%change), 1)
      trouble = 'the force jumps ' // trim(merge('up on the approach ', 'down on the retract', &
        i == 1)) // ' at z = ' // rounded(back(i)%z) // ' m, by ' // &
        rounded(abs(back(i)%change)) // ' over ' // rounded(abs(measured%z(back(i)%after) - &
        measured%z(back(i)%before))) // ' m: the rows of the file are in reverse order, ' // &
        'or the position is a separation and not that of the base (quantity = ''separation'')'
      return
    end if
    back = jumps_in(-measured%signal)
    if (before - near > steep*stiffness*travel .or. any(back%before > 0)) trouble = &
      'the force falls where the bodies are pressed together (by ' // rounded(before - near) // &
      ' over the nearest ' // rounded(travel) // ' m), but repulsion must be positive; ' // &
      'a minus before the name of a column changes its sign; if they are not in contact ' // &
      'there, but only attract each other, skip the nearest twentieth of the travel'

  contains

    !> The snap-in and snap-off of this curve if it had another signal.
    function jumps_in(signal) result(found)
      real(wp), intent(in) :: signal(:)
      type(measured_jump_t) :: found(2)
      type(measured_curve_t) :: other
      integer :: k

      other = measured
      other%signal = signal
      found = [find_jump(other, noise%deviation, stiffness, .true.), &
        find_jump(other, noise%deviation, stiffness, .false.)]
      do k = 1, size(found)
        if (no_jump(other, found(k))) found(k)%before = 0
        if (found(k)%before == 0) found(k)%change = 0
      end do
    end function jumps_in

    !> Sets `trouble` if approach and retract are exchanged. A cycle dissipates energy: between its
    !> ends, where the two segments meet, the approach lies above the retract, for any baseline. If
    !> the difference is within the noise, a contact at the far end decides.
    subroutine check_ways()
      real(wp) :: position(size(measured%z)), slope(2), slope_error(2), taken(2), sure
      real(wp), allocatable :: above(:), error(:), between(:)

      if (ways_in(measured%inward) < 2) return
      position = measured%facing*measured%z
      call compare_ways(measured, noise, above, error)
      if (size(above) == 0) return
      call slope_at(position, slope(1), slope_error(1))
      call slope_at(-position, slope(2), slope_error(2))
      ! If the signal has the opposite sign, both ends bend down.
      if (sum(slope) < 0) return
      taken = sum(above)/size(above) - above([1, size(above)])
      sure = surely*maxval(error([1, size(error)]))
      ! A ripple or a drift makes differences of both signs.
      between = above - 0.5_wp*(above(1) + above(size(above)))
      if (all(taken < -sure) .and. sum(between) < -0.5_wp*sum(abs(between))) then
        trouble = 'a cycle would gain energy, as the adhesion is stronger on the way in than ' // &
          'on the way out (by ' // rounded(-sum(between)/size(between)) // ' on average, of a ' // &
          'signal with errors of ' // rounded(sure/surely) // '): the rows of the file are in ' // &
          'reverse order, or approach and retract are exchanged in the third column'
      else if (sum(taken) < hardly*sure .and. slope(2) > steep*stiffness + surely*slope_error(2) &
        .and. abs(slope(1)) + surely*slope_error(1) < slope(2)/4) then
        trouble = 'the bodies press on each other at the largest distance of the base, where the ' &
          // 'signal has a slope of ' // rounded(slope(2)/stiffness) // ' of that of the spring: ' &
          // 'approach and retract are exchanged in the third column, or its rows are in reverse ' &
          // 'order'
      end if
    end subroutine check_ways

    !> Minus the slope of the signal at the samples with the smallest `place`.
    pure subroutine slope_at(place, slope, error)
      real(wp), intent(in) :: place(:)
      real(wp), intent(out) :: slope, error
      type(sample_line_t) :: line

      line = line_through(place, measured%signal, measured%usable .and. &
        place <= minval(place) + nearest_part*(maxval(place) - minval(place)))
      slope = -line%slope
      error = noise%long_deviation()/sqrt(line%squares)
    end subroutine slope_at

    !> The mean residual of the samples nearest to the other body, that of as many samples before
    !> them, the distance between the two groups, and whether the signal also falls within the
    !> nearest group. (If the contact first attracts and then repels, the signal rises there.)
    subroutine nearest()
      real(wp) :: position(size(left)), low, width
      logical :: mask(size(left))

      position = measured%facing*measured%z
      low = minval(position)
      width = nearest_part*(maxval(position) - low)
      mask = measured%usable .and. position <= low + width
      near = sum(left, mask)/max(1, count(mask))
      falls = sum(left, mask .and. position <= low + width/2)/ &
        max(1, count(mask .and. position <= low + width/2)) < near
      mask = measured%usable .and. position > low + width .and. position <= low + 2*width
      before = sum(left, mask)/max(1, count(mask))
      travel = width
    end subroutine nearest

  end subroutine check_measured

  !> Whether an apparent jump is no evidence for the order of the rows. Such a jump is one where the
  !> base hardly moves, as at the turn, where a load relaxes; or one no larger than the scatter of
  !> its neighbours, as in contacts that slip.
  pure logical function no_jump(measured, jump)
    type(measured_curve_t), intent(in) :: measured
    type(measured_jump_t), intent(in) :: jump
    !> Number of samples that count as the turn; number of neighbours on each side; limit of the
    !> jump over the largest step between these neighbours.
    integer, parameter :: at_turn = 10, neighbours = 20
    real(wp), parameter :: larger = 2
    integer :: i, turn
    real(wp) :: step, beside
    logical :: on_approach

    no_jump = jump%before == 0
    if (no_jump) return
    associate (z => measured%z, inward => measured%inward)
      on_approach = inward(jump%before)
      step = (maxval(z) - minval(z))/count(inward .eqv. on_approach)
      beside = 0
      do i = max(1, jump%before - neighbours), min(size(z) - 1, jump%after + neighbours - 1)
        if (i >= jump%before .and. i < jump%after) cycle
        if (measured%usable(i) .and. measured%usable(i + 1) .and. (inward(i) .eqv. inward(i + 1))) &
          beside = max(beside, abs(measured%signal(i + 1) - measured%signal(i)))
      end do
      turn = count(inward)
      no_jump = (abs(z(jump%after) - z(jump%before)) < 0.5_wp*step .and. min(abs(jump%before - &
        turn), abs(jump%after - turn)) < at_turn) .or. abs(jump%change) < larger*beside
    end associate
  end function no_jump

  !> The height of the approach above the retract after removing their common slope, and the error
  !> of this height. Both are given for each part of the travel in which both segments have samples,
  !> nearest first.
  pure subroutine compare_ways(measured, noise, above, error)
    type(measured_curve_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), allocatable, intent(out) :: above(:), error(:)
    real(wp), dimension(size(measured%z)) :: position, x, y
    logical, dimension(size(measured%z)) :: mask, mine
    real(wp) :: least, width, middle(2, 2), slope, variance
    integer :: part, way

    allocate (above(0), error(0))
    position = measured%facing*measured%z
    least = minval(position)
    width = (maxval(position) - least)/parts
    do part = 1, parts
      mask = measured%usable .and. min(parts, 1 + int((position - least)/width)) == part
      if (all(measured%inward .or. .not. mask) .or. .not. any(measured%inward .and. mask)) cycle
      x = 0
      y = 0
      variance = 0
      do way = 1, 2
        mine = mask .and. (measured%inward .eqv. way == 1)
        middle(:, way) = [sum(position, mine), sum(measured%signal, mine)]/count(mine)
        where (mine)
          x = position - middle(1, way)
          y = measured%signal - middle(2, way)
        end where
        variance = variance + noise%long_deviation()**2/count(mine)
      end do
      slope = sum(x*y)/max(sum(x**2), tiny(1.0_wp))
      above = [above, middle(2, 1) - middle(2, 2) - slope*(middle(1, 1) - middle(1, 2))]
      error = [error, sqrt(variance)]
    end do
  end subroutine compare_ways

  !> By how much the retract ends below the approach, as it does if the bodies have not separated.
  !> The result is 0 if this is within the noise, or less than half of the largest distance between
  !> the segments.
  pure real(wp) function open_end(measured, noise) result(below)
    type(measured_curve_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), allocatable :: above(:), error(:)
    integer :: last

    call compare_ways(measured, noise, above, error)
    last = size(above)
    below = 0
    if (last == 0) return
    above = above - above(1)
    if (above(last) > surely*(error(1) + error(last)) .and. &
      above(last) > 0.5_wp*maxval(above)) below = above(last)
  end function open_end

  !> The first and last sample of the longest sequence with the smallest or the largest signal, far
  !> from the baseline. They are 0 if this sequence is short, or if a signal of few digits has
  !> equally long sequences elsewhere.
  pure subroutine find_saturated(measured, noise, first, last)
    type(measured_curve_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    integer, intent(out) :: first, last
    integer, parameter :: fewest = 4, more = 3
    integer :: alike(size(measured%z)), i
    real(wp) :: level
    logical :: extreme(size(measured%z))

    associate (s => measured%signal, inward => measured%inward, usable => measured%usable)
      alike = 1
      do i = 2, size(s)
        if (.not. abs(s(i) - s(i - 1)) > 0 .and. (inward(i) .eqv. inward(i - 1))) &
          alike(i) = alike(i - 1) + 1
      end do
      level = sum(s, measured%far .and. usable)/max(1, count(measured%far .and. usable))
      extreme = .not. (s > minval(s, usable) .and. s < maxval(s, usable))
      last = maxloc(alike, 1, extreme .and. usable .and. &
        abs(s - level) > stands_out*noise%deviation)
      first = 0
      if (last == 0) return
      if (alike(last) >= max(fewest, more*maxval(alike, .not. extreme))) &
        first = last - alike(last) + 1
      if (first == 0) last = 0
    end associate
  end subroutine find_saturated

end module measured_checks
