!> Writes the results of a fit: fit.csv with the samples; fit.nml with the unknowns. For a fit of
!> several curves together, fit.nml and lines of the summary are written.
module fit_rows
  use kinds, only: wp
  use dimensionless_problem, only: adhesion_strength, tabor_parameter
  use text, only: counted, rounded
  use units, only: with_unit
  use namelist_writer, only: line_t, append, assignment_of
  use summary, only: summary_t
  use results, only: results_t
  use tables, only: direction_of
  use fit_request, only: unknown_t, of_radius
  use measured_jumps, only: measured_jump_t
  use fit_errors, only: fitted_t, within_95
  use fixed_parameter_test, only: held_t
  use baseline_test, only: lacking_t
  use fit_alternatives, only: alternative_t
  use fit_run, only: fit_outcome_t
  use joint_fit, only: joint_fit_t
  use fit_warnings, only: doubts_of
  implicit none
  private
  public :: write_fit_rows, fit_text, report_joint

  character(len=1), parameter :: nl = new_line('a')

contains

  !> Writes the rows of fit.csv.
  subroutine write_fit_rows(outcome, results)
    type(fit_outcome_t), intent(in) :: outcome
    type(results_t), intent(inout) :: results
    logical, dimension(size(outcome%curve%data%way)) :: used, outlier
    integer :: i

    outlier = outcome%curve%data%measured%outlier()
    used = .false.
    used(outcome%curve%data%sample) = .true.
    associate (data => outcome%curve%data%measured, fitted => outcome%fitted)
      do i = 1, size(used)
        call results%row(direction_of(data%inward(i)), [data%z(i), data%signal(i), &
          fitted%model(i), fitted%baseline(i), fitted%residual(i)], [used(i), outlier(i), &
          data%observed(i) == of_radius])
      end do
    end associate
  end subroutine write_fit_rows

  !> The text of fit.nml: a group for the fit of the path, and a group for the fit of each theory.
  function fit_text(outcome, title) result(text)
    type(fit_outcome_t), intent(in) :: outcome
    character(len=:), allocatable, intent(in) :: title
    character(len=:), allocatable :: text, signal_unit
    type(line_t), allocatable :: doubts(:)
    integer :: i

    text = '! A fit by snapin, SI units. Values that do not exist are NaN or left out.' // nl // &
      '&fit' // nl // assignment_of('title', title) // &
      of_fitted(outcome%curve%unknown, outcome%fitted)
    associate (curve => outcome%curve)
      text = text // numbers('outliers', [real(count(curve%data%measured%outlier()), wp)])
      if (allocated(outcome%problem)) then
        text = text // numbers('sigma', [adhesion_strength(outcome%problem)])
        text = text // numbers('tabor', [tabor_parameter(outcome%problem)])
      end if
      signal_unit = curve%data%measured%signal_unit()
      if (curve%data%measured%under_loads()) signal_unit = 'm'
      text = text // assignment_of('signal_unit', signal_unit)
      text = text // numbers('noise', [curve%data%noise%deviation])
      if (curve%data%noise_radius > 0) text = text // &
        numbers('noise_radius', [curve%data%noise_radius])
      text = text // numbers('noise_correlation', curve%data%noise%correlation(1:))
      text = text // numbers('rested', [real(count(curve%data%measured%rested), wp)])
      if (curve%data%measured%baseline%period > 0) text = text // &
        numbers('ripple_period', [curve%data%measured%baseline%period])
      text = text // of_jump('jump_in', curve%data%jump(1), outcome%fitted%jump_z(1)) // &
        of_jump('jump_out', curve%data%jump(2), outcome%fitted%jump_z(2))
    end associate
    text = text // of_held(outcome%held) // of_lacking(outcome%lacking, &
      outcome%fitted%deviation)
    do i = 1, size(outcome%derived)
      associate (derived => outcome%derived(i))
        text = text // numbers(derived%name, [derived%value]) // &
          numbers(derived%name // '_error', [derived%error])
        if (allocated(derived%poisson)) text = text // &
          numbers(derived%name // '_poisson', [derived%poisson])
      end associate
    end do
    if (allocated(outcome%alternative)) text = text // of_alternative(outcome%alternative)
    doubts = doubts_of(outcome)
    text = text // assignment_of('warnings', doubts) // '/' // nl
    do i = 1, size(outcome%theory)
      associate (theory => outcome%theory(i))
        if (.not. allocated(theory%fitted%effect)) cycle
        text = text // '&' // trim(theory%theory) // nl // &
          of_fitted(theory%unknown, theory%fitted) // '/' // nl
      end associate
    end do
  end function fit_text

  !> The entries that the fits of the path and of theories have in common.
  function of_fitted(unknown, fitted) result(text)
    type(unknown_t), intent(in) :: unknown(:)
    type(fitted_t), intent(in) :: fitted
    character(len=:), allocatable :: text
    type(line_t), allocatable :: names(:), units(:)
    logical, allocatable :: found
    integer :: i

    found = fitted%found
    do i = 1, size(unknown)
      call append(names, unknown(i)%name)
      call append(units, unknown(i)%unit)
    end do
    text = assignment_of('converged', found) // assignment_of('parameters', names) // &
      assignment_of('units', units) // &
      assignment_of('estimate', fitted%value) // assignment_of('standard_error', fitted%deviation)
    text = text // numbers('lower_68', &
      [(fitted%end_of(i, unknown(i), -1.0_wp), i=1, size(unknown))])
    text = text // numbers('upper_68', [(fitted%end_of(i, unknown(i), 1.0_wp), i=1, size(unknown))])
    text = text // numbers('lower_95', &
      [(fitted%end_of(i, unknown(i), -within_95), i=1, size(unknown))])
    text = text // numbers('upper_95', &
      [(fitted%end_of(i, unknown(i), within_95), i=1, size(unknown))])
    text = text // numbers('correlation', reshape(fitted%correlation, [size(fitted%correlation)]))
    text = text // numbers('identifiable', [fitted%identifiable])
    text = text // numbers('chi_squared', [fitted%chi_squared])
    text = text // numbers('degrees_of_freedom', [real(fitted%freedom, wp)])
    text = text // numbers('excess', [fitted%lack%excess])
    text = text // numbers('excess_width', [real(fitted%lack%width, wp)])
  end function of_fitted

  function of_held(held) result(text)
    type(held_t), intent(in) :: held(:)
    character(len=:), allocatable :: text
    type(line_t), allocatable :: names(:)
    integer :: i

    do i = 1, size(held)
      call append(names, held(i)%name)
    end do
    text = assignment_of('held', names) // numbers('held_asked', held%asked)
  end function of_held

  !> The entries about parts that the baseline may lack. deviation: the standard deviations of the
  !> unknowns.
  function of_lacking(lacking, deviation) result(text)
    type(lacking_t), intent(in) :: lacking(:)
    real(wp), intent(in) :: deviation(:)
    character(len=:), allocatable :: text
    type(line_t), allocatable :: names(:)
    integer :: i

    do i = 1, size(lacking)
      call append(names, lacking(i)%name)
    end do
    text = assignment_of('baseline_tested', names) // numbers('baseline_gain', lacking%gain) // &
      numbers('baseline_chance', [(exp(lacking(i)%chance), i=1, size(lacking))])
    text = text // numbers('baseline_hidden', [(maxval(abs(lacking(i)%hidden)/deviation), &
      i=1, size(lacking))])
    do i = 1, size(lacking)
      if (lacking(i)%period > 0) text = text // numbers('ripple_tested', [lacking(i)%period])
    end do
  end function of_lacking

  !> The entries about another fit that describes the data where this one does not.
  function of_alternative(alternative) result(text)
    type(alternative_t), intent(in) :: alternative
    character(len=:), allocatable :: text

    text = assignment_of('described_with', alternative%name) // &
      numbers('described_chi_squared', [alternative%chi_squared])
    if (alternative%value > 0) text = text // &
      numbers('described_value', [alternative%value, alternative%error])
  end function of_alternative

  !> Positions of the base at a jump, as measured and as modelled. If no jump was measured, only
  !> that of the model is given.
  function of_jump(name, jump, model) result(text)
    character(len=*), intent(in) :: name
    type(measured_jump_t), intent(in) :: jump
    real(wp), intent(in) :: model
    character(len=:), allocatable :: text

    text = numbers(name // '_z_model', [model])
    if (jump%before == 0) return
    text = text // numbers(name // '_z', [jump%z])
    text = text // numbers(name // '_z_uncertainty', [jump%uncertainty])
    text = text // numbers(name // '_change', [jump%change])
  end function of_jump

  !> Numbers as text after the name of a key.
  function numbers(key, values) result(text)
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text
    real(wp), allocatable :: written(:)

    written = values
    text = assignment_of(key, written)
  end function numbers

  !> The text of fit.nml for several curves: the shared parameters.
  function joint_text(joint, title) result(text)
    type(joint_fit_t), intent(in) :: joint
    character(len=:), allocatable, intent(in) :: title
    character(len=:), allocatable :: text

    text = '! A fit by snapin of several curves together, SI units: the shared parameters. ' // &
      'sweep.csv has those of each curve.' // nl // '&fit' // nl // &
      assignment_of('title', title) // of_fitted(joint%unknown, joint%fitted) // &
      numbers('curves', [real(joint%curves, wp)]) // &
      numbers('chi_squared_alone', [joint%alone]) // &
      numbers('degrees_of_freedom_alone', [real(joint%fitted%freedom - joint%spared, wp)]) // &
      assignment_of('warnings', joint%doubt) // '/' // nl
  end function joint_text

  !> Writes fit.nml, and adds to the summary how well the fit describes the curves, and the shared
  !> parameters.
  subroutine report_joint(joint, title, results, summary)
    type(joint_fit_t), intent(in) :: joint
    character(len=:), allocatable, intent(in) :: title
    type(results_t), intent(inout) :: results
    type(summary_t), intent(inout) :: summary
    integer :: i

    if (allocated(joint%trouble)) then
      call summary%fail_with('no fit of all curves: ' // joint%trouble)
      return
    end if
    ! An error in writing results has ended the fits.
    if (.not. allocated(joint%unknown)) return
    call results%write_text('fit.nml', joint_text(joint, title))
    if (allocated(joint%doubt)) call summary%warn('fit: ' // joint%doubt)
    call summary%note(counted(joint%curves, 'curve') // ' fitted together: chi squared ' // &
      rounded(joint%fitted%chi_squared) // ' with ' // &
      counted(joint%fitted%freedom, 'degree') // ' of freedom')
    do i = 1, size(joint%unknown)
      call summary%note(joint%unknown(i)%name // ' = ' // with_unit(joint%fitted%value(i), &
        joint%fitted%deviation(i), joint%unknown(i)%unit))
    end do
  end subroutine report_joint

end module fit_rows
