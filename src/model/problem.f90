!> The problem without its units. With gaps in units of the law's length L, lateral positions in
!> sqrt(R L) and pressures in the law's unit, (14)-(18) of the paper become
!>
!>     H(rho) = H0 + rho^2/2 + 2 coupling Int P(H) k rho' drho' ,
!>
!> with one parameter, coupling = (1-nu^2)/E sqrt(R/L) pressure_unit: sigma (40) for the
!> Lennard-Jones law, Lambda (39) at h0 = 0 for the exponential one, 0 for rigid bodies.
module problem
  use kinds, only: wp
  use force_law, only: force_law_t
  implicit none
  private
  public :: problem_t, new_problem, neck_width, spacing_over_neck, tabor_parameter, &
    surface_energy, largest_tension

  type :: problem_t
    class(force_law_t), allocatable :: law
    real(wp) :: coupling = 0
    !> Units: gap [m], lateral position [m], pressure [Pa], load [N].
    real(wp) :: length = 1, lateral = 1, pressure = 1, load = 1
    !> Bodies, SI: R, and E/(1-nu^2) of two identical bodies.
    real(wp) :: radius = 1, stiffness = 1
    logical :: rigid = .false.
    !> What each body deforms by over what it is for identical ones.
    real(wp) :: share(2) = 1
  end type problem_t

  !> Width of the neck times sigma, lateral units.
  real(wp), parameter :: neck = 0.375_wp

contains

  !> radius [m] and stiffness [Pa] as in `bodies`; stiffness is not used for rigid bodies.
  pure function new_problem(law, radius, stiffness, rigid) result(this)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: radius, stiffness
    logical, intent(in) :: rigid
    type(problem_t) :: this

    allocate (this%law, source=law)
    this%length = law%length
    this%lateral = sqrt(radius*law%length)
    this%pressure = law%pressure_unit
    this%load = law%pressure_unit*radius*law%length
    this%radius = radius
    this%stiffness = stiffness
    this%rigid = rigid
    if (.not. rigid) this%coupling = law%pressure_unit/stiffness*sqrt(radius/law%length)
  end function new_problem

  !> Width of the zone outside the contact edge over which the tension decays, lateral units:
  !> 0.75 E* L^2/gamma = 0.375/sigma; huge where bodies are rigid or nothing attracts.
  pure real(wp) function neck_width(this)
    type(problem_t), intent(in) :: this

    neck_width = huge(1.0_wp)
    if (this%coupling*this%law%adhesion > 0) &
      neck_width = neck/(this%coupling*this%law%adhesion)
  end function neck_width

  !> A distance between nodes (lateral units) over the width of the neck; 0 where there is no neck.
  pure real(wp) function spacing_over_neck(this, spacing)
    type(problem_t), intent(in) :: this
    real(wp), intent(in) :: spacing

    spacing_over_neck = spacing*this%coupling*this%law%adhesion/neck
  end function spacing_over_neck

  !> Tabor's parameter (R gamma^2/(E*^2 L^3))^(1/3) = (4 sigma^2)^(1/3); 0 without adhesion.
  pure real(wp) function tabor_parameter(this)
    type(problem_t), intent(in) :: this

    tabor_parameter = (4*(this%coupling*this%law%adhesion)**2)**(1.0_wp/3)
  end function tabor_parameter

  !> gamma [J/m^2], the depth of the energy minimum; 0 for a law that does not attract.
  pure real(wp) function surface_energy(this)
    type(problem_t), intent(in) :: this

    surface_energy = this%law%adhesion*this%pressure*this%length
  end function surface_energy

  !> Largest tension of the law [Pa], that at the contact edge; 0 for a law without a largest one.
  pure real(wp) function largest_tension(this)
    type(problem_t), intent(in) :: this
    real(wp) :: pressure(1)

    largest_tension = 0
    if (.not. this%law%edge_gap > 0) return
    pressure = this%law%pressure([this%law%edge_gap])
    largest_tension = -pressure(1)*this%pressure
  end function largest_tension

end module problem
