!> The interface of all shapes of the two bodies. The shape is the gap f(r) between the bodies when
!> they touch without force. A shape is a type that extends this one. It stands in a file of its own
!> under shapes/, with its keys, their reader, its parameters and formulas.
!>
!> Formulas are in the units of `dimensionless_problem`: lateral positions in units of l, heights in
!> lengths L of the force law. Each shape chooses l. With the radius l^2/L, all equations are those
!> of the parabola r^2/(2R), whose l is sqrt(R L). Shapes are convex, and smooth except at `breaks`.
!>
!> The theory of contact needs two integrals of the slope, after Galin and Sneddon: the indentation
!> q(a) of a rigid body of this shape with contact radius a, and the load for this indentation.
module shape
  use kinds, only: wp, pi
  use quadrature, only: gauss_legendre
  use root_finding, only: bracket_t, root_search_t, new_root_search
  implicit none
  private
  public :: shape_t

  type, abstract :: shape_t
    !> The radius l^2/L [m], where l is the lateral unit.
    real(wp) :: radius = 1
    !> Whether the shape is the parabola, for which the load of rigid bodies is 2 pi times the law's
    !> energy.
    logical :: parabolic = .false.
    !> The power of r that describes the shape near the axis (0 if there is none), and the power at
    !> large r.
    real(wp) :: exponent = 2, growth = 2
    !> Positions between 0 and infinity at which the slope or one of its derivatives jumps.
    real(wp), allocatable :: breaks(:)
    !> Position at which the body ends. Farther out the shape only defines a gap.
    real(wp) :: ends = huge(1.0_wp)
    !> Position of the last point, if the shape was read from a file.
    real(wp) :: known_to = huge(1.0_wp)
  contains
    !> f(r) and f'(r) at positions r >= 0.
    procedure(profile_function), deferred :: height
    procedure(profile_function), deferred :: slope
    procedure :: position_of
    procedure :: bend
    procedure :: unlike_scaling
    procedure :: indentation
    procedure :: rough_indentation
    procedure :: indentation_load
    procedure :: contact_radius
    procedure :: opening
    procedure :: hertz_gap
    procedure :: smooth_from
    procedure :: is_even
  end type shape_t

  abstract interface
    elemental real(wp) function profile_function(self, r) result(value)
      import :: shape_t, wp
      class(shape_t), intent(in) :: self
      real(wp), intent(in) :: r
    end function profile_function
  end interface

  !> Number of points of the quadratures; smallest number of points in each piece between breaks;
  !> number of points for estimates.
  integer, parameter :: points = 48, fewest = 4, rough = 12

contains

  !> The position at which the shape has a given height >= 0.
  elemental real(wp) function position_of(self, height) result(r)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: height
    type(bracket_t) :: bracket

    bracket = bracket_t(0.0_wp, 1.0_wp)
    do while (self%height(bracket%high) < height)
      bracket%high = 2*bracket%high
    end do
    do while (bracket%is_open())
      call bracket%narrow(self%height(bracket%middle()) < height)
    end do
    r = bracket%high
  end function position_of

  !> f(r + dr) - f(r) - f'(r) dr, the remainder after the linear term.
  elemental real(wp) function bend(self, r, dr)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: r, dr

    bend = self%height(r + dr) - self%height(r) - self%slope(r)*dr
  end function bend

  !> x f'(c x) - f(c x)/c: the derivative of f(c x) by c, minus the derivative that f would have if
  !> it were proportional to c.
  elemental real(wp) function unlike_scaling(self, c, x) result(change)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: c, x

    change = x*self%slope(c*x) - self%height(c*x)/c
  end function unlike_scaling

  !> q(a) = a Int_0^a f'(r)/sqrt(a^2 - r^2) dr, with r = a sin(t).
  elemental real(wp) function indentation(self, a)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a

    indentation = a*slope_integral(self, a, 0)
  end function indentation

  !> Int_0^a [q(a) - q(x)] dx = Int_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr; the load is 2 E* times this.
  elemental real(wp) function indentation_load(self, a) result(load)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a

    load = a**2*slope_integral(self, a, 2)
  end function indentation_load

  !> Int f'(a sin t) sin(t)^power dt from 0 to pi/2, in pieces between breaks.
  pure real(wp) function slope_integral(self, a, power) result(total)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a
    integer, intent(in) :: power
    real(wp), allocatable :: ends(:), x(:), w(:), sines(:)
    integer :: i, n

    allocate (ends(0))
    if (allocated(self%breaks)) ends = asin(pack(self%breaks, self%breaks < a)/a)
    ends = [0.0_wp, ends, 0.5_wp*pi]
    n = max(fewest, points/(size(ends) - 1))
    allocate (x(n), w(n))
    call gauss_legendre(x, w)
    total = 0
    do i = 1, size(ends) - 1
      sines = sin(ends(i) + (ends(i + 1) - ends(i))*x)
      total = total + (ends(i + 1) - ends(i))*sum(w*self%slope(a*sines)*sines**power)
    end do
  end function slope_integral

  !> The inverse of `indentation`; 0 if there is no indentation.
  elemental real(wp) function contact_radius(self, depth) result(a)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: depth
    type(root_search_t) :: search
    real(wp) :: high, excess

    a = 0
    if (.not. depth > 0) return
    high = 1
    do
      excess = self%indentation(high) - depth
      if (.not. excess < 0) exit
      high = 2*high
    end do
    search = new_root_search(0.0_wp, -depth, high, excess)
    do while (search%is_open())
      a = search%place()
      call search%note(a, self%indentation(a) - depth)
    end do
    a = search%root
  end function contact_radius

  !> How fast the gap opens outside a contact of radius a without adhesion. At the distance s from
  !> the edge it is proportional to sqrt(opening) s^(3/2); for the parabola `opening` is a.
  elemental real(wp) function opening(self, a)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a
    real(wp), parameter :: part = 0.01_wp

    opening = ((self%indentation(a*(1 + part)) - self%indentation(a*(1 - part)))/(4*part*a))**2/a
  end function opening

  !> A less accurate `indentation` for estimates, at several radii.
  pure function rough_indentation(self, a) result(indentation)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a(:)
    real(wp) :: indentation(size(a))

    indentation = self%indentation(a)
  end function rough_indentation

  !> The gap outside a contact of radius a without adhesion, at r = a (1 + beyond), for estimates:
  !> 2/pi Int_a^r [q(t) - q(a)]/sqrt(r^2 - t^2) dt.
  pure function hertz_gap(self, a, beyond) result(gap)
    class(shape_t), intent(in) :: self
    real(wp), intent(in) :: a, beyond(:)
    real(wp) :: gap(size(beyond))
    real(wp) :: node(rough), weight(rough), angle(size(beyond)), depth(0:size(beyond)*rough)
    integer :: k

    call gauss_legendre(node, weight)
    angle = atan(sqrt(beyond*(2 + beyond)))
    depth = self%rough_indentation([a, (a*(1 + beyond)*cos(angle*node(k)), k=1, rough)])
    gap = 2/pi*angle*(matmul(reshape(depth(1:), [size(beyond), rough]), weight) - depth(0))
  end function hertz_gap

  !> Position beyond which the body is smooth up to its end; 0 if it is smooth everywhere except on
  !> the axis.
  pure real(wp) function smooth_from(self) result(r)
    class(shape_t), intent(in) :: self

    r = 0
    if (allocated(self%breaks)) r = maxval([0.0_wp, pack(self%breaks, self%breaks < self%ends)])
  end function smooth_from

  !> Whether the shape is an even function of r, and therefore smooth on its axis.
  pure logical function is_even(self)
    class(shape_t), intent(in) :: self

    is_even = .not. abs(self%exponent - 2*nint(0.5_wp*self%exponent)) > 0
  end function is_even

end module shape
