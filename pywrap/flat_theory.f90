!> Closed forms for f2py: the classical theories, and slowly varying deformation.
!> Conventions as in `flat_deck`.
module flat_theory
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: classical_values, maugis_numbers, slow_states

contains

  !> A quantity of a theory at values x, SI, NaN if there is no state. `quantity`: the contact
  !> 'radius at load', 'radius at displacement' or 'radius at edge_ratio' for x; 'load' and
  !> 'displacement' at contact radii x; 'pressure' and 'gap' at distances x from the axis for the
  !> contact radius `a`; 'load at displacement' on the branch that is stable at fixed displacement;
  !> 'pull_off at load' and 'pull_off at displacement' for any x. Arguments that a theory does not
  !> use are ignored.
  subroutine classical_values(theory, quantity, x, a, radius, stiffness, surface_energy, strength, &
    y, stat, n)
    use classical, only: dmt_load, dmt_load_at_displacement, dmt_pull_off, dmt_radius_at_load, &
      hertz_displacement, hertz_gap, hertz_load, hertz_load_at_displacement, hertz_pressure, &
      hertz_radius_at_displacement, hertz_radius_at_load, jkr_displacement, jkr_gap, jkr_load, &
      jkr_load_at_displacement, jkr_pressure, jkr_pull_off, jkr_pull_off_fixed_displacement, &
      jkr_radius_at_displacement, jkr_radius_at_load
    use failure, only: bad_input
    use maugis, only: maugis_t, new_maugis
    use transition_fits, only: transition_fit_t, carpick_fit, pietrement_fit
    character(len=*), intent(in) :: theory, quantity
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: x(n), a, radius, stiffness, surface_energy, strength
    real(c_double), intent(out) :: y(n)
    integer(c_int), intent(out) :: stat
    type(maugis_t) :: cohesive
    type(transition_fit_t) :: fit

    stat = 0
    if (surface_energy > 0) cohesive = new_maugis(radius, stiffness, surface_energy, strength)
    if (theory == 'carpick') fit = carpick_fit(cohesive)
    if (theory == 'pietrement_troyon') fit = pietrement_fit(cohesive)
    associate (r => radius, k => stiffness, gamma => surface_energy)
      select case (theory//' '//quantity)
      case ('hertz radius at load'); y = hertz_radius_at_load(x, r, k)
      case ('jkr radius at load'); y = jkr_radius_at_load(x, r, k, gamma)
      case ('dmt radius at load'); y = dmt_radius_at_load(x, r, k, gamma)
      case ('hertz radius at displacement', 'dmt radius at displacement')
        y = hertz_radius_at_displacement(x, r)
      case ('jkr radius at displacement'); y = jkr_radius_at_displacement(x, r, k, gamma)
      case ('maugis radius at load'); y = cohesive%radius_at_load(x)
      case ('carpick radius at load', 'pietrement_troyon radius at load')
        y = fit%radius_at_load(x)
      case ('pietrement_troyon displacement at load'); y = fit%displacement_at_load(x)
      case ('maugis radius at displacement'); y = cohesive%radius_at_displacement(x)
      case ('maugis radius at edge_ratio'); y = cohesive%radius_at_edge_ratio(x)
      case ('hertz load'); y = hertz_load(x, r, k)
      case ('jkr load'); y = jkr_load(x, r, k, gamma)
      case ('dmt load'); y = dmt_load(x, r, k, gamma)
      case ('maugis load'); y = cohesive%load(x)
      case ('hertz displacement', 'dmt displacement'); y = hertz_displacement(x, r)
      case ('jkr displacement'); y = jkr_displacement(x, r, k, gamma)
      case ('maugis displacement'); y = cohesive%displacement(x)
      case ('hertz pressure'); y = hertz_pressure(x, a, r, k)
      case ('jkr pressure'); y = jkr_pressure(x, a, r, k, gamma)
      case ('hertz gap'); y = hertz_gap(x, a, r)
      case ('jkr gap'); y = jkr_gap(x, a, r, k, gamma)
      case ('hertz load at displacement'); y = hertz_load_at_displacement(x, r, k)
      case ('jkr load at displacement'); y = jkr_load_at_displacement(x, r, k, gamma)
      case ('dmt load at displacement'); y = dmt_load_at_displacement(x, r, k, gamma)
      case ('jkr pull_off at load'); y = jkr_pull_off(r, gamma)
      case ('jkr pull_off at displacement'); y = jkr_pull_off_fixed_displacement(r, gamma)
      case ('dmt pull_off at load'); y = dmt_pull_off(r, gamma)
      case ('maugis pull_off at load'); y = cohesive%pull_off()
      case ('carpick pull_off at load', 'pietrement_troyon pull_off at load'); y = fit%pull_off
      case default
        y = 0
        stat = bad_input
      end select
    end associate
  end subroutine classical_values

  !> The strength [Pa] equal to the largest tension of a Lennard-Jones law of length `z0` [m], and
  !> for this strength Maugis' parameter, and c/a at contact radii `a` [m].
  subroutine maugis_numbers(a, radius, stiffness, surface_energy, z0, strength, lambda, &
    edge_ratio, n)
    use maugis, only: lennard_jones_strength, maugis_t, new_maugis
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: a(n), radius, stiffness, surface_energy, z0
    real(c_double), intent(out) :: strength, lambda, edge_ratio(n)
    type(maugis_t) :: theory

    strength = lennard_jones_strength(surface_energy, z0)
    theory = new_maugis(radius, stiffness, surface_energy, strength)
    lambda = theory%lambda
    edge_ratio = theory%edge_ratio(a)
  end subroutine maugis_numbers

  !> Displacement [m], its derivative by the gap, and load [N] of a deck's bodies at gaps on the
  !> axis [m], for slowly varying deformation. form: 'quadrature', 'closed_form' or
  !> 'attraction_only'. Displacements are NaN up to and beyond a pole in contact.
  subroutine slow_states(deck, form, gap, displacement, slope, load, stat, message, n)
    use deck_problem, only: pose
    use dimensionless_problem, only: problem_t
    use failure, only: bad_input
    use kinds, only: nan
    use slow_deformation, only: attraction_only, by_quadrature, closed_form, has_form, &
      slow_displacement, slow_load, slow_slope
    character(len=*), intent(in) :: deck, form
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: gap(n)
    real(c_double), intent(out) :: displacement(n), slope(n), load(n)
    integer(c_int), intent(out) :: stat
    character(len=16000), intent(out) :: message
    type(problem_t) :: problem
    integer :: which

    displacement = 0
    slope = 0
    load = 0
    call pose(deck, problem, stat, message)
    if (stat /= 0) return
    which = 0
    if (form == 'quadrature') which = by_quadrature
    if (form == 'closed_form') which = closed_form
    if (form == 'attraction_only') which = attraction_only
    if (which == 0 .or. .not. has_form(problem, which)) then
      stat = bad_input
      message = 'form: this law has no "'//trim(form)//'"'
      return
    end if
    associate (at => problem%law%gap_of(gap))
      displacement = slow_displacement(problem, which, at)*problem%length
      slope = slow_slope(problem, which, at)
      load = slow_load(problem, which, at)*problem%load
      if (problem%law%smallest_gap > problem%law%gap_of(0.0_c_double)) then
        where (at < problem%law%smallest_gap) displacement = nan
      end if
    end associate
  end subroutine slow_states

end module flat_theory
