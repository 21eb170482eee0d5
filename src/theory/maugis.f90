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
  public :: lennard_jones_strength, maugis_lambda
  public :: maugis_edge_ratio, maugis_radius_at_edge_ratio
  public :: maugis_units_t, maugis_units
  public :: maugis_load, maugis_displacement, maugis_radius_at_displacement, maugis_pull_off
  public :: maugis_radius_at_load

  !> Maugis' units [N, m, m], in which JKR theory has no parameter.
  type :: maugis_units_t
    real(wp) :: load = 1, radius = 1, displacement = 1
  end type maugis_units_t

contains

  !> Cohesive strength [Pa] equal to the largest tension of the Lennard-Jones law (33),
  !> 16 gamma/(9 sqrt(3) z0) = 1.0264 gamma/z0 at h = 3^(1/6) z0. With the same gamma this is
  !> the usual choice; lambda is then 1.157 times Tabor's parameter.
  elemental real(wp) function lennard_jones_strength(surface_energy, z0) result(strength)
    real(wp), intent(in) :: surface_energy, z0

    strength = 16*surface_energy/(9*sqrt(3.0_wp)*z0)
  end function lennard_jones_strength

  !> Maugis' parameter lambda: DMT below about 0.1, JKR above about 5.
  elemental function maugis_lambda(radius, stiffness, surface_energy, strength) result(lambda)
    real(wp), intent(in) :: radius, stiffness, surface_energy, strength
    real(wp) :: lambda

    lambda = 2*strength*(9*radius/(4*pi*surface_energy*stiffness**2))**(1.0_wp/3.0_wp)
  end function maugis_lambda

  !> Ratio m = c/a of cohesive zone to contact radius at a contact radius a > 0 [m]: the gap at c is
  !> surface_energy/strength.
  elemental function maugis_edge_ratio(contact_radius, radius, stiffness, surface_energy, &
    strength) result(m)
    real(wp), intent(in) :: contact_radius, radius, stiffness, surface_energy, strength
    real(wp) :: m

    m = hypot(1.0_wp, zone_width(contact_radius/unit_length(radius, stiffness, surface_energy), &
      maugis_lambda(radius, stiffness, surface_energy, strength)))
  end function maugis_edge_ratio

  !> Contact radius [m] at a ratio m = c/a > 1, the inverse of `maugis_edge_ratio`.
  elemental function maugis_radius_at_edge_ratio(m, radius, stiffness, surface_energy, &
    strength) result(contact_radius)
    real(wp), intent(in) :: m, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius

    contact_radius = unit_length(radius, stiffness, surface_energy)* &
      radius_at_zone_width(sqrt((m - 1)*(m + 1)), &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_radius_at_edge_ratio

  !> Load [N] at a contact radius a > 0 [m].
  elemental function maugis_load(contact_radius, radius, stiffness, surface_energy, strength) &
    result(load)
    real(wp), intent(in) :: contact_radius, radius, stiffness, surface_energy, strength
    real(wp) :: load

    load = pi*surface_energy*radius &
      *scaled_load(contact_radius/unit_length(radius, stiffness, surface_energy), &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_load

  !> Displacement [m] at a contact radius a > 0 [m].
  elemental function maugis_displacement(contact_radius, radius, stiffness, surface_energy, &
    strength) result(displacement)
    real(wp), intent(in) :: contact_radius, radius, stiffness, surface_energy, strength
    real(wp) :: displacement, unit

    unit = unit_length(radius, stiffness, surface_energy)
    displacement = unit**2/radius*scaled_displacement(contact_radius/unit, &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_displacement

  !> Load [N] at the pull-off under a fixed load, negative: the least load over all contact radii.
  elemental function maugis_pull_off(radius, stiffness, surface_energy, strength) result(load)
    real(wp), intent(in) :: radius, stiffness, surface_energy, strength
    real(wp) :: load, lambda, a

    lambda = maugis_lambda(radius, stiffness, surface_energy, strength)
    call find_least(of_load, lambda, a, load)
    load = pi*surface_energy*radius*load
  end function maugis_pull_off

  !> Contact radius [m] at a displacement [m], of the state that is stable at fixed displacement:
  !> the largest contact radius. NaN below the smallest displacement of bodies in contact.
  elemental function maugis_radius_at_displacement(displacement, radius, stiffness, &
    surface_energy, strength) result(contact_radius)
    real(wp), intent(in) :: displacement, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius, unit

    unit = unit_length(radius, stiffness, surface_energy)
    contact_radius = unit*stable_radius(of_displacement, displacement*radius/unit**2, &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_radius_at_displacement

  !> Contact radius [m] at a load [N], of the stable state. NaN beyond the pull-off.
  elemental function maugis_radius_at_load(load, radius, stiffness, surface_energy, strength) &
    result(contact_radius)
    real(wp), intent(in) :: load, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius

    contact_radius = unit_length(radius, stiffness, surface_energy)* &
      stable_radius(of_load, load/(pi*surface_energy*radius), &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_radius_at_load

  !> Maugis' units.
  elemental function maugis_units(radius, stiffness, surface_energy) result(units)
    real(wp), intent(in) :: radius, stiffness, surface_energy
    type(maugis_units_t) :: units

    units%load = pi*surface_energy*radius
    units%radius = unit_length(radius, stiffness, surface_energy)
    units%displacement = units%radius**2/radius
  end function maugis_units

  !> Maugis' unit of contact radius [m].
  elemental real(wp) function unit_length(radius, stiffness, surface_energy) result(unit)
    real(wp), intent(in) :: radius, stiffness, surface_energy

    unit = (1.5_wp*pi*surface_energy*radius**2/stiffness)**(1.0_wp/3.0_wp)
  end function unit_length

end module maugis
