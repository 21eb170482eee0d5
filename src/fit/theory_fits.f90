!> Fits of the classical theories to a measured curve. Before the fit of the model they give
!> starting values, and after it a comparison.
module theory_fits
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t
  use noise, only: white_noise
  use measured_jumps, only: off_baseline
  use fit_request, only: unknown_t, of_model
  use fit_starts, only: character_t, character_of
  use classical, only: theories, hertz
  use classical_model, only: classical_model_t, adhesive
  use modelled_curve, only: modelled_curve_t, level_of
  use curve_fit, only: fit_curve
  use fit_errors, only: fitted_t
  implicit none
  private
  public :: theory_fit_t, fit_theories, suggested_characters

  !> The fit of a classical theory.
  type :: theory_fit_t
    character(len=len(theories)) :: theory = ''
    type(unknown_t), allocatable :: unknown(:)
    type(fitted_t) :: fitted
  end type theory_fit_t

  !> Starting moduli of the theories relative to the deck's; starting ranges of the force relative
  !> to the deck's; number of samples to which the theories are fitted for starting values.
  real(wp), parameter :: factors(*) = [1.0_wp, 0.1_wp, 10.0_wp, 0.01_wp, 100.0_wp], &
    ranges(*) = [0.25_wp, 4.0_wp]
  integer, parameter :: few_samples = 1000

contains

  !> Works of adhesion, plane-strain moduli and ranges of force that the data suggest. They come
  !> from the pull-off force, below a constant and below a sloping baseline, and from JKR and DMT
  !> fits, each combined with the range of the deck's force and with others. Without attraction only
  !> moduli from Hertz fits are suggested. The last suggestions are multiples of the deck's modulus.
  !> of_data: the number of suggestions before these.
  function suggested_characters(curve, problem, of_data) result(likely)
    type(modelled_curve_t), intent(in) :: curve
    type(problem_t), intent(in) :: problem
    integer, intent(out), optional :: of_data
    type(character_t), allocatable :: likely(:)
    type(character_t) :: own, new
    type(classical_model_t), target :: model
    type(modelled_curve_t) :: few
    type(fitted_t) :: fitted
    real(wp) :: start(2 + size(curve%unknown), size(factors)), pull_off(2)
    integer :: i, k, n

    allocate (likely(0))
    if (present(of_data)) of_data = 0
    own = character_of(problem)
    model%finds_work = problem%law%adhesion > 0
    if (model%finds_work) then
      if (.not. own%work > 0) return
      associate (data => curve%data%measured)
        if (data%under_loads()) then
          pull_off = -minval(data%z)*data%load_of_unit()
        else
          pull_off = -[minval(data%signal, data%usable) - level_of(curve), &
            minval(off_baseline(data), data%usable)]*curve%spring*curve%sensitivity
        end if
      end associate
      do i = size(pull_off), 1, -1
        own%work = pull_off(i)/(1.5_wp*pi*problem%radius)
        if (own%work > 0) likely = [likely, own]
      end do
      if (size(likely) == 0) likely = [character_of(problem)]
      own = likely(size(likely))
    end if
    if (problem%shape%parabolic) then
      model%radius = problem%radius
      few = curve
      few%data%noise = white_noise(curve%data%noise%deviation)
      call few%data%take(max(1, size(curve%data%sample)/few_samples))
      do i = 1, 2
        model%theory = adhesive(i)
        if (.not. model%finds_work) model%theory = hertz
        call take_unknowns(few, curve, model, own)
        n = size(few%unknown)
        do k = 1, size(factors)
          start(:n, k) = few%unknown%value
          start(count([model%finds_work, .true.]), k) = own%stiffness*factors(k)
        end do
        call fit_curve(few, model, start(:n, :), .false., fitted)
        if (.not. allocated(fitted%effect)) cycle
        new = own
        if (model%finds_work) new%work = fitted%value(1)
        new%stiffness = fitted%value(count([model%finds_work, .true.]))
        likely = [likely, new]
        if (.not. model%finds_work) exit
        do k = 1, size(ranges)
          new%range = own%range*ranges(k)
          likely = [likely, new]
        end do
      end do
    end if
    if (present(of_data)) of_data = size(likely)
    do k = 1, size(factors)
      new = own
      new%stiffness = own%stiffness*factors(k)
      likely = [likely, new]
    end do
  end function suggested_characters

  !> Fits JKR, DMT and Maugis-Dugdale theory to the same curve, or Hertz theory if the bodies do not
  !> attract each other. The bodies must be parabolas; otherwise there are no fits. The work of
  !> adhesion is an unknown if the deck fits a number of a force, and the modulus is an unknown if
  !> the deck fits one of the bodies. final: the fitted problem.
  subroutine fit_theories(fitted_curve, fitted, family, final, theory)
    type(modelled_curve_t), intent(in) :: fitted_curve
    type(fitted_t), intent(in) :: fitted
    class(problem_family_t), intent(in) :: family
    type(problem_t), intent(in) :: final
    type(theory_fit_t), allocatable, intent(out) :: theory(:)
    type(classical_model_t), target :: model
    type(modelled_curve_t) :: curve
    real(wp), allocatable :: start(:, :)
    logical :: elastic(size(family%parameter)), attracts
    integer :: i

    allocate (theory(0))
    attracts = final%law%adhesion > 0
    if (.not. final%shape%parabolic .or. (attracts .and. .not. final%law%work > 0)) return
    if (.not. final%body%is_homogeneous()) return
    elastic = [(index(family%parameter(i)%name, 'bodies.') == 1 .and. &
      family%parameter(i)%name /= 'bodies.radius', i=1, size(elastic))]
    model%radius = final%radius
    model%finds_stiffness = any(elastic)
    model%finds_work = attracts .and. .not. all(elastic)
    curve = fitted_curve
    call take_unknowns(curve, fitted_curve, model, character_of(final))
    if (size(curve%unknown) == 0) return
    deallocate (theory)
    allocate (theory(merge(size(adhesive), 1, attracts)))
    start = reshape([pack(curve%unknown%value, curve%unknown%role == of_model), &
      pack(fitted%value, fitted_curve%unknown%role /= of_model)], [size(curve%unknown), 1])
    do i = 1, size(theory)
      model%theory = hertz
      if (attracts) model%theory = adhesive(i)
      theory(i)%theory = theories(model%theory)
      theory(i)%unknown = curve%unknown
      call fit_curve(curve, model, start, .false., theory(i)%fitted)
    end do
  end subroutine fit_theories

  !> Sets the unknowns of a theory and those of the measurement.
  subroutine take_unknowns(curve, measured, model, start)
    type(modelled_curve_t), intent(inout) :: curve
    type(modelled_curve_t), intent(in) :: measured
    type(classical_model_t), intent(inout) :: model
    type(character_t), intent(in) :: start
    integer :: i, n

    model%work = start%work
    model%stiffness = start%stiffness
    model%range = start%range
    if (allocated(curve%unknown)) deallocate (curve%unknown)
    allocate (curve%unknown(count([model%finds_work, model%finds_stiffness]) + &
      count(measured%unknown%role /= of_model)))
    n = 0
    if (model%finds_work) call add(unknown_of('work_of_adhesion', 'J/m^2', model%work))
    if (model%finds_stiffness) call add(unknown_of('stiffness', 'Pa', model%stiffness))
    do i = 1, size(measured%unknown)
      if (measured%unknown(i)%role /= of_model) call add(measured%unknown(i))
    end do

  contains

    !> Unknowns are appended one by one, since an array constructor of arrays would not free the
    !> texts of its elements.
    subroutine add(unknown)
      type(unknown_t), intent(in) :: unknown

      n = n + 1
      curve%unknown(n) = unknown
    end subroutine add

  end subroutine take_unknowns

  !> A positive unknown of a theory.
  type(unknown_t) function unknown_of(name, unit, value) result(unknown)
    character(len=*), intent(in) :: name, unit
    real(wp), intent(in) :: value

    unknown%name = name
    unknown%unit = unit
    unknown%in_log = .true.
    unknown%value = value
    unknown%scale = value
  end function unknown_of

end module theory_fits
