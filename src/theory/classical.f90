!> The classical theories of elastic contact: Hertz, JKR, DMT. Maugis-Dugdale theory is in `maugis`.
!> Here are the names that the theories of `&classical` have in decks and tables.
!>
!> Units are SI, and conventions are the paper's. `radius` is R of h0(r) = h0 + r^2/(2R). `y` is the
!> plane-strain modulus E/(1-nu^2) of two identical bodies (twice the reduced modulus E*). `gamma`
!> is the work of adhesion, and `a` the contact radius. Loads are positive in compression;
!> `displacement` is delta = h(0) - h0. Each theory has exactly one state for each contact radius,
!> which is therefore the best parameter of its curves; at a load or displacement there may be none,
!> one or two states. Arguments must be positive and finite. If no equilibrium exists, the result is
!> NaN.
module classical
  use kinds, only: wp, pi, nan
  implicit none
  private
  public :: hertz_load, hertz_displacement, hertz_load_at_displacement, hertz_radius_at_load, &
    hertz_radius_at_displacement, hertz_pressure, hertz_gap, jkr_load, jkr_displacement, &
    jkr_radius_at_load, jkr_radius_at_displacement, jkr_load_at_displacement, jkr_pull_off, &
    jkr_pull_off_fixed_displacement, jkr_pressure, jkr_gap, dmt_load, dmt_load_at_displacement, &
    dmt_pull_off, dmt_radius_at_load, theories, hertz, jkr, dmt, maugis_dugdale, carpick, &
    pietrement_troyon, usual, convex

  !> Numbers of the theories that &classical shows, and their names in decks and tables.
  integer, parameter :: hertz = 1, jkr = 2, dmt = 3, maugis_dugdale = 4, carpick = 5, &
    pietrement_troyon = 6
  character(len=*), parameter :: theories(*) = [character(len=17) :: 'hertz', 'jkr', 'dmt', &
    'maugis_dugdale', 'carpick', 'pietrement_troyon']
  !> Whether a theory is shown by default; whether it holds for any convex shape and for layers.
  logical, parameter :: usual(*) = [.true., .true., .true., .true., .false., .false.]
  logical, parameter :: convex(*) = [.true., .true., .false., .false., .false., .false.]

contains

  !> Hertz load [N] at a contact radius [m], (5).
  elemental real(wp) function hertz_load(a, radius, y) result(load)
    real(wp), intent(in) :: a, radius, y

    load = 2*y*a**3/(3*radius)
  end function hertz_load

  !> Hertz displacement [m] at a contact radius [m], (4).
  elemental real(wp) function hertz_displacement(a, radius) result(displacement)
    real(wp), intent(in) :: a, radius

    displacement = a**2/radius
  end function hertz_displacement

  !> Hertz contact radius [m] at a load [N], (5); NaN under tension.
  elemental real(wp) function hertz_radius_at_load(load, radius, y) result(a)
    real(wp), intent(in) :: load, radius, y

    a = cube_root(1.5_wp*radius*load/y)
    if (load < 0) a = nan
  end function hertz_radius_at_load

  !> Hertz contact radius [m] at a displacement [m], (4); NaN if the bodies do not touch.
  elemental real(wp) function hertz_radius_at_displacement(displacement, radius) result(a)
    real(wp), intent(in) :: displacement, radius

    a = nan
    if (displacement >= 0) a = sqrt(radius*displacement)
  end function hertz_radius_at_displacement

  !> Hertz load [N] at a displacement [m], (6); zero if the bodies do not touch.
  elemental real(wp) function hertz_load_at_displacement(displacement, radius, y) result(load)
    real(wp), intent(in) :: displacement, radius, y
    real(wp) :: overlap

    overlap = max(displacement, 0.0_wp)
    load = 2*y*overlap*sqrt(radius*overlap)/3
  end function hertz_load_at_displacement

  !> Hertz pressure [Pa] at distance `r` [m] from the axis, (3).
  elemental real(wp) function hertz_pressure(r, a, radius, y) result(pressure)
    real(wp), intent(in) :: r, a, radius, y

    pressure = 0
    if (r < a) pressure = y*sqrt((a - r)*(a + r))/(pi*radius)
  end function hertz_pressure

  !> Hertz gap [m] at distance `r` [m] from the axis: (14), (17) under the pressure (3). For large r
  !> it tends to r^2/(2R) - a^2/R, the undeformed gap at h0 = -delta.
  elemental real(wp) function hertz_gap(r, a, radius) result(gap)
    real(wp), intent(in) :: r, a, radius
    real(wp) :: outside

    gap = 0
    if (r > a) then
      outside = sqrt((r - a)*(r + a))
      gap = (a*outside + (r**2 - 2*a**2)*atan2(outside, a))/(pi*radius)
    end if
  end function hertz_gap

  !> JKR load [N] at a contact radius [m], on both branches of (10).
  elemental real(wp) function jkr_load(a, radius, y, gamma) result(load)
    real(wp), intent(in) :: a, radius, y, gamma

    load = hertz_load(a, radius, y) - sqrt(4*pi*gamma*y*a)*a
  end function jkr_load

  !> JKR displacement [m] at a contact radius [m], (11).
  elemental real(wp) function jkr_displacement(a, radius, y, gamma) result(displacement)
    real(wp), intent(in) :: a, radius, y, gamma

    displacement = hertz_displacement(a, radius) - sqrt(4*pi*gamma*a/y)
  end function jkr_displacement

  !> JKR contact radius [m] of the stable state at a fixed load [N], (10). NaN beyond the pull-off.
  elemental real(wp) function jkr_radius_at_load(load, radius, y, gamma) result(a)
    real(wp), intent(in) :: load, radius, y, gamma
    real(wp) :: adhesion, inner

    adhesion = 3*pi*gamma*radius
    inner = adhesion*(2*load + adhesion)
    if (inner < -4*epsilon(inner)*adhesion**2) then
      a = nan
    else
      ! At the pull-off a rounding error may make this number slightly negative.
      a = cube_root(1.5_wp*radius/y *(load + adhesion + sqrt(max(inner, 0.0_wp))))
    end if
  end function jkr_radius_at_load

  !> JKR contact radius [m] of the stable state at a fixed displacement [m]: the larger root of
  !> (11). NaN beyond the pull-off.
  elemental real(wp) function jkr_radius_at_displacement(displacement, radius, y, gamma) result(a)
    real(wp), intent(in) :: displacement, radius, y, gamma
    real(wp) :: fold, d, q, u, z, s

    ! In x = sqrt(a/fold) and d = R delta/fold^2, (11) is x^4 - 4x - d = 0. Its fold is x = 1,
    ! d = -3. Ferrari: x = (s + sqrt(8/s - s^2))/2, where z = s^2 is the only positive root of
    ! z^3 + 4dz - 16 = 0, in a form of Cardano's solution that does not cancel for large d.
    fold = cube_root(pi*gamma*radius**2/(4*y))
    if (.not. fold > 0) then
      a = hertz_radius_at_displacement(displacement, radius)
      return
    end if
    d = displacement*radius/fold**2
    if (d < -3*(1 + 4*epsilon(d))) then
      a = nan
      return
    end if
    q = 4*d/3
    u = cube_root(8 + sqrt(max(64 + q**3, 0.0_wp)))
    z = 16/(u**2 + q + (q/u)**2)
    s = sqrt(z)
    a = fold*((s + sqrt(max(8/s - z, 0.0_wp)))/2)**2
  end function jkr_radius_at_displacement

  !> JKR load [N] at a fixed displacement [m], on the stable branch; NaN beyond the pull-off.
  elemental real(wp) function jkr_load_at_displacement(displacement, radius, y, gamma) result(load)
    real(wp), intent(in) :: displacement, radius, y, gamma

    load = jkr_load(jkr_radius_at_displacement(displacement, radius, y, gamma), radius, y, gamma)
  end function jkr_load_at_displacement

  !> JKR load [N] at the pull-off under a fixed load, negative, (1).
  elemental real(wp) function jkr_pull_off(radius, gamma) result(load)
    real(wp), intent(in) :: radius, gamma

    load = -1.5_wp*pi*gamma*radius
  end function jkr_pull_off

  !> JKR load [N] at the pull-off under a fixed displacement, negative, (12).
  elemental real(wp) function jkr_pull_off_fixed_displacement(radius, gamma) result(load)
    real(wp), intent(in) :: radius, gamma

    load = 5*jkr_pull_off(radius, gamma)/9
  end function jkr_pull_off_fixed_displacement

  !> JKR pressure [Pa] at distance `r` [m] from the axis, (3) + (7) with (9). It tends to minus
  !> infinity at the contact edge; the result is zero at the edge and outside.
  elemental real(wp) function jkr_pressure(r, a, radius, y, gamma) result(pressure)
    real(wp), intent(in) :: r, a, radius, y, gamma
    real(wp) :: inside

    pressure = 0
    if (r < a) then
      inside = sqrt((a - r)*(a + r))
      pressure = hertz_pressure(r, a, radius, y) - sqrt(y*gamma*a/pi)/inside
    end if
  end function jkr_pressure

  !> JKR gap [m] at distance `r` [m] from the axis. For large r it tends to r^2/(2R) - delta, (11).
  elemental real(wp) function jkr_gap(r, a, radius, y, gamma) result(gap)
    real(wp), intent(in) :: r, a, radius, y, gamma
    real(wp) :: outside

    gap = 0
    if (r > a) then
      outside = sqrt((r - a)*(r + a))
      gap = hertz_gap(r, a, radius) + sqrt(4*pi*gamma*a/y) *2/pi*atan2(outside, a)
    end if
  end function jkr_gap

  !> DMT load [N] at a contact radius [m]: the Hertz load minus the attraction 2 pi gamma R, (2).
  !> The displacement is that of Hertz theory.
  elemental real(wp) function dmt_load(a, radius, y, gamma) result(load)
    real(wp), intent(in) :: a, radius, y, gamma

    load = hertz_load(a, radius, y) + dmt_pull_off(radius, gamma)
  end function dmt_load

  !> DMT contact radius [m] at a load [N]; NaN beyond the pull-off.
  elemental real(wp) function dmt_radius_at_load(load, radius, y, gamma) result(a)
    real(wp), intent(in) :: load, radius, y, gamma

    a = hertz_radius_at_load(load - dmt_pull_off(radius, gamma), radius, y)
  end function dmt_radius_at_load

  !> DMT load [N] at a displacement [m]; NaN if the bodies do not touch, since the theory does not
  !> include attraction across a gap.
  elemental real(wp) function dmt_load_at_displacement(displacement, radius, y, gamma) result(load)
    real(wp), intent(in) :: displacement, radius, y, gamma

    load = dmt_load(hertz_radius_at_displacement(displacement, radius), radius, y, gamma)
  end function dmt_load_at_displacement

  !> DMT load [N] at the pull-off, negative, (2).
  elemental real(wp) function dmt_pull_off(radius, gamma) result(load)
    real(wp), intent(in) :: radius, gamma

    load = -2*pi*gamma*radius
  end function dmt_pull_off

  !> Real cube root; zero for a negative number.
  elemental real(wp) function cube_root(x) result(root)
    real(wp), intent(in) :: x

    root = max(x, 0.0_wp)**(1.0_wp/3.0_wp)
  end function cube_root

end module classical
