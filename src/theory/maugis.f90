!> Maugis-Dugdale theory of adhesive contact: a constant tension, `strength`, acts across the gap
!> between the contact radius a and the outer radius c of the cohesive zone, and the gap at c is
!> surface_energy/strength. It spans JKR (strong, short-ranged) and DMT (weak, long-ranged).
!> D. Maugis, J. Colloid Interface Sci. 150, 243 (1992).
!>
!> Units and conventions are those of module classical. Within, the theory's own:
!> K = 2 stiffness/3 (4 E*/3), A = a/(pi gamma R^2/K)^(1/3), P = F/(pi gamma R),
!> D = delta/(pi^2 gamma^2 R/K^2)^(1/3), lambda = 2 strength (R/(pi gamma K^2))^(1/3), and for the
!> width of the zone t = sqrt(m^2 - 1), m = c/a, which keeps its digits when m is close to one.
module maugis
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp, pi
  use root_finding, only: bracket_t, golden
  implicit none
  private
  public :: lennard_jones_strength, maugis_lambda
  public :: maugis_edge_ratio, maugis_radius_at_edge_ratio
  public :: maugis_units_t, maugis_units
  public :: maugis_load, maugis_displacement, maugis_radius_at_displacement, maugis_pull_off
  public :: maugis_radius_at_load

  !> Maugis' units [N, m, m], in which JKR theory is one curve.
  type :: maugis_units_t
    real(wp) :: load = 1, radius = 1, displacement = 1
  end type maugis_units_t

  !> Of which a least value is looked for.
  integer, parameter :: of_load = 1, of_displacement = 2

contains

  !> Cohesive strength [Pa] that stands for the Lennard-Jones law (33): its largest tension,
  !> 16 gamma/(9 sqrt(3) z0) = 1.0264 gamma/z0, met at h = 3^(1/6) z0. With the same gamma this is
  !> the usual choice; lambda is then 1.157 times Tabor's parameter.
  elemental function lennard_jones_strength(surface_energy, z0) result(strength)
    real(wp), intent(in) :: surface_energy, z0
    real(wp) :: strength

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

  !> Contact radius [m] at a ratio m = c/a > 1, the other way round: a quadratic.
  elemental function maugis_radius_at_edge_ratio(m, radius, stiffness, surface_energy, &
    strength) result(contact_radius)
    real(wp), intent(in) :: m, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius, lambda, t, linear, quadratic

    lambda = maugis_lambda(radius, stiffness, surface_energy, strength)
    t = sqrt((m - 1)*(m + 1))
    quadratic = lambda/2*profile_term(t)
    linear = 4*lambda**2/3*tension_term(t)
    contact_radius = unit_length(radius, stiffness, surface_energy) &
      *2/(linear + sqrt(linear**2 + 4*quadratic))
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

  !> Contact radius [m] at a displacement [m]: that of the state which is stable while the
  !> displacement is held, the largest of those there are. NaN below the least displacement of the
  !> bodies in contact.
  elemental function maugis_radius_at_displacement(displacement, radius, stiffness, &
    surface_energy, strength) result(contact_radius)
    real(wp), intent(in) :: displacement, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius, unit

    unit = unit_length(radius, stiffness, surface_energy)
    contact_radius = unit*stable_radius(of_displacement, displacement*radius/unit**2, &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_radius_at_displacement

  !> Contact radius [m] at a load [N]: that of the state which is stable under it. NaN beyond the
  !> pull-off.
  elemental function maugis_radius_at_load(load, radius, stiffness, surface_energy, strength) &
    result(contact_radius)
    real(wp), intent(in) :: load, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius

    contact_radius = unit_length(radius, stiffness, surface_energy)* &
      stable_radius(of_load, load/(pi*surface_energy*radius), &
      maugis_lambda(radius, stiffness, surface_energy, strength))
  end function maugis_radius_at_load

  !> The largest A at a given P or D; NaN below the least of these.
  pure function stable_radius(quantity, wanted, lambda) result(radius)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: wanted, lambda
    real(wp) :: radius, a, least
    type(bracket_t) :: bracket

    radius = ieee_value(radius, ieee_quiet_nan)
    call find_least(quantity, lambda, a, least)
    if (.not. wanted >= least) return
    bracket = bracket_t(a, max(1.0_wp, 2*a))
    do while (scaled(quantity, bracket%high, lambda) < wanted)
      bracket%high = 2*bracket%high
    end do
    ! Both grow with the contact from their least value on.
    do while (bracket%is_open())
      call bracket%narrow(scaled(quantity, bracket%middle(), lambda) < wanted)
    end do
    radius = bracket%high
  end function stable_radius

  !> Maugis' units.
  elemental function maugis_units(radius, stiffness, surface_energy) result(units)
    real(wp), intent(in) :: radius, stiffness, surface_energy
    type(maugis_units_t) :: units

    units%load = pi*surface_energy*radius
    units%radius = unit_length(radius, stiffness, surface_energy)
    units%displacement = units%radius**2/radius
  end function maugis_units

  !> The least P (`of_load`) or D (`of_displacement`) over all A, and where.
  pure subroutine find_least(quantity, lambda, a, least)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: lambda
    real(wp), intent(out) :: a, least
    ! JKR's least load is at A = 1.5^(1/3) = 1.145 and its least displacement at (1/6)^(1/3); those
    ! of a longer-ranged tension are at a smaller A.
    real(wp), parameter :: a_max = 1.5_wp
    ! The minimum is flat: half of the digits in A give all of them in the value.
    real(wp), parameter :: tolerance = 1e-9_wp
    real(wp) :: left, right, inner(2), value(2)

    left = 0
    right = a_max
    inner = [right - golden*(right - left), left + golden*(right - left)]
    value = scaled(quantity, inner, lambda)
    ! Not by a bracket: each value here takes a search of its own, and one of two is kept.
    do while (right - left > tolerance)
      if (value(1) <= value(2)) then
        right = inner(2)
        inner = [right - golden*(right - left), inner(1)]
        value = [scaled(quantity, inner(1), lambda), value(1)]
      else
        left = inner(1)
        inner = [inner(2), left + golden*(right - left)]
        value = [value(2), scaled(quantity, inner(2), lambda)]
      end if
    end do
    a = inner(minloc(value, 1))
    least = minval(value)
  end subroutine find_least

  !> Maugis' unit of contact radius [m].
  elemental function unit_length(radius, stiffness, surface_energy) result(unit)
    real(wp), intent(in) :: radius, stiffness, surface_energy
    real(wp) :: unit

    unit = (1.5_wp*pi*surface_energy*radius**2/stiffness)**(1.0_wp/3.0_wp)
  end function unit_length

  !> P at given A and lambda.
  elemental function scaled_load(a, lambda) result(load)
    real(wp), intent(in) :: a, lambda
    real(wp) :: load, t

    t = zone_width(a, lambda)
    load = a**3 - lambda*a**2*(t + (1 + t**2)*atan(t))
  end function scaled_load

  !> D at given A and lambda.
  elemental function scaled_displacement(a, lambda) result(displacement)
    real(wp), intent(in) :: a, lambda
    real(wp) :: displacement

    displacement = a**2 - 4*lambda/3*a*zone_width(a, lambda)
  end function scaled_displacement

  !> P or D at given A and lambda.
  elemental function scaled(quantity, a, lambda) result(value)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: a, lambda
    real(wp) :: value

    if (quantity == of_load) then
      value = scaled_load(a, lambda)
    else
      value = scaled_displacement(a, lambda)
    end if
  end function scaled

  !> t at given A and lambda: the root of
  !> (lambda A^2/2) profile_term(t) + (4 lambda^2 A/3) tension_term(t) = 1.
  !> In logarithms the left side is a smooth curve whose slope stays between 1 and 3: one value
  !> brackets the root, and Newton's method comes home from anywhere.
  elemental function zone_width(a, lambda) result(t)
    real(wp), intent(in) :: a, lambda
    real(wp) :: t
    integer, parameter :: max_steps = 100
    ! The step taken from here squares this error.
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

  !> t + (m^2 - 2) atan(t): the part of the Hertz gap at c that the tension holds open.
  elemental function profile_term(t) result(term)
    real(wp), intent(in) :: t
    real(wp) :: term

    term = tangent_excess(t) + t**2*atan(t)
  end function profile_term

  !> Derivative of `profile_term`.
  elemental function profile_slope(t) result(slope)
    real(wp), intent(in) :: t
    real(wp) :: slope

    slope = 2*t*(t/(1 + t**2) + atan(t))
  end function profile_slope

  !> t atan(t) - m + 1, the part of the gap at c that the tension closes, without cancellation.
  elemental function tension_term(t) result(term)
    real(wp), intent(in) :: t
    real(wp) :: term

    term = t*(atan(t) - t/(1 + sqrt(1 + t**2)))
  end function tension_term

  !> Derivative of `tension_term`.
  elemental function tension_slope(t) result(slope)
    real(wp), intent(in) :: t
    real(wp) :: slope

    slope = atan(t) + t/(1 + t**2) - t/sqrt(1 + t**2)
  end function tension_slope

  !> t - atan(t), for small t from the continued fraction of the arctangent.
  elemental function tangent_excess(t) result(excess)
    real(wp), intent(in) :: t
    real(wp) :: excess, w
    ! Above, the difference is good to a dozen units in the last place; below, eight terms are.
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
