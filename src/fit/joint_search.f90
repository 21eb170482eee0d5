!> The smallest sum of squares of several curves that share unknowns, starting from the fits of each
!> curve alone.
module joint_search
  use kinds, only: wp
  use linear_algebra, only: factorisation_t, factorise, solve
  use fit_request, only: of_contact_point, fitted_of
  use joint_residuals, only: joint_residuals_t
  use fit_errors, only: fitted_t, find_errors
  use significance, only: chance_of, rarely
  implicit none
  private
  public :: search_all, agree

  !> Largest number of curves whose shared values are tried as starting values, if the combination
  !> of all fits does not lead to agreement.
  integer, parameter :: most_starts = 5
  !> A number added to the diagonal of the normal equations, which keeps rounding from making them
  !> singular.
  real(wp), parameter :: damping = 1.0e-10_wp
  !> Largest change of a logarithm when the fits are combined.
  real(wp), parameter :: farthest = 1

contains

  !> Searches for the smallest sum of squares of all curves. The first start is a combination of the
  !> fits of each curve alone; if the curves do not agree there, further starts have the shared
  !> values of single fits. squares: the sums of squares of the curves alone; other arguments as in
  !> `agree`.
  subroutine search_all(residuals, squares, spared, value, found)
    type(joint_residuals_t), intent(inout) :: residuals
    real(wp), intent(in) :: squares
    integer, intent(in) :: spared
    real(wp), allocatable, intent(out) :: value(:)
    logical, intent(out) :: found
    type(fitted_t) :: alone(size(residuals%part))
    real(wp), allocatable :: trial(:)
    real(wp) :: left, least
    logical :: ended
    integer :: i

    call find_alone(residuals, alone)
    least = huge(least)
    found = .false.
    call combine(residuals, alone, trial)
    do i = 0, min(most_starts, size(alone))
      if (i > 0) call start_from(i)
      where (residuals%unknown%role == of_contact_point) residuals%unknown%origin = trial
      call residuals%descend(trial, left, ended)
      if (.not. (ended .and. left < least)) cycle
      least = left
      found = .true.
      value = trial
      if (agree(left, squares, residuals%rows(), spared)) exit
    end do
    if (.not. found) value = trial
    where (residuals%unknown%role == of_contact_point) residuals%unknown%origin = value

  contains

    !> Searches from the fits of each curve alone, with the shared values of curve i.
    subroutine start_from(i)
      integer, intent(in) :: i
      integer :: k

      do k = size(alone), 1, -1
        trial(residuals%place(:, k)) = alone(k)%value
      end do
      trial(residuals%place(:, i)) = alone(i)%value
    end subroutine start_from

  end subroutine search_all

  !> The fit of each curve alone, with its derivatives.
  subroutine find_alone(residuals, alone)
    type(joint_residuals_t), intent(inout) :: residuals
    type(fitted_t), intent(out) :: alone(:)
    real(wp), allocatable :: residual(:)
    logical :: found
    integer :: i

    do i = 1, size(alone)
      alone(i)%value = residuals%start(:, i)
      residual = spread(0.0_wp, 1, residuals%part(i)%rows())
      call find_errors(residuals%part(i), alone(i), residual, found)
    end do
  end subroutine find_alone

  !> The values that would give the smallest sum of squares of all curves if the residuals were
  !> linear about the fit of each curve alone.
  subroutine combine(residuals, alone, value)
    type(joint_residuals_t), intent(in) :: residuals
    type(fitted_t), intent(in) :: alone(:)
    real(wp), allocatable, intent(out) :: value(:)
    type(factorisation_t) :: normal
    real(wp), allocatable :: move(:), square(:, :)
    integer :: i, k, n

    n = size(residuals%unknown)
    allocate (value(n), move(n), source=0.0_wp)
    allocate (normal%lu(n, n), source=0.0_wp)
    do k = size(alone), 1, -1
      value(residuals%place(:, k)) = alone(k)%value
    end do
    do k = 1, size(alone)
      if (.not. allocated(alone(k)%by_fitted)) cycle
      associate (at => residuals%place(:, k))
        square = matmul(transpose(alone(k)%by_fitted), alone(k)%by_fitted)
        normal%lu(at, at) = normal%lu(at, at) + square
        move(at) = move(at) + matmul(square, fitted_of(residuals%unknown(at), alone(k)%value) - &
          fitted_of(residuals%unknown(at), value(at)))
      end associate
    end do
    do i = 1, n
      normal%lu(i, i) = normal%lu(i, i)*(1 + damping) + tiny(1.0_wp)
    end do
    call factorise(normal)
    if (.not. normal%valid) return
    call solve(normal, move)
    do i = 1, n
      associate (unknown => residuals%unknown(i))
        if (unknown%in_log) then
          value(i) = value(i)*exp(max(-farthest, min(farthest, move(i))))
        else
          value(i) = value(i) + unknown%scale*move(i)
        end if
      end associate
    end do
  end subroutine combine

  !> Whether chance explains the excess of the joint sum of squares over the sum for the curves
  !> fitted alone. rows: number of residuals; spared: by how many fewer values the joint fit has.
  pure logical function agree(left, alone, rows, spared)
    real(wp), intent(in) :: left, alone
    integer, intent(in) :: rows, spared

    agree = .not. rarely(chance_of(left - alone, alone/rows, 2*((spared + 1)/2), 1))
  end function agree

end module joint_search
