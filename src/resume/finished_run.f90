!> Whether a folder already holds all the results of a run.
module finished_run
  use files, only: read_file
  implicit none
  private
  public :: find_finished

contains

  !> Whether the folder's summary is that of the deck `resolved` (as text) by this `version` of the
  !> program; the summary is the last thing that a run writes. converged: whether all of that
  !> went well.
  subroutine find_finished(folder, resolved, version, finished, converged)
    character(len=*), intent(in) :: folder, resolved, version
    logical, intent(out) :: finished, converged
    character(len=:), allocatable :: text
    integer :: start

    finished = .false.
    converged = .false.
    call read_file(folder // '/summary.nml', text)
    if (.not. allocated(text)) return
    start = len(text) - len(resolved)
    if (start < 1) return
    ! The groups of results, then the deck.
    finished = text(start + 1:) == resolved .and. &
      index(text(:start), new_line('a') // '  version = ''' // version // '''' // new_line('a')) > 0
    converged = finished .and. &
      index(text(:start), new_line('a') // '  converged = .true.' // new_line('a')) > 0
  end subroutine find_finished

end module finished_run
