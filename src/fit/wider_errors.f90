!> The errors of a fit by the profile likelihood, where derivatives at the best values do not
!> describe the residuals over a few standard errors.
module wider_errors
  use kinds, only: wp
  use fit_request, only: unknown_t, fitted_of, inside
  use fit_residuals, only: fit_residuals_t
  use fit_errors, only: fitted_t, set_deviations, bounded
  implicit none
  private
  public :: widen

  !> out_to: number of standard errors out to which the residuals are examined. lacking: relative
  !> deficit of the rise of the sum of squares that is tolerated. most_steps: largest number of
  !> steps of one examination. corrections: number of corrections of the other unknowns in a step.
  real(wp), parameter :: out_to = 3, lacking = 0.2_wp
  integer, parameter :: most_steps = 6, corrections = 3
  !> Largest change of an unknown by its bounds that is only rounding, over its whole change.
  real(wp), parameter :: rounding = 1.0e-9_wp

contains

  !> Widens the errors where the sum of squares rises less than the derivatives at the best value
  !> predict. For example, a modulus to which a curve is hardly sensitive has no upper limit,
  !> whatever these derivatives are. The standard deviation of a side is then the one at three times
  !> which the sum of squares has risen by 9. If bounds are nearer, or values for which the model
  !> has no curve, it follows from the rise at the farthest possible value. better: the values of a
  !> smaller sum of squares if one was found on the way, otherwise not allocated. If `better` is
  !> absent, a smaller sum counts as a sum that does not rise.
  subroutine widen(residuals, fitted, better)
    class(fit_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(inout) :: fitted
    real(wp), allocatable, intent(out), optional :: better(:)
    type(unknown_t), allocatable :: unknown(:)
    real(wp) :: value(size(fitted%value)), far, rise, room
    logical :: found
    integer :: j, way, step

    unknown = residuals%unknowns()
    do j = 1, size(value)
      do way = 1, 2
        value = fitted%value
        room = room_for(unknown(j), fitted%value(j), way == 2)
        do step = 1, most_steps
          far = min(out_to*fitted%side(way, j), room)
          ! If the bound is nearer than one standard error, the bound decides and not the data.
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
          call widen_others(j)
          if (rise > (1 - lacking)*(far/fitted%side(way, j))**2) exit
          ! If the sum of squares no longer rises, the quotient would be unbounded.
          fitted%side(way, j) = min(2*fitted%side(way, j), far/sqrt(max(rise, tiny(rise))))
        end do
      end do
    end do
    call set_deviations(fitted, unknown)

  contains

    !> Widens the errors of numbers other than j at values with a known rise. Along a curved valley
    !> of the sum of squares another number may move far together with number j, although its own
    !> derivatives do not show this.
    subroutine widen_others(j)
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

    !> Moves fitted number j by `far` from its best value, and the other numbers to the smallest sum
    !> of squares under this condition. rise: this sum minus the best one. value: on entry the
    !> values at which the last step ended.
    subroutine go_to(j, far)
      integer, intent(in) :: j
      real(wp), intent(in) :: far
      real(wp) :: residual(size(fitted%by_fitted, 1)), trial(size(value)), next
      real(wp), dimension(size(value)) :: now, best, move, gradient
      integer :: k

      associate (c => fitted%covariance)
        best = fitted_of(unknown, fitted%value)
        now = fitted_of(unknown, value)
        now = now + c(:, j)/c(j, j)*(best(j) + far - now(j))
        rise = huge(rise)
        do k = 0, corrections
          trial = within_bounds(unknown, now)
          found = abs(fitted_of(unknown(j), trial(j)) - now(j)) <= rounding*abs(far)
          if (found) call residuals%residuals_of(trial, residual, found)
          if (.not. found) exit
          next = sum(residual**2) - fitted%chi_squared
          if (.not. next < rise) exit
          rise = next
          value = trial
          ! A Gauss-Newton step with number j fixed, with the derivatives at the best values.
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
      real(wp) :: sign, u

      sign = merge(1, -1, upward)
      u = fitted_of(unknown, value)
      room = huge(room)
      if (unknown%in_log) room = unknown%farthest(merge(2, 1, upward)) - sign*u
      if (upward .and. allocated(unknown%upper)) &
        room = min(room, fitted_of(unknown, unknown%upper) - u)
      if (.not. upward .and. allocated(unknown%lower)) &
        room = min(room, u - fitted_of(unknown, unknown%lower))
      room = (1 - inside)*room
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

end module wider_errors
