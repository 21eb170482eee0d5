!> Jumps in a measured curve. Behind a spring of stiffness k no stable state lets the force grow by
!> more than k over the way that the base moves; what falls or rises faster, and against the way that
!> springs push, is a jump.
module measured_jumps
  use kinds, only: wp
  use measured_curve, only: measured_t
  use noise, only: noise_t
  implicit none
  private
  public :: measured_jump_t, find_jump

  !> The last sample before and the first after it, 0 where none was seen; where the base was, with
  !> the uncertainty of that; by how much the signal changes.
  type :: measured_jump_t
    integer :: before = 0, after = 0
    real(wp) :: z = 0, uncertainty = 0, change = 0
  end type measured_jump_t

  !> Slope over k in some step of a jump; change over the noise; most steps that one takes in a
  !> record that an amplifier has smoothed.
  real(wp), parameter :: steep = 3, seen = 12
  integer, parameter :: most_steps = 6

contains

  !> The largest jump on the way in or out. stiffness: of the spring, units of signal over z.
  pure type(measured_jump_t) function find_jump(measured, noise, stiffness, inward) result(jump)
    type(measured_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    logical, intent(in) :: inward
    real(wp) :: steepest, change
    integer :: i, first, last, n

    n = size(measured%z)
    first = findloc(measured%inward, inward, 1)
    if (first == 0) return
    last = findloc(measured%inward, inward, 1, back=.true.)
    i = first
    do while (i < last)
      steepest = 0
      first = i
      do while (i < last)
        if (.not. slope_after(i) > stiffness) exit
        steepest = max(steepest, slope_after(i))
        i = i + 1
      end do
      change = abs(measured%signal(i) - measured%signal(first))
      if (steepest > steep*stiffness .and. i - first <= most_steps .and. &
        change > max(seen*noise%deviation, abs(jump%change))) then
        jump%before = first
        jump%after = i
        jump%change = measured%signal(i) - measured%signal(first)
      end if
      i = max(i, first + 1)
    end do
    if (jump%before == 0) return
    associate (z => measured%z(jump%before:jump%before + 1))
      jump%z = 0.5_wp*sum(z)
      ! That of an even distribution between the two, and of steps that are not equal.
      jump%uncertainty = sqrt((max(abs(z(2) - z(1)), typical_step())**2)/12)
    end associate

  contains

    !> Change of the signal over that of the position, to the next sample.
    pure real(wp) function slope_after(k) result(slope)
      integer, intent(in) :: k

      slope = (measured%signal(k + 1) - measured%signal(k))*measured%facing
      associate (step => measured%z(k + 1) - measured%z(k))
        slope = slope*step/max(step**2, tiny(1.0_wp))
      end associate
    end function slope_after

    pure real(wp) function typical_step()
      typical_step = (maxval(measured%z) - minval(measured%z))/ &
        max(1, count(measured%inward .eqv. inward))
    end function typical_step

  end function find_jump

end module measured_jumps
