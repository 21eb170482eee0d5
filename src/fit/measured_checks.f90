!> Whether a measured curve is one that can be fitted; if not, why, and what to do.
module measured_checks
  use kinds, only: wp
  use text, only: rounded
  use measured_curve, only: measured_t
  use measured_jumps, only: measured_jump_t, find_jump
  use noise, only: noise_t
  implicit none
  private
  public :: check_measured

  !> What stands out of the noise; the part of the samples that is nearest to the other body; how
  !> steep, over the spring, the wrong end of a curve must be to be called so; how much larger the
  !> pull-off of the approach. Fewer far samples say nothing of a slope.
  real(wp), parameter :: stands_out = 8, nearest_part = 0.05_wp, steep = 0.2_wp, &
    larger = 1.3_wp
  integer, parameter :: fewest_far = 12

contains

  !> trouble is allocated where the curve cannot be fitted. stiffness: of the spring, units of
  !> signal over z.
  subroutine check_measured(measured, noise, stiffness, trouble)
    type(measured_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    character(len=:), allocatable, intent(out) :: trouble
    type(measured_t) :: turned
    type(measured_jump_t) :: jump(2)
    real(wp), allocatable :: left(:)
    real(wp) :: near, before, travel

    left = off_baseline(measured)
    if (.not. maxval(abs(left), measured%usable) > stands_out*noise%deviation) then
      trouble = 'no contact in the data: nothing stands out of the noise of ' // &
        rounded(noise%deviation) // '; measure nearer, or see that columns names the signal'
      return
    end if
    call check_ways(measured, noise, stiffness, trouble)
    if (allocated(trouble)) return
    call nearest(measured, left, near, before, travel)
    if (near >= 0 .or. near >= before) return
    turned = measured
    turned%signal = -measured%signal
    jump(1) = find_jump(turned, noise%deviation, stiffness, .true.)
    jump(2) = find_jump(turned, noise%deviation, stiffness, .false.)
    if (before - near > steep*stiffness*travel .or. any(jump%before > 0)) trouble = &
      'the force falls where the bodies are pressed together: repulsion is positive here; a ' // &
      'minus before the name of a column turns its sign'
  end subroutine check_measured

  !> trouble where approach and retreat are exchanged: contact then is at the end that should be
  !> far, or the bodies hold together better on the way in than on the way out.
  subroutine check_ways(measured, noise, stiffness, trouble)
    type(measured_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    character(len=:), allocatable, intent(inout) :: trouble
    real(wp) :: deepest(2), slope(2), position(size(measured%z))
    real(wp), allocatable :: mine(:)
    logical :: own(size(measured%z))
    integer :: way

    if (.not. (any(measured%inward) .and. .not. all(measured%inward))) return
    position = measured%facing*measured%z
    slope = [slope_at(position), slope_at(-position)]/stiffness
    if (slope(2) > steep .and. abs(slope(1)) < 0.25_wp*steep) then
      trouble = 'the bodies press on each other where the base is farthest: approach and ' // &
        'retreat are exchanged in the third column, or its rows are'
      return
    end if
    do way = 1, 2
      own = measured%usable .and. (measured%inward .eqv. way == 1)
      mine = pack(measured%signal, own)
      ! Three neighbours lie below it: outliers seldom do.
      deepest(way) = sum(measured%signal, own .and. measured%far)/ &
        max(1, count(own .and. measured%far)) - &
        minval(max(mine(3:), mine(2:size(mine) - 1), mine(:size(mine) - 2)))
    end do
    if (deepest(1) > larger*deepest(2) + stands_out*noise%deviation) trouble = &
      'the approach has the larger pull-off: the rows of the file go backwards, or approach ' // &
      'and retreat are exchanged'

  contains

    !> Slope of the signal at the samples of smallest `place`, against it.
    pure real(wp) function slope_at(place)
      real(wp), intent(in) :: place(:)
      logical :: mask(size(place))
      real(wp) :: middle(2)

      mask = measured%usable .and. place <= minval(place) + nearest_part*(maxval(place) - &
        minval(place))
      middle = [sum(place, mask), sum(measured%signal, mask)]/max(1, count(mask))
      slope_at = -sum((place - middle(1))*(measured%signal - middle(2)), mask)/ &
        max(sum((place - middle(1))**2, mask), tiny(1.0_wp))
    end function slope_at

  end subroutine check_ways

  !> The signal less the straight line through the baseline of its way.
  pure function off_baseline(measured) result(left)
    type(measured_t), intent(in) :: measured
    real(wp) :: left(size(measured%z))
    logical :: far(size(measured%z))
    real(wp) :: middle(2), slope
    integer :: way

    left = 0
    do way = 1, 2
      far = measured%far .and. measured%usable .and. (measured%inward .eqv. way == 1)
      if (.not. any(far)) cycle
      associate (z => measured%z, s => measured%signal)
        middle = [sum(z, far), sum(s, far)]/count(far)
        slope = sum((z - middle(1))*(s - middle(2)), far)/ &
          max(sum((z - middle(1))**2, far), tiny(1.0_wp))
        if (count(far) < fewest_far) slope = 0
        where (measured%inward .eqv. way == 1) left = s - middle(2) - slope*(z - middle(1))
      end associate
    end do
  end function off_baseline

  !> Means of what is left over the samples nearest to the other body and the as many before them,
  !> and how far apart these are.
  pure subroutine nearest(measured, left, near, before, travel)
    type(measured_t), intent(in) :: measured
    real(wp), intent(in) :: left(:)
    real(wp), intent(out) :: near, before, travel
    real(wp) :: position(size(left)), low, width
    logical :: mask(size(left))

    position = measured%facing*measured%z
    low = minval(position)
    width = nearest_part*(maxval(position) - low)
    mask = measured%usable .and. position <= low + width
    near = sum(left, mask)/max(1, count(mask))
    mask = measured%usable .and. position > low + width .and. position <= low + 2*width
    before = sum(left, mask)/max(1, count(mask))
    travel = width
  end subroutine nearest

end module measured_checks
