!> Panels short enough for a force law with lengths of its own: barriers, oscillations and steps lie
!> somewhere between the edge and infinity, where no general rule can know of them.
!>
!> The pressure is tried over gaps as bodies have them: undeformed before contact, in contact the
!> gap outside a JKR contact. Panels in z on which the last Legendre coefficients of that pressure
!> are not small are halved.
module law_panels
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, calm_gap
  use discretisation, only: local_nodes_t, gauss_nodes
  implicit none
  private
  public :: fitting_panels, longest

  !> Longest panel in z; how often one is halved; gaps on the axis, or contact radii, that are
  !> tried.
  real(wp), parameter :: longest = 0.7_wp
  integer, parameter :: most_halvings = 6, tried = 9

contains

  !> Lengths in z of panels of so many nodes that lie outside `centre` (0: the axis, 1: the contact
  !> edge) at distances d sinh(z) up to z_length; low, high: contact radii in contact.
  function fitting_panels(problem, centre, d, z_length, low, high, order, digits) result(lengths)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: centre, d, z_length, low, high, digits
    integer, intent(in) :: order
    real(wp), allocatable :: lengths(:)
    type(local_nodes_t) :: local
    real(wp) :: parameter(tried), largest(1)
    integer :: panels, k

    local = gauss_nodes(order)
    largest = abs(problem%law%pressure([problem%law%edge_gap]))
    if (centre > 0) then
      parameter = low*(high/low)**[(real(k, wp)/(tried - 1), k=0, tried - 1)]
    else
      associate (from => problem%law%edge_gap)
        parameter = from*(max(calm_gap(problem), 2*from)/from)** &
          [(real(k, wp)/(tried - 1), k=0, tried - 1)]
      end associate
    end if
    allocate (lengths(0))
    panels = ceiling(z_length/longest)
    do k = 1, panels
      call add((k - 1)*z_length/panels, z_length/panels, 0)
    end do

  contains

    !> Adds the panel from z on, or its halves.
    recursive subroutine add(z, length, halvings)
      real(wp), intent(in) :: z, length
      integer, intent(in) :: halvings

      if (halvings < most_halvings .and. tail_on(z, length) > 10.0_wp**(-digits)*largest(1)) then
        call add(z, 0.5_wp*length, halvings + 1)
        call add(z + 0.5_wp*length, 0.5_wp*length, halvings + 1)
      else
        lengths = [lengths, length]
      end if
    end subroutine add

    !> The largest of the last two Legendre coefficients of the pressure on a panel.
    real(wp) function tail_on(z, length) result(tail)
      real(wp), intent(in) :: z, length
      real(wp) :: pressure(order)
      integer :: j

      tail = 0
      do j = 1, tried
        pressure = problem%law%pressure(gap_at(problem, centre, parameter(j), &
          centre + d*sinh(z + length*local%node)))
        tail = max(tail, abs(coefficient(local, pressure, order - 1)), &
          abs(coefficient(local, pressure, order - 2)))
      end do
    end function tail_on

  end function fitting_panels

  !> The gap at positions x: before contact with the gap h on the axis; in contact, outside a JKR
  !> contact of radius h, whose edge has the gap of largest tension.
  elemental real(wp) function gap_at(problem, centre, h, x) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: centre, h, x
    real(wp) :: angle

    if (.not. centre > 0) then
      gap = h + problem%shape%height(x)
      return
    end if
    angle = acos(min(1/x, 1.0_wp))
    gap = problem%law%edge_gap + problem%shape%hertz_gap(h, x) + &
      2/pi*sqrt(4*pi*problem%coupling*problem%law%adhesion*h)*angle
  end function gap_at

  !> A Legendre coefficient of a function given on Gauss-Legendre nodes.
  pure real(wp) function coefficient(local, value, degree)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: value(:)
    integer, intent(in) :: degree
    real(wp), dimension(size(value)) :: before, now, next
    integer :: k

    before = 1
    now = 2*local%node - 1
    do k = 1, degree - 1
      next = ((2*k + 1)*(2*local%node - 1)*now - k*before)/(k + 1)
      before = now
      now = next
    end do
    coefficient = (2*degree + 1)*sum(local%weight*value*now)
  end function coefficient

end module law_panels
