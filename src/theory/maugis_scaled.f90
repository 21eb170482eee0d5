!> Maugis-Dugdale theory in its own units, in which lambda is the only parameter.
!>
!> K = 2 stiffness/3 (4 E*/3), A = a/(pi gamma R^2/K)^(1/3), P = F/(pi gamma R),
!> D = delta/(pi^2 gamma^2 R/K^2)^(1/3), lambda = 2 strength (R/(pi gamma K^2))^(1/3). The width of
!> the zone is t = sqrt(m^2 - 1), m = c/a, which keeps its digits when m is close to one. `maugis`
!> defines a and c, and has the theory in SI units.
module maugis_scaled
  use kinds, only: wp, nan
  use root_finding, only: bracket_t, golden
  implicit none
  private
  public :: of_load, of_displacement
  public :: scaled_load, scaled_displacement, stable_radius, find_least
  public :: zone_width, radius_at_zone_width

  !> The quantities whose smallest value is searched for.
  integer, parameter :: of_load = 1, of_displacement = 2

contains

  !> P at given A and lambda.
  elemental function scaled_load(a, lambda) result(load)
    real(wp), intent(in) :: a, lambda
    real(wp) :: load, t

    t = zone_width(a, lambda)
    load = a**3 - lambda*a**2*(t + (1 + t**2)*atan(t))
  end function scaled_load

  !> D at given A and lambda.
  elemental real(wp) function scaled_displacement(a, lambda) result(displacement)
    real(wp), intent(in) :: a, lambda

    displacement = a**2 - 4*lambda/3*a*zone_width(a, lambda)
  end function scaled_displacement

  !> P or D at given A and lambda.
  elemental real(wp) function scaled(quantity, a, lambda) result(value)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: a, lambda

    if (quantity == of_load) then
      value = scaled_load(a, lambda)
    else
      value = scaled_displacement(a, lambda)
    end if
  end function scaled

  !> The largest A at a given P or D; NaN below the smallest P or D.
  pure function stable_radius(quantity, wanted, lambda) result(radius)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: wanted, lambda
    real(wp) :: radius, a, least
    type(bracket_t) :: bracket

    radius = nan
    call find_least(quantity, lambda, a, least)
    if (.not. wanted >= least) return
    bracket = bracket_t(a, max(1.0_wp, 2*a))
    do while (scaled(quantity, bracket%high, lambda) < wanted)
      bracket%high = 2*bracket%high
    end do
    ! From their smallest values on, both P and D grow with A.
    do while (bracket%is_open())
      call bracket%narrow(scaled(quantity, bracket%middle(), lambda) < wanted)
    end do
    radius = bracket%high
  end function stable_radius

  !> The smallest P (`of_load`) or D (`of_displacement`) over all A, and its A.
  pure subroutine find_least(quantity, lambda, a, least)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: lambda
    real(wp), intent(out) :: a, least
    ! JKR's smallest load is at A = 1.5^(1/3) = 1.145 and its smallest displacement at (1/6)^(1/3);
    ! those of a tension of longer range are at a smaller A.
    real(wp), parameter :: a_max = 1.5_wp
    ! The minimum is flat: half of the digits in A give all of them in the value.
    real(wp), parameter :: tolerance = 1e-9_wp
    real(wp) :: left, right, inner(2), value(2)

    left = 0
    right = a_max
    inner = [right - golden*(right - left), left + golden*(right - left)]
    value = scaled(quantity, inner, lambda)
    ! A bracket would evaluate both points anew; each value here takes a search of its own.
    do while (right - left > tolerance)
      if (value(1) <= value(2)) then
        right = inner(2)
        inner = [right - golden*(right - left), inner(1)]
        value = [scaled(quantity, inner(1), lambda), value(1)]
      else
        left = inner(1)
        inner = [inner(2), left + golden*(right - left)]
        value = [value(2), scaled(quantity, inner(2), lambda)]
      end if
    end do
    a = inner(minloc(value, 1))
    least = minval(value)
  end subroutine find_least

  !> t at given A and lambda: the root of
  !> (lambda A^2/2) profile_term(t) + (4 lambda^2 A/3) tension_term(t) = 1.
  !> In logarithms the left side is a smooth curve with a slope between 1 and 3, so that one value
  !> brackets the root, and Newton's method converges from any start.
  elemental real(wp) function zone_width(a, lambda) result(t)
    real(wp), intent(in) :: a, lambda
    integer, parameter :: max_steps = 100
    ! One more Newton step squares this error.
    real(wp), parameter :: close_enough = 1e-9_wp
    type(bracket_t) :: bracket
    real(wp) :: s, wide, narrow, total, excess
    integer :: step

    wide = lambda*a**2/2
    narrow = 4*lambda**2*a/3
    s = 0
    bracket = bracket_t(-huge(s), huge(s))
    do step = 1, max_steps
      t = exp(s)
      total = wide*profile_term(t) + narrow*tension_term(t)
      excess = log(total)
      if (excess > 0) then
        bracket = bracket_t(max(bracket%low, s - excess), s)
      else
        bracket = bracket_t(s, min(bracket%high, s - excess))
      end if
      s = s - excess*total/(t*(wide*profile_slope(t) + narrow*tension_slope(t)))
      if (abs(excess) <= close_enough) exit
      s = bracket%within(s)
    end do
    t = exp(s)
  end function zone_width

  !> A at given t and lambda, the inverse of `zone_width`: the root of a quadratic.
  elemental function radius_at_zone_width(t, lambda) result(a)
    real(wp), intent(in) :: t, lambda
    real(wp) :: a, linear, quadratic

    quadratic = lambda/2*profile_term(t)
    linear = 4*lambda**2/3*tension_term(t)
    a = 2/(linear + sqrt(linear**2 + 4*quadratic))
  end function radius_at_zone_width

  !> t + (m^2 - 2) atan(t): the part of the Hertz gap at c that the tension holds open.
  elemental real(wp) function profile_term(t) result(term)
    real(wp), intent(in) :: t

    term = tangent_excess(t) + t**2*atan(t)
  end function profile_term

  !> Derivative of `profile_term`.
  elemental real(wp) function profile_slope(t) result(slope)
    real(wp), intent(in) :: t

    slope = 2*t*(t/(1 + t**2) + atan(t))
  end function profile_slope

  !> t atan(t) - m + 1, the part of the gap at c that the tension closes, without cancellation.
  elemental real(wp) function tension_term(t) result(term)
    real(wp), intent(in) :: t

    term = t*(atan(t) - t/(1 + sqrt(1 + t**2)))
  end function tension_term

  !> Derivative of `tension_term`.
  elemental real(wp) function tension_slope(t) result(slope)
    real(wp), intent(in) :: t

    slope = atan(t) + t/(1 + t**2) - t/sqrt(1 + t**2)
  end function tension_slope

  !> t - atan(t), for small t from the continued fraction of the arctangent.
  elemental function tangent_excess(t) result(excess)
    real(wp), intent(in) :: t
    real(wp) :: excess, w
    ! Above, the difference is accurate to a dozen units in the last place; below, eight terms are.
    real(wp), parameter :: small = 0.25_wp
    integer, parameter :: terms = 8
    integer :: k

    if (t > small) then
      excess = t - atan(t)
    else
      w = 0
      do k = terms, 1, -1
        w = (k*t)**2/(2*k + 1 + w)
      end do
      excess = t*w/(1 + w)
    end if
  end function tangent_excess

end module maugis_scaled
