!> The command line that draws a sweep.
module map_command
  use files, only: file_exists, own_path, whole_path
  implicit none
  private
  public :: drawing_of

  !> Python and the script: in a checkout, with the program in a build folder, and in an
  !> installation.
  character(len=*), parameter :: pythons(2) = [character(len=16) :: '.venv/bin/python', &
    'bin/python3']
  character(len=*), parameter :: scripts(2) = [character(len=25) :: 'pywrap/plots/map.py', &
    'share/snapin/plots/map.py']

contains

  !> The command that draws the sweep in a folder of results; empty if there is no script.
  function drawing_of(folder) result(command)
    character(len=*), intent(in) :: folder
    character(len=:), allocatable :: command, program, top, python
    integer :: i

    command = ''
    program = trim(own_path())
    top = program(:index(program, '/', back=.true.) - 1)
    top = top(:index(top, '/', back=.true.))
    do i = 1, size(scripts)
      if (.not. file_exists(top // trim(scripts(i)))) cycle
      python = top // trim(pythons(i))
      if (.not. file_exists(python)) python = 'python3'
      if (top == whole_path('')) top = ''
      if (top == '' .and. python /= 'python3') python = trim(pythons(i))
      command = python // ' ' // top // trim(scripts(i)) // ' ' // folder
      return
    end do
  end function drawing_of

end module map_command
