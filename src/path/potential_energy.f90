!> The energy of the two bodies at controlled h0: that of the surface forces and that of the elastic
!> deformation. At fixed h0 an equilibrium is a stationary state of it, and along equilibria its
!> derivative by h0 is minus the load. What a jump loses is the difference between its ends, and no
!> integral along the path is needed.
module potential_energy
  use kinds, only: wp, pi
  use equilibrium, only: state_t, equations_t, gap_at_end
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: energy_of

  !> Points for the surface energy beyond the mesh, where it is a power of the gap or nothing.
  integer, parameter :: points = 8

contains

  !> 2 pi Int [e(H) + P (H - H0 - rho^2/2)/2] rho drho in units of load times length: e is the
  !> energy of the surface force per area, and the bodies have yielded by H - H0 - rho^2/2.
  !> uncertainty: what rounding, and a residual of the equations, leave of it.
  subroutine energy_of(equations, mesh, state, energy, uncertainty)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: energy, uncertainty
    real(wp) :: node(points), weight(points), last
    real(wp), dimension(size(state%gap)) :: of_surface, of_bodies

    call gauss_legendre(node, weight)
    associate (n => size(state%gap), c => state%scale, grid => equations%pair%grid(mesh), &
      law => equations%problem%law)
      of_surface = c**2*grid%weight(:n)*law%energy(state%gap)
      of_bodies = c**2*grid%weight(:n)*0.5_wp*state%pressure* &
        (state%gap - state%h0 - 0.5_wp*(c*grid%x(:n))**2)
      uncertainty = 2*pi*(epsilon(1.0_wp)*sum(abs(of_surface) + abs(of_bodies)) + &
        0.5_wp*state%residual*c**2*sum(abs(grid%weight(:n)*state%pressure)))
      energy = 2*pi*(sum(of_surface) + sum(of_bodies))
      if (.not. grid%is_bounded()) return
      ! Beyond the mesh rho drho = dH. With H = last/x the interval is finite.
      last = gap_at_end(grid, state)
      energy = energy + 2*pi*last*sum(weight*law%energy(last/node)/node**2)
    end associate
  end subroutine energy_of

end module potential_energy
