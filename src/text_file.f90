!> Text files that lose nothing in silence.
!>
!> They are written with C's streams because gfortran's units do: on a full disk `flush` and `close`
!> return iostat = 0 (seen with gfortran 12).
module text_file
  use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_null_char, c_null_ptr, c_ptr, &
    c_size_t
  use failure, only: failure_t
  use c_library, only: c_fopen, c_fwrite, c_fflush, c_fclose, errno, system_failure
  implicit none
  private
  public :: output_t, partial, plain

  !> Follows the name of a file that is not complete yet.
  character(len=*), parameter :: partial = '.partial'

  !> A text file that is being written. What does not reach the disk becomes an error in `flush` or
  !> `close` at the latest. The first error closes the file; from then on its procedures do nothing.
  !> Not to be copied while it is open.
  type :: output_t
    private
    type(c_ptr) :: stream = c_null_ptr
    character(len=:), allocatable :: path
  contains
    procedure :: open => open_output
    procedure :: is_open
    procedure :: put
    procedure :: line
    procedure :: flush => flush_output
    procedure :: close => close_output
    procedure, private :: give_up
  end type output_t

contains

  !> Creates the file `path`, or empties it, and opens it.
  subroutine open_output(self, path, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(failure_t), allocatable, intent(out) :: error

    call self%close(error)
    if (allocated(error)) return
    self%path = path
    self%stream = c_fopen(path // c_null_char, 'w' // c_null_char)
    if (.not. self%is_open()) call system_failure('cannot write ' // path, errno(), error)
  end subroutine open_output

  !> Whether the file is open.
  pure logical function is_open(self)
    class(output_t), intent(in) :: self

    is_open = c_associated(self%stream)
  end function is_open

  !> Writes `text` as it is.
  subroutine put(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error

    if (.not. self%is_open()) return
    if (c_fwrite(text, 1_c_size_t, int(len(text), c_size_t), self%stream) /= len(text)) &
      call self%give_up(errno(), error)
  end subroutine put

  !> Writes `text` and ends the line.
  subroutine line(self, text, error)
    class(output_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    type(failure_t), allocatable, intent(out) :: error

    call self%put(text // new_line('a'), error)
  end subroutine line

  !> Hands what was written to the system, so that it survives this process.
  subroutine flush_output(self, error)
    class(output_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error

    if (.not. self%is_open()) return
    if (c_fflush(self%stream) /= 0) call self%give_up(errno(), error)
  end subroutine flush_output

  !> Closes the file; nothing is done where none is open.
  subroutine close_output(self, error)
    class(output_t), intent(inout) :: self
    type(failure_t), allocatable, intent(out) :: error
    type(c_ptr) :: stream

    if (.not. self%is_open()) return
    ! The stream is gone even where closing it fails.
    stream = self%stream
    self%stream = c_null_ptr
    if (c_fclose(stream) /= 0) call system_failure('cannot write ' // self%path, errno(), error)
  end subroutine close_output

  !> Reports that writing failed and closes the file.
  subroutine give_up(self, code, error)
    class(output_t), intent(inout) :: self
    integer(c_int), intent(in) :: code
    type(failure_t), allocatable, intent(inout) :: error
    integer(c_int) :: status

    call system_failure('cannot write ' // self%path, code, error)
    status = c_fclose(self%stream)
    self%stream = c_null_ptr
  end subroutine give_up

  !> `text` as one line of plain ASCII: white space becomes a blank, anything else a question mark.
  pure function plain(text) result(clean)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: clean
    character(len=len(text)) :: buffer
    integer :: i, n, code

    n = 0
    do i = 1, len(text)
      code = ichar(text(i:i))
      if (code < 0) code = code + 256
      ! The further bytes of a UTF-8 character.
      if (code >= 128 .and. code < 192) cycle
      n = n + 1
      buffer(n:n) = text(i:i)
      if (code < 32) buffer(n:n) = ' '
      if (code > 126) buffer(n:n) = '?'
    end do
    clean = buffer(:n)
  end function plain

end module text_file
