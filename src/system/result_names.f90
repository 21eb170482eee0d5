!> Names of the files in a folder of results.
module result_names
  use folder_lock, only: folder_lock_t
  use text_file, only: partial
  implicit none
  private
  public :: result_files, summary_name, journal_name, intent_name, holds_results

  character(len=*), parameter :: summary_name = 'summary.nml'
  !> The files of a folder of results, the summary last.
  character(len=*), parameter :: result_files(*) = [character(len=21) :: 'curve.csv', &
    'profiles.csv', 'approximations.csv', 'classical.csv', 'device.csv', &
    'device_jumps.csv', 'fixed_load.csv', 'table.csv', 'sensitivity.csv', &
    'curve_sensitivity.csv', 'fit.csv', 'fit.nml', 'sweep.csv', summary_name]
  character(len=*), parameter :: journal_name = 'journal' // partial
  !> While a file of this name is there, the others may not belong together.
  character(len=*), parameter :: intent_name = 'INCOMPLETE.txt'

contains

  !> Whether any file in `folder` has the name of a result.
  logical function holds_results(folder)
    type(folder_lock_t), intent(in) :: folder
    integer :: i

    holds_results = .true.
    do i = 1, size(result_files)
      if (folder%contains_file(trim(result_files(i)))) return
    end do
    holds_results = .false.
  end function holds_results

end module result_names
