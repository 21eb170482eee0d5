!> The result of a fit, and the errors of its values: from the derivatives of the residuals, or from
!> the profile likelihood if the residuals are nonlinear over a few standard errors.
module fit_errors
  use kinds, only: wp
  use linear_algebra, only: singular_values
  use fit_request, only: unknown_t, fitted_of, value_by_fitted
  use curve_residuals, only: curve_residuals_t
  use second_look, only: lack_t, lack_in
  implicit none
  private
  public :: fitted_t, judge, widen, least_effect, within_95

  !> Half-width of a 95 % interval in standard deviations.
  real(wp), parameter :: within_95 = 1.959964_wp

  !> An unknown has no effect if a change of its fitted number (`fit_request`) by 1 changes the data
  !> by less than this, in standard deviations.
  real(wp), parameter :: least_effect = 0.1_wp
  !> Number of standard errors to which the residuals are examined; the part of its expected rise
  !> that the sum of squares may lack; number of steps of one examination, and of corrections of the
  !> other unknowns in a step.
  real(wp), parameter :: out_to = 3, lacking = 0.2_wp
  integer, parameter :: most_steps = 6, corrections = 3

  !> The result of a fit. value, deviation: each unknown and its standard deviation, in the unit of
  !> its key. fitted_deviation, correlation: the same for the fitted numbers (`fit_request`), whose
  !> errors are symmetric. identifiable: the smallest singular value of their Jacobian with columns
  !> of length 1; 1 if the data determine all unknowns, 0 if they do not. effect: the change of the
  !> curve, in standard deviations of all data together, if the fitted number changes by 1. side(:,
  !> i): standard deviations of fitted number i downward and upward; fitted_deviation(i) is the
  !> larger one. has_path: the model has a path for some start. has_curve: for some start it
  !> describes the samples better with a contact among them than without.
  type :: fitted_t
    logical :: found = .false., has_curve = .false., has_path = .false.
    real(wp), allocatable :: value(:), deviation(:), fitted_deviation(:), correlation(:, :), &
      effect(:), side(:, :)
    real(wp) :: identifiable = 0
    !> Sum of the squared residuals in standard deviations, and its expected value.
    real(wp) :: chi_squared = 0
    integer :: freedom = 0
    !> Standard deviation of a whitened residual, in the unit of the signal.
    real(wp) :: scale = 1
    type(lack_t) :: lack = lack_t()
    !> At all samples: the model with its baseline, the residual, the baseline.
    real(wp), allocatable :: model(:), residual(:), baseline(:)
    !> Position of the base at which the model jumps in and out; NaN without a jump.
    real(wp) :: jump_z(2) = 0
    !> Derivatives of the residuals by the fitted numbers, and the covariance of these.
    real(wp), allocatable, private :: by_fitted(:, :), covariance(:, :)
  contains
    procedure :: end_of
    procedure :: is_better_than
  end type fitted_t

contains

  !> Whether a fit has errors, each of its unknowns has an effect, and it is more likely than
  !> another fit, each with its own noise.
  pure logical function is_better_than(self, other)
    class(fitted_t), intent(in) :: self
    type(fitted_t), intent(in) :: other

    is_better_than = allocated(self%effect)
    if (is_better_than) is_better_than = all(self%effect > least_effect)
    if (is_better_than .and. allocated(other%effect)) is_better_than = surprise(self) < &
      surprise(other)

  contains

    !> Minus twice the logarithm of the likelihood of a sample.
    pure real(wp) function surprise(fitted)
      class(fitted_t), intent(in) :: fitted

      surprise = fitted%chi_squared/fitted%freedom + 2*log(fitted%scale)
    end function surprise

  end function is_better_than

  !> Finds errors and correlations of the values, and the residuals of the curve.
  subroutine judge(residuals, fitted)
    type(curve_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp) :: jacobian(residuals%rows(), size(fitted%value)), residual(residuals%rows())
    real(wp), dimension(size(fitted%value), size(fitted%value)) :: right, covariance
    real(wp), dimension(size(fitted%value)) :: length, singular
    logical :: found
    integer :: i, j, n

    n = size(fitted%value)
    call residuals%residuals_of(fitted%value, residual, found)
    if (found) call residuals%jacobian_of(fitted%value, jacobian, found)
    fitted%found = fitted%found .and. found
    if (.not. found) return
    fitted%chi_squared = sum(residual**2)
    fitted%freedom = size(residual) - n - residuals%curve%data%baseline_numbers()
    associate (data => residuals%curve%data)
      fitted%scale = data%noise%left(data%noise%order)
      fitted%lack = lack_in(residual(:size(data%sample)), 3*data%way(data%sample) + &
        data%side(data%sample), size(data%sample) - n - data%baseline_numbers(), data%noise)
    end associate
    do j = 1, n
      jacobian(:, j) = jacobian(:, j)*value_by_fitted(residuals%curve%unknown(j), fitted%value(j))
    end do
    length = norm2(jacobian, 1)
    fitted%effect = length
    fitted%by_fitted = jacobian
    do j = 1, n
      jacobian(:, j) = jacobian(:, j)/max(length(j), tiny(1.0_wp))
    end do
    call singular_values(jacobian, singular, right)
    fitted%identifiable = minval(singular)
    do i = 1, n
      do j = 1, n
        covariance(i, j) = sum(right(:, i)*right(:, j)/max(singular, epsilon(1.0_wp))**2)
      end do
    end do
    length = max(length, tiny(1.0_wp)**0.25_wp)
    fitted%side = spread([(sqrt(covariance(j, j))/length(j), j=1, n)], 1, 2)
    call set_deviations(fitted, residuals%curve%unknown)
    allocate (fitted%correlation(n, n))
    do j = 1, n
      fitted%correlation(:, j) = &
        [(covariance(i, j)/sqrt(covariance(i, i)*covariance(j, j)), i=1, n)]
    end do
    fitted%covariance = covariance/spread(length, 1, n)/spread(length, 2, n)
    call residuals%curve%split(fitted%value, fitted%model, fitted%baseline)
    fitted%residual = residuals%curve%data%measured%signal - fitted%model
    fitted%jump_z = [(residuals%curve%jump_of(fitted%value, i), i=1, 2)]
  end subroutine judge

  subroutine set_deviations(fitted, unknown)
    type(fitted_t), intent(inout) :: fitted
    type(unknown_t), intent(in) :: unknown(:)
    integer :: j

    fitted%fitted_deviation = maxval(fitted%side, 1)
    fitted%deviation = fitted%fitted_deviation* &
      abs([(value_by_fitted(unknown(j), fitted%value(j)), j=1, size(unknown))])
  end subroutine set_deviations

  !> Increases errors if the sum of squares rises less than its derivatives predict (profile
  !> likelihood): a modulus to which a curve is hardly sensitive has no upper limit. The deviation
  !> of a side is a third of the distance at which the sum rises by nine; if bounds, or values
  !> without a model, are nearer, it follows from the rise at the farthest values. better: allocated
  !> if a smaller sum of squares was found, with its values; if the argument is absent, such a sum
  !> counts as no rise.
  subroutine widen(residuals, fitted, better)
    type(curve_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp), allocatable, intent(out), optional :: better(:)
    real(wp) :: value(size(fitted%value)), far, rise, room
    logical :: found
    integer :: j, way, step

    do j = 1, size(value)
      do way = 1, 2
        value = fitted%value
        room = room_for(residuals%curve%unknown(j), fitted%value(j), way == 2)
        do step = 1, most_steps
          far = min(out_to*fitted%side(way, j), room)
          ! The bound decides, and not the data.
          if (far < fitted%side(way, j)) exit
          call go_to(j, merge(far, -far, way == 2))
          if (.not. found) then
            value = fitted%value
            room = 0.5_wp*far
            cycle
          end if
          if (rise < -1 .and. present(better)) then
            better = value
            return
          end if
          call widen_others(residuals%curve%unknown, j)
          if (rise > (1 - lacking)*(far/fitted%side(way, j))**2) exit
          ! Without a rise this step would be infinite.
          fitted%side(way, j) = min(2*fitted%side(way, j), far/sqrt(max(rise, tiny(rise))))
        end do
      end do
    end do
    call set_deviations(fitted, residuals%curve%unknown)

  contains

    !> Increases the errors of numbers other than j at values with a known rise. Along a curved
    !> valley a number may move far together with number j, which its own derivatives do not show.
    subroutine widen_others(unknown, j)
      type(unknown_t), intent(in) :: unknown(:)
      integer, intent(in) :: j
      real(wp) :: moved
      integer :: k, way

      if (rise > out_to**2) return
      do k = 1, size(value)
        if (k == j) cycle
        moved = fitted_of(unknown(k), value(k)) - fitted_of(unknown(k), fitted%value(k))
        way = merge(2, 1, moved > 0)
        if (rise < (1 - lacking)*(moved/fitted%side(way, k))**2) fitted%side(way, k) = &
          max(fitted%side(way, k), abs(moved)/sqrt(max(rise, 1.0_wp)))
      end do
    end subroutine widen_others

    !> Moves fitted number j by `far` from its best value, and the others to the smallest sum of
    !> squares there, which is `rise` above the best. value: on entry where the last step ended.
    subroutine go_to(j, far)
      integer, intent(in) :: j
      real(wp), intent(in) :: far
      real(wp) :: residual(size(fitted%by_fitted, 1)), trial(size(value)), next
      real(wp), dimension(size(value)) :: now, best, move, gradient
      integer :: k

      associate (unknown => residuals%curve%unknown, c => fitted%covariance)
        best = fitted_of(unknown, fitted%value)
        now = fitted_of(unknown, value)
        now = now + c(:, j)/c(j, j)*(best(j) + far - now(j))
        rise = huge(rise)
        do k = 0, corrections
          trial = within_bounds(unknown, now)
          found = abs(fitted_of(unknown(j), trial(j)) - now(j)) <= 1.0e-9_wp*abs(far)
          if (found) call residuals%residuals_of(trial, residual, found)
          if (.not. found) exit
          next = sum(residual**2) - fitted%chi_squared
          if (.not. next < rise) exit
          rise = next
          value = trial
          ! The step of Gauss and Newton with number j fixed, by the derivatives at the best values.
          gradient = matmul(residual, fitted%by_fitted)
          move = matmul(c, gradient)
          move = move - c(:, j)*move(j)/c(j, j)
          if (dot_product(move, gradient) < lacking) exit
          now = fitted_of(unknown, trial) - move
        end do
        found = rise < huge(rise)
      end associate
    end subroutine go_to

    !> How far a fitted number may move upward or downward from its best value.
    pure real(wp) function room_for(unknown, value, upward) result(room)
      type(unknown_t), intent(in) :: unknown
      real(wp), intent(in) :: value
      logical, intent(in) :: upward
      real(wp), parameter :: within = 1 - 1.0e-6_wp
      real(wp) :: sign, u

      sign = merge(1, -1, upward)
      u = fitted_of(unknown, value)
      room = huge(room)
      if (unknown%in_log) room = unknown%farthest(merge(2, 1, upward)) - sign*u
      if (upward .and. allocated(unknown%upper)) &
        room = min(room, fitted_of(unknown, unknown%upper) - u)
      if (.not. upward .and. allocated(unknown%lower)) &
        room = min(room, u - fitted_of(unknown, unknown%lower))
      room = within*room
    end function room_for

    !> The values of fitted numbers, moved to the nearest bound if they are beyond it.
    elemental real(wp) function within_bounds(unknown, u) result(value)
      type(unknown_t), intent(in) :: unknown
      real(wp), intent(in) :: u

      value = unknown%origin + unknown%scale*u
      if (unknown%in_log) value = unknown%scale*exp(u)
      value = bounded(unknown, value)
    end function within_bounds

  end subroutine widen

  elemental real(wp) function bounded(unknown, value)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    bounded = value
    if (allocated(unknown%lower)) bounded = max(bounded, unknown%lower)
    if (allocated(unknown%upper)) bounded = min(bounded, unknown%upper)
  end function bounded

  !> The end of the interval of `sign` standard deviations about unknown i, limited by its bounds.
  !> For a positive unknown the standard deviations are those of the logarithm.
  pure real(wp) function end_of(self, i, unknown, sign) result(value)
    class(fitted_t), intent(in) :: self
    integer, intent(in) :: i
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: sign
    real(wp), parameter :: largest = 100
    real(wp) :: deviation

    deviation = self%side(merge(2, 1, sign > 0), i)
    value = self%value(i) + sign*deviation*unknown%scale
    if (unknown%in_log) value = self%value(i)*exp(sign*min(deviation, largest))
    value = bounded(unknown, value)
  end function end_of

end module fit_errors
