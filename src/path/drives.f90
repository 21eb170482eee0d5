!> Drives, the controlled quantities Q = a h0 + b F: the position z = h0 - F/k of the base of a
!> spring of stiffness k (a = 1, b = -1/k), h0 itself (a = 1, b = 0), or a dead load -F (a = 0, b =
!> -1).
module drives
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  use interpolation, only: hermite_t
  use traced_path, only: traced_path_t
  use path_point, only: path_point_t, part_of
  implicit none
  private
  public :: drive_t, through_spring

  !> Weights of h0 and load in Q (`path_point`).
  type :: drive_t
    real(wp) :: weights(2) = [1.0_wp, 0.0_wp]
  contains
    procedure :: position
    procedure :: energy
    procedure :: work_between
  end type drive_t

  !> Nodes of the quadrature rule for an interval.
  integer, parameter :: rule = 8

contains

  !> The drive through a spring of stiffness k in units of load over length. k = 0 is a dead load;
  !> if k is infinite, h0 is prescribed.
  pure type(drive_t) function through_spring(k) result(drive)
    real(wp), intent(in) :: k

    if (k > 0) then
      drive%weights = [1.0_wp, -1/k]
    else
      drive%weights = [0.0_wp, -1.0_wp]
    end if
  end function through_spring

  !> Q at a state.
  elemental real(wp) function position(self, point)
    class(drive_t), intent(in) :: self
    type(path_point_t), intent(in) :: point

    position = self%weights(1)*point%state%h0 + self%weights(2)*point%state%load
  end function position

  !> Energy of bodies and spring, or of bodies and dead load. At fixed Q equilibria are stationary
  !> points of this energy; a jump dissipates the difference. The derivative by Q is minus the
  !> conjugate of Q.
  elemental real(wp) function energy(self, point)
    class(drive_t), intent(in) :: self
    type(path_point_t), intent(in) :: point

    if (self%weights(1) > 0) then
      energy = point%energy - 0.5_wp*self%weights(2)*point%state%load**2
    else
      energy = point%energy + point%state%load*point%state%h0
    end if
  end function energy

  !> The integral of the conjugate of Q (the load, or h0 for a dead load) over Q from one place to
  !> another place farther in.
  pure real(wp) function work_between(self, path, from, to) result(work)
    class(drive_t), intent(in) :: self
    type(traced_path_t), intent(in) :: path
    type(path_point_t), intent(in) :: from, to
    type(hermite_t) :: force, driven
    real(wp) :: node(rule), weight(rule), ends(2), x
    integer :: i, k

    call gauss_legendre(node, weight)
    work = 0
    do i = from%interval, to%interval
      if (.not. path%point(i)%leads_on) cycle
      call path%curve_between(i, merge([0.0_wp, 1.0_wp], [1.0_wp, 0.0_wp], self%weights(1) > 0), &
        force, ends)
      call path%curve_between(i, self%weights, driven, ends)
      ends = part_of(ends, i, from, to)
      do k = 1, rule
        x = ends(1) + (ends(2) - ends(1))*node(k)
        work = work + (ends(2) - ends(1))*weight(k)*force%value(x)*driven%slope(x)
      end do
    end do
  end function work_between

end module drives
