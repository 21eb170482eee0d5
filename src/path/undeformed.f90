!> Bodies so far apart that they do not deform: Derjaguin's load (23) and the energy, closed forms
!> in the units of `dimensionless_problem`.
module undeformed
  use kinds, only: wp, pi
  use force_law, only: force_law_t
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: load_undeformed, load_slope_undeformed, energy_undeformed

  !> The energy is integrated over the logarithm of the gap: panels, their ratio, nodes of each.
  !> Beyond 1e18 gaps nothing is left of any law.
  integer, parameter :: panels = 60, nodes = 8
  real(wp), parameter :: ratio = 2

contains

  !> The load at h0, 2 pi e(h0).
  pure real(wp) function load_undeformed(law, h0) result(load)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: h0

    load = 2*pi*sum(law%energy([h0]))
  end function load_undeformed

  !> Its derivative by h0.
  pure real(wp) function load_slope_undeformed(law, h0) result(slope)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: h0

    slope = -2*pi*sum(law%pressure([h0]))
  end function load_slope_undeformed

  !> The energy at h0 > 0, whose derivative by h0 is minus the load.
  pure real(wp) function energy_undeformed(law, h0) result(energy)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: h0
    real(wp) :: node(nodes), weight(nodes), gap(nodes)
    integer :: panel

    call gauss_legendre(node, weight)
    energy = 0
    do panel = 1, panels
      gap = h0*ratio**(panel - 1 + node)
      energy = energy + log(ratio)*sum(weight*gap*law%energy(gap))
    end do
    energy = 2*pi*energy
  end function energy_undeformed

end module undeformed
