!> The scales of a force law, from a scan of its pressure: zeros, largest tension, range, depth of
!> the minimum. Solvers use only these scales and the formulas of a law.
module law_scan
  use kinds, only: wp
  use root_finding, only: bracket_t
  use force_law, only: force_law_t, of_pressure, of_slope, of_energy
  implicit none
  private
  public :: find_scales, surroundings_t, surroundings_of

  !> Features outside the primary minimum, in the law's units: the highest barrier of energy, with
  !> the largest pressure on its far side, and the deepest secondary minimum.
  type :: surroundings_t
    logical :: has_barrier = .false., has_well = .false.
    real(wp) :: barrier_pressure = 0, barrier_energy = 0, well_gap = 0, well_energy = 0
  end type surroundings_t

  !> Gaps of the scan, in lengths L of the law. They are geometrically spaced from `nearest` to
  !> `farthest` above the smallest gap of a singular law. For other laws further gaps are evenly
  !> spaced below.
  real(wp), parameter :: nearest = 1.0e-2_wp, farthest = 1.0e5_wp, lowest = -60
  integer, parameter :: geometric = 3000, even = 3000
  !> A law ends where its pressure is smaller than this fraction of the largest tension or of the
  !> unit, or at this number of lengths beyond the equilibrium separation.
  real(wp), parameter :: ended = 1.0e-16_wp, longest = 59
  !> Pressures smaller than this one count as zero.
  real(wp), parameter :: vanished = 1.0e-100_wp
  !> Error of the local exponent below which the pressure counts as a power of the gap.
  real(wp), parameter :: settled = 1.0e-2_wp
  !> Barriers and secondary minima whose pressures are smaller than this fraction of the largest
  !> tension are ignored.
  real(wp), parameter :: nothing = 1.0e-12_wp

contains

  !> Sets the scales of a law, unless the law has set its range itself.
  subroutine find_scales(law)
    class(force_law_t), intent(inout) :: law
    real(wp), allocatable :: gap(:), pressure(:), slope(:)
    real(wp) :: largest, ends
    integer :: i, rest

    if (law%range > 0) then
      law%work = law%adhesion
      return
    end if
    gap = gaps_of(law)
    pressure = law%pressure(gap)
    ! Exponentials below this underflow, and their signs are meaningless.
    i = findloc(abs(pressure) > vanished, .true., 1, back=.true.)
    gap = gap(:i)
    pressure = pressure(:i)
    slope = law%slope(gap)
    if (pressure(1) < 0) then
      law%falls_below = huge(1.0_wp)
      ends = huge(1.0_wp)
      i = next_zero(pressure, 1, falling=.false.)
      if (i > 0) then
        ends = zero_between(law, gap(i), gap(i + 1), of_pressure)
        law%falls_below = ends
        i = next_zero(slope, i, falling=.true.)
        if (i > 0) law%falls_below = zero_between(law, gap(i), gap(i + 1), of_slope)
      end if
    end if
    rest = next_zero(pressure, 1, falling=.true.)
    largest = 1
    if (rest > 0) then
      law%rest_gap = zero_between(law, gap(rest), gap(rest + 1), of_pressure)
      law%work = -law%at(of_energy, law%rest_gap)
      law%adhesion = law%work
      i = next_zero(pressure, rest + 1, falling=.false.)
      if (i > 0) law%adhesion = law%work + &
        law%at(of_energy, zero_between(law, gap(i), gap(i + 1), of_pressure))
      i = next_zero(slope, rest, falling=.false.)
      if (i > 0) then
        law%edge_gap = zero_between(law, gap(i), gap(i + 1), of_slope)
        largest = -law%at(of_pressure, law%edge_gap)
        law%outer_edges = [real(wp) ::]
        do
          i = next_zero(slope, i + 1, falling=.false.)
          if (i == 0) exit
          if (pressure(i) < -nothing*largest) law%outer_edges = [law%outer_edges, &
            zero_between(law, gap(i), gap(i + 1), of_slope)]
        end do
      end if
    else if (law%falls_below > 0) then
      call find_adhesion_without_rest(law, ends)
    end if
    if (law%tail_power < huge(1.0_wp)) then
      i = findloc(abs(gap*slope + law%tail_power*pressure) > settled*abs(pressure), &
        .true., 1, back=.true.)
      if (i > 0) law%power_from = gap(i)
    end if
    law%range = law%rest_gap + longest
    i = findloc(abs(pressure) > ended*largest, .true., 1, back=.true.)
    if (i > 0 .and. i < size(gap)) law%range = min(law%range, gap(i + 1))
  end subroutine find_scales

  !> Sets adhesion and work of a law without an equilibrium separation, whose attraction ends at a
  !> gap, or nowhere. The work of adhesion is the energy at contact. For a singular law this energy
  !> would be infinite. In this case work is 0, and adhesion is only a scale: the energy at a gap of
  !> one length, or at half the gap where the attraction ends.
  subroutine find_adhesion_without_rest(law, ends)
    class(force_law_t), intent(inout) :: law
    real(wp), intent(in) :: ends
    real(wp) :: from

    from = law%gap_of(0.0_wp)
    if (law%smallest_gap <= from) then
      law%work = -law%at(of_energy, from)
    else
      from = min(1.0_wp, 0.5_wp*ends)
    end if
    law%adhesion = -law%at(of_energy, from)
    if (ends < huge(1.0_wp)) law%adhesion = law%adhesion + law%at(of_energy, ends)
  end subroutine find_adhesion_without_rest

  !> Finds the features outside the primary minimum.
  type(surroundings_t) function surroundings_of(law) result(found)
    class(force_law_t), intent(in) :: law
    real(wp), allocatable :: gap(:), pressure(:)
    logical, allocatable :: counts(:)
    real(wp) :: top, bottom, depth
    integer :: i, j, peak

    if (.not. law%edge_gap > 0) return
    gap = gaps_of(law)
    pressure = law%pressure(gap)
    ! Smaller pressures are negligible or rounding errors. A barrier that decays into them has no
    ! secondary minimum.
    counts = abs(pressure) >= nothing*abs(law%at(of_pressure, law%edge_gap))
    gap = pack(gap, counts)
    pressure = pack(pressure, counts)
    i = next_zero(pressure, 1, falling=.true.)
    if (i == 0) return
    do
      j = next_zero(pressure, i + 1, falling=.false.)
      if (j == 0) return
      i = next_zero(pressure, j + 1, falling=.true.)
      top = zero_between(law, gap(j), gap(j + 1), of_pressure)
      peak = j + maxloc(pressure(j + 1:merge(i, size(gap), i > 0)), 1)
      if (.not. pressure(peak) > 0) return
      if (.not. found%has_barrier .or. law%at(of_energy, top) > found%barrier_energy) then
        found%barrier_energy = law%at(of_energy, top)
        found%barrier_pressure = pressure(peak)
        if (peak > 1 .and. peak < size(gap)) found%barrier_pressure = &
          law%at(of_pressure, zero_between(law, gap(peak - 1), gap(peak + 1), of_slope))
        found%has_barrier = .true.
      end if
      if (i == 0) return
      bottom = zero_between(law, gap(i), gap(i + 1), of_pressure)
      depth = -law%at(of_energy, bottom)
      if (.not. found%has_well .or. depth > -found%well_energy) then
        found%has_well = .true.
        found%well_gap = bottom
        found%well_energy = -depth
      end if
    end do
  end function surroundings_of

  !> The first index at or after `from` after which values change their sign from positive to
  !> negative (falling) or from negative to positive; 0 if there is none.
  pure integer function next_zero(value, from, falling) result(i)
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: from
    logical, intent(in) :: falling

    do i = from, size(value) - 1
      if (falling .and. value(i) > 0 .and. value(i + 1) <= 0) return
      if (.not. falling .and. value(i) < 0 .and. value(i + 1) >= 0) return
    end do
    i = 0
  end function next_zero

  !> A zero of the pressure or of its slope (`quantity`), between two gaps at which the signs
  !> differ. It is bisected to rounding accuracy, since all scales depend on the result.
  real(wp) function zero_between(law, from, to, quantity) result(middle)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: from, to
    integer, intent(in) :: quantity
    type(bracket_t) :: bracket
    logical :: positive

    bracket = bracket_t(from, to)
    positive = law%at(quantity, from) > 0
    do while (bracket%is_open())
      call bracket%narrow((law%at(quantity, bracket%middle()) > 0) .eqv. positive)
    end do
    middle = bracket%middle()
  end function zero_between

  !> The gaps of the scan, in ascending order. A step of the law may be narrower than the spacing of
  !> these gaps; therefore gaps within the step are added.
  pure function gaps_of(law) result(gap)
    class(force_law_t), intent(in) :: law
    real(wp), allocatable :: gap(:)
    real(wp), allocatable :: through(:)
    real(wp) :: base
    integer :: i

    allocate (gap(0))
    base = law%smallest_gap
    if (base < lowest) then
      gap = [(lowest + i*(nearest - lowest)/even, i=0, even - 1)]
      base = 0
    end if
    gap = [gap, (base + nearest*(farthest/nearest)**(real(i, wp)/geometric), i=0, geometric)]
    if (.not. law%step_width > 0) return
    through = law%step_at + law%step_width*[(0.5_wp*i, i=-16, 16)]
    ! A wide step may begin at contact.
    through = pack(through, through > gap(1))
    ! A step at gaps smaller than all of the scan is part of contact.
    if (size(through) == 0) return
    gap = [pack(gap, gap < through(1)), through, pack(gap, gap > through(size(through)))]
  end function gaps_of

end module law_scan
