!> A force that is known at points. The pressure, or the energy, is divided by its tail and then
!> interpolated. For a tail that is a power, q = p g^m is interpolated as a function of u = ln g;
!> for an exponential tail, q = p exp(u) with u = g/l. The gap g is in units of the first gap. If
!> the pressure is given, the energy is the integral of the interpolant; if the energy is given, the
!> pressure is its derivative. Beyond the last point q is constant. Before the first point the
!> pressure is a power of the gap that continues its value and slope.
module force_table
  use kinds, only: wp
  use interpolation, only: spline, monotone, interval_of
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: force_table_t, new_force_table, largest_step

  !> The quadrature is exact except for rounding over intervals in which the tail falls by no more
  !> than exp(-largest_step).
  integer, parameter :: order = 16
  real(wp), parameter :: largest_step = 10

  type :: force_table_t
    logical :: of_energy = .false.
    !> Exponents of the tails of the interpolated quantity and of the energy; 1 for an exponential
    !> tail.
    real(wp) :: rate = 1, energy_rate = 1
    !> The decay length l; 0 for a tail that is a power.
    real(wp) :: decay_length = 0
    !> The repulsion before the first point is gap^-power; pressure and energy are those at the
    !> first point.
    real(wp) :: power = 0, pressure = 0, energy = 0
    real(wp), allocatable :: u(:), cubic(:, :), energy_from(:)
    real(wp) :: x(order) = 0, w(order) = 0
  contains
    procedure :: values
    procedure, private :: u_of, integral
  end type force_table_t

contains

  !> Makes the table from `value`, pressures or energies at the ascending gaps g, the first of which
  !> is 1. Beyond the last point the pressure falls as g^-tail_exponent, or as exp(-g/decay_length)
  !> if decay_length is not 0.
  function new_force_table(g, value, of_energy, tail_exponent, decay_length, by_spline) &
    result(table)
    real(wp), intent(in) :: g(:), value(:), tail_exponent, decay_length
    logical, intent(in) :: of_energy, by_spline
    type(force_table_t) :: table
    real(wp) :: at_first(3)
    integer :: n, i

    n = size(g)
    table%of_energy = of_energy
    table%decay_length = decay_length
    if (.not. decay_length > 0) then
      table%energy_rate = tail_exponent - 1
      table%rate = merge(table%energy_rate, tail_exponent, of_energy)
    end if
    call gauss_legendre(table%x, table%w)
    table%u = table%u_of(g)
    if (by_spline) then
      table%cubic = spline(table%u, value*exp(table%rate*table%u))
    else
      table%cubic = monotone(table%u, value*exp(table%rate*table%u))
    end if
    allocate (table%energy_from(n))
    table%energy_from(n) = value(n)
    if (.not. of_energy) then
      table%energy_from(n) = value(n)*merge(decay_length, g(n), decay_length > 0)/table%energy_rate
      do i = n - 1, 1, -1
        table%energy_from(i) = table%energy_from(i + 1) + table%integral(i, table%u(i))
      end do
    end if
    at_first = table%values(1.0_wp, with_energy=.true.)
    table%pressure = at_first(1)
    table%energy = at_first(3)
    ! If the pressure vanishes, it has no power.
    table%power = -at_first(2)/sign(max(abs(at_first(1)), tiny(1.0_wp)), at_first(1))
  end function new_force_table

  !> The coordinate u of a gap.
  elemental real(wp) function u_of(self, gap) result(u)
    class(force_table_t), intent(in) :: self
    real(wp), intent(in) :: gap

    if (self%decay_length > 0) then
      u = gap/self%decay_length
    else
      u = log(gap)
    end if
  end function u_of

  !> The integral of the pressure from u, in interval i, to the end of this interval.
  pure real(wp) function integral(self, i, u)
    class(force_table_t), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: u
    real(wp) :: v(order), t(order)

    v = u + (self%u(i + 1) - u)*self%x
    t = v - self%u(i)
    associate (c => self%cubic(:, i))
      integral = (self%u(i + 1) - u)* &
        sum(self%w*(c(1) + t*(c(2) + t*(c(3) + t*c(4))))*exp(-self%energy_rate*v))
    end associate
    if (self%decay_length > 0) integral = integral*self%decay_length
  end function integral

  !> Pressure, slope and energy at a gap. with_energy = .false.: pressure and slope only, which
  !> takes less time.
  pure function values(self, gap, with_energy) result(value)
    class(force_table_t), intent(in) :: self
    real(wp), intent(in) :: gap
    logical, intent(in) :: with_energy
    real(wp) :: value(3), u, t, q(0:2), fall, du, ddu, z
    integer :: i, n

    if (gap < 1) then
      value(1) = self%pressure*gap**(-self%power)
      value(2) = -self%power*value(1)/gap
      value(3) = 0
      if (.not. with_energy) return
      ! The integral (g^(1 - n) - 1)/(n - 1), whose limit at n = 1 is -ln g.
      z = (1 - self%power)*log(gap)/2
      z = sign(max(abs(z), epsilon(z)), z)
      value(3) = self%energy - self%pressure*log(gap)*exp(z)*sinh(z)/z
      return
    end if
    n = size(self%u)
    u = self%u_of(gap)
    du = 1/gap
    ddu = -1/gap**2
    if (self%decay_length > 0) then
      du = 1/self%decay_length
      ddu = 0
    end if
    i = interval_of(self%u(:n - 1), u)
    t = min(u, self%u(n)) - self%u(i)
    associate (c => self%cubic(:, i))
      q = [c(1) + t*(c(2) + t*(c(3) + t*c(4))), c(2) + t*(2*c(3) + 3*t*c(4)), 2*c(3) + 6*t*c(4)]
    end associate
    if (u >= self%u(n)) q(1:) = 0
    fall = exp(-self%rate*u)
    ! The derivative by u, with the factor of the tail.
    q(2) = fall*(q(2) - 2*self%rate*q(1) + self%rate**2*q(0))
    q(1) = fall*(q(1) - self%rate*q(0))
    q(0) = fall*q(0)
    if (self%of_energy) then
      value = [-du*q(1), -ddu*q(1) - du**2*q(2), q(0)]
    else if (u >= self%u(n)) then
      value = [q(0), du*q(1), q(0)/(du*self%energy_rate)]
    else
      value = [q(0), du*q(1), 0.0_wp]
      if (with_energy) value(3) = self%energy_from(i + 1) + self%integral(i, u)
    end if
  end function values

end module force_table
