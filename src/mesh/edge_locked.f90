!> The two meshes on which the whole equilibrium path is resolved at any adhesion strength.
!>
!> Before contact the mesh is graded to the axis and the gap there is the coordinate of the path. In
!> contact the mesh is locked to the contact edge: positions are in units of the contact radius c,
!> the edge stays at 1, and c is the coordinate. Both coordinates are monotone along the path.
module edge_locked
  use kinds, only: wp, pi
  use root_finding, only: bracket_t
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t, neck_width
  use convex_contact, only: jkr_like_detachment
  use discretisation, only: discretisation_t
  use panels, only: new_panel_grid, graded_ends
  implicit none
  private
  public :: mesh_pair_t, new_mesh_pair, hertz_scale, largest_radius, contact_level, &
    smallest_feature, beyond_contact
  public :: approach, contact

  !> The two stretches of the path.
  integer, parameter :: approach = 1, contact = 2

  type :: mesh_pair_t
    type(discretisation_t) :: grid(2)
    !> Whether the path can be traced: the law attracts, or the bodies are rigid and it is trivial.
    !> If not, only the mesh for contact exists, and its scale is prescribed by `hertz_scale`.
    logical :: traceable = .true.
    !> Lateral position up to which a state is resolved, and contact radius at which the path passes
    !> from one mesh to the other; both in lateral units.
    real(wp) :: reach = 0, passage = 0
    !> Gap at which a law without a contact edge begins to deform the bodies.
    real(wp) :: level = -huge(1.0_wp)
  end type mesh_pair_t

  !> Smallest feature over the contact radius that a mesh follows: where adhesion makes smaller
  !> ones, rounding hides them, and the mesh would grow for nothing.
  real(wp), parameter :: finest = 1.0e-13_wp

  !> How finely to resolve.
  type, public :: resolution_t
    !> Nodes a panel; size of the smallest panel over the smallest feature; relative error that the
    !> finite reach of the mesh may cause.
    integer :: order = 12
    real(wp) :: fineness = 0.5_wp, accuracy = 1.0e-8_wp
    !> Raises the reach above what follows from all else.
    real(wp) :: farther = 1
  end type resolution_t

contains

  !> Meshes for H0 from h0_high down to h0_low. shape_only leaves the kernels out, to learn how
  !> large they would be.
  function new_mesh_pair(problem, h0_high, h0_low, resolution, shape_only) result(pair)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low
    type(resolution_t), intent(in) :: resolution
    logical, intent(in), optional :: shape_only
    type(mesh_pair_t) :: pair
    real(wp) :: feature, widest
    logical :: elastic

    elastic = .not. problem%rigid
    if (present(shape_only)) elastic = elastic .and. .not. shape_only
    pair%traceable = problem%law%adhesion > 0 .or. problem%rigid
    if (.not. pair%traceable) pair%level = contact_level(problem)
    widest = largest_radius(problem, h0_low, pair%level)
    feature = smallest_feature(problem, 1.0_wp)
    pair%passage = min(0.6_wp*neck_width(problem), 0.4_wp)
    ! Until then the axis of rigid bodies has come half the way from most tension to rest.
    if (problem%law%edge_gap > 0) &
      pair%passage = min(pair%passage, problem%shape%position_of( &
      0.5_wp*(problem%law%edge_gap - problem%law%rest_gap)))
    pair%reach = resolution%farther*reach_of(problem, h0_high, h0_low, widest, resolution%accuracy)
    associate (fineness => resolution%fineness, order => resolution%order)
      if (pair%traceable) pair%grid(approach) = new_panel_grid(0.0_wp, &
        graded_ends(0.0_wp, pair%reach, fineness*feature, 1.0_wp, pair%reach), order, elastic)
      if (problem%law%edge_gap > 0 .and. .not. problem%rigid .or. .not. pair%traceable) &
        pair%grid(contact) = new_locked_grid(pair%reach/min(pair%passage, 1.0_wp), &
        fineness*smallest_feature(problem, widest)/widest, &
        tip_panel(problem%shape, resolution%accuracy), order, elastic)
    end associate
  end function new_mesh_pair

  !> Lateral position up to which states are resolved, for this relative error and largest contact.
  pure real(wp) function reach_of(problem, h0_high, h0_low, widest, accuracy) result(reach)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low, widest, accuracy

    associate (law => problem%law, shape => problem%shape)
      ! The neglected pressure, of parabolas of order rho^-6, lowers the gap by about
      ! 17 coupling/reach^5, and so for other powers of gap and shape.
      reach = max(shape%position_of(max(law%range - min(h0_low, 0.0_wp), 1.0_wp)), &
        (17*(2/shape%growth)*law%adhesion*problem%coupling**(1.0_wp/3)/accuracy)** &
        (1/(shape%growth*law%tail_power - 1)), &
        4**(2/max(shape%growth, 2.0_wp))*law%adhesion*widest, &
        shape%position_of(50*law%adhesion*max(h0_high, 1.0_wp)))
    end associate
  end function reach_of

  !> Size of the panel on the axis, where the pressure of a contact goes as r^(n-1), with a
  !> logarithm if n is odd: what the panel cannot resolve is a part r^(n+1) of the load. Bodies of
  !> even n are smooth, and any panel does.
  pure real(wp) function tip_panel(shape, accuracy) result(size)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: accuracy

    size = 1
    associate (n => shape%exponent)
      if (abs(n - 2*nint(0.5_wp*n)) > 0) size = accuracy**(1/(n + 1))
    end associate
  end function tip_panel

  !> A mesh locked to the edge at 1, out to `extent`, with smallest panels of size `finest`, and of
  !> size `tip` on the axis, where that is smaller than follows from it.
  function new_locked_grid(extent, finest, tip, order, elastic) result(grid)
    real(wp), intent(in) :: extent, finest, tip
    integer, intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    real(wp), allocatable :: ends(:)

    ends = graded_ends(1.0_wp, extent, min(finest, 0.25_wp), 1.0_wp, extent)
    do while (1 + ends(2) > tip)
      ends = [ends(1), 0.5_wp*(ends(2) - 1), ends(2:)]
    end do
    grid = new_panel_grid(1.0_wp, ends, order, elastic)
  end function new_locked_grid

  !> Contact radius that JKR theory, (11), gives at H0, with a margin of a fifth; for a law without
  !> adhesion that of Hertz, beginning at its level.
  pure real(wp) function largest_radius(problem, h0, level) result(c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0, level
    real(wp) :: before
    integer :: step

    if (problem%law%adhesion <= 0) then
      c = hertz_scale(problem%shape, level, h0)
      return
    end if
    c = 1
    do step = 1, 200
      before = c
      c = problem%shape%contact_radius(max(1 - h0, 0.0_wp) + &
        sqrt(4*pi*problem%coupling*problem%law%adhesion*c))
      if (.not. abs(c - before) > 0) exit
    end do
    c = max(1.0_wp, 1.2_wp*c)
  end function largest_radius

  !> An H0 beyond which no contact reaches: the jump out of contact at fixed displacement of JKR
  !> theory, with a margin of a fifth.
  pure real(wp) function beyond_contact(problem)
    type(problem_t), intent(in) :: problem

    beyond_contact = 1.2_wp*(1 + jkr_like_detachment(problem%shape, &
      problem%coupling*problem%law%adhesion))
  end function beyond_contact

  !> Scale of the mesh for a law without adhesion: about the radius of a Hertz contact that begins
  !> at the given level, never less than 1.
  pure real(wp) function hertz_scale(shape, level, h0)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: level, h0

    hertz_scale = shape%contact_radius(1 + max(0.0_wp, level - h0))
  end function hertz_scale

  !> The gap at which the pressure over a unit radius deforms the bodies by one unit, by bisection
  !> of a law that decreases with the gap.
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

  !> The smallest lateral feature of the pressure up to the contact radius c: the neck, or where
  !> that is wide, the half-width of the pressure between bodies near contact and the boundary layer
  !> of a Hertz contact, whose gap opens as the power 3/2 of the distance from the edge and changes
  !> the repulsion over one repulsion length.
  pure real(wp) function smallest_feature(problem, c)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: c

    smallest_feature = max(finest*max(c, 1.0_wp), min(neck_width(problem), 0.5_wp, &
      (problem%law%repulsion_length**2/problem%shape%opening(max(c, 1.0_wp)))**(1.0_wp/3)))
  end function smallest_feature

end module edge_locked
