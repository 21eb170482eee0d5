!> The compliance of a surface of bonded layers on a base, for a periodic pressure. Under p cos(k
!> x), or p J0(k r), the surface moves by 2 p L(k)/(E' k) times the same function, with E' =
!> E/(1-nu^2) of the top layer. For a half-space L = 1.
!>
!> In a layer the amplitudes (U, W, S, T) are displacements along and across the surface, and normal
!> (S) and tangential (T) stresses over the shear modulus G. With z k as depth they obey
!>
!>     U' = W + T,  W' = -eta U + beta S,  T' = gamma U + eta S,  S' = -T ,
!>
!> eta = nu/(1-nu), beta = (1-2nu)/(2(1-nu)), gamma = 2/(1-nu), all finite at nu = 1/2. The base
!> allows two such states. Both grow upward in the same way, and their difference would be lost.
!> Instead their five minors are followed upward (Dunkin, Bull. Seism. Soc. Am. 55, 335 (1965)),
!> with signs that make them positive in a half-space:
!>
!>     p = -|U W|,  q = |U S|,  r = -|W S| = |U T|,  v = -|W T|,  x = |S T| ,
!>     d/d(-z) (p, q, r, v, x) =
!>       (v + beta q, x + 2 r, v - eta q, gamma p - 2 eta r + beta x, gamma q) .
!>
!> This matrix M satisfies M^3 (M^2 - 4) = 0, so that a layer of k t = a changes minors y into
!>
!>     exp(M a) y = [1 + a M + a^2/2 M^2 + (sinh 2a - 2a)/8 M^3 + (cosh 2a - 1 - 2 a^2)/16 M^4] y .
!>
!> At the surface, W/S without tangential stress T is -v/x.
module layered_surface
  use kinds, only: wp
  implicit none
  private
  public :: layered_surface_t

  !> Layers from the top down; any unit of length and any unit of modulus.
  type :: layered_surface_t
    real(wp), allocatable :: thickness(:), shear(:), poisson(:)
    !> The base below the layers is rigid, or a half-space.
    logical :: on_rigid = .false.
    real(wp) :: base_shear = 1, base_poisson = 0
  contains
    procedure :: compliance
  end type layered_surface_t

contains

  !> L at a wave number k > 0, in inverse units of the thicknesses.
  pure real(wp) function compliance(self, k)
    class(layered_surface_t), intent(in) :: self
    real(wp), intent(in) :: k
    real(wp) :: y(5), below
    integer :: i

    compliance = 1
    if (size(self%thickness) == 0) return
    y = [0, 0, 0, 0, 1]
    if (.not. self%on_rigid) then
      associate (nu => self%base_poisson)
        y = [0.75_wp - nu, 1 - nu, 0.5_wp - nu, 1 - nu, 1.0_wp]
      end associate
      below = self%base_shear
    else
      below = self%shear(size(self%shear))
    end if
    do i = size(self%thickness), 1, -1
      ! Stresses are relative to the shear modulus of the present layer.
      associate (ratio => self%shear(i)/below)
        y(1) = y(1)*ratio
        y(5) = y(5)/ratio
      end associate
      y = raised(y, self%poisson(i), k*self%thickness(i))
      y = y/maxval(abs(y))
      below = self%shear(i)
    end do
    compliance = y(4)/((1 - self%poisson(1))*y(5))
  end function compliance

  !> exp(M a - 2 a) y.
  pure function raised(y, nu, a) result(top)
    real(wp), intent(in) :: y(5), nu, a
    real(wp) :: top(5)
    real(wp) :: decay, factor(0:4), power(5)
    integer :: j

    decay = exp(-2*a)
    factor(:2) = decay*[1.0_wp, a, 0.5_wp*a**2]
    if (a > 1) then
      factor(3) = (0.5_wp*(1 - decay)*(1 + decay) - 2*a*decay)/8
      factor(4) = (0.5_wp*(1 - decay)**2 - 2*a**2*decay)/16
    else
      factor(3) = decay*rest(2*a, 3)/8
      factor(4) = decay*rest(2*a, 4)/16
    end if
    power = y
    top = factor(0)*y
    do j = 1, 4
      power = grown(power, nu)
      top = top + factor(j)*power
    end do
  end function raised

  !> M y.
  pure function grown(y, nu) result(my)
    real(wp), intent(in) :: y(5), nu
    real(wp) :: my(5)

    associate (eta => nu/(1 - nu), beta => (0.5_wp - nu)/(1 - nu), gamma => 2/(1 - nu))
      my = [y(4) + beta*y(2), y(5) + 2*y(3), y(4) - eta*y(2), &
        gamma*y(1) - 2*eta*y(3) + beta*y(5), gamma*y(2)]
    end associate
  end function grown

  !> x^n/n! + x^(n+2)/(n+2)! + ..., for x up to 2: sinh x - x with n = 3, cosh x - 1 - x^2/2 with 4.
  pure real(wp) function rest(x, n)
    real(wp), intent(in) :: x
    integer, intent(in) :: n
    integer, parameter :: terms = 12
    integer :: j

    rest = 1
    do j = terms, 1, -1
      rest = 1 + rest*x**2/((n + 2*j - 1)*(n + 2*j))
    end do
    rest = rest*x**n/product([(real(j, wp), j=2, n)])
  end function rest

end module layered_surface
