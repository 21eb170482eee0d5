!> The dimensionless problem. Gaps are in units of the law's length L, lateral positions in the unit
!> of the shape, sqrt(R L), and pressures in the law's unit. Equations (14) to (18) of the paper
!> then become, as in (38),
!>
!>     H(rho) = H0 + f(rho) + 2 coupling Int P(H) k rho' drho' ,
!>
!> with f(rho) = rho^2/2 for the paper's parabola. The only parameter is the coupling
!> (1-nu^2)/E sqrt(R/L) pressure_unit. It is sigma (40) for the Lennard-Jones law, Lambda (39) at
!> h0 = 0 for the exponential law, 0 for rigid bodies. For other shapes R is defined by their
!> lateral unit, sqrt(R L).
module dimensionless_problem
  use kinds, only: wp, pi
  use force_law, only: force_law_t, whole_step, of_pressure
  use shape, only: shape_t
  use elastic_body, only: elastic_body_t
  implicit none
  private
  public :: problem_t, new_problem, neck_width, spacing_over_neck, tabor_parameter, &
    adhesion_strength, coupling_over, surface_energy, largest_tension, tension_is_even, calm_gap, &
    yielding_gap, contact_level_of

  type :: problem_t
    class(force_law_t), allocatable :: law
    class(shape_t), allocatable :: shape
    !> The remainder that the compliance of the bodies has in addition to that of a half-space;
    !> homogeneous bodies have none.
    class(elastic_body_t), allocatable :: body
    real(wp) :: coupling = 0
    !> Units: gap [m], lateral position [m], pressure [Pa], load [N].
    real(wp) :: length = 1, lateral = 1, pressure = 1, load = 1
    !> The bodies in SI units: R of their shape, and the plane-strain modulus E/(1-nu^2) of two
    !> identical bodies.
    real(wp) :: radius = 1, stiffness = 1
    logical :: rigid = .false.
    !> Largest gap (lengths L of the law) at which the pressure of a draining fluid is not yet a
    !> power of the position; 0 without a fluid.
    real(wp) :: film_gap = 0
    !> Deformation of each body, relative to that of identical bodies.
    real(wp) :: share(2) = 1
  end type problem_t

  !> Bodies are in contact, as in the paper's Fig. 6, at gaps smaller than this multiple of the
  !> equilibrium gap.
  real(wp), parameter :: contact_gap = 1.1_wp
  !> The tension counts as uniform between contact and the gap of largest tension if the distance of
  !> these two gaps exceeds this fraction of the range (depth of the well over largest tension). The
  !> fraction is 0.2 for the Lennard-Jones law, 0.35 for Morse's, 0.9 and more for a step.
  real(wp), parameter :: even = 0.5_wp
  !> The width of the cohesive zone (lateral units) times sigma.
  real(wp), parameter :: neck = 0.375_wp

  !> Ratio of the stiffness of the repulsion to that of the bodies above which kinks of the
  !> repulsion have no effect.
  real(wp), parameter :: stiff = 30

contains

  !> Makes a problem. stiffness [Pa]: the plane-strain modulus of `bodies`, ignored for rigid
  !> bodies.
  type(problem_t) function new_problem(law, shape, stiffness, rigid) result(problem)
    class(force_law_t), intent(in) :: law
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: stiffness
    logical, intent(in) :: rigid

    allocate (problem%law, source=law)
    allocate (problem%shape, source=shape)
    allocate (elastic_body_t :: problem%body)
    problem%length = law%length
    problem%lateral = sqrt(shape%radius*law%length)
    problem%pressure = law%pressure_unit
    problem%load = law%pressure_unit*shape%radius*law%length
    problem%radius = shape%radius
    problem%stiffness = stiffness
    problem%rigid = rigid
    if (.not. rigid) problem%coupling = law%pressure_unit/stiffness*sqrt(shape%radius/law%length)
    call forget_stiff_kinks(problem)
  end function new_problem

  !> Removes kinks from the law's list where the repulsion is so much stiffer than the bodies that
  !> gaps follow pressures. There a kink hardly changes a gap.
  subroutine forget_stiff_kinks(problem)
    type(problem_t), intent(inout) :: problem

    if (.not. allocated(problem%law%kinks)) return
    associate (law => problem%law)
      law%kinks = pack(law%kinks, problem%coupling*law%slope(law%kinks) > -stiff)
      if (size(law%kinks) == 0) deallocate (law%kinks)
    end associate
  end subroutine forget_stiff_kinks

  !> sigma (40): the coupling times the dimensionless work of adhesion; 0 without adhesion.
  pure real(wp) function adhesion_strength(problem)
    type(problem_t), intent(in) :: problem

    adhesion_strength = problem%coupling*problem%law%adhesion
  end function adhesion_strength

  !> The approximate coupling of half-spaces that have the same compliance under a flat punch of
  !> this radius (lateral units). The pressure of a punch has Hankel components of weight (sin(k
  !> radius)/(k radius))^2. These are replaced by equal weights up to a k for which their sum is the
  !> same.
  elemental real(wp) function coupling_over(problem, radius) result(coupling)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: radius

    coupling = problem%coupling
    if (.not. problem%body%is_homogeneous()) &
      coupling = coupling*(1 + problem%body%mean_beside(0.5_wp*pi/max(radius, tiny(radius))))
  end function coupling_over

  !> Width of the zone outside the contact edge over which the tension decays, in lateral units:
  !> 0.75 E* L^2/w = 0.375/sigma with the work of adhesion w. It is huge for rigid bodies or without
  !> attraction.
  pure real(wp) function neck_width(problem)
    type(problem_t), intent(in) :: problem

    neck_width = huge(1.0_wp)
    if (adhesion_strength(problem) > 0) neck_width = neck/adhesion_strength(problem)
  end function neck_width

  !> A distance between nodes (lateral units), relative to the width of the cohesive zone; 0 without
  !> such a zone.
  pure real(wp) function spacing_over_neck(problem, spacing)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: spacing

    spacing_over_neck = spacing*adhesion_strength(problem)/neck
  end function spacing_over_neck

  !> Tabor's parameter (R w^2/(E*^2 L^3))^(1/3) = (4 sigma^2)^(1/3), with the work of adhesion w.
  !> For a gap B r^n it is ((w/E*)^n/(2 B L^(2n-1)))^(1/(2n-1)) = (2 sigma)^(n/(2n-1)). It is 0
  !> without adhesion. If the tension is uniform, L is its range, even if a repulsion gives the law
  !> another length.
  pure real(wp) function tabor_parameter(problem)
    type(problem_t), intent(in) :: problem

    associate (sigma => adhesion_strength(problem), n => problem%shape%exponent)
      if (abs(n - 2) > 0) then
        tabor_parameter = (2*sigma)**(n/(2*n - 1))
      else
        tabor_parameter = (4*sigma**2)**(1.0_wp/3)
      end if
    end associate
    if (tension_is_even(problem)) tabor_parameter = tabor_parameter/range_of(problem)
  end function tabor_parameter

  !> The range: the depth of the primary minimum over the largest tension, in lengths L of the law.
  pure real(wp) function range_of(problem)
    type(problem_t), intent(in) :: problem

    range_of = problem%law%adhesion/(-problem%law%at(of_pressure, problem%law%edge_gap))
  end function range_of

  !> Whether the tension is nearly uniform from contact to a far gap, as under a step. It is then
  !> largest at this gap, outside the contact of the theories.
  pure logical function tension_is_even(problem)
    type(problem_t), intent(in) :: problem

    tension_is_even = problem%law%edge_gap > 0 .and. problem%law%rest_gap > 0
    if (tension_is_even) tension_is_even = problem%law%edge_gap - problem%law%rest_gap > &
      even*range_of(problem)
  end function tension_is_even

  !> A gap beyond which bodies hardly deform: twice the gap at which parabolas snap in under an r^-3
  !> attraction, (37). For any shape and attractive law, the deformation there is about a tenth of
  !> that at snap-in. If the law has a step, the gap is larger than that of the step.
  pure real(wp) function calm_gap(problem) result(gap)
    type(problem_t), intent(in) :: problem

    gap = max(5.0_wp, yielding_gap(problem, 1.0_wp/8))
    if (problem%law%step_width > 0) &
      gap = max(gap, problem%law%step_at + whole_step*problem%law%step_width)
    if (problem%shape%parabolic) gap = max(gap, 2*(27*coupling_over(problem, &
      problem%shape%position_of(0.5_wp*gap))*max(problem%law%adhesion, 0.0_wp))**(2.0_wp/7))
  end function calm_gap

  !> The largest gap at which bodies deform by more than the fraction `left` of the deformation at
  !> snap-in; 0 if there is none. The law acts over a zone of a certain width, sqrt(gap) for a
  !> parabola. Its slope deforms the bodies by a constant times coupling*slope*width, relative to
  !> their gap. The constant makes this quantity one at (37), the gap of snap-in under an r^-3
  !> attraction.
  pure real(wp) function yielding_gap(problem, left) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: left
    real(wp), parameter :: at_jump = 27.0_wp/8
    !> Ratio of successive trial gaps, and their number, with which they reach 1e6 lengths L.
    real(wp), parameter :: ratio = 1.05_wp
    integer, parameter :: tried = 284
    real(wp) :: at(tried), width(tried)
    integer :: i, last

    gap = 0
    if (.not. problem%law%adhesion > 0) return
    at = [(ratio**i, i=1, tried)]
    width = problem%shape%position_of(0.5_wp*at)
    last = findloc(at_jump*coupling_over(problem, width)*abs(problem%law%slope(at))*width > left, &
      .true., 1, back=.true.)
    if (last > 0) gap = at(last)
  end function yielding_gap

  !> The work of adhesion w [J/m^2]; 0 for a law that does not attract, negative if contact is only
  !> metastable.
  pure real(wp) function surface_energy(problem)
    type(problem_t), intent(in) :: problem

    surface_energy = problem%law%work*problem%pressure*problem%length
  end function surface_energy

  !> The largest tension of the law [Pa], which acts at the contact edge; 0 for a law without a
  !> largest tension.
  pure real(wp) function largest_tension(problem)
    type(problem_t), intent(in) :: problem

    largest_tension = 0
    if (problem%law%edge_gap > 0) &
      largest_tension = -problem%law%at(of_pressure, problem%law%edge_gap)*problem%pressure
  end function largest_tension

  !> Largest gap (lengths L) at which bodies count as in contact; -huge if the law does not define
  !> it.
  pure real(wp) function contact_level_of(problem) result(level)
    type(problem_t), intent(in) :: problem

    level = -huge(1.0_wp)
    if (problem%law%rest_gap > 0) level = contact_gap*problem%law%rest_gap
  end function contact_level_of

end module dimensionless_problem
