!> The number of digits of load and h0, at a fixed contact radius or axis gap, that a mesh needs for
!> a given accuracy of the results. It is fitted so that the error estimates of loads, h0 and
!> displacements, also at folds and extrema, are within the accuracy, for accuracies from 1e-2 to
!> 1e-10 and sigma from 1e-4 to 1e4.
module mesh_digits
  use kinds, only: wp
  use shape_panels, only: rim_passed_at
  use dimensionless_problem, only: problem_t, adhesion_strength, coupling_over
  implicit none
  private
  public :: digits_for, digits_of_layers, most_digits

  !> Digits for the load alone by decimal places of accuracy, as three lines, each with its constant
  !> and its slope: for up to 3.7 places, up to 6 places, and more.
  real(wp), parameter :: for_few_places(2) = [-0.25_wp, 1.5_wp], &
    for_places(2) = [2.5_wp, 0.75_wp], for_many_places(2) = [-0.2_wp, 1.2_wp]
  !> Least number of digits for a path; largest number of digits that rounding allows.
  real(wp), parameter :: fewest = 4.25_wp, most_digits = 13
  !> Least number of digits for each decade of sigma: with fewer digits folds would be missing or
  !> wrong, since they are closer together for stronger adhesion. For laws with a step or a period:
  !> the number to be added to `fewest`. `enough_for_folds` digits always separate the folds in
  !> contact.
  real(wp), parameter :: for_folds = 1.5_wp, for_folds_of_lengths = 1, enough_for_folds = 9
  !> Digits to be added, relative to a path under the Lennard-Jones law: for bodies without jumps;
  !> for laws with a step; for oscillating laws. Digits to be added for profiles, which are
  !> sensitive to the position of the edge: a constant; a number for each decade of sigma, as the
  !> cohesive zone narrows. Digits to be added for bodies with a kink over which panels pass.
  real(wp), parameter :: without_jumps = -0.5_wp, for_steps = 0.6_wp, for_waves = 1.1_wp, &
    for_profiles = 2, for_narrow_necks = 0.3_wp, for_kinks = 1.5_wp
  !> Digits to be added for layers: `for_softer` times s w^2. Here s is the number of decades by
  !> which the compliance of the contact exceeds that on a half-space, and w that by which the
  !> contact is wider than the layer. Such a layer differs from a half-space for wave numbers of at
  !> most `waves_in_layer` over the radius.
  real(wp), parameter :: for_softer = 0.6_wp, waves_in_layer = 32
  !> The sigma at which jumps begin under the Lennard-Jones law, and approximately under other laws.
  !> Digits to be added there, and the factor in sigma within which they are added. The part of this
  !> range of ln(sigma) in which the two folds are so close that coarse meshes miss them.
  real(wp), parameter :: onset = 0.29_wp, at_onset = 2, about_onset = 1.5_wp, near_onset = 0.35_wp

contains

  !> Digits for a mesh. profiles: whether profiles are requested. widest: the largest contact
  !> radius.
  pure real(wp) function digits_for(problem, widest, accuracy, profiles) result(digits)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: widest, accuracy
    logical, intent(in) :: profiles
    real(wp) :: sigma, decades, least, left, lengths, away

    sigma = adhesion_strength(problem)
    decades = log10(1 + sigma)
    digits = of_load(-log10(accuracy))
    ! Jumps are more sensitive to errors than other results.
    if (sigma < onset) digits = digits + without_jumps
    lengths = 0
    if (problem%law%step_width > 0) lengths = for_steps
    if (problem%law%period > 0) lengths = for_waves
    digits = digits + lengths
    least = max(fewest, for_folds*decades)
    if (lengths > 0) least = fewest + lengths + for_folds_of_lengths*decades
    if (profiles) digits = digits + for_profiles + for_narrow_necks*decades
    if (problem%shape%smooth_from() > 0 .and. rim_passed_at(problem, widest) < widest) &
      digits = digits + for_kinks
    digits = digits + digits_of_layers(problem, widest)
    away = abs(log(max(sigma, tiny(1.0_wp))/onset))/log(about_onset)
    digits = digits + at_onset*max(0.0_wp, min(1.0_wp, 1.5_wp*(1 - away)))
    if (away < near_onset) least = max(least, enough_for_folds)
    digits = max(digits, least)
    left = -log10(epsilon(1.0_wp)*max(1.0_wp, sigma*widest, &
      coupling_over(problem, widest)*problem%law%adhesion*widest))
    digits = max(fewest, min(digits, left, most_digits))
    if (left > fewest) digits = max(digits, min(enough_for_folds, least))
  end function digits_for

  !> Digits added at a contact radius for stiff layers.
  pure real(wp) function digits_of_layers(problem, radius) result(digits)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: radius
    real(wp) :: wider, softer

    digits = 0
    if (problem%body%is_homogeneous()) return
    wider = log10(hypot(1.0_wp, &
      radius*maxval(problem%body%wave_range(most_digits))/waves_in_layer))
    softer = log10(coupling_over(problem, radius)/problem%coupling)
    digits = for_softer*wider**2*max(0.0_wp, softer)
  end function digits_of_layers

  !> Digits for the load alone, for a number of decimal places of accuracy.
  pure real(wp) function of_load(places) result(digits)
    real(wp), intent(in) :: places

    digits = max(min(on(for_few_places), on(for_places)), on(for_many_places))

  contains

    pure real(wp) function on(line)
      real(wp), intent(in) :: line(2)

      on = line(1) + line(2)*places
    end function on

  end function of_load

end module mesh_digits
