!> Two flat charged surfaces in a symmetric electrolyte, described by the Poisson-Boltzmann equation
!> y'' = sinh y. Potentials y are in units of kT/(z e), gaps in Debye lengths, and pressures in 2 n
!> kT, the osmotic pressure of the bulk.
!>
!> The first integral of this equation, y'^2 = 2 (cosh y - 1 - P), contains the pressure P. The gap
!> is an elliptic integral, that of 1/y' over y. The force is attractive, P < 0, if the electric
!> field vanishes nowhere between the surfaces.
!>
!> A surface regulates its charge with a parameter p, where p = 1 is constant charge and p = 0
!> constant potential. It obeys p (s - s0) + (1 - p) cosh(y0/2) (y - y0) = 0. Here s is the slope of
!> y towards the surface; y0 and s0 = 2 sinh(y0/2) are the values of the isolated surface. The
!> charge of the inner layer is then linear in the potential, and p = C_D/(C_D + C_I) is the share
!> of the diffuse layer's capacity cosh(y0/2) (the constant regulation approximation, J. Phys. Chem.
!> B 108, 19467, 2004). On this line y = y0 + p t and s = s0 - (1 - p) cosh(y0/2) t. The values of t
!> at the two surfaces are the unknowns.
module poisson_boltzmann
  use kinds, only: wp
  use special_functions, only: carlson_rf
  implicit none
  private
  public :: surface_t, gap_state_t, far_state, solve_gap

  !> One surface: the reduced potential of the isolated surface, and its regulation from 0 to 1.
  type :: surface_t
    real(wp) :: potential = 0, regulation = 1
  end type surface_t

  !> The state at one gap: t of both surfaces, and the pressure.
  type :: gap_state_t
    real(wp) :: t(2) = 0, pressure = 0
  end type gap_state_t

contains

  !> The state at a large gap, to first order in exp(-gap). The first surface must have the higher
  !> potential, which must not be 0.
  pure type(gap_state_t) function far_state(surface, gap) result(state)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    real(wp) :: y, share

    y = surface(2)%potential
    ! The ratio 4 tanh(y/4)/sinh y, which is 1 if the second surface has no charge.
    share = 1/(cosh(y/4)**2*cosh(y/2))
    state%t(2) = 8*tanh(surface(1)%potential/4)*exp(-gap)*share
    state%pressure = pressure_at(surface(2), state%t(2))
    state%t(1) = state%pressure/sinh(surface(1)%potential)
  end function far_state

  !> Newton's iteration from a nearby state to the state at `gap`. solved: whether it converged. The
  !> derivatives are finite differences, updated by each step (Broyden, 1965) as long as steps are
  !> successful.
  pure subroutine solve_gap(surface, gap, state, solved)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: gap
    type(gap_state_t), intent(inout) :: state
    logical, intent(out) :: solved
    !> increment: step of the finite differences relative to the unknowns, which is also the
    !> relative error of the differences. gain: the differences are computed again if the residual
    !> is reduced by less than this factor. rounding: largest error after the last step relative to
    !> the unknowns, estimated as the length of the step times the error of the derivatives.
    real(wp), parameter :: increment = 1.0e-7_wp, gain = 0.1_wp, rounding = 1.0e-16_wp
    !> The smaller t counts as at least this fraction of the larger one.
    real(wp), parameter :: negligible = 1.0e-3_wp
    integer, parameter :: most_steps = 60, most_halvings = 20
    real(wp) :: r(2), trial(2), jacobian(2, 2), step(2), t(2), scale(2), unit, off, last
    logical :: gains
    integer :: i, k

    solved = .false.
    gains = .false.
    last = 1
    t = state%t
    unit = maxval(abs([pressure_at(surface(1), t(1)), pressure_at(surface(2), t(2))]))
    r = residual(t)
    do i = 1, most_steps
      scale = max(abs(t), negligible*maxval(abs(t)))
      if (.not. gains) then
        do k = 1, 2
          trial = t
          trial(k) = t(k) + increment*scale(k)
          jacobian(:, k) = (residual(trial) - r)/(trial(k) - t(k))
        end do
      end if
      step = [r(2)*jacobian(1, 2) - r(1)*jacobian(2, 2), &
        r(1)*jacobian(2, 1) - r(2)*jacobian(1, 1)]/ &
        (jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1))
      if (.not. all(abs(step) < huge(step))) return
      off = maxval(abs(step)/scale)
      solved = off*merge(off/last, increment, gains) <= rounding
      if (solved) then
        t = t + step
        exit
      end if
      do k = 1, most_halvings
        trial = residual(t + step)
        if (norm2(trial) < norm2(r)) exit
        step = step/2
      end do
      t = t + step
      last = maxval(abs(step)/scale)
      gains = norm2(trial) < gain*norm2(r)
      jacobian = jacobian + spread(trial - r - matmul(jacobian, step), 2, 2)* &
        spread(step/scale**2/sum((step/scale)**2), 1, 2)
      r = trial
    end do
    state%t = t
    ! The pressure is taken at the surface of lower potential, where its rounding error is smaller.
    state%pressure = pressure_at(surface(2), t(2))

  contains

    !> The difference of the pressures at the two surfaces, and of the gap from the given one.
    pure function residual(t) result(r)
      real(wp), intent(in) :: t(2)
      real(wp) :: r(2)

      r = [(pressure_at(surface(1), t(1)) - pressure_at(surface(2), t(2)))/unit, &
        (gap_of(surface(1), surface(2), t(1), t(2)) - gap)/min(gap, 1.0_wp)]
    end function residual

  end subroutine solve_gap

  !> P from the t of a surface, without cancellation if t is small.
  elemental real(wp) function pressure_at(surface, t) result(pressure)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: t
    real(wp) :: rise, drop

    rise = surface%regulation*t/2
    drop = (1 - surface%regulation)*cosh(surface%potential/2)*t
    pressure = 2*sinh(surface%potential + rise)*sinh(rise) &
      + drop*(2*sinh(surface%potential/2) - drop/2)
  end function pressure_at

  !> The slope y' towards a surface from its t.
  elemental real(wp) function slope_at(surface, t) result(slope)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: t

    slope = 2*sinh(surface%potential/2) - (1 - surface%regulation)*cosh(surface%potential/2)*t
  end function slope_at

  !> The gap between two surfaces: the integral of 1/y' over y. With w = sinh(y/2)^2 it is the
  !> integral of 1/(2 sqrt(w (w - P/2) (1 + w))) over w, from one surface to the other. If w has its
  !> minimum, P/2 or 0, between the surfaces, it is the sum of the integrals from there to both.
  elemental real(wp) function gap_of(surface_1, surface_2, t_1, t_2) result(gap)
    type(surface_t), intent(in) :: surface_1, surface_2
    real(wp), intent(in) :: t_1, t_2
    real(wp) :: y(2), s(2), root(3, 2), least(3), difference, p
    logical :: between

    y = [surface_1%potential + surface_1%regulation*t_1, &
      surface_2%potential + surface_2%regulation*t_2]
    s = [slope_at(surface_1, t_1), slope_at(surface_2, t_2)]
    p = pressure_at(surface_2, t_2)
    p = sign(max(abs(p), tiny(p)), p)
    ! Before convergence, slopes and potentials are inconsistent; the smaller of the two gives the
    ! more accurate w.
    if (p > 0) then
      between = .not. s(1)*s(2) < 0
      root(2, :) = abs(s)/2
      root(1, :) = sqrt(root(2, :)**2 + p/2)
      difference = (s(1) - s(2))*(s(1) + s(2))/4
      least = [sqrt(p/2), 0.0_wp, sqrt(1 + p/2)]
      if (between) s(1) = sum(s)
    else
      between = y(1)*y(2) < 0
      root(1, :) = abs(sinh(y/2))
      root(2, :) = sqrt(root(1, :)**2 - p/2)
      difference = sinh((y(1) + y(2))/2)*sinh((y(1) - y(2))/2)
      least = [0.0_wp, sqrt(-p/2), 1.0_wp]
    end if
    root(3, :) = sqrt(1 + root(1, :)**2)
    if (between) then
      gap = from_least(1) + from_least(2)
    else
      gap = integral(difference, root(:, 1), root(:, 2))
    end if
    gap = sign(gap, gap*s(1)*y(1))

  contains

    !> The integral from the minimum of w to a surface.
    pure real(wp) function from_least(i)
      integer, intent(in) :: i

      from_least = integral(root(merge(2, 1, p > 0), i)**2, root(:, i), least)
    end function from_least

    !> The integral between two values of w, from their difference and from the roots of the three
    !> factors at the first one, x, and at the second one, y.
    pure real(wp) function integral(difference, x, y)
      real(wp), intent(in) :: difference, x(3), y(3)

      integral = difference
      if (abs(difference) > 0) integral = difference* &
        carlson_rf((x(1)*x(2)*y(3) + y(1)*y(2)*x(3))**2, &
        (x(1)*x(3)*y(2) + y(1)*y(3)*x(2))**2, (x(2)*x(3)*y(1) + y(2)*y(3)*x(1))**2)
    end function integral

  end function gap_of

end module poisson_boltzmann
