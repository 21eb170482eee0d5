!> The results of a fit of several curves together: fit.nml, and lines of the summary.
module joint_rows
  use kinds, only: wp
  use units, only: with_unit
  use text, only: counted, rounded
  use namelist_writer, only: line_t, assignment_of
  use joint_fit, only: joint_fit_t
  use summary, only: summary_t
  use results, only: results_t
  use fit_rows, only: of_fitted, numbers
  implicit none
  private
  public :: report_joint

  character(len=1), parameter :: nl = new_line('a')

contains

  !> The text of fit.nml: the shared parameters.
  function joint_text(joint, title) result(text)
    type(joint_fit_t), intent(in) :: joint
    character(len=:), allocatable, intent(in) :: title
    character(len=:), allocatable :: text
    type(line_t), allocatable :: doubts(:)

    allocate (doubts(merge(1, 0, allocated(joint%doubt))))
    if (size(doubts) > 0) doubts(1)%text = joint%doubt
    text = '! A fit by snapin of several curves together, SI units: the shared parameters. ' // &
      'sweep.csv has those of each curve.' // nl // '&fit' // nl // &
      assignment_of('title', title) // of_fitted(joint%unknown, joint%fitted) // &
      numbers('curves', [real(joint%curves, wp)]) // &
      numbers('chi_squared_alone', [joint%alone]) // &
      numbers('degrees_of_freedom_alone', [real(joint%fitted%freedom - joint%spared, wp)]) // &
      assignment_of('warnings', doubts) // '/' // nl
  end function joint_text

  !> Writes fit.nml, and tells in the summary how well the fit describes the curves, and the shared
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
    ! Results that could not be written ended the fits.
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

end module joint_rows
