!> Closed forms fitted to Maugis-Dugdale theory, from DMT to JKR by one parameter alpha from 0 to 1:
!> R. W. Carpick, D. F. Ogletree and M. Salmeron, J. Colloid Interface Sci. 211, 395 (1999), for the
!> contact radius under a load, and O. Pietrement and M. Troyon, J. Colloid Interface Sci. 226, 166
!> (2000), for the displacement too. In Maugis' units, F0 < 0 being the pull-off, a0 the contact
!> radius without load:
!>
!>     a = a0 z^(2/3),  z = (alpha + sqrt(1 - F/F0))/(1 + alpha),
!>     displacement = a0^2 (z^(4/3) - S z^(2 beta/3))            (Pietrement and Troyon)
!>
!> Both take alpha from lambda = -0.924 ln(1 - 1.02 alpha). Units and conventions are those of
!> module classical; `strength` is that of `maugis`.
module transition_fits
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: wp
  use maugis, only: maugis_lambda, maugis_units, maugis_units_t
  use root_finding, only: bracket_t
  implicit none
  private
  public :: transition_alpha
  public :: carpick_pull_off, carpick_radius_at_load
  public :: pietrement_pull_off, pietrement_radius_at_load, pietrement_displacement_at_load, &
    pietrement_load_at_displacement

  !> Pull-off, negative, and contact radius without load in Maugis' units; alpha.
  type :: fit_t
    real(wp) :: pull_off = 0, radius = 0, alpha = 0
  end type fit_t

contains

  !> alpha at Maugis' lambda: 0 of DMT, 0.98 of JKR theory.
  elemental function transition_alpha(lambda) result(alpha)
    real(wp), intent(in) :: lambda
    real(wp) :: alpha

    alpha = (1 - exp(-lambda/0.924_wp))/1.02_wp
  end function transition_alpha

  !> Numbers of Carpick, Ogletree and Salmeron at Maugis' lambda.
  elemental type(fit_t) function carpick(lambda) result(fit)
    real(wp), intent(in) :: lambda
    real(wp) :: load, radius

    load = 4.04_wp*lambda**1.4_wp
    radius = 2.28_wp*lambda**1.3_wp
    fit = fit_t(pull_off=-1.75_wp + 0.25_wp*(load - 1)/(load + 1), &
      radius=1.54_wp + 0.279_wp*(radius - 1)/(radius + 1), alpha=transition_alpha(lambda))
  end function carpick

  !> Numbers of Pietrement and Troyon at Maugis' lambda.
  elemental type(fit_t) function pietrement(lambda) result(fit)
    real(wp), intent(in) :: lambda
    real(wp) :: alpha

    alpha = transition_alpha(lambda)
    fit = fit_t(pull_off=-(2 + alpha*(-0.767_wp + alpha*0.267_wp)), radius=1.264_wp + &
      alpha*(0.950_wp + alpha*(-1.365_wp + alpha*(1.417_wp - alpha*0.451_wp))), alpha=alpha)
  end function pietrement

  !> z at a load in Maugis' units; NaN beyond the pull-off.
  elemental function state_at_load(fit, load) result(z)
    type(fit_t), intent(in) :: fit
    real(wp), intent(in) :: load
    real(wp) :: z, room

    room = 1 - load/fit%pull_off
    z = ieee_value(z, ieee_quiet_nan)
    if (room >= 0) z = (fit%alpha + sqrt(room))/(1 + fit%alpha)
  end function state_at_load

  !> Displacement in Maugis' units at a state z of Pietrement and Troyon.
  elemental function displacement_at_state(fit, z) result(displacement)
    type(fit_t), intent(in) :: fit
    real(wp), intent(in) :: z
    real(wp) :: displacement, pull, beta

    associate (alpha => fit%alpha)
      pull = -2.160_wp*alpha**0.019_wp + 2.7531_wp*alpha**0.064_wp + 0.073_wp*alpha**1.919_wp
      beta = alpha*(0.429_wp + alpha*(0.235_wp + alpha*(-0.683_wp + alpha*0.516_wp)))
    end associate
    displacement = fit%radius**2*(z**(4.0_wp/3) - pull*z**(2*beta/3))
  end function displacement_at_state

  !> Pull-off [N], negative, of Carpick, Ogletree and Salmeron.
  elemental function carpick_pull_off(radius, stiffness, surface_energy, strength) result(load)
    real(wp), intent(in) :: radius, stiffness, surface_energy, strength
    real(wp) :: load
    type(maugis_units_t) :: units
    type(fit_t) :: fit

    units = maugis_units(radius, stiffness, surface_energy)
    fit = carpick(maugis_lambda(radius, stiffness, surface_energy, strength))
    load = units%load*fit%pull_off
  end function carpick_pull_off

  !> Contact radius [m] of Carpick, Ogletree and Salmeron at a load [N], stable under it; NaN
  !> beyond the pull-off.
  elemental function carpick_radius_at_load(load, radius, stiffness, surface_energy, strength) &
    result(contact_radius)
    real(wp), intent(in) :: load, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius
    type(maugis_units_t) :: units
    type(fit_t) :: fit

    units = maugis_units(radius, stiffness, surface_energy)
    fit = carpick(maugis_lambda(radius, stiffness, surface_energy, strength))
    contact_radius = units%radius*fit%radius*state_at_load(fit, load/units%load)**(2.0_wp/3)
  end function carpick_radius_at_load

  !> Pull-off [N], negative, of Pietrement and Troyon.
  elemental function pietrement_pull_off(radius, stiffness, surface_energy, strength) result(load)
    real(wp), intent(in) :: radius, stiffness, surface_energy, strength
    real(wp) :: load
    type(maugis_units_t) :: units
    type(fit_t) :: fit

    units = maugis_units(radius, stiffness, surface_energy)
    fit = pietrement(maugis_lambda(radius, stiffness, surface_energy, strength))
    load = units%load*fit%pull_off
  end function pietrement_pull_off

  !> Contact radius [m] of Pietrement and Troyon at a load [N], stable under it; NaN beyond the
  !> pull-off.
  elemental function pietrement_radius_at_load(load, radius, stiffness, surface_energy, strength) &
    result(contact_radius)
    real(wp), intent(in) :: load, radius, stiffness, surface_energy, strength
    real(wp) :: contact_radius
    type(maugis_units_t) :: units
    type(fit_t) :: fit

    units = maugis_units(radius, stiffness, surface_energy)
    fit = pietrement(maugis_lambda(radius, stiffness, surface_energy, strength))
    contact_radius = units%radius*fit%radius*state_at_load(fit, load/units%load)**(2.0_wp/3)
  end function pietrement_radius_at_load

  !> Displacement [m] of Pietrement and Troyon at a load [N]; NaN beyond the pull-off.
  elemental function pietrement_displacement_at_load(load, radius, stiffness, surface_energy, &
    strength) result(displacement)
    real(wp), intent(in) :: load, radius, stiffness, surface_energy, strength
    real(wp) :: displacement
    type(maugis_units_t) :: units
    type(fit_t) :: fit

    units = maugis_units(radius, stiffness, surface_energy)
    fit = pietrement(maugis_lambda(radius, stiffness, surface_energy, strength))
    displacement = units%displacement* &
      displacement_at_state(fit, state_at_load(fit, load/units%load))
  end function pietrement_displacement_at_load

  !> Load [N] of Pietrement and Troyon at a displacement [m], stable under it: the displacement
  !> grows with the load. NaN below that of the pull-off.
  elemental function pietrement_load_at_displacement(displacement, radius, stiffness, &
    surface_energy, strength) result(load)
    real(wp), intent(in) :: displacement, radius, stiffness, surface_energy, strength
    real(wp) :: load, wanted
    type(maugis_units_t) :: units
    type(fit_t) :: fit
    type(bracket_t) :: bracket

    units = maugis_units(radius, stiffness, surface_energy)
    fit = pietrement(maugis_lambda(radius, stiffness, surface_energy, strength))
    wanted = displacement/units%displacement
    load = ieee_value(load, ieee_quiet_nan)
    bracket = bracket_t(fit%pull_off, 1.0_wp)
    if (.not. at(bracket%low) <= wanted) return
    do while (at(bracket%high) < wanted)
      bracket%high = 2*bracket%high
    end do
    do while (bracket%is_open())
      call bracket%narrow(at(bracket%middle()) < wanted)
    end do
    load = units%load*bracket%high

  contains

    pure real(wp) function at(load)
      real(wp), intent(in) :: load

      at = displacement_at_state(fit, state_at_load(fit, load))
    end function at
  end function pietrement_load_at_displacement

end module transition_fits
