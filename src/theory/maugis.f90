!> Maugis-Dugdale theory of adhesive contact: a constant tension, `strength`, acts across the gap
!> between the contact radius a and the outer radius c of the cohesive zone, and the gap at c is
!> surface_energy/strength. It spans JKR (strong, short-ranged) and DMT (weak, long-ranged).
!> D. Maugis, J. Colloid Interface Sci. 150, 243 (1992).
!>
!> Units and conventions are those of module classical; `maugis_scaled` solves the theory in its own
!> units.
module maugis
  use kinds, only: wp, pi
  use maugis_scaled, only: find_least, of_displacement, of_load, radius_at_zone_width, &
    scaled_displacement, scaled_load, stable_radius, zone_width
  implicit none
  private
  public :: lennard_jones_strength, maugis_units_t, maugis_units, maugis_t, new_maugis

  !> Maugis' units [N, m, m], in which JKR theory has no parameter.
  type :: maugis_units_t
    real(wp) :: load = 1, radius = 1, displacement = 1
  end type maugis_units_t

  !> The theory of two bodies: its units, and Maugis' parameter lambda, DMT below about 0.1, JKR
  !> above about 5.
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
    theory%lambda = &
      2*strength*(9*radius/(4*pi*surface_energy*stiffness**2))**(1.0_wp/3.0_wp)
  end function new_maugis

  !> Ratio m = c/a of cohesive zone to contact radius at a contact radius a > 0 [m]: the gap at c is
  !> surface_energy/strength.
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

    load = self%unit%load*scaled_load(contact_radius/self%unit%radius, self%lambda)
  end function load

  !> Displacement [m] at a contact radius a > 0 [m].
  elemental real(wp) function displacement(self, contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: contact_radius

    displacement = self%unit%displacement* &
      scaled_displacement(contact_radius/self%unit%radius, self%lambda)
  end function displacement

  !> Load [N] at the pull-off under a fixed load, negative: the least load over all contact radii.
  elemental real(wp) function pull_off(self)
    class(maugis_t), intent(in) :: self
    real(wp) :: a, least

    call find_least(of_load, self%lambda, a, least)
    pull_off = self%unit%load*least
  end function pull_off

  !> Contact radius [m] at a displacement [m], of the state that is stable at fixed displacement:
  !> the largest contact radius. NaN below the smallest displacement of bodies in contact.
  elemental real(wp) function radius_at_displacement(self, displacement) result(contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: displacement

    contact_radius = self%unit%radius* &
      stable_radius(of_displacement, displacement/self%unit%displacement, self%lambda)
  end function radius_at_displacement

  !> Contact radius [m] at a load [N], of the stable state. NaN beyond the pull-off.
  elemental real(wp) function radius_at_load(self, load) result(contact_radius)
    class(maugis_t), intent(in) :: self
    real(wp), intent(in) :: load

    contact_radius = self%unit%radius*stable_radius(of_load, load/self%unit%load, self%lambda)
  end function radius_at_load

end module maugis
