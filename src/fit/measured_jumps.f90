!> Jumps in a measured curve. In a jump inward the force falls, in one outward it rises, over less
!> of the base's travel than the spring alone would take for it.
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

  !> Change in the first step of a jump over what the spring makes of it; change over the noise;
  !> most steps that a jump takes in a record that an amplifier has smoothed.
  real(wp), parameter :: steep = 3, seen = 12
  integer, parameter :: most_steps = 6

contains

  !> The largest jump on the way in or out. stiffness: of the spring, units of signal over z.
  pure type(measured_jump_t) function find_jump(measured, noise, stiffness, inward) result(jump)
    type(measured_t), intent(in) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    logical, intent(in) :: inward
    real(wp) :: change
    integer :: i, first, last

    first = findloc(measured%inward, inward, 1)
    if (first == 0) return
    last = findloc(measured%inward, inward, 1, back=.true.)
    i = first
    do while (i < last)
      first = i
      i = i + 1
      if (.not. exceeds(first, steep)) cycle
      ! What goes on slower but the same way is still the flight, or the amplifier.
      do while (i < last)
        if (.not. exceeds(i, 1.0_wp)) exit
        i = i + 1
      end do
      change = measured%signal(i) - measured%signal(first)
      if (i - first <= most_steps .and. &
        abs(change) > max(seen*noise%deviation, abs(jump%change))) then
        jump%before = first
        jump%after = i
        jump%change = change
      end if
    end do
    if (jump%before == 0) return
    associate (z => measured%z(jump%before:jump%before + 1))
      jump%z = 0.5_wp*sum(z)
      ! That of an even distribution between the two, and of steps that are not equal.
      jump%uncertainty = sqrt((max(abs(z(2) - z(1)), typical_step())**2)/12)
    end associate

  contains

    !> Whether the signal goes the way of a jump by more than `times` what the spring makes of the
    !> step to the next sample.
    pure logical function exceeds(k, times)
      integer, intent(in) :: k
      real(wp), intent(in) :: times
      real(wp) :: change

      change = measured%signal(k + 1) - measured%signal(k)
      exceeds = merge(-change, change, inward) > times*stiffness*abs(measured%z(k + 1) - &
        measured%z(k))
    end function exceeds

    pure real(wp) function typical_step()
      typical_step = (maxval(measured%z) - minval(measured%z))/ &
        max(1, count(measured%inward .eqv. inward))
    end function typical_step

  end function find_jump

end module measured_jumps
