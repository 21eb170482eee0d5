!> The library as f2py can see it: scalars, arrays of explicit shape with their sizes last, and
!> for every procedure that may refuse its arguments `stat` (0, or the kind of the failure) and
!> `message`. No derived types, no optional arguments, no decisions: those live in the library, and
!> the checks of shape and value in the Python package above. Kinds are those of C, which f2py
!> knows; the length of `message` must be a literal for the same reason.
module snapin_flat
  use iso_c_binding, only: c_double, c_int
  implicit none
  private
  public :: classical_states, classical_curve, classical_profile, classical_loads
  public :: classical_pull_off, maugis_numbers, use_one_thread

contains

  !> Contact radii `a` [m] of the states at given values of a control: 'load' [N],
  !> 'displacement' [m], or 'edge_ratio' (Maugis-Dugdale alone); NaN where there is no state.
  subroutine classical_states(theory, control, values, radius, stiffness, surface_energy, &
    strength, a, stat, message, n)
    use classical, only: hertz_radius_at_load, hertz_radius_at_displacement, &
      jkr_radius_at_load, jkr_radius_at_displacement, dmt_radius_at_load
    use failure, only: bad_input
    use maugis, only: maugis_radius_at_edge_ratio
    character(len=*), intent(in) :: theory, control
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: values(n), radius, stiffness, surface_energy, strength
    real(c_double), intent(out) :: a(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    a = 0
    select case (trim(theory)//' at '//trim(control))
    case ('hertz at load')
      a = hertz_radius_at_load(values, radius, stiffness)
    case ('hertz at displacement', 'dmt at displacement')
      a = hertz_radius_at_displacement(values, radius)
    case ('jkr at load')
      a = jkr_radius_at_load(values, radius, stiffness, surface_energy)
    case ('jkr at displacement')
      a = jkr_radius_at_displacement(values, radius, stiffness, surface_energy)
    case ('dmt at load')
      a = dmt_radius_at_load(values, radius, stiffness, surface_energy)
    case ('maugis at edge_ratio')
      a = maugis_radius_at_edge_ratio(values, radius, stiffness, surface_energy, strength)
    case default
      stat = bad_input
      message = 'theory: "'//trim(theory)//'" has no states at given "'//trim(control)//'"'
    end select
  end subroutine classical_states

  !> Load [N] and displacement [m] at contact radii `a` [m].
  subroutine classical_curve(theory, a, radius, stiffness, surface_energy, strength, load, &
    displacement, stat, message, n)
    use classical, only: hertz_load, hertz_displacement, jkr_load, jkr_displacement, dmt_load
    use failure, only: bad_input
    use maugis, only: maugis_load, maugis_displacement
    character(len=*), intent(in) :: theory
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: a(n), radius, stiffness, surface_energy, strength
    real(c_double), intent(out) :: load(n), displacement(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    load = 0
    displacement = 0
    select case (theory)
    case ('hertz')
      load = hertz_load(a, radius, stiffness)
      displacement = hertz_displacement(a, radius)
    case ('jkr')
      load = jkr_load(a, radius, stiffness, surface_energy)
      displacement = jkr_displacement(a, radius, stiffness, surface_energy)
    case ('dmt')
      load = dmt_load(a, radius, stiffness, surface_energy)
      displacement = hertz_displacement(a, radius)
    case ('maugis')
      load = maugis_load(a, radius, stiffness, surface_energy, strength)
      displacement = maugis_displacement(a, radius, stiffness, surface_energy, strength)
    case default
      stat = bad_input
      message = 'theory: there is no "'//trim(theory)//'"'
    end select
  end subroutine classical_curve

  !> Pressure [Pa] and gap [m] at distances `r` [m] from the axis, for one contact radius `a` [m].
  subroutine classical_profile(theory, r, a, radius, stiffness, surface_energy, pressure, gap, &
    stat, message, n)
    use classical, only: hertz_pressure, hertz_gap, jkr_pressure, jkr_gap
    use failure, only: bad_input
    character(len=*), intent(in) :: theory
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: r(n), a, radius, stiffness, surface_energy
    real(c_double), intent(out) :: pressure(n), gap(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    pressure = 0
    gap = 0
    select case (theory)
    case ('hertz')
      pressure = hertz_pressure(r, a, radius, stiffness)
      gap = hertz_gap(r, a, radius)
    case ('jkr')
      pressure = jkr_pressure(r, a, radius, stiffness, surface_energy)
      gap = jkr_gap(r, a, radius, stiffness, surface_energy)
    case default
      stat = bad_input
      message = 'theory: "'//trim(theory)//'" has no profile'
    end select
  end subroutine classical_profile

  !> Loads [N] at displacements [m] on the branch that is stable under a fixed displacement.
  subroutine classical_loads(theory, displacement, radius, stiffness, surface_energy, load, &
    stat, message, n)
    use classical, only: hertz_load_at_displacement, jkr_load_at_displacement, &
      dmt_load_at_displacement
    use failure, only: bad_input
    character(len=*), intent(in) :: theory
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: displacement(n), radius, stiffness, surface_energy
    real(c_double), intent(out) :: load(n)
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    load = 0
    select case (theory)
    case ('hertz')
      load = hertz_load_at_displacement(displacement, radius, stiffness)
    case ('jkr')
      load = jkr_load_at_displacement(displacement, radius, stiffness, surface_energy)
    case ('dmt')
      load = dmt_load_at_displacement(displacement, radius, stiffness, surface_energy)
    case default
      stat = bad_input
      message = 'theory: "'//trim(theory)//'" gives no load at a displacement'
    end select
  end subroutine classical_loads

  !> Load [N] at the pull-off under a fixed 'load' or a fixed 'displacement'.
  subroutine classical_pull_off(theory, control, radius, stiffness, surface_energy, strength, &
    load, stat, message)
    use classical, only: jkr_pull_off, jkr_pull_off_fixed_displacement, dmt_pull_off
    use failure, only: bad_input
    use maugis, only: maugis_pull_off
    character(len=*), intent(in) :: theory, control
    real(c_double), intent(in) :: radius, stiffness, surface_energy, strength
    real(c_double), intent(out) :: load
    integer(c_int), intent(out) :: stat
    character(len=200), intent(out) :: message

    stat = 0
    message = ''
    load = 0
    select case (trim(theory)//' at '//trim(control))
    case ('jkr at load')
      load = jkr_pull_off(radius, surface_energy)
    case ('jkr at displacement')
      load = jkr_pull_off_fixed_displacement(radius, surface_energy)
    case ('dmt at load')
      load = dmt_pull_off(radius, surface_energy)
    case ('maugis at load')
      load = maugis_pull_off(radius, stiffness, surface_energy, strength)
    case default
      stat = bad_input
      message = 'theory: "'//trim(theory)//'" has no pull-off at fixed "'//trim(control)//'"'
    end select
  end subroutine classical_pull_off

  !> Maugis' parameter, the strength [Pa] that stands for a Lennard-Jones law of length `z0` [m],
  !> and c/a at contact radii `a` [m], all for that strength.
  subroutine maugis_numbers(a, radius, stiffness, surface_energy, z0, strength, lambda, &
    edge_ratio, n)
    use maugis, only: lennard_jones_strength, maugis_lambda, maugis_edge_ratio
    integer(c_int), intent(in) :: n
    real(c_double), intent(in) :: a(n), radius, stiffness, surface_energy, z0
    real(c_double), intent(out) :: strength, lambda, edge_ratio(n)

    strength = lennard_jones_strength(surface_energy, z0)
    lambda = maugis_lambda(radius, stiffness, surface_energy, strength)
    edge_ratio = maugis_edge_ratio(a, radius, stiffness, surface_energy, strength)
  end subroutine maugis_numbers

  !> Lets the calling thread compute alone from now on: in a process that was forked after the
  !> OpenMP run-time had started threads they are gone, and it would wait for them for ever.
  subroutine use_one_thread()
    !$ use omp_lib, only: omp_set_num_threads

    !$ call omp_set_num_threads(1)
  end subroutine use_one_thread

end module snapin_flat
