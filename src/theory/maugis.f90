!> Maugis-Dugdale theory of adhesive contact. A constant tension, `strength`, acts across the gap
!> between the contact radius a and the outer radius c of the cohesive zone, and the gap at c is
!> surface_energy/strength. The theory includes the limits JKR (strong, short-ranged tension) and
!> DMT (weak, long-ranged tension). D. Maugis, J. Colloid Interface Sci. 150, 243 (1992).
!>
!> Units and conventions are those of module classical. The theory is solved in Maugis' units, in
!> which lambda is the only parameter:
!>
!> K = 2 stiffness/3 (4 E*/3), A = a/(pi gamma R^2/K)^(1/3), P = F/(pi gamma R),
!> D = delta/(pi^2 gamma^2 R/K^2)^(1/3), lambda = 2 strength (R/(pi gamma K^2))^(1/3). The width of
!> the zone is t = sqrt(m^2 - 1), m = c/a, which keeps its digits when m is close to one.
module maugis
  use kinds, only: wp, pi, nan
  use root_finding, only: bracket_t, root_search_t, new_root_search
  implicit none
  private
  public :: lennard_jones_strength, maugis_units_t, maugis_units, maugis_t, new_maugis

  !> The quantities whose minimum over the contact radius is computed.
  integer, parameter :: of_load = 1, of_displacement = 2

  !> Maugis' units [N, m, m], in which JKR theory has no parameter.
  type :: maugis_units_t
    real(wp) :: load = 1, radius = 1, displacement = 1
  end type maugis_units_t

  !> The theory for two bodies: its units, and Maugis' parameter lambda. DMT theory holds for lambda
  !> below about 0.1, JKR theory above about 5.
  type :: maugis_t
    type(maugis_units_t) :: unit
    real(wp) :: lambda = 0
  contains
    procedure :: edge_ratio
    procedure :: radius_at_edge_ratio
    procedure :: load
    procedure :: displacement
    procedure :: pull_off
    procedure :: radius_at_displacement
    procedure :: radius_at_load
  end type maugis_t

contains

  !> Cohesive strength [Pa] equal to the largest tension of the Lennard-Jones law (33),
  !> 16 gamma/(9 sqrt(3) z0) = 1.0264 gamma/z0 at h = 3^(1/6) z0. With the same gamma this is
  !> the usual choice; lambda is then 1.157 times Tabor's parameter.
  elemental real(wp) function lennard_jones_strength(surface_energy, z0) result(strength)
    real(wp), intent(in) :: surface_energy, z0

    strength = 16*surface_energy/(9*sqrt(3.0_wp)*z0)
  end function lennard_jones_strength

  !> Maugis' units.
  elemental type(maugis_units_t) function maugis_units(radius, stiffness, surface_energy) &
    result(unit)
    real(wp), intent(in) :: radius, stiffness, surface_energy

    unit%load = pi*surface_energy*radius
    unit%radius = (1.5_wp*pi*surface_energy*radius**2/stiffness)**(1.0_wp/3.0_wp)
    unit%displacement = unit%radius**2/radius
  end function maugis_units

  !> The theory of bodies with a cohesive strength [Pa].
  elemental type(maugis_t) function new_maugis(radius, stiffness, surface_energy, strength) &
    result(theory)
    real(wp), intent(in) :: radius, stiffness, surface_energy, strength

    theory%unit = maugis_units(radius, stiffness, surface_energy)
    theory%lambda = 2*strength*(9*radius/(4*pi*surface_energy*stiffness**2))**(1.0_wp/3.0_wp)
  end function new_maugis

  !> Ratio m = c/a of the outer radius of the cohesive zone to the contact radius a > 0 [m]. It
  !> follows from the condition that the gap at c is surface_energy/strength.
  elemental real(wp) function edge_ratio(self, contact_radius) result(m)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: contact_radius

    m = hypot(1.0_wp, zone_width(contact_radius/self%unit%radius, self%lambda))
  end function edge_ratio

  !> Contact radius [m] at a ratio m = c/a > 1, the inverse of `edge_ratio`.
  elemental real(wp) function radius_at_edge_ratio(self, m) result(contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: m

    contact_radius = self%unit%radius*radius_at_zone_width(sqrt((m - 1)*(m + 1)), self%lambda)
  end function radius_at_edge_ratio

  !> Load [N] at a contact radius a > 0 [m].
  elemental real(wp) function load(self, contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: contact_radius

    load = self%unit%load*scaled(of_load, contact_radius/self%unit%radius, self%lambda)
  end function load

  !> Displacement [m] at a contact radius a > 0 [m].
  elemental real(wp) function displacement(self, contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: contact_radius

    displacement = self%unit%displacement* &
      scaled(of_displacement, contact_radius/self%unit%radius, self%lambda)
  end function displacement

  !> Load [N] at the pull-off under a fixed load, which is negative: the smallest load over all
  !> contact radii.
  elemental real(wp) function pull_off(self)
    class(maugis_t), intent(in) :: self

    pull_off = self%unit%load*scaled(of_load, radius_of_least(of_load, self%lambda), self%lambda)
  end function pull_off

  !> Contact radius [m] at a displacement [m], for the state that is stable at fixed displacement,
  !> which has the largest contact radius. NaN below the smallest displacement of bodies in contact.
  elemental real(wp) function radius_at_displacement(self, displacement) result(contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: displacement

    contact_radius = self%unit%radius* &
      stable_radius(of_displacement, displacement/self%unit%displacement, self%lambda)
  end function radius_at_displacement

  !> Contact radius [m] of the stable state at a load [N]. NaN beyond the pull-off.
  elemental real(wp) function radius_at_load(self, load) result(contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: load

    contact_radius = self%unit%radius*stable_radius(of_load, load/self%unit%load, self%lambda)
  end function radius_at_load

  !> P or D at given A and lambda.
  elemental real(wp) function scaled(quantity, a, lambda) result(value)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: a, lambda
    real(wp) :: t

    t = zone_width(a, lambda)
    if (quantity == of_load) then
      value = a**3 - lambda*a**2*(t + (1 + t**2)*atan(t))
    else
      value = a**2 - 4*lambda/3*a*t
    end if
  end function scaled

  !> The largest A at a given P or D; NaN below the smallest P or D.
  pure real(wp) function stable_radius(quantity, wanted, lambda) result(radius)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: wanted, lambda
    type(root_search_t) :: search
    real(wp) :: a, least, high

    radius = nan
    a = radius_of_least(quantity, lambda)
    least = scaled(quantity, a, lambda)
    if (.not. wanted >= least) return
    ! Above their minima, P and D both increase with A.
    high = max(1.0_wp, 2*a)
    do while (scaled(quantity, high, lambda) < wanted)
      high = 2*high
    end do
    search = new_root_search(a, least - wanted, high, scaled(quantity, high, lambda) - wanted)
    do while (search%is_open())
      radius = search%place()
      call search%note(radius, scaled(quantity, radius, lambda) - wanted)
    end do
    radius = search%root
  end function stable_radius

  !> The A at which P (`of_load`) or D (`of_displacement`) is smallest.
  pure real(wp) function radius_of_least(quantity, lambda) result(a)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: lambda
    ! In JKR theory the smallest load is at A = 1.5^(1/3) = 1.145, and the smallest displacement at
    ! (1/6)^(1/3). With a tension of longer range, both are at a smaller A.
    real(wp), parameter :: a_max = 1.5_wp
    ! The minimum is flat: half of the digits of A determine all digits of the value.
    integer, parameter :: sections = 44
    type(bracket_t) :: bracket
    integer :: i

    bracket = bracket_t(0.0_wp, a_max)
    do i = 1, sections
      call bracket%keep_larger(-scaled(quantity, bracket%golden_points(), lambda))
    end do
    a = bracket%middle()
  end function radius_of_least

  !> t at given A and lambda: the root of
  !> (lambda A^2/2) profile_term(t) + (4 lambda^2 A/3) tension_term(t) = 1.
  !> In logarithms the left side is a smooth curve with a slope between 1 and 3, so that one value
  !> brackets the root, and Newton's method converges from any start.
  elemental real(wp) function zone_width(a, lambda) result(t)
    real(wp), intent(in) :: a, lambda
    integer, parameter :: max_steps = 100
    ! After this accuracy is reached, one more Newton step squares the error.
    real(wp), parameter :: close_enough = 1e-9_wp
    type(bracket_t) :: bracket
    real(wp) :: s, wide, narrow, total, excess
    integer :: step

    wide = lambda*a**2/2
    narrow = 4*lambda**2*a/3
    s = 0
    bracket = bracket_t(-huge(s), huge(s))
    do step = 1, max_steps
      t = exp(s)
      total = wide*profile_term(t) + narrow*tension_term(t)
      excess = log(total)
      if (excess > 0) then
        bracket = bracket_t(max(bracket%low, s - excess), s)
      else
        bracket = bracket_t(s, min(bracket%high, s - excess))
      end if
      s = s - excess*total/(t*(wide*profile_slope(t) + narrow*tension_slope(t)))
      if (abs(excess) <= close_enough) exit
      s = bracket%within(s)
    end do
    t = exp(s)
  end function zone_width

  !> A at given t and lambda, the inverse of `zone_width`: the root of a quadratic.
  elemental real(wp) function radius_at_zone_width(t, lambda) result(a)
    real(wp), intent(in) :: t, lambda
    real(wp) :: linear, quadratic

    quadratic = lambda/2*profile_term(t)
    linear = 4*lambda**2/3*tension_term(t)
    a = 2/(linear + sqrt(linear**2 + 4*quadratic))
  end function radius_at_zone_width

  !> t + (m^2 - 2) atan(t): the term of the gap at c that follows from the shape of the bodies.
  elemental real(wp) function profile_term(t) result(term)
    real(wp), intent(in) :: t

    term = tangent_excess(t) + t**2*atan(t)
  end function profile_term

  !> Derivative of `profile_term`.
  elemental real(wp) function profile_slope(t) result(slope)
    real(wp), intent(in) :: t

    slope = 2*t*(t/(1 + t**2) + atan(t))
  end function profile_slope

  !> t atan(t) - m + 1: the term of the gap at c that follows from the tension, computed without
  !> cancellation.
  elemental real(wp) function tension_term(t) result(term)
    real(wp), intent(in) :: t

    term = t*(atan(t) - t/(1 + sqrt(1 + t**2)))
  end function tension_term

  !> Derivative of `tension_term`.
  elemental real(wp) function tension_slope(t) result(slope)
    real(wp), intent(in) :: t

    slope = atan(t) + t/(1 + t**2) - t/sqrt(1 + t**2)
  end function tension_slope

  !> t - atan(t). For small t it is computed from the continued fraction of the arctangent.
  elemental real(wp) function tangent_excess(t) result(excess)
    real(wp), intent(in) :: t
    real(wp) :: w
    ! Above this t the difference is accurate to a dozen units in the last place; below it eight
    ! terms of the fraction are.
    real(wp), parameter :: small = 0.25_wp
    integer, parameter :: terms = 8
    integer :: k

    if (t > small) then
      excess = t - atan(t)
    else
      w = 0
      do k = terms, 1, -1
        w = (k*t)**2/(2*k + 1 + w)
      end do
      excess = t*w/(1 + w)
    end if
  end function tangent_excess

end module maugis
