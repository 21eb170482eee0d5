!> The messages of a run on standard error. Each line begins with the folder of the results.
module run_messages
  use kinds, only: wp, nan
  use units, only: with_unit
  use text, only: counted, rounded
  use files, only: file_exists, own_path, whole_path, write_stderr
  use scene_groups, only: scene_t
  use summary, only: summary_t
  use namelist_writer, only: line_t
  use findings, only: findings_of
  use equilibrium, only: cost_t
  implicit none
  private
  public :: destination_t, tell

  !> folder: the folder of a run's results, or the program's name if they go to standard output.
  !> quiet: no messages. verbose: messages also describe the numerical methods. to_stream: results
  !> go to standard output.
  type :: destination_t
    character(len=:), allocatable :: folder
    logical :: quiet = .false., verbose = .false., to_stream = .false.
  contains
    procedure :: say
  end type destination_t

  !> The name of the plotting command, which stands beside an installed program; in a checkout,
  !> where the program is in a build folder, the path of Python and the folder of the scripts.
  character(len=*), parameter :: plotter = 'snapin-plot', python_there = '.venv/bin/python', &
    scripts = 'pywrap/plots/'

contains

  !> Writes warnings, the main results and, if wanted, the numerical methods to standard error.
  subroutine tell(scene, destination, summary, cost)
    type(scene_t), intent(in) :: scene
    type(destination_t), intent(in) :: destination
    type(summary_t), intent(in) :: summary
    type(cost_t), intent(in) :: cost
    type(line_t), allocatable :: lines(:)
    character(len=40) :: found
    character(len=12) :: seconds
    character(len=:), allocatable :: command
    real(wp) :: took
    integer :: i

    do i = 1, size(summary%warnings)
      call destination%say('warning: '//summary%warnings(i)%text)
    end do
    do i = 1, size(summary%notes)
      call destination%say('note: '//summary%notes(i)%text)
    end do
    if (destination%verbose .and. summary%has('grid')) call destination%say('grid '// &
      summary%text('grid')//', method '//summary%text('method')//': '// &
      summary%text('chosen_because'))
    if (destination%verbose .and. summary%has('path_traced_h0')) call destination%say( &
      'the path begins at h0 = '//in_metres('path_traced_h0'))
    if (destination%verbose .and. summary%has('path_undeformed_h0')) call destination%say( &
      'before it, from h0 = '//in_metres('path_undeformed_h0')//', bodies are taken as rigid')
    ! The path of a fit belongs to the deck's own values, and its results are not reported.
    allocate (lines(0))
    if (.not. allocated(scene%fit)) lines = findings_of(summary)
    do i = 1, size(lines)
      call destination%say(lines(i)%text)
    end do
    if (summary%has('regime_reason')) &
      call destination%say('regime: '//summary%text('regime_reason'))
    took = summary%number('wall_seconds')
    write (seconds, merge('(f5.3)', '(f0.2)', took < 1)) took
    found = 'done'
    if (cost%states > 0) write (found, '(i0, a)') cost%states, &
      merge(' state ', ' states', cost%states == 1)
    call destination%say(trim(found)//' in '//trim(seconds)//' s')
    if (allocated(scene%sweep)) then
      command = ''
      if (.not. destination%to_stream) then
        command = 'map.py'
        if (scene%sweep%costs) command = 'accuracy.py'
        if (allocated(scene%fit)) command = 'curve_map.py'
        command = drawing_of(destination%folder, command)
        if (command /= '') command = '; to draw it: '//command
        if (scene%sweep%costs) command = ' and costs.csv'//command
        command = ': '//destination%folder//'/sweep.csv'//command
      end if
      call destination%say(counted(scene%sweep%cases(), 'case')//', '// &
        rounded(scene%sweep%cases()/max(took, epsilon(took)))//' a second'//command)
    end if

  contains

    function in_metres(key) result(text)
      character(len=*), intent(in) :: key
      character(len=:), allocatable :: text

      text = with_unit(summary%number(key), nan, 'm')
    end function in_metres

  end subroutine tell

  !> Writes a line to standard error.
  subroutine say(self, text)
    class(destination_t), intent(in) :: self
    character(len=*), intent(in) :: text

    if (.not. self%quiet) call write_stderr(self%folder//': '//text)
  end subroutine say

  !> The command that draws the sweep in a folder of results; empty if no plotting command is found.
  function drawing_of(folder, script) result(command)
    character(len=*), intent(in) :: folder, script
    character(len=:), allocatable :: command, program, beside, top, python

    command = ''
    program = trim(own_path())
    beside = program(:index(program, '/', back=.true.))
    if (beside /= '' .and. file_exists(beside // plotter)) then
      command = shell_word(beside // plotter) // ' ' // shell_word(folder)
      return
    end if
    top = beside(:index(beside(:len(beside) - 1), '/', back=.true.))
    if (.not. file_exists(top // scripts // script)) return
    python = top // python_there
    if (.not. file_exists(python)) python = 'python3'
    if (top == whole_path('')) top = ''
    if (top == '' .and. python /= 'python3') python = python_there
    command = shell_word(python) // ' ' // shell_word(top // scripts // script) // ' ' // &
      shell_word(folder)
  end function drawing_of

  !> A text as one word of a shell command, in quotes if a character may have a special meaning.
  pure function shell_word(text) result(word)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: word
    character(len=*), parameter :: plain = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ' &
      // '0123456789/._-+=:,@%'
    integer :: i

    word = text
    if (verify(text, plain) == 0) return
    word = "'"
    do i = 1, len(text)
      if (text(i:i) == "'") then
        word = word // "'\''"
      else
        word = word // text(i:i)
      end if
    end do
    word = word // "'"
  end function shell_word

end module run_messages
