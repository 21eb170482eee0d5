!> Jumps in a measured curve, before any model is known. In a jump inward the force falls, in one
!> outward it rises, over less of the base's travel than the spring alone would take for it. The
!> means of some samples before and of as many after a place are compared: of few where that is
!> enough to stand out of the noise, of more where it is not.
module measured_jumps
  use kinds, only: wp
  use measured_curve, only: measured_t
  implicit none
  private
  public :: measured_jump_t, find_jump

  !> Samples up to `before` - 1 are before it, those from `after` on after it; 0 where none was
  !> seen. Where the base was, with the uncertainty of that; by how much the signal changes.
  type :: measured_jump_t
    integer :: before = 0, after = 0
    real(wp) :: z = 0, uncertainty = 0, change = 0
  end type measured_jump_t

  !> Change over what the spring makes of it; what is left of it over its noise; most steps that a
  !> jump takes in a record that an amplifier has smoothed.
  real(wp), parameter :: steep = 3, seen = 8
  integer, parameter :: most_steps = 6

contains

  !> The largest jump on the way in or out. deviation: of the noise; stiffness: of the spring, units
  !> of signal over z.
  pure type(measured_jump_t) function find_jump(measured, deviation, stiffness, inward) result(jump)
    type(measured_t), intent(in) :: measured
    real(wp), intent(in) :: deviation, stiffness
    logical, intent(in) :: inward
    integer, allocatable :: at(:)
    real(wp), allocatable :: total(:), place(:)
    real(wp) :: change, most, spring
    integer :: width, i, k, n, first, last

    at = pack([(i, i=1, size(measured%z))], (measured%inward .eqv. inward) .and. measured%usable)
    n = size(at)
    if (n < 4) return
    allocate (total(0:n), place(0:n), source=0.0_wp)
    do i = 1, n
      total(i) = total(i - 1) + merge(-1, 1, inward)*measured%signal(at(i))
      place(i) = place(i - 1) + measured%z(at(i))
    end do
    width = 1
    do while (width <= n/4)
      most = 0
      k = 0
      do i = width, n - width
        change = (total(i + width) - 2*total(i) + total(i - width))/width
        spring = steep*stiffness*abs(place(i + width) - 2*place(i) + place(i - width))/width
        if (.not. change - spring > max(most, seen*deviation*sqrt(2.0_wp/width))) cycle
        most = change - spring
        k = i
      end do
      if (k > 0) exit
      width = 2*width
    end do
    if (k == 0) return
    ! Somewhere in the middle of as many samples as were needed to see it.
    first = k - width/2
    last = k + 1 + width/2
    do while (width == 1 .and. first > 1 .and. last - first < most_steps)
      if (.not. goes_on(first - 1)) exit
      first = first - 1
    end do
    do while (width == 1 .and. last < n .and. last - first < most_steps)
      if (.not. goes_on(last)) exit
      last = last + 1
    end do
    jump%before = at(first)
    jump%after = at(last)
    jump%change = merge(-1, 1, inward)*(total(last) - total(last - 1) - total(first) + &
      total(first - 1))
    associate (z => measured%z)
      k = merge(first + 1, last, width == 1)
      jump%z = 0.5_wp*(z(at(first)) + z(at(k)))
      ! That of an even distribution between the two, and of steps that are not equal.
      jump%uncertainty = max(abs(z(at(k)) - z(at(first))), (maxval(z) - minval(z))/n)/sqrt(12.0_wp)
    end associate

  contains

    !> Whether the signal goes the way of a jump from sample i to the next by more than the spring
    !> makes of it, and more than noise does.
    pure logical function goes_on(i)
      integer, intent(in) :: i

      goes_on = total(i + 1) - 2*total(i) + total(i - 1) > stiffness*abs(place(i + 1) - &
        2*place(i) + place(i - 1)) + 4*deviation
    end function goes_on

  end function find_jump

end module measured_jumps
