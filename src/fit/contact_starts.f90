!> Where a fit may start from: contact points at which a model with the values of the deck leaves
!> least of the measured curve. Moving the curve along needs no new solution, so that many are
!> tried.
module contact_starts
  use kinds, only: wp
  use root_finding, only: bracket_t
  use fit_request, only: of_contact_point
  use noise, only: white_noise
  use curve_residuals, only: curve_residuals_t
  implicit none
  private
  public :: find_starts

  !> Contact points that are tried, samples for each, and sections by which the best are refined.
  integer, parameter :: tried = 160, samples = 250, sections = 25

contains

  !> Contact points from which to start, best first, and the sum of squares there, which has its
  !> lowest minima at them. value: the unknowns; found = .false.: the model has no curve there.
  subroutine find_starts(residuals, value, most, starts, costs, found)
    type(curve_residuals_t), intent(in) :: residuals
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: most
    real(wp), allocatable, intent(out) :: starts(:), costs(:)
    logical, intent(out) :: found
    type(curve_residuals_t) :: few
    type(bracket_t) :: bracket
    real(wp) :: at(0:tried + 1), cost(0:tried + 1), ends(2), points(2)
    integer :: i, k, role

    few = residuals
    few%curve%data%noise = white_noise(residuals%curve%data%noise%deviation)
    call few%curve%data%take(max(1, size(few%curve%data%measured%z)/samples))
    call few%curve%reach(value, ends, found)
    allocate (starts(0), costs(0))
    if (.not. found) return
    role = findloc(few%curve%unknown%role, of_contact_point, 1)
    at = [(ends(1) + (ends(2) - ends(1))*(i - 1)/(tried - 1), i=0, tried + 1)]
    cost = [(cost_at(at(i)), i=0, tried + 1)]
    do i = 1, tried
      if (.not. (cost(i) <= cost(i - 1) .and. cost(i) < cost(i + 1))) cycle
      bracket = bracket_t(at(i - 1), at(i + 1))
      do k = 1, sections
        points = bracket%golden_points()
        call bracket%keep_larger([-cost_at(points(1)), -cost_at(points(2))])
      end do
      starts = [starts, bracket%middle()]
      costs = [costs, cost_at(bracket%middle())]
    end do
    found = size(starts) > 0
    if (.not. found) return
    do i = 1, min(most, size(starts))
      k = i - 1 + minloc(costs(i:), 1)
      starts([i, k]) = starts([k, i])
      costs([i, k]) = costs([k, i])
    end do
    k = min(most, size(starts))
    starts = starts(:k)
    costs = costs(:k)

  contains

    real(wp) function cost_at(contact_point) result(total)
      real(wp), intent(in) :: contact_point
      real(wp) :: trial(size(value)), residual(few%rows())
      logical :: there

      trial = value
      trial(role) = contact_point
      call few%residuals_of(trial, residual, there)
      total = huge(total)
      if (there) total = sum(residual**2)
    end function cost_at

  end subroutine find_starts

end module contact_starts
