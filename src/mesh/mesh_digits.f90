!> How many digits a mesh must give load and h0, at a fixed contact radius or axis gap, for what is
!> reported to have the accuracy asked for. Fitted so that error estimates of loads, h0 and
!> displacements, at folds and extrema too, are within the accuracy, from 1e-2 to 1e-10 and sigma
!> 1e-4 to 1e4.
module mesh_digits
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, adhesion_strength, coupling_over
  implicit none
  private
  public :: digits_for, most_digits

  !> No path is traced with fewer; no more can be told from rounding.
  real(wp), parameter :: fewest = 4.25_wp, most_digits = 13
  !> With fewer than these for each decade of sigma the folds are not those that the path has: they
  !> come the nearer to one another the stronger adhesion is. Laws that have a step, a kink or a
  !> period: on top of the fewest. And as long as there is a contact at all these are enough to tell
  !> folds apart.
  real(wp), parameter :: for_folds = 1.5_wp, for_folds_of_lengths = 0.5_wp, enough_for_folds = 9
  !> More or less than for a path of the Lennard-Jones law: bodies that do not jump; laws that have
  !> a step or a kink, and those that oscillate; profiles, which feel every error of the edge's
  !> place, the more the narrower the neck, for each decade of sigma; bodies with a kink, where the
  !> edge passes it.
  real(wp), parameter :: without_jumps = -0.5_wp, for_steps = 0.6_wp, for_waves = 1.1_wp, &
    for_profiles = 2, for_narrow_necks = 0.3_wp, for_kinks = 1.5_wp
  !> For each decade of what a contact yields more than on a half-space, times the square of the
  !> decades by which it is wider than layers that yield unlike a half-space to waves of this many
  !> or fewer over the radius.
  real(wp), parameter :: for_softer = 0.3_wp, waves_in_layer = 32
  !> sigma at which jumps begin under the Lennard-Jones law, about that of others; what is more
  !> there, the factor in sigma up to which that is felt, and the part of it, logarithmically, in
  !> which the two folds are so near each other that coarse meshes lose them.
  real(wp), parameter :: onset = 0.29_wp, at_onset = 2, about_onset = 1.5_wp, near_onset = 0.35_wp

contains

  !> profiles: whether some are asked for. widest: the largest contact radius.
  pure real(wp) function digits_for(problem, widest, accuracy, profiles) result(digits)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: widest, accuracy
    logical, intent(in) :: profiles
    real(wp) :: sigma, decades, least, left, lengths, away, wider, softer

    sigma = adhesion_strength(problem)
    decades = log10(1 + sigma)
    digits = of_load(-log10(accuracy))
    ! Nothing is as sensitive as jumps are.
    if (sigma < onset) digits = digits + without_jumps
    lengths = 0
    if (problem%law%step_width > 0 .or. problem%law%has_kink) lengths = for_steps
    if (problem%law%period > 0) lengths = for_waves
    digits = digits + lengths
    least = max(fewest, for_folds*decades)
    if (lengths > 0) least = fewest + lengths + for_folds_of_lengths*decades
    if (profiles) digits = digits + for_profiles + for_narrow_necks*decades
    if (problem%shape%smooth_from() > 0) digits = digits + for_kinks
    if (.not. problem%body%is_homogeneous()) then
      wider = log10(hypot(1.0_wp, widest*maxval(problem%body%wave_range())/waves_in_layer))
      softer = log10(coupling_over(problem, widest)/problem%coupling)
      digits = digits + for_softer*wider**2*max(0.0_wp, softer)
    end if
    away = abs(log(max(sigma, tiny(1.0_wp))/onset))/log(about_onset)
    digits = digits + at_onset*max(0.0_wp, min(1.0_wp, 1.5_wp*(1 - away)))
    if (away < near_onset) least = max(least, enough_for_folds)
    digits = max(digits, least)
    left = -log10(epsilon(1.0_wp)*max(1.0_wp, sigma*widest, &
      coupling_over(problem, widest)*problem%law%adhesion*widest))
    digits = max(fewest, min(digits, left, most_digits))
    if (left > fewest) digits = max(digits, min(enough_for_folds, least))
  end function digits_for

  !> Where nothing else matters, for so many decimal places of accuracy.
  pure real(wp) function of_load(places) result(digits)
    real(wp), intent(in) :: places

    digits = max(min(1.5_wp*places - 0.25_wp, 2.5_wp + 0.75_wp*places), 1.2_wp*places - 0.2_wp)
  end function of_load

end module mesh_digits
