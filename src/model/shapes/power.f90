!> The gap B r^n. The lateral unit is the position at which the gap is half the law's length L, so
!> that the dimensionless gap is r^n/2; for n = 2 it is the parabola itself.
module power
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use group_reading, only: require, check_decades, read_radius, refuse_radius
  use shape, only: shape_t
  use parabola, only: new_parabola
  implicit none
  private
  public :: keys, read_shape, take_power

  type, extends(shape_t) :: power_t
    real(wp), private :: kappa = 2
    !> n if it is an integer, otherwise 0; products are computed faster than general powers.
    integer, private :: whole = 0
  contains
    procedure :: height
    procedure :: slope
    procedure :: position_of
    procedure :: indentation
    procedure :: indentation_load
    procedure :: contact_radius
  end type power_t

  !> The rows of a power in &shape.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('shape', 'exponent', real_value, 'n of the gap B r^n.', low=1.0_wp, high=10.0_wp), &
    key_spec('shape', 'coefficient', real_value, 'B of the gap B r^n.', 'm^(1-n)', above=0.0_wp, &
      otherwise='1/(2 R^(n-1))')]

contains

  !> Reads kind = 'power': B from coefficient or radius. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    real(wp) :: n, coefficient, radius

    call require(deck, 'shape', 'kind', 'power', 'exponent')
    if (allocated(deck%error)) return
    call deck%get('shape', 'exponent', n)
    if (deck%is_set('shape', 'coefficient')) then
      call refuse_radius(deck, 'the coefficient replaces it')
      call deck%get('shape', 'coefficient', coefficient)
      if (abs(n - 2) > 0) then
        call take_power(deck, 'coefficient', n, log(coefficient), length, shape)
      else
        allocate (shape, source=new_parabola(0.5_wp/coefficient))
      end if
    else
      call read_radius(deck, radius)
      if (allocated(deck%error)) return
      if (abs(n - 2) > 0) then
        call take_power(deck, 'exponent', n, -(n - 1)*log(radius) - log(2.0_wp), length, shape)
      else
        allocate (shape, source=new_parabola(radius))
      end if
    end if
  end subroutine read_shape

  !> Makes the shape from n, the logarithm of B [m^(1-n)] and the law's length [m]. It fails, with
  !> the given key in the message, if the lateral unit is out of range.
  subroutine take_power(deck, key, n, log_b, length, shape)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: n, log_b, length
    class(shape_t), allocatable, intent(out) :: shape
    type(power_t) :: this
    real(wp) :: log_radius

    log_radius = 2*(log(length) - log(2.0_wp) - log_b)/n - log(length)
    call check_decades(deck, 'shape', key, log_radius/log(10.0_wp), 'a radius', ' m')
    if (allocated(deck%error)) return
    this%radius = exp(log_radius)
    this%exponent = n
    this%growth = n
    if (.not. abs(n - nint(n)) > 0) this%whole = nint(n)
    this%kappa = sqrt(pi)*gamma(n/2 + 1)/gamma((n + 1)/2)
    allocate (shape, source=this)
  end subroutine take_power

  elemental real(wp) function height(self, r) result(value)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: r

    if (self%whole > 0) then
      value = 0.5_wp*r**self%whole
    else
      value = 0.5_wp*r**self%exponent
    end if
  end function height

  elemental real(wp) function slope(self, r) result(value)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: r

    if (self%whole > 0) then
      value = 0.5_wp*self%whole*r**(self%whole - 1)
    else
      value = 0.5_wp*self%exponent*r**(self%exponent - 1)
    end if
  end function slope

  elemental real(wp) function position_of(self, height) result(r)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: height

    r = (2*height)**(1/self%exponent)
  end function position_of

  !> The indentation kappa B a^n, kappa = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2).
  elemental real(wp) function indentation(self, a)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: a

    indentation = 0.5_wp*self%kappa*a**self%exponent
  end function indentation

  !> The load integral, n/(n + 1) times a q(a).
  elemental real(wp) function indentation_load(self, a) result(load)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: a

    load = self%exponent/(self%exponent + 1)*a*self%indentation(a)
  end function indentation_load

  elemental real(wp) function contact_radius(self, depth) result(a)
    class(power_t), intent(in) :: self
    real(wp), intent(in) :: depth

    a = (2*max(depth, 0.0_wp)/self%kappa)**(1/self%exponent)
  end function contact_radius

end module power
