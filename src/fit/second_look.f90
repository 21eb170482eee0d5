!> A second examination of the data with a fitted model: residuals show noise, outliers and jumps
!> better than the curve itself.
module second_look
  use kinds, only: wp
  use noise, only: noise_t, noise_of, white_noise, noise_of_steps, median_of, normal_median, &
    stand_apart
  use measured_jumps, only: measured_jump_t, likely_jump
  use modelled_curve, only: modelled_curve_t
  implicit none
  private
  public :: look_again

  !> Standard deviations above which a sample is an outlier; one good sample in 150,000 exceeds
  !> this.
  real(wp), parameter :: apart = 4.5_wp
  !> Number of far samples that suffices to find a correlation of the noise; standard errors by
  !> which the noise far from contact must differ from the noise elsewhere.
  integer, parameter :: enough = 50
  real(wp), parameter :: differs = 4

contains

  !> Finds noise, outliers and jumps again. value: the best fit so far. keep_noise: the noise is
  !> given. settled: there was no significant change.
  subroutine look_again(curve, value, keep_noise, settled)
    type(modelled_curve_t), intent(inout) :: curve
    real(wp), intent(in) :: value(:)
    logical, intent(in) :: keep_noise
    logical, intent(out) :: settled
    real(wp), allocatable :: model(:), baseline(:), left(:)
    logical, allocatable :: usable(:)
    type(measured_jump_t) :: jump
    real(wp) :: deviation, spread
    integer :: way

    call curve%split(value, model, baseline)
    left = curve%data%measured%signal - model
    associate (data => curve%data)
      usable = data%measured%usable
      deviation = data%noise%deviation
      ! A wrong model leaves large residuals nearly everywhere.
      spread = max(deviation, median_of(abs(left(data%sample)))/normal_median)
      ! Near a jump, on whose side the model may be wrong, outliers are kept.
      data%measured%usable = merge(usable, .not. (data%measured%skipped .or. &
        stand_apart(left, 3*data%way + data%side, .not. data%measured%skipped, &
        [(apart*spread, way=1, size(left))])), data%side < 0)
      settled = all(usable .eqv. data%measured%usable)
      if (.not. keep_noise) call renew_noise(curve, left)
      settled = settled .and. abs(data%noise%deviation - deviation) < 0.01_wp*deviation
      do way = 1, 2
        if (curve%response%way(way)%main == 0 .or. .not. any(data%way == way)) cycle
        jump = jump_by_model(curve, value, baseline, left, way)
        settled = settled .and. jump%before == data%jump(way)%before .and. jump%after == &
          data%jump(way)%after .and. abs(jump%z - data%jump(way)%z) <= 0.1_wp*jump%uncertainty
        data%jump(way) = jump
      end do
    end associate
    call curve%data%take(1)
  end subroutine look_again

  !> Finds the noise of the residuals, of all samples if possible.
  subroutine renew_noise(curve, left)
    type(modelled_curve_t), intent(inout) :: curve
    real(wp), intent(in) :: left(:)
    type(noise_t) :: far_noise, all_noise
    logical :: far(size(left))
    integer :: steps

    associate (data => curve%data)
      far = .false.
      far(data%sample) = data%measured%far(data%sample)
      far = far .and. data%measured%usable
      call noise_of_steps(left(data%sample), data%run(data%sample), all_noise, steps)
      if (steps < enough) return
      if (count(far) >= enough) then
        far_noise = noise_of(pack(data%measured%z, far), pack(left, far), pack(data%way, far))
        if (far_noise%order > 0 .or. abs(log(all_noise%deviation/far_noise%deviation)) > &
          differs*sqrt(0.5_wp/count(far) + 0.75_wp/steps)) all_noise = far_noise
      end if
      if (all_noise%deviation > 0) data%noise = all_noise
      if (data%noise%deviation < data%least_noise) data%noise = white_noise(data%least_noise)
    end associate
  end subroutine renew_noise

  !> The jump of the curve from one branch of the model to the other.
  type(measured_jump_t) function jump_by_model(curve, value, baseline, left, way) result(jump)
    type(modelled_curve_t), intent(in) :: curve
    real(wp), intent(in) :: value(:), baseline(:), left(:)
    integer, intent(in) :: way
    integer, allocatable :: at(:)
    real(wp), allocatable :: before(:), after(:), bare(:)
    real(wp) :: unit
    integer :: i

    associate (data => curve%data)
      at = pack([(i, i=1, size(left))], data%way == way)
      unit = data%noise%long_deviation()**2*max(1.0_wp, sum(left(data%sample)**2)/ &
        size(data%sample)/data%noise%deviation**2)
      bare = data%measured%signal(at) - baseline(at)
      before = curve%signal_of(value, at, side=1)
      after = curve%signal_of(value, at, side=2)
      i = minloc(abs(data%measured%z(at) - curve%jump_of(value, way)), 1)
      if (.not. curve%response%way(way)%foretold) i = size(at)/2
      associate (change => after(i) - before(i))
        before = merge((bare - before)**2/unit, 0.0_wp, .not. data%measured%skipped(at))
        after = merge((bare - after)**2/unit, 0.0_wp, .not. data%measured%skipped(at))
        jump = likely_jump(data%measured%z(at), before, after, change, sqrt(unit), at(1))
      end associate
      if (jump%before > 0) jump%change = data%measured%signal(jump%after) - &
        data%measured%signal(jump%before)
    end associate
  end function jump_by_model

end module second_look
