!> The command line: options, decks, help.
module command_line
  use failure, only: failure_t, fail, bad_input
  use files, only: with_slashes
  use text, only: guess, printable
  implicit none
  private
  public :: options_t, file_t, read_command_line, stem_of, help_text, usage

  !> One file name.
  type :: file_t
    character(len=:), allocatable :: name
  end type file_t

  !> The content of the command line: options and decks.
  type :: options_t
    !> out: the folder in which each deck gets a folder of its own, or '-' for standard output.
    !> into: the folder for the results of a single deck; if `out` is '-', these are also written to
    !> standard output.
    character(len=:), allocatable :: out, into
    !> The name that the deck on standard input has in messages and results.
    character(len=:), allocatable :: name
    logical :: check = .false., price = .false., resume = .false., quiet = .false., &
      verbose = .false.
    logical :: keys = .false., results = .false., version = .false., help = .false.
    type(file_t), allocatable :: decks(:)
  contains
    procedure :: informs
  end type options_t

  character(len=*), parameter :: usage = &
    'snapin [--out DIR | --into DIR] [--name NAME] [--check] [--price] [--resume] ' // &
    '[--quiet | --verbose] [--keys] [--results] [--version] [--help] DECK [DECK ...]'
  character(len=*), parameter :: known = &
    '--out --into --name --check --price --resume --quiet --verbose --keys --results ' // &
    '--version --help'

contains

  !> Reads the arguments of this run. It fails on unknown options, if a deck is missing, and if two
  !> decks would have the same folder of results.
  subroutine read_command_line(options, error)
    type(options_t), intent(out) :: options
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: argument, value
    type(file_t) :: file
    logical :: only_decks
    integer :: i, sign

    allocate (options%decks(0))
    only_decks = .false.
    i = 0
    do while (i < command_argument_count())
      i = i + 1
      argument = argument_at(i)
      if (only_decks .or. index(argument, '-') /= 1 .or. argument == '-') then
        ! Not by a structure constructor: compiler note 1.
        file = file_t(argument)
        options%decks = [options%decks, file]
        cycle
      end if
      sign = index(argument, '=')
      if (any(argument(:sign) == ['--out= ', '--into=', '--name='])) then
        value = argument(sign + 1:)
        argument = argument(:sign - 1)
      end if
      select case (argument)
      case ('--')
        only_decks = .true.
      case ('--check')
        options%check = .true.
      case ('--price')
        options%price = .true.
      case ('--resume')
        options%resume = .true.
      case ('--quiet', '-q')
        options%quiet = .true.
      case ('--verbose', '-v')
        options%verbose = .true.
      case ('--keys')
        options%keys = .true.
      case ('--results')
        options%results = .true.
      case ('--version')
        options%version = .true.
      case ('--help', '-h')
        options%help = .true.
      case ('--out', '-o')
        call take_value(options%out)
      case ('--into')
        call take_value(options%into)
      case ('--name')
        call take_value(options%name)
      case default
        call fail(error, bad_input, 'unknown option "' // printable(argument) // '"' // &
                  guess(argument, known, ''))
      end select
      if (allocated(error)) return
    end do
    if (options%informs()) return
    if (size(options%decks) == 0) then
      call fail(error, bad_input, 'no deck; name at least one file')
    else if (given(options%into, '-')) then
      call fail(error, bad_input, '--into needs a folder; --out - writes to standard output')
    else if (allocated(options%out) .and. allocated(options%into) .and. &
      .not. given(options%out, '-')) then
      call fail(error, bad_input, 'give --out or --into, not both')
    else if (options%price .and. (options%check .or. options%resume .or. &
      allocated(options%out) .or. allocated(options%into))) then
      call fail(error, bad_input, '--price prints a table and writes no results; give it ' // &
        'without --check, --resume, --out and --into')
    else if (allocated(options%name) .and. &
      all([(options%decks(i)%name /= '-', i=1, size(options%decks))])) then
      call fail(error, bad_input, '--name is for a deck on standard input, -')
    else if (allocated(options%name)) then
      ! The folder would be the one of all results, or one above it.
      if (verify(stem_of(options%name), '.') == 0) call fail(error, bad_input, &
        '--name needs a name for a folder, not "' // printable(options%name) // '"')
    end if
    if (allocated(error)) return
    if (.not. allocated(options%out)) options%out = 'results'
    if (.not. allocated(options%name)) options%name = 'deck'
    if (size(options%decks) > 1 .and. (allocated(options%into) .or. options%out == '-')) then
      call fail(error, bad_input, 'the results of several decks cannot go to one place; give ' // &
        'one deck, or --out DIR')
    else if (.not. options%check .and. .not. options%price) then
      call check_stems(options, error)
    end if

  contains

    !> Whether an option was given with this value.
    pure logical function given(option, text)
      character(len=:), allocatable, intent(in) :: option
      character(len=*), intent(in) :: text

      given = .false.
      if (allocated(option)) given = option == text
    end function given

    !> Takes the value of an option: the text after its equals sign, or the next argument.
    subroutine take_value(taken)
      character(len=:), allocatable, intent(inout) :: taken

      if (.not. allocated(value)) then
        i = i + 1
        value = ''
        if (i <= command_argument_count()) value = argument_at(i)
      end if
      if (len_trim(value) == 0) call fail(error, bad_input, argument // ' needs a ' // &
        trim(merge('name  ', 'folder', argument == '--name')))
      call move_alloc(value, taken)
    end subroutine take_value

  end subroutine read_command_line

  !> Whether the options only ask for information about the program, so that no deck is read.
  pure logical function informs(self)
    class(options_t), intent(in) :: self

    informs = self%keys .or. self%results .or. self%version .or. self%help
  end function informs

  !> Refuses two decks whose results would be in the same folder.
  subroutine check_stems(options, error)
    type(options_t), intent(in) :: options
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i, j

    associate (decks => options%decks)
      do i = 2, size(decks)
        do j = 1, i - 1
          if (folder_of(decks(i)%name) /= folder_of(decks(j)%name)) cycle
          call fail(error, bad_input, printable(decks(j)%name) // ' and ' // &
                    printable(decks(i)%name) // ' would both write to the folder ' // &
                    printable(folder_of(decks(i)%name)) // &
                    '; rename one, or run them one by one with --out')
          return
        end do
      end do
    end associate

  contains

    pure function folder_of(name) result(folder)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: folder

      folder = stem_of(name)
      if (name == '-') folder = stem_of(options%name)
    end function folder_of

  end subroutine check_stems

  !> The file name of `path` without folders and without its last extension. A name such as `...nml`
  !> is kept whole, since without the extension it would name a folder above the results.
  pure function stem_of(path) result(stem)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: stem
    integer :: dot

    stem = path(index(path, '/', back=.true.) + 1:)
    dot = index(stem, '.', back=.true.)
    if (verify(stem(:dot), '.') > 0) stem = stem(:dot - 1)
  end function stem_of

  function argument_at(i) result(argument)
    integer, intent(in) :: i
    character(len=:), allocatable :: argument
    integer :: length

    call get_command_argument(i, length=length)
    allocate (character(len=length) :: argument)
    call get_command_argument(i, argument)
    argument = with_slashes(argument)
  end function argument_at

  !> A description of the program and its options, and an example of a deck.
  function help_text() result(text)
    character(len=:), allocatable :: text
    integer :: i
    character(len=*), parameter :: lines(*) = [character(len=90) :: &
      '', &
      'Elastic deformation and adhesion of two bodies near and in contact. Each DECK, a', &
      'namelist file or - for standard input, is computed into results/<name of the deck>/.', &
      '', &
      '  --out DIR   write to DIR/<name of the deck>/ instead (-o); to standard output if DIR', &
      '              is -: each piece of a file after a line with its name and its bytes;', &
      '              the last line is "complete 0"', &
      '  --into DIR  write the results of one deck into DIR itself; with --out - to both', &
      '  --name NAME name of the deck on standard input', &
      '  --check     validate the decks, compute nothing', &
      '  --price     the decks at five accuracies: a table of time and errors; no results', &
      '  --resume    continue an interrupted sweep; leave finished results as they are', &
      '  --quiet     no progress and no messages on the terminal (-q)', &
      '  --verbose   also tell which numerics were chosen, and why (-v)', &
      '  --keys      print all groups and keys of decks, with unit, default and meaning, or only', &
      '              those named, as GROUP or GROUP.KEY', &
      '  --results   print every file, column and entry of results: unit, meaning', &
      '  --version   print version, compiler and libraries', &
      '  --help      print this (-h)', &
      '', &
      'Exit status: 0 done; 1 a calculation failed; 2 deck or command line wrong, and nothing', &
      'written.', &
      '', &
      'A deck to start from (SI units):', &
      '', &
      '  &bodies radius = 1.5e-2, stiffness = 1.0e10 /            ! sphere radius, E/(1-nu^2)', &
      '  &force law = ''lennard_jones'', hamaker = 1.0e-19, z0 = 0.5e-9 /', &
      '  &loading h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.05e-9 /', &
      '  &unloading /                                             ! back from h0_end', &
      '  &profiles h0 = 4.3e-9, 3.6e-9 /']

    text = 'usage: ' // usage // new_line('a')
    do i = 1, size(lines)
      text = text // trim(lines(i)) // new_line('a')
    end do
  end function help_text

end module command_line
