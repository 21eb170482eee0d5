!> Exponential repulsion, (30) of the paper: p = p0 exp(-h/decay_length).
module exponential
  use kinds, only: wp
  use force_law, only: force_law_t
  implicit none
  private
  public :: exponential_t, new_exponential

  type, extends(force_law_t) :: exponential_t
  contains
    procedure :: pressure
    procedure :: slope
    procedure :: energy
  end type exponential_t

  !> Exponent beyond which the pressure would underflow or overflow.
  real(wp), parameter :: largest_exponent = 700

contains

  !> p0 [Pa], decay_length [m], both positive.
  pure function new_exponential(p0, decay_length) result(law)
    real(wp), intent(in) :: p0, decay_length
    type(exponential_t) :: law

    law%length = decay_length
    law%pressure_unit = p0
    law%range = 45
    ! The pressure may grow sevenfold in an iteration.
    law%closure_length = 2
  end function new_exponential

  !> exp(-gap); 0 without underflow at large gaps, finite at any gap.
  pure function pressure(self, gap) result(value)
    class(exponential_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    ! Both branches of a mask may be evaluated everywhere, hence the bounds on both sides.
    where (gap < largest_exponent)
      value = exp(-max(min(gap, largest_exponent), -largest_exponent))
    elsewhere
      value = 0
    end where
  end function pressure

  pure function slope(self, gap) result(value)
    class(exponential_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = -self%pressure(gap)
  end function slope

  pure function energy(self, gap) result(value)
    class(exponential_t), intent(in) :: self
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))

    value = self%pressure(gap)
  end function energy

end module exponential
