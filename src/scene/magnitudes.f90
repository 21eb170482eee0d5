!> Checks that the numbers of a scene, and the units that follow from them, stay within the range of
!> numbers. The calculation is dimensionless, but the units are products of powers of the numbers in
!> the deck.
module magnitudes
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief
  use law_reading, only: check_decades
  use scene_groups, only: scene_t
  implicit none
  private
  public :: check_derived

  !> Decimal order of the largest h0 in the law's lengths; beyond, rounding exceeds this length.
  integer, parameter :: most_lengths = 15

contains

  !> Refuses a scene whose units, coupling or h0 are out of range. It adds logarithms, which cannot
  !> overflow.
  subroutine check_derived(scene, error)
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    real(wp) :: length, pressure, radius, farthest

    radius = log10(scene%shape%radius)
    length = log10(scene%law%length)
    pressure = log10(scene%law%pressure_unit)
    call check(pressure + radius + length, 'loads', ' N')
    if (.not. scene%bodies%rigid) call check(pressure - log10(scene%bodies%stiffness) + &
      0.5_wp*(radius - length), 'a coupling of law and bodies (sigma or Lambda)', '')
    farthest = 0
    if (allocated(scene%loading)) farthest = max(farthest, abs(scene%loading%h0_start), &
      abs(scene%loading%h0_end))
    if (allocated(scene%unloading)) farthest = max(farthest, abs(scene%unloading%h0_end))
    if (allocated(scene%path)) then
      farthest = max(farthest, abs(scene%path%h0_end))
      if (allocated(scene%path%h0_start)) farthest = max(farthest, abs(scene%path%h0_start))
    end if
    if (allocated(scene%device)) then
      if (allocated(scene%device%z_start)) farthest = max(farthest, abs(scene%device%z_start))
      if (allocated(scene%device%z_end)) farthest = max(farthest, abs(scene%device%z_end))
    end if
    if (allocated(scene%classical)) call include_range(scene%classical%h0_start, &
      scene%classical%h0_end)
    if (allocated(scene%approximations)) call include_range(scene%approximations%h0_start, &
      scene%approximations%h0_end)
    if (.not. farthest <= 10.0_wp**most_lengths*scene%law%length) &
      call scene%deck%mistake(trim(scene%law%group), trim(scene%law%length_key), 'h0 reaches '// &
      brief(farthest)//' m, more than 1e15 of these lengths, so that the law is lost in rounding', &
      error)

  contains

    subroutine check(decades, what, unit)
      real(wp), intent(in) :: decades
      character(len=*), intent(in) :: what, unit

      call check_decades(scene%deck, trim(scene%law%group), trim(scene%law%strength_key), decades, &
        what, unit, error)
    end subroutine check

    subroutine include_range(start, finish)
      real(wp), allocatable, intent(in) :: start
      real(wp), intent(in) :: finish

      farthest = max(farthest, abs(finish))
      if (allocated(start)) farthest = max(farthest, abs(start))
    end subroutine include_range

  end subroutine check_derived

end module magnitudes
