!> Text files. Errors in writing them are reported.
!>
!> System calls write the files, because Fortran's units do not report a full disk: compiler note 6.
module text_file
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp
  use clock, only: seconds
  use text, only: brief
  use failure, only: failure_t
  use c_library, only: c_open, c_write, c_sync, c_close, check_status, as_output, nul
  implicit none
  private
  public :: output_t, plain

  !> Longest time [s] after which written text becomes visible in the file.
  real(wp), parameter :: show_interval = 0.1_wp

  !> A text file that is being written. An error in writing is reported by `flush` or `close` at the
  !> latest. The first error closes the file; its procedures then do nothing. It must not be copied
  !> while it is open.
  type :: output_t
    private
    integer(c_int) :: descriptor = -1
    !> Whether the file is part of a stream of several files, in which a line with the file's name
    !> and the number of bytes precedes each piece.
    logical :: streamed = .false.
    character(len=:), allocatable :: path
    !> The text still to be written is buffer(:held).
    character(len=8192) :: buffer
    integer :: held = 0
    !> Time of the last writing [s].
    real(wp) :: handed = 0
  contains
    procedure :: open => open_output
    procedure :: is_open
    procedure :: put
    procedure :: line
    procedure :: piece
    procedure :: flush => flush_output
    procedure :: show
    procedure :: close => close_output
    procedure, private :: hand_over
  end type output_t

contains

  !> Creates or empties the file `path` and opens it. It fails if `path` is not a regular file but a
  !> link or a pipe. stream: the descriptor of a stream that the file becomes part of.
  subroutine open_output(self, path, error, stream)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int), intent(in), optional :: stream

    call self%close(error)
    if (allocated(error)) return
    self%path = path
    self%held = 0
    self%streamed = present(stream)
    if (present(stream)) then
      self%descriptor = stream
      return
    end if
    self%descriptor = c_open(path // nul, as_output)
    call check_status('cannot write ' // path, self%descriptor, error)
  end subroutine open_output

  !> Whether the file is open.
  pure logical function is_open(self)
    class(output_t), intent(in) :: self

    is_open = self%descriptor >= 0
  end function is_open

  !> Appends `text`.
  subroutine put(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error

    if (.not. self%is_open()) return
    if (self%held + len(text) > len(self%buffer)) call self%flush(error)
    if (allocated(error)) return
    if (len(text) > len(self%buffer)) then
      call self%hand_over(text, error)
    else
      self%buffer(self%held + 1:self%held + len(text)) = text
      self%held = self%held + len(text)
    end if
  end subroutine put

  !> Appends `text` and ends the line.
  subroutine line(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error

    call self%put(text // new_line('a'), error)
  end subroutine line

  !> Writes `text` as one piece of a stream, even if it is empty, and ends the file.
  subroutine piece(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(inout) :: error

    call self%hand_over(text, error)
    self%descriptor = -1
  end subroutine piece

  !> Writes the text collected so far, so that it is kept if this process ends.
  subroutine flush_output(self, error)
    class(output_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error
    integer :: held

    if (.not. self%is_open()) return
    held = self%held
    if (held == 0) return
    self%held = 0
    self%handed = seconds()
    call self%hand_over(self%buffer(:held), error)
  end subroutine flush_output

  !> Writes the collected text for users who watch the file, at most once per `show_interval`.
  subroutine show(self, error)
    class(output_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error

    if (self%streamed) return
    if (seconds() - self%handed > show_interval) call self%flush(error)
  end subroutine show

  !> Waits until the file has been written to the disk and closes it, if it is open.
  subroutine close_output(self, error)
    class(output_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error
    integer(c_int) :: synced, closed

    call self%flush(error)
    if (.not. self%is_open()) return
    if (self%streamed) then
      self%descriptor = -1
      return
    end if
    synced = c_sync(self%descriptor)
    closed = c_close(self%descriptor)
    self%descriptor = -1
    if (synced == 0) synced = closed
    call check_status('cannot write ' // self%path, synced, error)
  end subroutine close_output

  !> Writes `text`. A failure closes the file.
  subroutine hand_over(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(inout) :: error
    integer(c_int) :: status

    status = 0
    if (self%streamed) then
      associate (line => self%path // ' ' // brief(len(text)) // new_line('a'))
        status = c_write(self%descriptor, line, int(len(line), c_long))
      end associate
    end if
    if (status == 0) status = c_write(self%descriptor, text, int(len(text), c_long))
    if (status == 0) return
    call check_status('cannot write ' // self%path, status, error)
    if (.not. self%streamed) status = c_close(self%descriptor)
    self%descriptor = -1
  end subroutine hand_over

  !> `text` as one line of plain ASCII. White space is replaced by blanks, other characters by
  !> question marks.
  pure function plain(text) result(clean)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: clean
    character(len=len(text)) :: buffer
    integer :: i, n, code

    n = 0
    do i = 1, len(text)
      code = ichar(text(i:i))
      if (code < 0) code = code + 256
      ! Skip the continuation bytes of a UTF-8 character.
      if (code >= 128 .and. code < 192) cycle
      n = n + 1
      buffer(n:n) = text(i:i)
      if (code < 32) buffer(n:n) = ' '
      if (code > 126) buffer(n:n) = '?'
    end do
    clean = buffer(:n)
  end function plain

end module text_file
