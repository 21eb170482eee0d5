!> Repulsion and attraction as two powers of the gap: with the surface energy w
!> p = (w/z0) C [(z0/h)^n - (z0/h)^m], C = (n - 1)(m - 1)/(n - m), whole or either part alone. With
!> n, m = 9, 3 it is the Lennard-Jones law between half-spaces.
module power_pair
  use kinds, only: wp
  use force_law, only: force_law_t
  implicit none
  private
  public :: new_power_pair, pair_factor

  type, extends(force_law_t) :: power_pair_t
    real(wp) :: n = 9, m = 3
    !> C times the weights of the parts, which are 0 or 1.
    real(wp) :: repulsive = 0, attractive = 0
  contains
    procedure :: pressure
    procedure :: slope
    procedure :: energy
  end type power_pair_t

contains

  !> The factor C.
  pure real(wp) function pair_factor(exponents)
    real(wp), intent(in) :: exponents(2)

    pair_factor = (exponents(1) - 1)*(exponents(2) - 1)/(exponents(1) - exponents(2))
  end function pair_factor

  !> surface_energy [J/m^2], z0 [m]; exponents n > m > 1; part is 'full', 'repulsive' or
  !> 'attractive'. Scales have closed forms; all else is as in `new_lennard_jones`.
  pure type(power_pair_t) function new_power_pair(surface_energy, z0, exponents, part) result(law)
    real(wp), intent(in) :: surface_energy, z0, exponents(2)
    character(len=*), intent(in) :: part

    law%n = exponents(1)
    law%m = exponents(2)
    law%repulsive = merge(0.0_wp, pair_factor(exponents), part == 'attractive')
    law%attractive = merge(0.0_wp, pair_factor(exponents), part == 'repulsive')
    law%length = z0
    law%has_z0 = .true.
    law%pressure_unit = surface_energy/z0
    law%range = 60
    law%tail_power = law%m
    if (part == 'repulsive') law%tail_power = law%n
    law%smallest_gap = 10.0_wp**(-120/(law%n + 1))
    if (part /= 'attractive') law%repulsion_length = 0.9_wp/law%n
    law%closure_fraction = 2.7_wp/law%n
    if (part /= 'repulsive') law%adhesion = 1
    if (part == 'full') then
      law%edge_gap = (law%n/law%m)**(1/(law%n - law%m))
      law%rest_gap = 1
    end if
    law%group = 'force'
    law%strength_key = 'surface_energy'
    law%length_key = 'z0'
  end function new_power_pair

  pure function pressure(self, gap) result(value)
    class(power_pair_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = self%repulsive*gap**(-self%n) - self%attractive*gap**(-self%m)
  end function pressure

  pure function slope(self, gap) result(value)
    class(power_pair_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = (self%attractive*self%m*gap**(-self%m) - self%repulsive*self%n*gap**(-self%n))/gap
  end function slope

  pure function energy(self, gap) result(value)
    class(power_pair_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = gap*(self%repulsive/(self%n - 1)*gap**(-self%n) - &
      self%attractive/(self%m - 1)*gap**(-self%m))
  end function energy

end module power_pair
