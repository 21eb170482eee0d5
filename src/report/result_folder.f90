!> The folder with the results of a run. All files are first written to the folder `unfinished`
!> within it; `close` then puts the whole set in place (`publication`). Until then the results of an
!> earlier run stay unchanged. Only one run at a time can use the folder. A journal stores the
!> states found, from which another run can continue. Results may also be written to standard
!> output: while they are computed, without a folder, or when they are in place.
module result_folder
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_open, c_read, c_close, check_status, as_input, nul
  use files, only: make_folder, file_exists
  use folder_lock, only: folder_lock_t
  use publication, only: publish, check_names, clear_unfinished, result_files, journal_name, &
    unfinished
  use journal, only: journal_t
  use run_identity, only: difference_between
  use text_file, only: output_t
  implicit none
  private
  public :: result_folder_t, journal_of, to_stream

  !> The name given instead of a folder if results go to standard output; each file is written there
  !> in pieces (`text_file`).
  character(len=*), parameter :: to_stream = '-'
  integer(c_int), parameter :: standard_output = 1
  !> The name of the piece without bytes that ends a complete stream.
  character(len=*), parameter :: stream_end = 'complete'

  type :: result_folder_t
    !> The states found by this run, and those found by an interrupted run.
    type(journal_t) :: journal
    !> Prevents other runs from using the folder.
    type(folder_lock_t) :: lock
    !> The descriptor of the stream, if results are written to a stream while they are computed.
    !> Then there is no folder and no journal.
    integer(c_int), allocatable :: stream
    !> Whether results in the folder are also written to standard output.
    logical :: handed_over = .false.
    character(len=:), allocatable, private :: path
    !> For each of `result_files`, whether this run has made it.
    logical, private :: made(size(result_files)) = .false.
  contains
    procedure :: open => open_folder
    procedure :: new_file
    procedure :: check_presence
    procedure :: hand_over
    procedure :: close => close_folder
  end type result_folder_t

contains

  !> Creates and locks the folder and opens its journal; to be called once. owner: the run's
  !> identity. resume: continues the journal of an interrupted run, if there is one. After an error
  !> the caller unlocks the folder.
  subroutine open_folder(self, folder, owner, resume, error)
    class(result_folder_t), intent(inout) :: self
    character(len=*), intent(in) :: folder, owner
    logical, intent(in) :: resume
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: other
    logical :: continued

    self%path = folder
    if (len(folder) == 0) self%path = '.'
    if (folder == to_stream) then
      self%stream = standard_output
      return
    end if
    call make_folder(self%path, error)
    if (.not. allocated(error)) call self%lock%take(self%path, error)
    if (.not. allocated(error)) call check_names(self%lock, error)
    if (allocated(error)) return
    continued = resume
    if (resume) continued = file_exists(journal_of(self%path))
    if (continued) then
      call self%journal%go_on(journal_of(self%path), owner, other, error)
      if (allocated(other)) call fail(error, file_trouble, 'cannot continue: the interrupted ' // &
        'run had another ' // difference_between(other, owner))
    else
      call clear_unfinished(self%lock, error)
      if (.not. allocated(error)) call make_folder(self%path // '/' // unfinished, error)
      if (.not. allocated(error)) call self%journal%begin(journal_of(self%path), owner, error)
    end if
  end subroutine open_folder

  !> Path of the journal in a folder of results.
  pure function journal_of(folder) result(path)
    character(len=*), intent(in) :: folder
    character(len=:), allocatable :: path

    path = folder // '/' // journal_name
  end function journal_of

  !> Path of a file of this run while it is written, or the name of the file in a stream.
  function new_file(self, name) result(path)
    class(result_folder_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: path

    where (result_files == name) self%made = .true.
    path = self%path // '/' // unfinished // '/' // name
    if (allocated(self%stream)) path = name
  end function new_file

  !> Fails if a file that this run has begun is no longer in the folder.
  subroutine check_presence(self, error)
    class(result_folder_t), intent(in) :: self
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    if (allocated(self%stream)) return
    if (.not. self%lock%contains_file(journal_name)) call complain(journal_name)
    do i = 1, size(result_files)
      if (allocated(error)) return
      if (.not. self%made(i)) cycle
      if (.not. self%lock%contains_file(unfinished // '/' // trim(result_files(i)))) &
        call complain(unfinished // '/' // trim(result_files(i)))
    end do

  contains

    subroutine complain(name)
      character(len=*), intent(in) :: name

      call fail(error, file_trouble, self%path // '/' // name // ' was removed or moved ' // &
        'away during the run; make sure that no other program does this')
    end subroutine complain

  end subroutine check_presence

  !> Writes the results in the locked folder to standard output: each file, then the end of the
  !> stream.
  subroutine hand_over(self, error)
    class(result_folder_t), intent(in) :: self
    type(failure_t), allocatable, intent(inout) :: error
    character(len=65536) :: piece
    character(len=:), allocatable :: path
    integer(c_int) :: file, closed
    integer(c_long) :: length
    integer :: i

    do i = 1, size(result_files)
      if (.not. self%lock%contains_file(trim(result_files(i)))) cycle
      path = self%lock%path_of(trim(result_files(i)))
      file = c_open(path // nul, as_input)
      call check_status('cannot read ' // path, file, error)
      do while (.not. allocated(error))
        length = c_read(file, piece, len(piece, kind=c_long))
        call check_status('cannot read ' // path, int(min(length, 0_c_long), c_int), error)
        if (.not. allocated(error) .and. length > 0) &
          call send(trim(result_files(i)), piece(:length), error)
        if (length < len(piece)) exit
      end do
      if (file >= 0) closed = c_close(file)
      if (allocated(error)) return
    end do
    call send(stream_end, '', error)
  end subroutine hand_over

  !> Writes one piece to standard output.
  subroutine send(name, text, error)
    character(len=*), intent(in) :: name, text
    type(failure_t), allocatable, intent(inout) :: error
    type(output_t) :: file

    call file%open(name, error, standard_output)
    if (.not. allocated(error)) call file%piece(text, error)
  end subroutine send

  !> Puts the files of this run in place, then removes the journal and the files of an earlier run.
  !> After an error nothing is moved, and the unfinished files and the journal stay. In any case the
  !> folder is unlocked.
  subroutine close_folder(self, error)
    class(result_folder_t), intent(inout) :: self
    type(failure_t), allocatable, intent(inout) :: error

    if (allocated(self%stream)) then
      if (.not. allocated(error)) call send(stream_end, '', error)
    else if (any(self%made)) then
      if (.not. allocated(error)) call self%check_presence(error)
      if (.not. allocated(error)) call publish(self%lock, self%made, error)
      if (self%handed_over .and. .not. allocated(error)) call self%hand_over(error)
    end if
    if (allocated(error)) then
      call self%journal%close()
    else
      call self%journal%drop()
    end if
    call self%lock%release()
  end subroutine close_folder

end module result_folder
