!> Two flat charged surfaces in a symmetric electrolyte, by the linear Poisson-Boltzmann equation
!> with charge regulation (Carnie and Chan, J. Colloid Interface Sci. 161, 260, 1993). With
!> x = exp(-h), a = 2 p1 - 1, b = 2 p2 - 1, potentials in kT/(z e), gaps in Debye lengths and
!> pressures in 2 n kT,
!>
!>     e = 2 [y1 y2 x + (b y1^2 + a y2^2) x^2/2]/(1 - a b x^2),   p = -de/dh .
module linear_layers
  use kinds, only: wp
  use poisson_boltzmann, only: surface_t
  implicit none
  private
  public :: linear_values

contains

  !> Pressure, slope and energy at a positive gap.
  pure function linear_values(surface, gap) result(value)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    real(wp) :: value(3), y(2), p(2), sense, x, d, ab, g, mixed, top, top_slope, bottom

    ! Changing the sign of one potential, and p into 1 - p, only changes the sign of the pressure.
    ! The form below loses no digits at small gaps where both p are small; their sum is at most 1.
    y = surface%potential
    p = surface%regulation
    sense = 1
    if (sum(p) > 1) then
      sense = -1
      y(2) = -y(2)
      p = 1 - p
    end if
    x = exp(-gap)
    ! 1 - x
    d = 2*sinh(gap/2)*exp(-gap/2)
    ab = product(2*p - 1)
    g = y(1)*y(2)
    mixed = (y(1) - y(2))*(p(2)*y(1) - p(1)*y(2))
    ! p = 2 x top/bottom^2, top = y1 y2 (1 + a b x^2) + (b y1^2 + a y2^2) x
    top = g*d**2 - (y(1) - y(2))**2*x + 2*x*(mixed + g*(sum(p)*d + 2*product(p)*x))
    top_slope = -2*g*d - (y(1) - y(2))**2 + 2*(mixed + g*(sum(p)*d + 2*product(p)*x)) &
      + 2*x*g*(2*product(p) - sum(p))
    bottom = (1 - ab) + ab*d*(1 + x)
    value(1) = 2*x*top/bottom**2
    value(2) = -2*x*((top + x*top_slope)*bottom + 4*ab*x**2*top)/bottom**3
    value(3) = 2*x*(g*d + (p(2)*y(1)**2 + p(1)*y(2)**2 - (y(1) - y(2))**2/2)*x)/bottom
    value = sense*value
  end function linear_values

end module linear_layers
