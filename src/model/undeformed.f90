!> Bodies so far apart that they do not deform: Derjaguin's load (23) and the energy, in the units
!> of `dimensionless_problem`.
module undeformed
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t
  use beyond_mesh, only: load_beyond, load_slope_beyond, energy_beyond
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: load_undeformed, load_slope_undeformed, energy_undeformed

  !> The energy of parabolas is integrated over the logarithm of the gap: panels, their ratio, nodes
  !> of each.
  !> Beyond 1e18 gaps nothing is left of any law.
  integer, parameter :: panels = 60, nodes = 8
  real(wp), parameter :: ratio = 2

contains

  !> The load at h0; of parabolas 2 pi e(h0).
  pure real(wp) function load_undeformed(problem, h0) result(load)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0

    load = 2*pi*load_beyond(problem, h0, 0.0_wp)
  end function load_undeformed

  !> Its derivative by h0.
  pure real(wp) function load_slope_undeformed(problem, h0) result(slope)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    real(wp) :: slopes(2)

    slopes = load_slope_beyond(problem, h0, 0.0_wp)
    slope = 2*pi*slopes(1)
  end function load_slope_undeformed

  !> The energy at h0 > 0, whose derivative by h0 is minus the load.
  pure real(wp) function energy_undeformed(problem, h0) result(energy)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0
    real(wp) :: node(nodes), weight(nodes), gap(nodes)
    integer :: panel

    if (.not. problem%shape%parabolic) then
      energy = 2*pi*energy_beyond(problem, h0, 0.0_wp)
      return
    end if
    call gauss_legendre(node, weight)
    energy = 0
    do panel = 1, panels
      gap = h0*ratio**(panel - 1 + node)
      energy = energy + log(ratio)*sum(weight*gap*problem%law%energy(gap))
    end do
    energy = 2*pi*energy
  end function energy_undeformed

end module undeformed
