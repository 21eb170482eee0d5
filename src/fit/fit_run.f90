!> A whole fit: finds noise and jumps of the measured curve, fits the model of the path, then fits
!> the classical theories to the same samples.
module fit_run
  use kinds, only: wp, pi
  use text, only: rounded
  use failure, only: failure_t
  use listener, only: listener_t
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t
  use experiment_request, only: numerics_t
  use fit_request, only: fit_t, unknown_t, of_model, of_contact_point, is_at_end
  use measured_curve, only: measured_t
  use measured_jumps, only: find_jump, find_far, off_baseline
  use measured_checks, only: check_measured, check_loads, other_order
  use noise, only: white_noise, rounding_of
  use fit_starts, only: character_t, character_of, starts_like
  use mending, only: too_much
  use path_model, only: path_model_t
  use classical_model, only: classical_model_t, theories
  use modelled_curve, only: modelled_curve_t
  use curve_fit, only: fit_curve
  use fit_errors, only: fitted_t, least_effect
  use held_numbers, only: held_t, test_held
  implicit none
  private
  public :: fit_outcome_t, run_fit

  !> The fit of a classical theory.
  type :: theory_fit_t
    character(len=14) :: theory = ''
    type(unknown_t), allocatable :: unknown(:)
    type(fitted_t) :: fitted
  end type theory_fit_t

  !> The result. trouble: the reason why there is no fit, with advice.
  type :: fit_outcome_t
    character(len=:), allocatable :: trouble
    type(modelled_curve_t) :: curve
    type(fitted_t) :: fitted
    !> Whether the meshes of the model resolve the force law.
    logical :: resolved = .true.
    type(theory_fit_t), allocatable :: theory(:)
    !> The test of each number that the deck holds fixed.
    type(held_t), allocatable :: held(:)
    !> The problem with the fitted values, if it could be posed.
    type(problem_t), allocatable :: problem
  end type fit_outcome_t

  !> Smallest noise over the largest signal, for computed signals.
  real(wp), parameter :: least_noise = 1.0e-9_wp
  !> The model is solved up to this many times the largest signal, since a trial may be too soft.
  real(wp), parameter :: beyond = 1.2_wp
  !> Starting stiffnesses of the theories over the deck's; starting ranges of the force over the
  !> deck's; samples to which the theories are fitted to find starting values.
  real(wp), parameter :: factors(*) = [1.0_wp, 0.1_wp, 10.0_wp, 0.01_wp, 100.0_wp], &
    ranges(*) = [0.25_wp, 4.0_wp], works(*) = [0.2_wp, 5.0_wp]
  integer, parameter :: few_samples = 1000

contains

  !> Runs the fit. family: the problems, whose parameters are the unknowns of the model. wider: the
  !> same family with the fixed numbers of the deck as further parameters. problem: the problem with
  !> the deck's values.
  subroutine run_fit(measured, fit, numerics, family, wider, problem, listener, outcome)
    type(measured_t), intent(in) :: measured
    type(fit_t), intent(in) :: fit
    type(numerics_t), intent(in) :: numerics
    class(problem_family_t), intent(in) :: family, wider
    type(problem_t), intent(in) :: problem
    class(listener_t), intent(inout) :: listener
    type(fit_outcome_t), intent(out) :: outcome
    type(path_model_t), target :: model
    type(modelled_curve_t) :: curve
    real(wp), allocatable :: start(:, :)
    integer :: i

    call take_curve(outcome%trouble)
    if (allocated(outcome%trouble)) return
    call listener%hear('fitting the path')
    allocate (model%family, source=family)
    model%numerics = numerics
    call starts_like(likely_characters(), family, curve%unknown, start)
    call fit_curve(curve, model, start, .true., outcome%fitted)
    outcome%resolved = model%left_out <= too_much*model%numerics%accuracy
    outcome%curve = curve
    if (.not. outcome%fitted%has_curve) then
      outcome%trouble = 'with the values of the deck the path could not be solved over the ' // &
        'range of the data, or is far from them; start from other values, or fit a part of the data'
      return
    end if
    if (.not. allocated(outcome%fitted%effect)) then
      outcome%trouble = &
        'the search ended where the path has no derivatives; start from other values'
      return
    end if
    associate (fitted => outcome%fitted)
      if (.not. fitted%lack%is_noise() .and. any(fitted%effect <= least_effect .or. &
        is_at_end(outcome%curve%unknown, fitted%value))) then
        outcome%trouble = other_order(outcome%curve, model)
        if (len(outcome%trouble) > 0) return
        deallocate (outcome%trouble)
      end if
    end associate
    do i = 1, size(outcome%fitted%effect)
      if (outcome%fitted%effect(i) > least_effect) cycle
      outcome%trouble = outcome%curve%unknown(i)%name // &
        ' has no effect on this curve near the best value found, ' // &
        rounded(outcome%fitted%value(i)) // '; remove it from parameters, or give a prior'
      return
    end do
    call test_held(outcome%curve, outcome%fitted%value, numerics, wider, outcome%held)
    call listener%hear('fitting classical theories')
    call fit_theories()

  contains

    !> Makes the curve to fit: the samples, their noise and jumps, and the unknowns.
    subroutine take_curve(trouble)
      character(len=:), allocatable, intent(out) :: trouble
      real(wp) :: slope

      curve%data%measured = measured
      curve%unknown = fit%unknown
      where (curve%unknown%role == of_contact_point) curve%unknown%scale = problem%length
      curve%spring = measured%spring_constant
      curve%sensitivity = 1/measured%spring_constant
      if (allocated(measured%sensitivity)) curve%sensitivity = measured%sensitivity
      if (allocated(measured%contact_point)) curve%contact_point = measured%contact_point
      slope = 1/curve%sensitivity
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
        call check_measured(data, curve%data%noise, slope, trouble)
        if (.not. allocated(trouble)) call check_loads(curve, trouble)
        if (allocated(trouble)) return
        curve%data%jump = [find_jump(data, curve%data%noise%deviation, slope, .true.), &
          find_jump(data, curve%data%noise%deviation, slope, .false.)]
        curve%largest = beyond*max(maxval(data%signal, data%usable) - level_of(data), &
          maxval(off_baseline(data), data%usable))
      end associate
      call curve%data%take(1)
      if (size(curve%data%sample) < 2*size(curve%unknown) + 4) &
        trouble = 'too few samples for so many parameters'
    end subroutine take_curve

    !> Likely works of adhesion, stiffnesses and ranges of force: from the pull-off below the mean
    !> of the baseline and below its slope, and from JKR and DMT fits, each with the range of the
    !> deck's force and with others.
    function likely_characters() result(likely)
      type(character_t), allocatable :: likely(:)
      type(character_t) :: own, new
      type(classical_model_t), target :: model
      type(modelled_curve_t) :: few
      type(fitted_t) :: fitted
      real(wp) :: start(2 + size(curve%unknown), size(factors)), pull_off(2)
      integer :: i, k

      allocate (likely(0))
      own = character_of(problem)
      if (.not. own%work > 0) return
      do k = 1, size(works)
        new = own
        new%work = own%work*works(k)
        likely = [likely, new]
      end do
      associate (data => curve%data%measured)
        pull_off = -[minval(data%signal, data%usable) - level_of(data), &
          minval(off_baseline(data), data%usable)]
      end associate
      do i = size(pull_off), 1, -1
        own%work = pull_off(i)*curve%spring*curve%sensitivity/(1.5_wp*pi*problem%radius)
        if (own%work > 0) likely = [likely, own]
      end do
      if (size(likely) == size(works)) return
      own = likely(size(likely))
      model%radius = problem%radius
      few = curve
      few%data%noise = white_noise(curve%data%noise%deviation)
      call few%data%take(max(1, size(curve%data%sample)/few_samples))
      do i = 1, 2
        if (.not. problem%shape%parabolic) exit
        model%theory = theories(i)
        call take_unknowns(few, curve, model, own)
        do k = 1, size(factors)
          start(:size(few%unknown), k) = few%unknown%value
          start(2, k) = own%stiffness*factors(k)
        end do
        call fit_curve(few, model, start(:size(few%unknown), :), .false., fitted)
        if (.not. allocated(fitted%effect)) cycle
        new = character_t(fitted%value(1), fitted%value(2), own%range)
        likely = [likely, new]
        do k = 1, size(ranges)
          new%range = own%range*ranges(k)
          likely = [likely, new]
        end do
      end do
      do k = 1, size(factors)
        new = own
        new%stiffness = own%stiffness*factors(k)
        likely = [likely, new]
      end do
    end function likely_characters

    !> Fits JKR, DMT and Maugis-Dugdale theory to the same curve, if the bodies are parabolas. The
    !> work of adhesion is unknown if the deck fits a number of a force, the stiffness if it fits
    !> one of the bodies.
    subroutine fit_theories()
      type(classical_model_t), target :: model
      type(modelled_curve_t) :: curve
      type(problem_t) :: final
      type(failure_t), allocatable :: error
      real(wp), allocatable :: start(:, :)
      logical :: elastic(size(family%parameter))
      integer :: i

      allocate (outcome%theory(0))
      call family%pose(pack(outcome%fitted%value, outcome%curve%unknown%role == of_model), final, &
        error)
      if (allocated(error)) return
      outcome%problem = final
      if (.not. problem%shape%parabolic .or. .not. final%law%work > 0) return
      if (.not. final%body%is_homogeneous()) return
      elastic = [(index(family%parameter(i)%name, 'bodies.') == 1 .and. &
        family%parameter(i)%name /= 'bodies.radius', i=1, size(elastic))]
      model%radius = final%radius
      model%finds_stiffness = any(elastic)
      model%finds_work = .not. all(elastic)
      curve = outcome%curve
      call take_unknowns(curve, outcome%curve, model, character_of(final))
      deallocate (outcome%theory)
      allocate (outcome%theory(size(theories)))
      start = reshape([pack(curve%unknown%value, curve%unknown%role == of_model), &
        pack(outcome%fitted%value, outcome%curve%unknown%role /= of_model)], [size(curve%unknown), &
        1])
      do i = 1, size(theories)
        model%theory = theories(i)
        outcome%theory(i)%theory = theories(i)
        outcome%theory(i)%unknown = curve%unknown
        call fit_curve(curve, model, start, .false., outcome%theory(i)%fitted)
      end do
    end subroutine fit_theories

    !> Sets the unknowns of a theory and those of the measurement.
    subroutine take_unknowns(curve, measured, model, start)
      type(modelled_curve_t), intent(inout) :: curve
      type(modelled_curve_t), intent(in) :: measured
      type(classical_model_t), intent(inout) :: model
      type(character_t), intent(in) :: start
      type(unknown_t) :: unknown(2)

      model%work = start%work
      model%stiffness = start%stiffness
      model%range = start%range
      unknown(1) = unknown_of('work_of_adhesion', model%work)
      unknown(2) = unknown_of('stiffness', model%stiffness)
      curve%unknown = [pack(unknown, [model%finds_work, model%finds_stiffness]), &
        pack(measured%unknown, measured%unknown%role /= of_model)]
    end subroutine take_unknowns

    !> The mean of the far samples.
    pure real(wp) function level_of(data) result(level)
      type(measured_t), intent(in) :: data

      associate (far => data%far .and. data%usable)
        level = sum(data%signal, far)/max(1, count(far))
      end associate
    end function level_of

    !> A positive unknown of a theory.
    type(unknown_t) function unknown_of(name, value) result(unknown)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: value

      unknown%name = name
      unknown%in_log = .true.
      unknown%value = value
      unknown%scale = value
    end function unknown_of

  end subroutine run_fit

end module fit_run
