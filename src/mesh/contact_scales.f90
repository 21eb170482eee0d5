!> Lateral lengths of a contact for meshes and searches: the largest radius, the smallest feature of
!> the pressure, and the H0 at which contact begins.
module contact_scales
  use kinds, only: wp, pi
  use root_finding, only: bracket_t
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t, neck_width, adhesion_strength, &
    coupling_over
  use convex_contact, only: jkr_like_detachment
  implicit none
  private
  public :: largest_radius, beyond_contact, hertz_scale, contact_level, cohesive_width, &
    smallest_feature, &
    lost_in_rounding, largest_floor

  !> Smallest feature, over the contact radius, that a mesh resolves; smaller features due to
  !> adhesion are hidden by rounding.
  real(wp), parameter :: finest = 1.0e-13_wp

  !> Range of the Lennard-Jones law (its adhesion over its largest tension) in the law's length.
  real(wp), parameter :: usual_range = 0.97_wp

  !> Margin of radii and separations of JKR theory.
  real(wp), parameter :: margin = 1.2_wp

  !> The residual due to rounding, in the law's lengths, above which the law is not resolved.
  real(wp), parameter :: largest_floor = 1.0e-3_wp

contains

  !> Contact radius of JKR theory, (11), at H0, with a margin of a fifth; for a law without adhesion
  !> that of Hertz theory, beginning at the law's level. Bodies that are less compliant at long
  !> wavelengths have a larger radius at the same depth, up to twice for a thin incompressible film.
  pure real(wp) function largest_radius(problem, h0, level) result(c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0, level
    real(wp) :: before
    integer :: step

    if (problem%law%adhesion <= 0) then
      c = hertz_scale(problem%shape, level, h0)
    else
      c = 1
      do step = 1, 200
        before = c
        c = problem%shape%contact_radius(max(1 - h0, 0.0_wp) + &
          sqrt(4*pi*coupling_over(problem, c)*problem%law%adhesion*c))
        if (.not. abs(c - before) > 0) exit
      end do
      c = max(1.0_wp, margin*c)
    end if
    if (.not. problem%body%is_homogeneous()) &
      c = c*(2 - min(1.0_wp, coupling_over(problem, c)/problem%coupling))
  end function largest_radius

  !> An H0 above which there is no contact: that of the snap-off at prescribed displacement in JKR
  !> theory, with a margin of a fifth. The theory is used for half-spaces with the compliance that
  !> the bodies have at the contact radius of zero displacement.
  pure real(wp) function beyond_contact(problem)
    type(problem_t), intent(in) :: problem
    real(wp) :: strength

    strength = adhesion_strength(problem)
    if (.not. problem%body%is_homogeneous()) strength = problem%law%adhesion* &
      max(problem%coupling, coupling_over(problem, largest_radius(problem, 1.0_wp, 1.0_wp)))
    beyond_contact = margin*(1 + jkr_like_detachment(problem%shape, strength))
  end function beyond_contact

  !> Scale of the mesh for a law without adhesion: about the radius of a Hertz contact that begins
  !> at the given level, at least 1.
  pure real(wp) function hertz_scale(shape, level, h0)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: level, h0

    hertz_scale = shape%contact_radius(1 + max(0.0_wp, level - h0))
  end function hertz_scale

  !> The gap at which the pressure over a unit radius deforms the bodies by one unit, found by
  !> bisection for a law that decreases with the gap.
  pure real(wp) function contact_level(problem) result(level)
    type(problem_t), intent(in) :: problem
    type(bracket_t) :: bracket
    real(wp) :: pressure(1)

    bracket = bracket_t(problem%law%smallest_gap, problem%law%range + 500)
    do while (bracket%is_open())
      pressure = problem%law%pressure([bracket%middle()])
      call bracket%narrow(2*problem%coupling*pressure(1) > 1)
    end do
    level = bracket%middle()
  end function contact_level

  !> Width of the zone outside the edge over which the tension decays, in lateral units.
  !> `neck_width` assumes that the law's range is the law's length. If the ratio of the range to
  !> that of the Lennard-Jones law is below 1, the width is multiplied by the square of this ratio.
  pure real(wp) function cohesive_width(problem) result(width)
    type(problem_t), intent(in) :: problem
    real(wp) :: tension(1)

    width = neck_width(problem)
    if (.not. problem%law%edge_gap > 0) return
    tension = -problem%law%pressure([problem%law%edge_gap])
    width = width*min(1.0_wp, (problem%law%adhesion/(usual_range*tension(1)))**2)
  end function cohesive_width

  !> The smallest lateral feature of the pressure up to the contact radius c: the width of the
  !> cohesive zone (neck) or, if that is wide, the smaller of two lengths. One is the half-width of
  !> the pressure between bodies near contact. The other is the boundary layer of a Hertz contact,
  !> over which the gap, increasing as the power 3/2 of the distance from the edge, changes by one
  !> repulsion length.
  pure real(wp) function smallest_feature(problem, c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: c
    real(wp) :: opening

    smallest_feature = min(cohesive_width(problem), 0.5_wp)
    opening = problem%shape%opening(max(c, 1.0_wp))
    ! On a flat face the gap does not increase.
    if (opening > 0) smallest_feature = min(smallest_feature, &
      (problem%law%repulsion_length**2/opening)**(1.0_wp/3))
    smallest_feature = max(finest*max(c, 1.0_wp), smallest_feature)
  end function smallest_feature

  !> Whether a contact of radius c (lateral units) is deformed so much under the law's largest
  !> tension, about one unit of pressure, that rounding hides the law.
  pure logical function lost_in_rounding(problem, c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: c

    lost_in_rounding = 8*epsilon(1.0_wp)*c*problem%law%adhesion* &
      max(problem%coupling, coupling_over(problem, c)) > largest_floor
  end function lost_in_rounding

end module contact_scales
