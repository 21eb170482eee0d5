!> Closed forms fitted to Maugis-Dugdale theory, from DMT to JKR by one parameter alpha from 0 to 1:
!> R. W. Carpick, D. F. Ogletree and M. Salmeron, J. Colloid Interface Sci. 211, 395 (1999), for the
!> contact radius at a load, and O. Pietrement and M. Troyon, J. Colloid Interface Sci. 226, 166
!> (2000), also for the displacement. In Maugis' units, with the pull-off F0 < 0 and the contact
!> radius a0 without load:
!>
!>     a = a0 z^(2/3),  z = (alpha + sqrt(1 - F/F0))/(1 + alpha),
!>     displacement = a0^2 (z^(4/3) - S z^(2 beta/3))            (Pietrement and Troyon)
!>
!> Both take alpha from lambda = -0.924 ln(1 - 1.02 alpha). Units and conventions are those of
!> module classical.
module transition_fits
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use maugis, only: maugis_t
  use root_finding, only: bracket_t
  implicit none
  private
  public :: transition_fit_t, carpick_fit, pietrement_fit

  !> A fit for two bodies. alpha: 0 in DMT, 0.98 in JKR theory. pull_off: the pull-off force [N],
  !> negative. radius: the contact radius [m] without load. sunk: the displacement [m] in Hertz
  !> theory at that radius. no_load: the unit of load [N]. The states are stable at their load;
  !> results are NaN beyond the pull-off.
  type :: transition_fit_t
    real(wp) :: alpha = 0, pull_off = 0, radius = 0
    real(wp), private :: sunk = 0, no_load = 0
  contains
    procedure, private :: state_at_load
    procedure :: radius_at_load
    procedure :: displacement_at_load
    procedure :: load_at_displacement
  end type transition_fit_t

  !> Scales of lambda and alpha in lambda = -0.924 ln(1 - 1.02 alpha), of both publications.
  real(wp), parameter :: lambda_scale = 0.924_wp, alpha_scale = 1.02_wp
  !> Coefficients of `step_of` for the pull-off force and the radius without load as functions of
  !> lambda, by Carpick, Ogletree and Salmeron.
  real(wp), parameter :: carpick_pull_off(4) = [-1.75_wp, 0.25_wp, 4.04_wp, 1.4_wp], &
    carpick_radius(4) = [1.54_wp, 0.279_wp, 2.28_wp, 1.3_wp]
  !> Coefficients of the powers of alpha, beginning with alpha^0, by Pietrement and Troyon: for the
  !> radius without load, the magnitude of the pull-off force, and beta.
  real(wp), parameter :: radius_terms(*) = [1.264_wp, 0.950_wp, -1.365_wp, 1.417_wp, -0.451_wp], &
    pull_off_terms(*) = [2.0_wp, -0.767_wp, 0.267_wp], &
    beta_terms(*) = [0.0_wp, 0.429_wp, 0.235_wp, -0.683_wp, 0.516_wp]
  !> Factors and exponents of the three powers of alpha in S, by Pietrement and Troyon.
  real(wp), parameter :: s_factors(*) = [-2.160_wp, 2.7531_wp, 0.073_wp], &
    s_exponents(*) = [0.019_wp, 0.064_wp, 1.919_wp]

contains

  !> The fit of Carpick, Ogletree and Salmeron.
  elemental type(transition_fit_t) function carpick_fit(theory) result(fit)
    type(maugis_t), intent(in) :: theory

    fit = new_fit(theory)
    fit%pull_off = fit%pull_off*step_of(theory%lambda, carpick_pull_off)
    fit%radius = fit%radius*step_of(theory%lambda, carpick_radius)
  end function carpick_fit

  !> A smooth step between two limits: terms(1) + terms(2) (x - 1)/(x + 1), with
  !> x = terms(3) lambda^terms(4).
  pure real(wp) function step_of(lambda, terms) result(value)
    real(wp), intent(in) :: lambda, terms(4)
    real(wp) :: x

    x = terms(3)*lambda**terms(4)
    value = terms(1) + terms(2)*(x - 1)/(x + 1)
  end function step_of

  !> The fit of Pietrement and Troyon.
  elemental type(transition_fit_t) function pietrement_fit(theory) result(fit)
    type(maugis_t), intent(in) :: theory
    real(wp) :: width

    fit = new_fit(theory)
    width = polynomial(radius_terms, fit%alpha)
    fit%pull_off = -fit%pull_off*polynomial(pull_off_terms, fit%alpha)
    fit%radius = fit%radius*width
    fit%sunk = fit%sunk*width**2
  end function pietrement_fit

  !> The polynomial in x with the given coefficients, beginning with x^0.
  pure real(wp) function polynomial(terms, x) result(value)
    real(wp), intent(in) :: terms(:), x
    integer :: k

    value = 0
    do k = size(terms), 1, -1
      value = terms(k) + x*value
    end do
  end function polynomial

  !> A fit with the units of a theory, which are Maugis' units.
  elemental type(transition_fit_t) function new_fit(theory) result(fit)
    type(maugis_t), intent(in) :: theory

    fit = transition_fit_t((1 - exp(-theory%lambda/lambda_scale))/alpha_scale, &
      theory%unit%load, theory%unit%radius, theory%unit%displacement, theory%unit%load)
  end function new_fit

  !> z at a load [N]; NaN below the pull-off force, and if the load is NaN.
  elemental real(wp) function state_at_load(self, load) result(z)
    class(transition_fit_t), intent(in) :: self
    real(wp), intent(in) :: load
    real(wp) :: room

    z = nan
    if (ieee_is_nan(load)) return
    room = 1 - load/self%pull_off
    if (room >= 0) z = (self%alpha + sqrt(room))/(1 + self%alpha)
  end function state_at_load

  !> Contact radius [m] at a load [N].
  elemental real(wp) function radius_at_load(self, load)
    class(transition_fit_t), intent(in) :: self
    real(wp), intent(in) :: load

    radius_at_load = self%radius*self%state_at_load(load)**(2.0_wp/3)
  end function radius_at_load

  !> Displacement [m] at a load [N], in the fit of Pietrement and Troyon only.
  elemental real(wp) function displacement_at_load(self, load) result(displacement)
    class(transition_fit_t), intent(in) :: self
    real(wp), intent(in) :: load
    real(wp) :: s, beta

    s = sum(s_factors*self%alpha**s_exponents)
    beta = polynomial(beta_terms, self%alpha)
    associate (z => self%state_at_load(load))
      displacement = self%sunk*(z**(4.0_wp/3) - s*z**(2*beta/3))
    end associate
  end function displacement_at_load

  !> Load [N] at a displacement [m], in the fit of Pietrement and Troyon only; it grows with the
  !> displacement. NaN below the displacement of the pull-off.
  elemental real(wp) function load_at_displacement(self, displacement) result(load)
    class(transition_fit_t), intent(in) :: self
    real(wp), intent(in) :: displacement
    type(bracket_t) :: bracket

    load = nan
    bracket = bracket_t(self%pull_off, self%no_load)
    if (.not. self%displacement_at_load(bracket%low) <= displacement) return
    do while (self%displacement_at_load(bracket%high) < displacement)
      bracket%high = 2*bracket%high
    end do
    do while (bracket%is_open())
      call bracket%narrow(self%displacement_at_load(bracket%middle()) < displacement)
    end do
    load = bracket%high
  end function load_at_displacement

end module transition_fits
