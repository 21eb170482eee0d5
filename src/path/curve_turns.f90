!> Where along the path a combination of h0 and load turns round.
module curve_turns
  use kinds, only: wp
  use equilibrium, only: equations_t
  use known_path, only: known_path_t
  use path_curve, only: curve_t
  use curve_states, only: curve_solver_t, curve_state_t, place_t
  implicit none
  private
  public :: find_turning_places

  !> Places of an interval at which the slope is looked at, and the width below which only its ends
  !> are.
  integer, parameter :: looks = 8
  real(wp), parameter :: narrow_interval = 1.0e-4_wp

contains

  !> Where within an interval a combination of h0 and load turns round, in order. The curve's slope
  !> is exact at the interval's ends alone: where it turns more than once, states between say
  !> whether the path does. A load that grows by orders of magnitude makes polynomials swing.
  subroutine find_turning_places(solver, equations, known, i, weights, places)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    real(wp), allocatable, intent(out) :: places(:)
    type(curve_state_t) :: state
    logical, allocatable :: falls(:)
    integer :: k

    places = turning_places(solver%curve, i, weights)
    if (size(places) < 2) return
    falls = [(mod(k, 2) == 0 .eqv. solver%curve%slope(i, weights, begin_x()) < 0, &
      k=0, size(places))]
    do k = 1, size(places) - 1
      call solver%state_of(equations, known, place_t(i, 0.5_wp*(places(k) + places(k + 1))), state)
      if (state%converged) falls(k + 1) = dot_product(weights, state%slopes) < 0
    end do
    places = pack(places, falls(:size(places)) .neqv. falls(2:))

  contains

    real(wp) function begin_x()
      associate (begin => solver%curve%begin_of(i))
        begin_x = begin%x
      end associate
    end function begin_x

  end subroutine find_turning_places

  !> Where within an interval the curve says that a combination of h0 and load turns round, in
  !> order.
  pure function turning_places(curve, i, weights) result(places)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    real(wp), allocatable :: places(:)
    real(wp) :: x, x_before, slope, slope_before
    integer :: k, n

    allocate (places(0))
    associate (begin => curve%begin_of(i), end => curve%end_of(i))
      n = merge(looks, 1, end%x - begin%x > narrow_interval)
      x_before = begin%x
      slope_before = curve%slope(i, weights, x_before)
      do k = 1, n
        x = begin%x + (end%x - begin%x)*k/n
        slope = curve%slope(i, weights, x)
        if ((slope < 0) .neqv. (slope_before < 0)) places = [places, &
          x_before + (x - x_before)*slope_before/(slope_before - slope)]
        x_before = x
        slope_before = slope
      end do
    end associate
  end function turning_places

end module curve_turns
