!> Outliers: samples that differ from their neighbours on both sides. A jump, a bend or a lasting
!> change does not count as an outlier.
module outliers
  use kinds, only: wp
  implicit none
  private
  public :: stand_apart

  !> Number of neighbours on each side whose median is compared with a sample; with three, one of
  !> them may be an outlier.
  integer, parameter :: neighbours = 3

contains

  !> Marks samples that lie outside the range between the medians of their neighbours on the two
  !> sides, within the run, by more than their `tolerance`. Samples that are not `usable` are
  !> ignored.
  pure function stand_apart(signal, run, usable, tolerance) result(apart)
    real(wp), intent(in) :: signal(:), tolerance(:)
    integer, intent(in) :: run(:)
    logical, intent(in) :: usable(:)
    logical :: apart(size(signal)), good(size(signal))
    real(wp) :: middle(2)
    logical :: known(2)
    integer :: i, pass

    good = usable
    ! The second pass ignores the outliers of the first, which may have hidden others.
    do pass = 1, 2
      apart = .false.
      do i = 1, size(signal)
        call beside(signal, run, good, i, -1, middle(1), known(1))
        call beside(signal, run, good, i, 1, middle(2), known(2))
        if (.not. any(known)) cycle
        apart(i) = usable(i) .and. (signal(i) < minval(middle, known) - tolerance(i) .or. &
          signal(i) > maxval(middle, known) + tolerance(i))
      end do
      good = usable .and. .not. apart
    end do
  end function stand_apart

  !> The median of the nearest good samples of the run, on one side of sample i.
  pure subroutine beside(signal, run, good, i, step, middle, known)
    real(wp), intent(in) :: signal(:)
    integer, intent(in) :: run(:), i, step
    logical, intent(in) :: good(:)
    real(wp), intent(out) :: middle
    logical, intent(out) :: known
    real(wp) :: near(neighbours)
    integer :: k, n

    n = 0
    k = i + step
    do while (n < neighbours .and. k >= 1 .and. k <= size(signal))
      if (run(k) /= run(i)) exit
      if (good(k)) then
        n = n + 1
        near(n) = signal(k)
      end if
      k = k + step
    end do
    known = n > 0
    middle = 0
    if (n == 3) middle = sum(near) - maxval(near) - minval(near)
    if (n == 1 .or. n == 2) middle = sum(near(:n))/n
  end subroutine beside

end module outliers
