!> Compares the loads of a measured curve with the loads that its spring permits, and with those of
!> the model. Loads in a wrong unit differ from both by orders of magnitude.
module measured_loads
  use kinds, only: wp
  use text, only: rounded
  use significance, only: stands_out, surely
  use measured_jumps, only: off_baseline
  use fit_request, only: of_sensitivity, farthest_off
  use force_model, only: force_model_t
  use modelled_curve, only: modelled_curve_t
  implicit none
  private
  public :: check_loads, other_order

  !> Factor by which a sensitivity that is not fitted may be wrong; factor between loads of
  !> different orders of magnitude.
  real(wp), parameter :: wrong = 3, order = 10

contains

  !> Sets `trouble` if the load falls more than the spring permits. For any bodies h0 grows with the
  !> position of the base, so that the load falls by at most the spring constant times the travel.
  subroutine check_loads(curve, trouble)
    type(modelled_curve_t), intent(in) :: curve
    character(len=:), allocatable, intent(inout) :: trouble
    real(wp), dimension(size(curve%data%measured%z)) :: left, travel, excess
    logical :: mine(size(left))
    real(wp) :: most, newtons
    integer :: way, near, far

    most = merge(exp(farthest_off), wrong, any(curve%unknown%role == of_sensitivity))/ &
      curve%sensitivity
    newtons = curve%spring*curve%sensitivity
    associate (data => curve%data%measured)
      left = off_baseline(data)
      do way = 1, 2
        mine = data%usable .and. (data%inward .eqv. way == 1)
        if (.not. any(mine)) cycle
        travel = data%facing*data%z
        near = minloc(travel, 1, mine)
        travel = travel - travel(near)
        excess = left(near) - left - most*travel
        far = maxloc(excess, 1, mine)
        if (excess(far) < max(stands_out*curve%data%noise%deviation, &
          0.5_wp*(maxval(left, mine) - minval(left, mine)))) cycle
        trouble = 'the largest load of the data is ' // rounded(maxval(abs(left), mine)*newtons) &
          // ' N, and from contact the load falls by ' // &
          rounded((left(near) - left(far))*newtons) // ' N, where the spring permits ' // &
          rounded(curve%spring*travel(far)) // ' N at most: check the unit of the signal ' // &
          '(units), sensitivity if it is in volts, and spring_constant'
      end do
    end associate
  end subroutine check_loads

  !> The largest tension of the data below the baseline [N], from the mean of the samples that stand
  !> out from the noise; 0 if none does.
  pure real(wp) function largest_tension_of(curve) result(tension)
    type(modelled_curve_t), intent(in) :: curve

    associate (data => curve%data%measured)
      tension = -minval(off_baseline(data), data%usable)
      if (tension < surely*curve%data%noise%deviation) tension = 0
      tension = tension*curve%spring*curve%sensitivity
    end associate
  end function largest_tension_of

  !> A message if the pull-off force of the data has another order of magnitude than that of the
  !> model with the deck's values; otherwise ''. The bodies separate at the pull-off force on the
  !> retract. An approach alone does not show this force, and noise hides a small one.
  function other_order(curve, model) result(words)
    type(modelled_curve_t), intent(in) :: curve
    class(force_model_t), intent(inout), target :: model
    character(len=:), allocatable :: words
    type(modelled_curve_t) :: start
    real(wp) :: tension, own
    logical :: found

    words = ''
    tension = largest_tension_of(curve)
    if (all(curve%data%measured%inward) .or. .not. tension > 0) return
    start = curve
    call start%use_model(model)
    call start%ask(start%unknown%value, .false., found)
    if (.not. found) return
    own = start%response%largest_tension()
    if (own < order*tension .and. tension < order*own) return
    words = 'the largest tension of the data is ' // rounded(tension) // ' N, and that of the ' // &
      'model with the values of the deck ' // rounded(own) // ' N: check the unit of the ' // &
      'signal (units), sensitivity and spring_constant, or start nearer'
  end function other_order

end module measured_loads
