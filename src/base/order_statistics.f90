!> The number of a rank among given numbers, and their median.
module order_statistics
  use kinds, only: wp
  implicit none
  private
  public :: ranked, median_of

contains

  !> The number of a rank, from 1 for the smallest; 0 if there are no numbers. Each step halves the
  !> range of the numbers that remain.
  pure real(wp) function ranked(numbers, rank) result(number)
    real(wp), intent(in) :: numbers(:)
    integer, intent(in) :: rank
    real(wp), allocatable :: left(:)
    logical, allocatable :: lower(:)
    real(wp) :: low, high
    integer :: place

    number = 0
    if (size(numbers) == 0) return
    left = numbers
    place = rank
    do
      low = minval(left)
      high = maxval(left)
      if (.not. high > low) exit
      ! Between neighbouring numbers the middle may be rounded to the upper one.
      lower = left <= 0.5_wp*low + 0.5_wp*high .and. left < high
      if (place > count(lower)) then
        place = place - count(lower)
        lower = .not. lower
      end if
      left = pack(left, lower)
    end do
    number = left(1)
  end function ranked

  !> The median: the number in the middle or, if there are two, the smaller one of these.
  pure real(wp) function median_of(numbers)
    real(wp), intent(in) :: numbers(:)

    median_of = ranked(numbers, (size(numbers) + 1)/2)
  end function median_of

end module order_statistics
