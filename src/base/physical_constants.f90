!> Constants of nature (CODATA 2018), in SI units.
module physical_constants
  use kinds, only: wp
  implicit none
  private
  public :: elementary_charge, boltzmann, vacuum_permittivity, avogadro

  !> [C], [J/K], [F/m], [1/mol].
  real(wp), parameter :: elementary_charge = 1.602176634e-19_wp, boltzmann = 1.380649e-23_wp, &
    vacuum_permittivity = 8.8541878128e-12_wp, avogadro = 6.02214076e23_wp

end module physical_constants
