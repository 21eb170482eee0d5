!> The energy of the two bodies at controlled h0: the energy of the surface forces plus that of the
!> elastic deformation. At fixed h0 an equilibrium is a stationary point of this energy, and along
!> equilibria the derivative by h0 is minus the load. The energy that a jump dissipates is the
!> difference between its ends, so no integral along the path is needed.
module potential_energy
  use kinds, only: wp, pi
  use far_field, only: energy_density, falls_slowly
  use dimensionless_problem, only: calm_gap
  use undeformed, only: energy_undeformed
  use contact_state, only: state_t
  use equilibrium, only: equations_t
  implicit none
  private
  public :: energy_of, energy_of_surface

  !> A pressure that falls at least as fast as this power of r hardly acts beyond a mesh.
  real(wp), parameter :: falls_far = 3

contains

  !> 2 pi Int [e(H) + P (H - H0 - f)/2] rho drho, in units of load times length. Here e is the
  !> `energy_density` of the surface force, and H - H0 - f the deformation of the bodies.
  !> uncertainty: error of the energy due to rounding and the residual of the equations.
  subroutine energy_of(equations, mesh, state, energy, uncertainty)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: energy, uncertainty
    real(wp), dimension(size(state%gap)) :: of_bodies
    real(wp) :: of_surface, size_of_surface

    call find_energy_of_surface(equations, mesh, state, of_surface, size_of_surface)
    associate (n => size(state%gap), c => state%scale, grid => equations%meshes%grid(mesh), &
      shape => equations%problem%shape)
      of_bodies = 2*pi*c**2*grid%weight(:n)*0.5_wp*state%pressure* &
        (state%gap - state%h0 - shape%height(c*grid%x(:n)))
      uncertainty = epsilon(1.0_wp)*(size_of_surface + sum(abs(of_bodies))) + &
        pi*state%residual*c**2*sum(abs(grid%weight(:n)*state%pressure))
      energy = of_surface + sum(of_bodies)
    end associate
  end subroutine energy_of

  !> The part of the surface force, 2 pi Int e(H) rho drho. Beyond a bounded mesh nothing is added.
  !> There the bodies count as undeformed and have the same energy at both ends of a jump; pressures
  !> there would shift both branches by nearly the same h0.
  real(wp) function energy_of_surface(equations, mesh, state) result(energy)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp) :: whole

    call find_energy_of_surface(equations, mesh, state, energy, whole)
  end function energy_of_surface

  !> The energy of the surface force, and the sum of the magnitudes of its terms. If the energy per
  !> area falls slowly with the radius, that of undeformed bodies is subtracted at each node and
  !> added as an exact integral. The H0 of these bodies is chosen such that their energy per area is
  !> smooth on the mesh: the height at the contact edge, or a gap beyond the law's features.
  subroutine find_energy_of_surface(equations, mesh, state, energy, whole)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: energy, whole
    real(wp) :: terms(size(state%gap)), reference

    associate (n => size(state%gap), c => state%scale, grid => equations%meshes%grid(mesh), &
      problem => equations%problem)
      reference = 1
      ! Where pressures fall more slowly than this, load and energy beyond the mesh have few
      ! accurate digits.
      if (falls_slowly(problem) .and. problem%law%tail_power >= &
        falls_far/max(problem%shape%exponent, problem%shape%growth)) &
        reference = max(problem%shape%height(c), calm_gap(problem))
      terms = 2*pi*c**2*grid%weight(:n)*energy_density(problem, state%gap, c*grid%x(:n), reference)
      energy = sum(terms)
      whole = sum(abs(terms))
      ! Slowly falling energies are relative to that of undeformed bodies at H0 = 1.
      if (reference > 1) energy = energy + energy_undeformed(problem, reference)
    end associate
  end subroutine find_energy_of_surface

end module potential_energy
