!> A whole fit: finds noise and jumps of the measured curve, fits the model of the path, tests it,
!> then fits the classical theories to the same samples.
module fit_run
  use kinds, only: wp
  use text, only: rounded
  use failure, only: failure_t
  use progress_observer, only: progress_observer_t
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t
  use experiment_request, only: numerics_t
  use fit_request, only: fit_t, unknown_t, of_model, of_contact_point, of_sensitivity, &
    is_at_end, farthest_off, of_radius
  use measured_curve, only: measured_curve_t
  use measured_jumps, only: find_jump, find_far, off_baseline
  use measured_checks, only: check_measured
  use part_slopes, only: steepest_slope
  use measured_loads, only: check_loads
  use turn_rest, only: leave_out_rest
  use noise, only: white_noise, rounding_of, rough_deviation
  use fit_starts, only: character_t, character_of, starts_like
  use mesh_refinement, only: too_much
  use force_model, only: force_model_t
  use curve_models, only: curve_models_t
  use modelled_curve, only: modelled_curve_t, beyond, level_of
  use curve_residuals, only: curve_residuals_t
  use curve_fit, only: fit_curve
  use significance, only: negligible
  use fit_errors, only: fitted_t
  use fixed_parameter_test, only: held_t, test_held
  use baseline_test, only: lacking_t, test_baseline
  use fit_alternatives, only: alternative_t, find_alternative
  use fit_refusals, only: check_fit
  use derived_numbers, only: derived_t, derive_numbers
  use theory_fits, only: theory_fit_t, fit_theories, suggested_characters
  implicit none
  private
  public :: fit_outcome_t, run_fit, examine_fit

  !> The result of a fit. trouble: the reason why there is no fit, with advice.
  type :: fit_outcome_t
    character(len=:), allocatable :: trouble
    type(modelled_curve_t) :: curve
    type(fitted_t) :: fitted
    !> Whether the meshes of the model resolve the force law.
    logical :: resolved = .true.
    type(theory_fit_t), allocatable :: theory(:)
    !> The test of each number that the deck holds fixed.
    type(held_t), allocatable :: held(:)
    !> Parts that the baseline may lack; and another fit that describes the data if this fit does
    !> not.
    type(lacking_t), allocatable :: lacking(:)
    type(alternative_t), allocatable :: alternative
    !> Numbers that follow from the fitted values.
    type(derived_t), allocatable :: derived(:)
    !> The problem with the fitted values, if these values define a valid problem.
    type(problem_t), allocatable :: problem
    !> For a curve that is fitted together with others: the message about all of them.
    character(len=:), allocatable :: of_all
  end type fit_outcome_t

  !> Smallest ratio of the noise to the largest signal; computed signals have less noise.
  real(wp), parameter :: least_noise = 1.0e-9_wp
  !> Spring constant of a device without a spring [N/m]: so large that no load deflects it.
  real(wp), parameter :: no_spring = 1.0e20_wp
  !> Works of adhesion of further starts, relative to the deck's.
  real(wp), parameter :: works(*) = [0.2_wp, 5.0_wp]

contains

  !> Runs the fit. family: the problems, whose parameters are the unknowns of the model. wider: the
  !> same family with the fixed numbers of the deck as further parameters. problem: the problem with
  !> the deck's values. theories: whether the classical theories are fitted too. like: values of the
  !> unknowns for a similar curve; if a search from these values describes the data, no other search
  !> follows.
  subroutine run_fit(measured, fit, numerics, family, wider, problem, theories, observer, outcome, &
    like)
    type(measured_curve_t), intent(in) :: measured
    type(fit_t), intent(in) :: fit
    type(numerics_t), intent(in) :: numerics
    class(problem_family_t), intent(in) :: family, wider
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: theories
    class(progress_observer_t), intent(inout) :: observer
    type(fit_outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: like(:)
    type(curve_models_t), target :: models
    class(force_model_t), pointer :: model
    type(modelled_curve_t) :: curve
    type(curve_residuals_t) :: residuals
    character(len=:), allocatable :: suggestion
    real(wp), allocatable :: start(:, :)

    call take_curve(outcome%trouble)
    if (allocated(outcome%trouble)) return
    call observer%hear('fitting the path')
    call models%set(family, numerics, problem%law%adhesion > 0, measured%has(of_radius), model)
    suggestion = ''
    if (.not. is_like()) then
      call find_starts()
      call fit_curve(curve, model, start, .true., outcome%fitted)
    end if
    outcome%resolved = models%path%left_out <= too_much*numerics%accuracy
    outcome%curve = curve
    call check_fit(curve, model, outcome%fitted, suggestion, outcome%trouble)
    if (allocated(outcome%trouble)) return
    residuals%curve = curve
    call residuals%curve%use_model(model)
    call examine_fit(residuals, fit, family, wider, outcome)
    if (.not. outcome%fitted%lack%is_noise()) then
      call observer%hear('analysing the residuals')
      call find_alternative(family, problem, curve, model, asked_most(outcome%held) == &
        'measurement.spring_constant', outcome%fitted, outcome%alternative)
    end if
    if (.not. (theories .and. allocated(outcome%problem))) return
    call observer%hear('fitting classical theories')
    call fit_theories(curve, outcome%fitted, family, outcome%problem, outcome%theory)

  contains

    !> Prepares the curve for the fit: the samples, their noise and jumps, and the unknowns.
    subroutine take_curve(trouble)
      character(len=:), allocatable, intent(out) :: trouble
      real(wp) :: slope
      integer :: i

      if (measured%has(of_radius) .and. .not. problem%law%rest_gap > 0) then
        trouble = 'contact radii need a force that pulls and pushes: the edge of a contact is ' // &
          'where the separation is a tenth above that of zero force'
        return
      end if
      curve%data%measured = measured
      curve%unknown = fit%unknown
      do i = 1, size(fit%unknown)
        ! If the signal is a force or a deflection, the unit of the sensitivity is not m/V.
        if (fit%unknown(i)%role == of_sensitivity .and. scan(measured%signal_in, 'Nm') > 0) &
          curve%unknown(i)%unit = 'm/' // measured%signal_in
      end do
      ! A shift of the contact point by the range of the force, or by a step of the base, counts as
      ! large.
      where (curve%unknown%role == of_contact_point) curve%unknown%scale = max(problem%length, &
        (maxval(measured%z) - minval(measured%z))/size(measured%z))
      curve%spring = measured%spring_constant
      if (.not. curve%spring > 0) curve%spring = no_spring
      curve%is_force = .not. allocated(measured%sensitivity)
      if (measured%under_loads()) curve%spring = 0
      curve%sensitivity = measured%load_of_unit()/max(curve%spring, tiny(curve%spring))
      if (.not. curve%is_force) curve%sensitivity = measured%sensitivity
      if (allocated(measured%contact_point)) curve%contact_point = measured%contact_point
      slope = 1/curve%sensitivity
      if (.not. measured%spring_constant > 0) slope = steepest_slope(measured)
      curve%largest_slope = slope
      curve%data%noise_radius_is_given = allocated(fit%noise_radius)
      if (measured%under_loads()) then
        call take_radii()
        return
      end if
      associate (data => curve%data%measured)
        call find_far(data, slope, curve%data%noise)
        curve%data%least_noise = least_noise*maxval(abs(data%signal))
        curve%data%noise_is_given = allocated(fit%noise)
        if (curve%data%noise_is_given) then
          curve%data%noise = white_noise(fit%noise)
        else
          curve%data%least_noise = max(curve%data%least_noise, rounding_of(data%signal))
        end if
        if (curve%data%noise%deviation < curve%data%least_noise) &
          curve%data%noise = white_noise(curve%data%least_noise)
        call leave_out_rest(data, curve%data%noise, slope)
        call check_measured(data, curve%data%noise, slope, trouble)
        if (.not. allocated(trouble) .and. measured%spring_constant > 0) &
          call check_loads(curve, trouble)
        if (allocated(trouble)) return
        curve%data%jump = [find_jump(data, curve%data%noise%deviation, slope, .true.), &
          find_jump(data, curve%data%noise%deviation, slope, .false.)]
        curve%largest = beyond*max(maxval(data%signal, data%usable) - level_of(curve), &
          maxval(off_baseline(data), data%usable))
      end associate
      if (curve%data%noise_radius_is_given) then
        curve%data%noise_radius = fit%noise_radius
      else if (allocated(measured%contact_radius)) then
        associate (seen => pack(measured%contact_radius, measured%contact_radius > 0))
          if (size(seen) > 2) curve%data%noise_radius = rough_deviation(seen)
        end associate
      end if
      call curve%data%measured%add_radii()
      call finish_curve()
    end subroutine take_curve

    !> Prepares a curve of contact radii under loads. Such a curve has no baseline and no jump; the
    !> model must reach the largest load.
    subroutine take_radii()
      associate (data => curve%data%measured)
        data%far = spread(.false., 1, size(data%z))
        data%rested = data%far
        curve%data%noise_is_given = curve%data%noise_radius_is_given
        if (curve%data%noise_is_given) then
          curve%data%noise = white_noise(fit%noise_radius)
        else
          curve%data%least_noise = max(least_noise*maxval(data%signal), rounding_of(data%signal))
          curve%data%noise = white_noise(max(rough_deviation(data%signal), &
            curve%data%least_noise))
        end if
        curve%largest = beyond*max(0.0_wp, maxval(data%z))
      end associate
      call finish_curve()
    end subroutine take_radii

    subroutine finish_curve()
      call curve%data%take(1)
      if (size(curve%data%sample) < 2*size(curve%unknown) + 4) &
        outcome%trouble = 'too few samples for so many parameters'
    end subroutine finish_curve

    !> Whether a search from the values of a similar curve describes the data. The limits of the
    !> search are extended by a range about these values.
    logical function is_like() result(found)
      type(modelled_curve_t) :: trial
      integer :: i

      found = .false.
      if (.not. present(like)) return
      trial = curve
      do i = 1, size(trial%unknown)
        call reach_for(trial%unknown(i), like(i))
      end do
      call fit_curve(trial, model, reshape(like, [size(like), 1]), .true., outcome%fitted)
      associate (fitted => outcome%fitted)
        if (.not. (fitted%found .and. allocated(fitted%effect))) return
        found = fitted%lack%is_noise() .and. all(fitted%effect > negligible) .and. &
          .not. any(is_at_end(trial%unknown, fitted%value))
      end associate
      if (found) curve = trial
    end function is_like

    !> Extends the limits of a search, which are a range about the deck's value, by the same range
    !> about another value.
    subroutine reach_for(unknown, value)
      type(unknown_t), intent(inout) :: unknown
      real(wp), intent(in) :: value
      real(wp) :: off

      if (.not. unknown%in_log) return
      off = log(value/unknown%value)
      unknown%farthest = max(unknown%farthest, farthest_off + [-off, off])
    end subroutine reach_for

    !> Sets the starting values and the limits of the search: ranges about the deck's values, and
    !> about the values that the data suggest.
    subroutine find_starts()
      type(character_t), allocatable :: likely(:)
      type(character_t) :: new
      integer :: i, k, of_data

      likely = suggested_characters(curve, problem, of_data)
      call starts_like(likely(:of_data), family, curve%unknown, start)
      if (size(start, 2) > 1) suggestion = '; the data suggest ' // values_of(start(:, 2))
      call starts_like(likely, family, curve%unknown, start)
      do i = 1, size(curve%unknown)
        do k = 1, size(start, 2)
          call reach_for(curve%unknown(i), start(i, k))
        end do
      end do
      if (.not. problem%law%adhesion > 0) return
      do k = 1, size(works)
        new = character_of(problem)
        new%work = new%work*works(k)
        likely = [likely, new]
      end do
      call starts_like(likely, family, curve%unknown, start)
    end subroutine find_starts

    !> A text with the values of the model's unknowns.
    function values_of(value) result(words)
      real(wp), intent(in) :: value(:)
      character(len=:), allocatable :: words
      integer :: i

      words = ''
      do i = 1, size(value)
        if (curve%unknown(i)%role /= of_model) cycle
        if (len(words) > 0) words = words // ', '
        words = words // curve%unknown(i)%name // ' = ' // rounded(value(i))
      end do
    end function values_of

    !> The name of the fixed number that the data contradict most; '' without such a number.
    function asked_most(held) result(name)
      type(held_t), intent(in) :: held(:)
      character(len=:), allocatable :: name

      name = ''
      if (size(held) > 0) name = held(maxloc(abs(held%asked), 1))%name
    end function asked_most

  end subroutine run_fit

  !> Tests a fit, outcome%fitted, and derives further numbers from it. residuals: those of its curve
  !> under the model. Other arguments: as in `run_fit`.
  subroutine examine_fit(residuals, fit, family, wider, outcome)
    type(curve_residuals_t), intent(inout) :: residuals
    type(fit_t), intent(in) :: fit
    class(problem_family_t), intent(in) :: family, wider
    type(fit_outcome_t), intent(inout) :: outcome
    type(problem_t) :: problem
    type(failure_t), allocatable :: error

    outcome%curve = residuals%curve
    associate (value => outcome%fitted%value, unknown => outcome%curve%unknown)
      call test_held(outcome%curve, value, wider, outcome%held)
      call test_baseline(residuals, value, outcome%lacking)
      outcome%theory = [theory_fit_t ::]
      outcome%derived = [derived_t ::]
      call family%pose(pack(value, unknown%role == of_model), problem, error)
      if (allocated(error)) return
      call derive_numbers(family, fit, unknown, outcome%fitted, problem, outcome%derived)
      outcome%problem = problem
    end associate
  end subroutine examine_fit

end module fit_run
