!> The main program: command line, decks, exit status. The status is 0 after success, 1 if a
!> calculation failed, 2 if the deck or the command line is wrong.
program snapin
  use, intrinsic :: iso_c_binding, only: c_int
  use failure, only: failure_t, fail, bad_input
  use text, only: lower, quoted, clip, counted, guess
  use deck_source, only: largest_deck
  use deck_keys, only: key_spec, keys_text, is_of, names_of
  use scene, only: scene_t, keys_of_scene, read_scene
  use c_library, only: c_prepare, c_end_with_parent
  use files, only: read_standard_input, write_stdout, write_stderr
  use result_folder, only: to_stream
  use machine, only: begin_with_one_thread
  use result_tables, only: result_listing
  use command_line, only: options_t, read_command_line, stem_of, help_text, usage
  use launch, only: own_rank
  use simulation, only: run_scene
  use price, only: price_scene
  use sweeps, only: work_on_sweeps
  use dispatch, only: dismiss
  use ranks, only: crew_t
  use case_columns, only: left_out
  use preflight, only: check_room, check_inputs, large_results
  use forecast, only: advice_t, advice_on
  use scene_problem, only: problem_of
  use build_info, only: version, compiler, blas, options_of_build => options
  implicit none

  interface
    ! `stop` would print its code and any floating-point flags; exit of the C library prints
    ! nothing.
    subroutine c_exit(status) bind(c, name='exit')
      import :: c_int
      implicit none
      integer(c_int), value :: status
    end subroutine c_exit
  end interface

  character(len=1), parameter :: nl = new_line('a')
  type(options_t) :: options
  type(crew_t) :: crew
  type(failure_t), allocatable :: error

  call c_prepare()
  call begin_with_one_thread()
  call read_command_line(options, error)
  if (allocated(error)) then
    call write_stderr('snapin: ' // error%message)
    call write_stderr('usage: ' // usage)
    call write_stderr('try "snapin --help"')
    call leave(2)
  end if
  ! If there are several processes, only the first one answers.
  if (options%informs() .or. options%price) then
    if (own_rank() > 0) call leave(0)
  end if
  if (options%help) then
    call leave(status_of(help_text()))
  else if (options%version) then
    call leave(status_of('snapin ' // version // nl // 'compiler: ' // compiler // nl // &
      'blas: ' // blas // nl // 'options: ' // options_of_build // nl))
  else if (options%keys) then
    call leave(show_keys())
  else if (options%results) then
    call leave(status_of(result_listing()))
  else
    call leave(run_decks())
  end if

contains

  !> Prints the keys of the named groups, the named keys, or all keys; returns the exit status.
  integer function show_keys() result(status)
    type(key_spec), allocatable :: specs(:)
    character(len=:), allocatable :: name
    logical, allocatable :: shown(:)
    integer :: i

    status = 0
    specs = keys_of_scene()
    allocate (shown(size(specs)), source=size(options%decks) == 0)
    do i = 1, size(options%decks)
      name = lower(options%decks(i)%name)
      if (.not. any(is_of(specs, name))) then
        call write_stderr('snapin: no group or key ' // quoted(clip(name)) // &
          guess(name, names_of(specs, ''), ''))
        status = 2
      end if
      shown = shown .or. is_of(specs, name)
    end do
    if (status == 0) status = status_of(keys_text(pack(specs, shown)))
  end function show_keys

  !> Validates all decks, then computes them one by one; returns the exit status. All decks are read
  !> before anything is written, so that a wrong deck leaves no results behind.
  integer function run_decks() result(status)
    type(scene_t), allocatable :: scenes(:)
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: folder, said
    logical :: converged
    integer :: first, written, i

    status = 0
    written = 0
    call crew%begin(trouble)
    if (.not. allocated(trouble) .and. crew%workers > 0 .and. &
      any([(options%decks(i)%name == '-', i=1, size(options%decks))])) &
      call fail(trouble, bad_input, 'several processes cannot read one standard input; give files')
    if (allocated(trouble)) then
      if (crew%rank == 0) call write_stderr('snapin: ' // trouble%message)
      status = 2
      return
    end if
    if (options%out == to_stream) call c_end_with_parent()
    allocate (scenes(size(options%decks)))
    do i = 1, size(scenes)
      if (options%decks(i)%name == '-') then
        options%decks(i)%name = options%name
        call read_scene(options%name, scenes(i), trouble, &
          read_standard_input(largest_deck + 1))
      else
        call read_scene(options%decks(i)%name, scenes(i), trouble)
      end if
      if (.not. allocated(trouble) .and. .not. options%price) &
        call check_inputs(scenes(i), options%decks(i)%name, folder_of(i), trouble)
      if (allocated(trouble)) then
        status = 2
        if (crew%rank == 0) call write_stderr(trouble%message)
        said = trouble%message
      else if (options%check .and. crew%rank == 0) then
        written = max(written, status_of(options%decks(i)%name // ': ok' // nl))
        call print_notes(scenes(i), options%decks(i)%name, folder_of(i))
      end if
    end do
    ! If one process cannot read a deck, all processes stop.
    first = crew%first_of(status /= 0)
    if (first > 0 .and. first == crew%rank) call write_stderr(said)
    if (first >= 0) status = 2
    if (status == 0) status = written
    if (options%check .or. status /= 0) return
    if (crew%rank > 0) then
      call work_on_sweeps(crew, scenes)
      return
    end if
    do i = 1, size(scenes)
      if (options%price) then
        call price_scene(scenes(i), options%decks(i)%name, options%quiet, converged, trouble)
        if (allocated(trouble)) call write_stderr(options%decks(i)%name // ': ' // &
          trouble%message)
        if (allocated(trouble)) then
          status = max(status, merge(2, 1, trouble%kind == bad_input))
        else if (.not. converged) then
          status = max(status, 1)
        end if
        cycle
      end if
      folder = folder_of(i)
      call run_scene(scenes(i), folder, options%out == to_stream, options%quiet, &
        options%verbose, options%resume, crew, i, converged, trouble)
      if (allocated(trouble)) call write_stderr(folder // ': ' // trouble%message)
      if (allocated(trouble) .or. .not. converged) status = 1
    end do
    call dismiss(crew)
  end function run_decks

  !> Prints the notes of `--check` on a valid deck: how its curve is understood, what its results
  !> need and leave out, and which choices will fail or take long.
  subroutine print_notes(scene, name, folder)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name, folder
    type(advice_t), allocatable :: advice(:)
    type(failure_t), allocatable :: trouble
    integer :: i

    if (allocated(scene%fit) .and. allocated(scene%sweep)) then
      call print_note(name, counted(scene%sweep%cases(), 'curve'))
    else if (allocated(scene%fit)) then
      call print_note(name, scene%measured%understood)
    end if
    call check_room(scene, folder, trouble)
    if (allocated(trouble)) call print_note(name, trouble%message)
    call print_note(name, large_results(scene))
    call print_note(name, left_out(scene))
    advice = advice_on(scene, problem_of(scene))
    do i = 1, size(advice)
      call print_note(name, 'warning: ' // advice(i)%text)
    end do
  end subroutine print_notes

  !> Prints a note on a deck, if the note is not empty.
  subroutine print_note(name, text)
    character(len=*), intent(in) :: name, text

    if (text /= '') call write_stderr('snapin: ' // name // ': ' // text)
  end subroutine print_note

  function folder_of(i) result(folder)
    integer, intent(in) :: i
    character(len=:), allocatable :: folder

    folder = options%out // '/' // stem_of(options%decks(i)%name)
    if (options%out == to_stream) folder = to_stream
    if (allocated(options%into)) folder = options%into
  end function folder_of

  !> Writes `text` to standard output; returns the exit status, which is 1 if writing fails.
  integer function status_of(text) result(status)
    character(len=*), intent(in) :: text
    type(failure_t), allocatable :: trouble

    status = 0
    call write_stdout(text, trouble)
    if (.not. allocated(trouble)) return
    call write_stderr('snapin: ' // trouble%message)
    status = 1
  end function status_of

  subroutine leave(status)
    integer, intent(in) :: status

    call crew%end()
    call c_exit(int(status, c_int))
  end subroutine leave

end program snapin
