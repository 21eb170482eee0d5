!> Whether the numbers of a scene, and what follows from them, stay within the range of numbers.
!> The calculation is dimensionless and minds no unit, but the units themselves are products of
!> powers of what the deck gives.
module magnitudes
  use kinds, only: wp, pi
  use failure, only: failure_t
  use text, only: brief
  use deck, only: deck_t
  use scene_groups, only: scene_t
  implicit none
  private
  public :: check_derived

  !> Decades, either way, that the units and the coupling may have.
  integer, parameter :: most_derived = 100
  !> Values of h0 in the law's lengths: beyond this many, rounding is longer than the law.
  integer, parameter :: most_lengths = 15

contains

  !> Refuses a scene whose units, coupling or h0 are out of range. Sums of logarithms cannot
  !> overflow.
  subroutine check_derived(scene, error)
    type(scene_t), intent(in) :: scene
    type(failure_t), allocatable, intent(inout) :: error
    real(wp) :: length, pressure, radius, farthest
    character(len=:), allocatable :: key

    radius = log10(scene%bodies%radius)
    if (scene%force%law == 'lennard_jones') then
      key = 'hamaker'
      length = log10(scene%force%z0)
      pressure = log10(scene%force%hamaker) - log10(16*pi) - 3*length
    else
      key = 'p0'
      length = log10(scene%force%decay_length)
      pressure = log10(scene%force%p0)
    end if
    call check(pressure, 'a pressure of 1e', ' Pa')
    call check(pressure + radius + length, 'loads of 1e', ' N')
    if (.not. scene%bodies%rigid) call check(pressure - log10(scene%bodies%stiffness) + &
      0.5_wp*(radius - length), 'a coupling of law and bodies (sigma or Lambda) of 1e', '')
    farthest = 0
    if (allocated(scene%loading)) farthest = max(farthest, abs(scene%loading%h0_start), &
      abs(scene%loading%h0_end))
    if (allocated(scene%unloading)) farthest = max(farthest, abs(scene%unloading%h0_end))
    if (allocated(scene%path)) then
      farthest = max(farthest, abs(scene%path%h0_end))
      if (allocated(scene%path%h0_start)) farthest = max(farthest, abs(scene%path%h0_start))
    end if
    if (allocated(scene%classical)) call include_range(scene%classical%h0_start, &
      scene%classical%h0_end)
    if (allocated(scene%approximations)) call include_range(scene%approximations%h0_start, &
      scene%approximations%h0_end)
    if (.not. farthest <= 10.0_wp**most_lengths*10.0_wp**length) call scene%deck%mistake('force', &
      length_key(), 'h0 reaches '//brief(farthest)//' m, more than 1e15 of these lengths, so '// &
      'that the law is lost in rounding', error)

  contains

    subroutine check(decades, what, unit)
      real(wp), intent(in) :: decades
      character(len=*), intent(in) :: what, unit

      if (.not. abs(decades) <= most_derived) call scene%deck%mistake('force', key, &
        'these values of &bodies and &force make '//what//brief(real(nint(decades), wp))//unit// &
        '; allowed: from 1e-100 to 1e100', error)
    end subroutine check

    subroutine include_range(start, finish)
      real(wp), allocatable, intent(in) :: start
      real(wp), intent(in) :: finish

      farthest = max(farthest, abs(finish))
      if (allocated(start)) farthest = max(farthest, abs(start))
    end subroutine include_range

    function length_key()
      character(len=:), allocatable :: length_key

      length_key = 'decay_length'
      if (key == 'hamaker') length_key = 'z0'
    end function length_key

  end subroutine check_derived

end module magnitudes
