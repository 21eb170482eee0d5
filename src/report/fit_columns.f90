!> The columns of a fit in sweep.csv: each parameter with its errors, the derived numbers, how well
!> the model describes the curve, and a verdict in a word.
module fit_columns
  use kinds, only: wp, nan
  use namelist_writer, only: line_t
  use scene_groups, only: scene_t
  use fit_errors, only: fitted_t
  use fit_rows, only: most
  use fit_run, only: fit_outcome_t
  implicit none
  private
  public :: columns_of_fit, numbers_of_fit, values_of_fit, count_of_fit, verdict_of, verdicts, &
    described, warned, not_described, refused, unreadable, text_columns

  !> The verdicts by their numbers, from 1.
  integer, parameter :: described = 1, warned = 2, not_described = 3, refused = 4, unreadable = 5
  character(len=13), parameter :: verdicts(*) = [character(len=13) :: 'described', 'warned', &
    'not_described', 'refused', 'unreadable']
  !> The columns with text, which follow the numbers.
  character(len=*), parameter :: text_columns(*) = [character(len=100) :: &
    'verdict [] of the fit: described, warned, not_described, refused or unreadable', &
    'warning [] the first warning about the fit; blank if there is none']

  !> Endings of the names of a parameter's columns, and their meanings.
  character(len=*), parameter :: endings(*) = [character(len=16) :: '_estimate', &
    '_standard_error', '_lower_95', '_upper_95']
  character(len=*), parameter :: meanings(*) = [character(len=32) :: 'fitted value', &
    'standard error', 'lower end of the 95 % interval', 'upper end of the 95 % interval']
  !> Numbers that a fit may have, with their errors, and others.
  character(len=*), parameter :: derived(*) = [character(len=16) :: 'work_of_adhesion', &
    'reduced_modulus', 'young_of_sample']
  character(len=*), parameter :: units(*) = [character(len=5) :: 'J/m^2', 'Pa', 'Pa']
  character(len=*), parameter :: others(*) = [character(len=100) :: &
    'contact_height [m] fitted contact point: position of the base where undeformed bodies touch', &
    'chi_squared [] sum of the squared residuals over the noise', &
    'degrees_of_freedom []', &
    'excess [] standard deviations by which the residuals exceed the noise', &
    'identifiable [] 1: the data tell all parameters apart; 0: they do not', &
    'noise [] standard deviation of the signal', &
    'samples [] in the fit', &
    'outliers [] left out', &
    'warnings [] number of warnings about the fit']

contains

  !> The columns with numbers, each described as 'name [unit] meaning'.
  function columns_of_fit(scene) result(columns)
    type(scene_t), intent(in) :: scene
    character(len=132), allocatable :: columns(:)
    integer :: i, k, n

    allocate (columns(count_of_fit(scene)))
    n = 0
    do i = 1, size(scene%fit%unknown)
      associate (unknown => scene%fit%unknown(i))
        do k = 1, size(endings)
          n = n + 1
          columns(n) = unknown%name // trim(endings(k)) // ' [' // unknown%unit // '] ' // &
            meanings(k)
        end do
      end associate
    end do
    do i = 1, size(derived)
      columns(n + 1) = 'fitted_' // trim(derived(i)) // ' [' // trim(units(i)) // &
        '] from the fitted values'
      columns(n + 2) = 'fitted_' // trim(derived(i)) // '_error [' // trim(units(i)) // &
        '] its standard error'
      n = n + 2
    end do
    columns(n + 1:) = others
  end function columns_of_fit

  !> The number of these columns.
  pure integer function count_of_fit(scene) result(n)
    type(scene_t), intent(in) :: scene

    n = size(endings)*size(scene%fit%unknown) + 2*size(derived) + size(others)
  end function count_of_fit

  !> The numbers of the columns; NaN without a fit.
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
          fitted%deviation(i), fitted%end_of(i, curve%unknown(i), -most), &
          fitted%end_of(i, curve%unknown(i), most)]
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

  !> The fitted values among the numbers of a fit of `unknowns` numbers.
  pure function values_of_fit(numbers, unknowns) result(values)
    real(wp), intent(in) :: numbers(:)
    integer, intent(in) :: unknowns
    real(wp) :: values(unknowns)

    values = numbers(:size(endings)*unknowns:size(endings))
  end function values_of_fit

  !> The verdict on a fit that was made.
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

end module fit_columns
