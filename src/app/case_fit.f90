!> The cases of a sweep that fits measured curves: each curve alone, or all curves together.
module case_fit
  use kinds, only: wp, nan
  use text, only: first_line
  use failure, only: failure_t
  use namelist_writer, only: line_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use scene_problem, only: problem_of
  use curve_index, only: curve_index_t
  use deck_family, only: deck_family_t, widened
  use fit_group, only: load_curve, family_of_fit
  use experiment_result, only: experiment_result_t
  use experiment, only: run_experiment
  use progress, only: progress_t
  use summary, only: summary_t
  use summarise, only: summary_of
  use problem_numbers, only: describe_problem
  use fit_errors, only: within_95
  use fit_run, only: fit_outcome_t
  use fit_warnings, only: doubts_of
  use joint_fit, only: joint_curve_t, joint_fit_t, fit_jointly
  use fit_columns, only: count_of_fit, endings, derived, described, warned, not_described, &
    refused, unreadable
  use measured_fit, only: fit_measured
  use case_columns, only: numbers_of
  use sweep_case, only: case_t, case_observer_t
  implicit none
  private
  public :: run_fit_case, fit_together

  !> The fit of a case. scene: the scene of the sweep with the values of the case. readable: whether
  !> the curve could be read.
  type :: fitted_case_t
    type(scene_t) :: scene
    type(problem_t) :: problem
    type(summary_t) :: summary
    type(fit_outcome_t) :: outcome
    logical :: readable = .false.
  end type fitted_case_t

contains

  !> Fits the curve of the case with the given number, values and text of the scene's sweep. If a
  !> curve cannot be read or fitted, the row has the reason. index: the positions of the curves in a
  !> file with several curves, once they are known. Fits make strings, so that only one may be made
  !> at a time in one process (compiler note 4).
  subroutine run_fit_case(scene, progress, index, case)
    type(scene_t), intent(in) :: scene
    type(progress_t), intent(in), target :: progress
    type(curve_index_t), intent(inout) :: index
    type(case_t), intent(inout) :: case
    type(fitted_case_t) :: fitted

    call fit_case(scene, progress, index, case, fitted)
    call finish_case(scene, fitted, case)
  end subroutine run_fit_case

  !> Reads and fits the curve of a case.
  subroutine fit_case(scene, progress, index, case, fitted)
    type(scene_t), intent(in) :: scene
    type(progress_t), intent(in), target :: progress
    type(curve_index_t), intent(inout) :: index
    type(case_t), intent(inout) :: case
    type(fitted_case_t), intent(out) :: fitted
    type(case_observer_t) :: observer
    type(experiment_result_t) :: result
    type(failure_t), allocatable :: error

    observer%case = case%number
    observer%progress => progress
    call fitted%summary%set('converged', .false.)
    call swept_scene(scene, scene%sweep%names, case%values, fitted%scene, error, case%text)
    if (.not. allocated(error)) call load_curve(fitted%scene, error, index)
    fitted%readable = .not. allocated(error)
    if (.not. fitted%readable) then
      fitted%outcome%trouble = first_line(error%message)
      return
    end if
    fitted%problem = problem_of(fitted%scene)
    call run_experiment(fitted%scene, fitted%problem, observer, result)
    fitted%summary = summary_of(fitted%scene, fitted%problem, result)
    case%cost = result%cost
    if (size(case%like) > 0) then
      call fit_measured(fitted%scene, fitted%problem, .false., observer, fitted%outcome, case%like)
    else
      call fit_measured(fitted%scene, fitted%problem, .false., observer, fitted%outcome)
    end if
  end subroutine fit_case

  !> Makes the row of a case from the result of its fit.
  subroutine finish_case(scene, fitted, case)
    type(scene_t), intent(in) :: scene
    type(fitted_case_t), intent(inout) :: fitted
    type(case_t), intent(inout) :: case
    type(line_t), allocatable :: doubts(:)

    allocate (doubts(0))
    case%failure = ''
    case%warning = ''
    associate (outcome => fitted%outcome, summary => fitted%summary)
      if (.not. allocated(outcome%trouble)) then
        doubts = doubts_of(outcome)
        if (allocated(outcome%problem)) call describe_problem(outcome%problem, summary)
      end if
      case%verdict = unreadable
      if (fitted%readable) case%verdict = verdict_of(outcome, doubts)
      if (size(doubts) > 0) case%warning = doubts(1)%text
      if (allocated(summary%failure)) case%failure = summary%failure
      if (allocated(outcome%trouble)) case%failure = outcome%trouble
      if (case%failure /= '' .or. .not. outcome%fitted%found) call summary%set('converged', .false.)
      case%converged = summary%is_true('converged')
      case%numbers = [numbers_of(summary, scene), numbers_of_fit(scene, outcome, doubts)]
    end associate
    case%costs = [real(wp) ::]
  end subroutine finish_case

  !> The numbers of the columns of a fit; NaN without a fit.
  function numbers_of_fit(scene, outcome, doubts) result(numbers)
    type(scene_t), intent(in) :: scene
    type(fit_outcome_t), intent(in) :: outcome
    type(line_t), intent(in) :: doubts(:)
    real(wp), allocatable :: numbers(:)
    integer :: i, k, n

    allocate (numbers(count_of_fit(scene)), source=nan)
    if (allocated(outcome%trouble)) return
    n = size(scene%fit%unknown)
    associate (fitted => outcome%fitted, curve => outcome%curve)
      do i = 1, n
        numbers(size(endings)*(i - 1) + 1:size(endings)*i) = [fitted%value(i), &
          fitted%deviation(i), fitted%end_of(i, curve%unknown(i), -within_95), &
          fitted%end_of(i, curve%unknown(i), within_95)]
      end do
      n = size(endings)*n
      do i = 1, size(derived)
        do k = 1, size(outcome%derived)
          if (outcome%derived(k)%name /= derived(i)) cycle
          numbers(n + 2*i - 1:n + 2*i) = [outcome%derived(k)%value, outcome%derived(k)%error]
        end do
      end do
      n = n + 2*size(derived)
      numbers(n + 1:) = [curve%contact_height(fitted%value), fitted%chi_squared, &
        real(fitted%freedom, wp), fitted%lack%excess, fitted%identifiable, &
        curve%data%noise%deviation, real(size(curve%data%sample), wp), &
        real(count(curve%data%measured%outlier()), wp), real(size(doubts), wp)]
    end associate
  end function numbers_of_fit

  !> The verdict on a completed fit.
  pure integer function verdict_of(outcome, doubts) result(verdict)
    type(fit_outcome_t), intent(in) :: outcome
    type(line_t), intent(in) :: doubts(:)

    verdict = described
    if (allocated(outcome%trouble)) then
      verdict = refused
    else if (.not. outcome%fitted%lack%is_noise()) then
      verdict = not_described
    else if (size(doubts) > 0) then
      verdict = warned
    end if
  end function verdict_of

  !> Fits the curves of all cases together: first each curve alone, then all curves that the model
  !> describes. A curve that takes no part keeps the row of its fit alone.
  subroutine fit_together(scene, progress, case, joint)
    type(scene_t), intent(in) :: scene
    type(progress_t), intent(in), target :: progress
    type(case_t), intent(inout) :: case(:)
    type(joint_fit_t), intent(out) :: joint
    type(fitted_case_t), allocatable :: fitted(:)
    type(joint_curve_t), allocatable :: curve(:)
    type(case_observer_t) :: observer
    type(curve_index_t) :: index
    integer :: i, first

    allocate (fitted(size(case)), curve(size(case)))
    index = scene%sweep%index
    first = 0
    do i = 1, size(case)
      ! All later fits start from the values of the first curve that the model describes.
      if (first > 0) case(i)%like = fitted(first)%outcome%fitted%value
      call fit_case(scene, progress, index, case(i), fitted(i))
      call take_curve(fitted(i), curve(i))
      call finish_case(scene, fitted(i), case(i))
      if (first == 0 .and. case(i)%verdict == described) first = i
    end do
    observer%progress => progress
    call fit_jointly(curve, observer, joint)
    do i = 1, size(case)
      call take_row(curve(i), fitted(i), case(i))
    end do

  contains

    !> Makes the row of a curve.
    subroutine take_row(curve, fitted, case)
      type(joint_curve_t), intent(inout) :: curve
      type(fitted_case_t), intent(inout) :: fitted
      type(case_t), intent(inout) :: case
      character(len=:), allocatable :: text

      if (.not. curve%takes_part) then
        text = 'not fitted together with the others: ' // trim(case%warning)
        if (case%verdict == not_described) case%warning = text
      else if (allocated(joint%trouble)) then
        case%converged = .false.
        case%failure = 'no fit of all curves: ' // joint%trouble
      else
        fitted%outcome = curve%outcome
        call finish_case(scene, fitted, case)
      end if
    end subroutine take_row

  end subroutine fit_together

  !> Makes a curve for the joint fit from the fit of this curve alone.
  subroutine take_curve(fitted, curve)
    type(fitted_case_t), intent(in) :: fitted
    type(joint_curve_t), intent(out) :: curve
    type(deck_family_t) :: family
    type(failure_t), allocatable :: error

    curve%outcome = fitted%outcome
    if (.not. fitted%readable) return
    ! The deck has been read already, so that its family has no mistake.
    call family_of_fit(fitted%scene%deck, family, error)
    allocate (curve%family, source=family)
    allocate (curve%wider, source=widened(family))
    curve%fit = fitted%scene%fit
    curve%numerics = fitted%scene%numerics
    curve%attracts = fitted%problem%law%adhesion > 0
  end subroutine take_curve

end module case_fit
