!> Two flat charged surfaces in a symmetric electrolyte, by the Poisson-Boltzmann equation
!> y'' = sinh y. Potentials y are in kT/(z e), gaps in Debye lengths, pressures in 2 n kT, the
!> osmotic pressure of the bulk.
!>
!> Its first integral, y'^2 = 2 (cosh y - 1 - P), holds the pressure P, and the gap is an integral
!> of 1/y' over y. The force is attractive, P < 0, where the electric field vanishes nowhere.
!>
!> A surface that regulates its charge, p = 1 constant charge, p = 0 constant potential, keeps
!> p (s - s0) + (1 - p) cosh(y0/2) (y - y0) = 0, s being the slope of y towards the surface, y0 and
!> s0 = 2 sinh(y0/2) those of the surface alone: the charge of the inner layer is linear in the
!> potential, and p = C_D/(C_D + C_I) the share of the diffuse layer's capacity cosh(y0/2) (the
!> constant regulation approximation, J. Phys. Chem. B 108, 19467, 2004). Along that line
!> y = y0 + p t and s = s0 - (1 - p) cosh(y0/2) t. Unknown are the two t.
module poisson_boltzmann
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: surface_t, gap_state_t, far_amplitude, far_state, solve_gap

  !> One surface: reduced potential alone, and regulation from 0 to 1.
  type :: surface_t
    real(wp) :: potential = 0, regulation = 1
  end type surface_t

  !> The surfaces at one gap: t of both, and the pressure.
  type :: gap_state_t
    real(wp) :: t(2) = 0, pressure = 0
  end type gap_state_t

  !> Order of the quadrature on a piece of the gap, and the longest piece where y and y' are small.
  !> The integrand is analytic to a distance of about pi/2 from the real line there, and of 3/b
  !> where b, below, is large; with pieces of 2/(1 + b/2) the error is below rounding.
  integer, parameter :: order = 16
  real(wp), parameter :: longest_piece = 2

contains

  !> The limit of P exp(gap) far away, 32 tanh(y1/4) tanh(y2/4).
  pure real(wp) function far_amplitude(surface) result(amplitude)
    type(surface_t), intent(in) :: surface(2)

    amplitude = 32*product(tanh(surface%potential/4))
  end function far_amplitude

  !> The state at a large gap, to first order in exp(-gap). The first surface is the one of higher
  !> potential, which is not 0.
  pure type(gap_state_t) function far_state(surface, gap) result(state)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    real(wp) :: y, share

    y = surface(2)%potential
    ! 4 tanh(y/4)/sinh y, which is 1 where the second surface has no charge.
    share = 1/(cosh(y/4)**2*cosh(y/2))
    state%t(2) = 8*tanh(surface(1)%potential/4)*exp(-gap)*share
    state%pressure = pressure_at(surface(2), state%t(2))
    state%t(1) = state%pressure/sinh(surface(1)%potential)
  end function far_state

  !> Newton's iteration from a state near by to that at `gap`; `solved` says whether it came there.
  pure subroutine solve_gap(surface, gap, state, solved)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    type(gap_state_t), intent(inout) :: state
    logical, intent(out) :: solved
    !> Increment of the differences relative to the unknowns, and the last step: with differences of
    !> that quality one more has the accuracy of rounding.
    real(wp), parameter :: increment = 1.0e-7_wp, last_step = 1.0e-9_wp
    !> A t that is less than so much of the other counts as that much.
    real(wp), parameter :: negligible = 1.0e-3_wp
    integer, parameter :: most_steps = 60, most_halvings = 20
    real(wp) :: x(order), w(order), r(2), trial(2), jacobian(2, 2), step(2), t(2), scale, unit
    integer :: i, k

    call gauss_legendre(x, w)
    solved = .false.
    t = state%t
    unit = maxval(abs([pressure_at(surface(1), t(1)), pressure_at(surface(2), t(2))]))
    r = residual(t)
    do i = 1, most_steps
      scale = maxval(abs(t))
      do k = 1, 2
        trial = t
        trial(k) = t(k) + increment*max(abs(t(k)), negligible*scale)
        jacobian(:, k) = (residual(trial) - r)/(trial(k) - t(k))
      end do
      step = [r(2)*jacobian(1, 2) - r(1)*jacobian(2, 2), &
        r(1)*jacobian(2, 1) - r(2)*jacobian(1, 1)]/ &
        (jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1))
      if (.not. all(abs(step) < huge(step))) return
      solved = all(abs(step) <= last_step*max(abs(t), negligible*scale))
      do k = 1, most_halvings
        trial = residual(t + step)
        if (solved .or. norm2(trial) < norm2(r)) exit
        step = step/2
      end do
      t = t + step
      r = trial
      if (solved) exit
    end do
    state%t = t
    ! The surface of lower potential has less rounding in it.
    state%pressure = pressure_at(surface(2), t(2))

  contains

    !> Difference of the two pressures and of the gap to that asked for.
    pure function residual(t) result(r)
      real(wp), intent(in) :: t(2)
      real(wp) :: r(2)

      r = [(pressure_at(surface(1), t(1)) - pressure_at(surface(2), t(2)))/unit, &
        (gap_of(surface, t, x, w) - gap)/min(gap, 1.0_wp)]
    end function residual

  end subroutine solve_gap

  !> P of a surface at t, without cancellation where t is small.
  elemental real(wp) function pressure_at(surface, t) result(pressure)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: t
    real(wp) :: rise, drop

    rise = surface%regulation*t/2
    drop = (1 - surface%regulation)*cosh(surface%potential/2)*t
    pressure = 2*sinh(surface%potential + rise)*sinh(rise) &
      + drop*(2*sinh(surface%potential/2) - drop/2)
  end function pressure_at

  !> The gap between two surfaces, from quadrature nodes and weights on [0, 1]: the integral of 1/y'
  !> with y = b cosh v, b where the field vanishes, or y = b sinh v where it does so nowhere, which
  !> make 1/y' smooth.
  pure real(wp) function gap_of(surface, t, x, w) result(gap)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: t(2), x(:), w(:)
    real(wp) :: y(2), s(2), v(2), p, b, piece
    integer :: pieces, i

    y = surface%potential + surface%regulation*t
    s = 2*sinh(surface%potential/2) - (1 - surface%regulation)*cosh(surface%potential/2)*t
    p = pressure_at(surface(2), t(2))
    p = sign(max(abs(p), tiny(p)), p)
    if (p > 0) then
      b = 2*asinh(sqrt(p/2))
      ! The difference of |y| and b follows from the slope without cancellation.
      v = 2*asinh(s**2/(4*sinh((abs(y) + b)/2)))
      v = sign(2*asinh(sqrt(v/(2*b))), s*sign(1.0_wp, y(1)))
      v = [-v(2), v(1)]
    else
      b = sqrt(-2*p)
      v = asinh(y/b)
      v = [v(2), v(1)]*sign(1.0_wp, s(1))
    end if
    pieces = max(1, min(200, ceiling(abs(v(2) - v(1))*(1 + b/2)/longest_piece)))
    piece = (v(2) - v(1))/pieces
    gap = 0
    do i = 1, pieces
      gap = gap + piece*sum(w*rate(v(1) + piece*(i - 1 + x)))
    end do

  contains

    !> dy/dv over |y'|.
    elemental real(wp) function rate(v)
      real(wp), intent(in) :: v
      real(wp) :: rise

      if (p > 0) then
        rise = 2*b*sinh(v/2)**2
        rate = 1
        if (rise > 0) rate = b*abs(sinh(v))/sqrt(4*sinh(b + rise/2)*sinh(rise/2))
        ! Where the field vanishes, the limit.
        if (.not. rise > 0) rate = sqrt(b/sinh(b))
      else
        rate = b*cosh(v)/sqrt(4*sinh(b*sinh(v)/2)**2 + b**2)
      end if
    end function rate

  end function gap_of

end module poisson_boltzmann
