!> The natural scales of a force law, from one look at its pressure: where it vanishes, where it
!> pulls most, how far it reaches, how deep its well is. Solvers know a law by these alone.
module law_scan
  use kinds, only: wp
  use force_law, only: force_law_t
  implicit none
  private
  public :: find_scales

  !> Gaps that are looked at, in the law's lengths: geometrically from `nearest` to `farthest` above
  !> the smallest gap of a law that is singular there, and evenly below for one that is not.
  real(wp), parameter :: nearest = 1.0e-2_wp, farthest = 1.0e5_wp, lowest = -60
  integer, parameter :: geometric = 3000, even = 3000
  !> What is left of a pressure, relative to the largest tension or the unit, where it has ended;
  !> and the length, in lengths beyond the gap at rest, after which a tail no longer matters: where
  !> a repulsion of the ninth power is below that.
  real(wp), parameter :: ended = 1.0e-16_wp, longest = 59

contains

  !> Fills in adhesion, edge_gap, rest_gap and range of a law, unless the law has set its range.
  subroutine find_scales(law)
    class(force_law_t), intent(inout) :: law
    real(wp), allocatable :: gap(:), pressure(:), slope(:)
    real(wp) :: energy(1), least(1)
    integer :: i, rest

    if (law%range > 0) return
    gap = gaps_of(law)
    pressure = law%pressure(gap)
    slope = law%slope(gap)
    rest = 0
    do i = 1, size(gap) - 1
      if (.not. (pressure(i) > 0 .and. pressure(i + 1) <= 0)) cycle
      rest = i
      exit
    end do
    least = law%pressure_unit/law%pressure_unit
    if (rest > 0) then
      law%rest_gap = zero_between(gap(rest), gap(rest + 1), .false.)
      energy = law%energy([law%rest_gap])
      law%adhesion = max(-energy(1), 0.0_wp)
      do i = rest, size(gap) - 1
        if (.not. (slope(i) < 0 .and. slope(i + 1) >= 0)) cycle
        law%edge_gap = zero_between(gap(i), gap(i + 1), .true.)
        least = abs(law%pressure([law%edge_gap]))
        exit
      end do
    end if
    law%range = law%rest_gap + longest
    do i = size(gap), 1, -1
      if (abs(pressure(i)) > ended*least(1)) exit
    end do
    if (i < size(gap) .and. i > 0) law%range = min(law%range, gap(i + 1))

  contains

    !> A zero of the pressure, or of its slope, between two gaps where it has different signs: by
    !> bisection to the last bit, since everything else is built on it.
    real(wp) function zero_between(from, to, of_slope) result(middle)
      real(wp), intent(in) :: from, to
      logical, intent(in) :: of_slope
      real(wp) :: low, high

      low = from
      high = to
      do
        middle = low + 0.5_wp*(high - low)
        if (middle <= low .or. middle >= high) exit
        if ((value(middle, of_slope) > 0) .eqv. (value(low, of_slope) > 0)) then
          low = middle
        else
          high = middle
        end if
      end do
    end function zero_between

    real(wp) function value(gap, of_slope)
      real(wp), intent(in) :: gap
      logical, intent(in) :: of_slope
      real(wp) :: values(1)

      if (of_slope) then
        values = law%slope([gap])
      else
        values = law%pressure([gap])
      end if
      value = values(1)
    end function value

  end subroutine find_scales

  !> The gaps of the scan.
  pure function gaps_of(law) result(gap)
    class(force_law_t), intent(in) :: law
    real(wp), allocatable :: gap(:)
    real(wp) :: base
    integer :: i

    allocate (gap(0))
    base = law%smallest_gap
    if (base < lowest) then
      gap = [(lowest + i*(nearest - lowest)/even, i=0, even - 1)]
      base = 0
    end if
    gap = [gap, (base + nearest*(farthest/nearest)**(real(i, wp)/geometric), i=0, geometric)]
  end function gaps_of

end module law_scan
