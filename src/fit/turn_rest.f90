!> Samples taken at the turn while the base rests. A contact that is held there relaxes or creeps,
!> so that the load changes by more than the travel of the base explains. Such samples depend on
!> time, are no equilibria, and do not count in a fit.
module turn_rest
  use kinds, only: wp
  use significance, only: surely
  use noise, only: noise_t
  use measured_curve, only: measured_curve_t
  implicit none
  private
  public :: leave_out_rest

  !> Smallest number of samples of a rest.
  integer, parameter :: fewest = 4

contains

  !> Marks the samples of rests on both segments as skipped. stiffness: the slope of the spring, in
  !> units of signal over z.
  pure subroutine leave_out_rest(measured, noise, stiffness)
    type(measured_curve_t), intent(inout) :: measured
    type(noise_t), intent(in) :: noise
    real(wp), intent(in) :: stiffness
    integer, allocatable :: at(:)
    integer :: way, i, n

    measured%rested = [(.false., i=1, size(measured%z))]
    do way = 1, 2
      ! The samples of a segment, ordered from the turn on.
      at = pack([(i, i=1, size(measured%z))], measured%usable .and. &
        (measured%inward .eqv. way == 1))
      if (size(at) < 2) cycle
      if (way == 1) at = at(size(at):1:-1)
      n = resting(abs(measured%z(at) - measured%z(at(1))), measured%signal(at), &
        noise%long_deviation(), stiffness)
      measured%rested(at(:n)) = .true.
    end do
    measured%skipped = measured%skipped .or. measured%rested
    measured%usable = measured%usable .and. .not. measured%rested
  end subroutine leave_out_rest

  !> The number of first samples that are a rest. These are all samples within a mean step of the
  !> first one, if the means of two parts of them differ by more than spring and noise explain;
  !> otherwise the number is 0. Every division into two parts is tried, since a load that relaxes
  !> fast changes only in the first few samples.
  pure integer function resting(travel, signal, deviation, stiffness) result(n)
    real(wp), intent(in) :: travel(:), signal(:), deviation, stiffness
    real(wp) :: change, most
    integer :: k

    n = findloc(travel > maxval(travel)/size(travel), .true., 1) - 1
    if (n < fewest) then
      n = 0
      return
    end if
    most = 0
    do k = 1, n - 1
      change = abs(sum(signal(:k))/k - sum(signal(k + 1:n))/(n - k))
      most = max(most, (change - stiffness*maxval(travel(:n)))/ &
        (deviation*sqrt(1.0_wp/k + 1.0_wp/(n - k))))
    end do
    if (.not. most > surely) n = 0
  end function resting

end module turn_rest
