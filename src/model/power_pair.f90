!> Repulsion and attraction as two powers of the gap. With the work of adhesion w, the pressure is p
!> = (w/z0) C [(z0/h)^n - (z0/h)^m], C = (n - 1)(m - 1)/(n - m), either as a whole or one part
!> alone. With n, m = 9, 3 it is the Lennard-Jones law between half-spaces.
module power_pair
  use kinds, only: wp
  use force_law, only: force_law_t, of_pressure, of_slope, closure_of_power, length_of_power
  implicit none
  private
  public :: power_pair_t, new_power_pair, pair_factor

  !> The pressure is repulsive/gap^n - attractive/gap^m. In units of w/z0 these two factors are C
  !> times the weights of the parts, which are 0 or 1.
  type, extends(force_law_t) :: power_pair_t
    real(wp) :: n = 9, m = 3
    real(wp) :: repulsive = 0, attractive = 0
  contains
    procedure :: set_scales
    procedure :: evaluate
  end type power_pair_t

contains

  !> The factor C.
  pure real(wp) function pair_factor(exponents)
    real(wp), intent(in) :: exponents(2)

    pair_factor = (exponents(1) - 1)*(exponents(2) - 1)/(exponents(1) - exponents(2))
  end function pair_factor

  !> Makes the law. surface_energy: the work of adhesion w [J/m^2]; z0 [m]; exponents: n > m > 1;
  !> part: 'full', 'repulsive' or 'attractive'. The scales have closed forms.
  pure type(power_pair_t) function new_power_pair(surface_energy, z0, exponents, part) result(law)
    real(wp), intent(in) :: surface_energy, z0, exponents(2)
    character(len=*), intent(in) :: part

    law%n = exponents(1)
    law%m = exponents(2)
    law%repulsive = merge(0.0_wp, pair_factor(exponents), part == 'attractive')
    law%attractive = merge(0.0_wp, pair_factor(exponents), part == 'repulsive')
    law%length = z0
    law%pressure_unit = surface_energy/z0
    law%range = 60
    law%tail_power = law%m
    if (part == 'repulsive') law%tail_power = law%n
    call law%set_scales()
    if (part /= 'repulsive') law%adhesion = 1
    if (part == 'attractive') law%falls_below = huge(1.0_wp)
    if (part == 'full') then
      law%edge_gap = (law%n/law%m)**(1/(law%n - law%m))
      law%rest_gap = 1
    end if
    law%group = 'force'
    law%strength_key = 'work_of_adhesion'
    law%length_key = 'z0'
  end function new_power_pair

  !> Sets the scales that follow from n.
  pure subroutine set_scales(self)
    class(power_pair_t), intent(inout) :: self

    self%has_z0 = .true.
    ! The slope at this gap is 1e121, whose square does not overflow.
    self%smallest_gap = 10.0_wp**(-120/(self%n + 1))
    if (self%repulsive > 0) self%repulsion_length = length_of_power/self%n
    self%closure_fraction = closure_of_power/self%n
  end subroutine set_scales

  pure subroutine evaluate(self, quantity, gap, value)
    class(power_pair_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp), intent(out) :: value(size(gap))

    select case (quantity)
    case (of_pressure)
      value = self%repulsive*inverse_power(gap, self%n)
      if (self%attractive > 0) value = value - self%attractive*inverse_power(gap, self%m)
    case (of_slope)
      value = -self%repulsive*self%n*inverse_power(gap, self%n + 1)
      if (self%attractive > 0) value = value + self%attractive*self%m*inverse_power(gap, self%m + 1)
    case default
      value = self%repulsive/(self%n - 1)*inverse_power(gap, self%n - 1)
      if (self%attractive > 0) &
        value = value - self%attractive/(self%m - 1)*inverse_power(gap, self%m - 1)
    end select
  end subroutine evaluate

  !> gap**(-n). For integer exponents multiplications suffice, which take a quarter of the time.
  pure function inverse_power(gap, n) result(value)
    real(wp), intent(in) :: gap(:), n
    real(wp) :: value(size(gap)), square(size(gap))
    integer, parameter :: most = 32
    integer :: left

    if (n > most .or. abs(n - nint(n)) > 0) then
      value = gap**(-n)
      return
    end if
    left = nint(n)
    square = 1/gap
    value = 1
    do
      if (modulo(left, 2) == 1) value = value*square
      left = left/2
      if (left == 0) exit
      square = square*square
    end do
  end function inverse_power

end module power_pair
