!> Progress of a run on standard error. On a terminal there is one line that changes, otherwise a
!> new line from time to time. A line shows the elapsed time and, if steps are counted, the
!> estimated remaining time. A separate thread writes it (`heartbeat.c`), so that the line also
!> changes during long steps.
module progress
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_long, c_ptr, c_null_ptr, &
    c_associated, nul => c_null_char
  use kinds, only: wp
  use text, only: printable
  use files, only: is_terminal
  implicit none
  private
  public :: progress_t, duration

  !> The progress of a run, which shows nothing until it is started. All text is plain ASCII. It
  !> must not be copied after the start.
  type :: progress_t
    private
    type(c_ptr) :: heartbeat = c_null_ptr
  contains
    procedure :: start
    procedure :: step
    procedure :: note
    procedure :: detail
    procedure :: finish
  end type progress_t

  interface
    !> Starts a thread that writes lines beginning with a name; null if no thread can be started.
    type(c_ptr) function begin_progress(name, total, live) bind(c, name='snapin_begin_progress')
      import :: c_char, c_int, c_long, c_ptr
      character(kind=c_char), intent(in) :: name(*)
      integer(c_long), value :: total
      integer(c_int), value :: live
    end function begin_progress

    !> Sets the label of the present work. counted: number of steps to count. given: 1 if an earlier
    !> run completed them, -1 for a part of a step. failed: number of failed steps.
    subroutine show_progress(heartbeat, label, counted, given, failed) &
        bind(c, name='snapin_progress')
      import :: c_char, c_int, c_ptr
      type(c_ptr), value :: heartbeat
      character(kind=c_char), intent(in) :: label(*)
      integer(c_int), value :: counted, given, failed
    end subroutine show_progress

    !> Ends the output: the line on a terminal disappears; elsewhere a last line is written.
    subroutine end_progress(heartbeat) bind(c, name='snapin_end_progress')
      import :: c_ptr
      type(c_ptr), value :: heartbeat
    end subroutine end_progress

    subroutine tell_duration(seconds, text, size) bind(c, name='snapin_duration')
      import :: c_char, c_double, c_int
      real(c_double), value :: seconds
      character(kind=c_char), intent(out) :: text(*)
      integer(c_int), value :: size
    end subroutine tell_duration
  end interface

contains

  !> Starts the output. total: the number of steps, 0 if it is not known. name: the beginning of
  !> every line, such as the name of the deck. quiet: nothing is written.
  subroutine start(self, total, name, quiet)
    class(progress_t), intent(inout) :: self
    integer, intent(in) :: total
    character(len=*), intent(in) :: name
    logical, intent(in) :: quiet

    if (.not. quiet) self%heartbeat = begin_progress(printable(name) // nul, &
      int(max(total, 0), c_long), merge(1_c_int, 0_c_int, is_terminal()))
  end subroutine start

  !> Counts one step of `label` (a branch). failed: the step failed. given: an earlier run completed
  !> the step, so that it does not enter the estimate of time.
  subroutine step(self, label, failed, given)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label
    logical, intent(in), optional :: failed, given
    integer(c_int) :: of_failed, of_given

    of_failed = 0
    if (present(failed)) of_failed = merge(1, 0, failed)
    of_given = 0
    if (present(given)) of_given = merge(1, 0, given)
    if (c_associated(self%heartbeat)) &
      call show_progress(self%heartbeat, trim(label) // nul, 1, of_given, of_failed)
  end subroutine step

  !> Shows a label without counting a step.
  subroutine note(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label

    if (c_associated(self%heartbeat)) call show_progress(self%heartbeat, label // nul, 0, 0, 0)
  end subroutine note

  !> Shows the label of a part of a step. Several threads may call this procedure at the same time.
  subroutine detail(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label
    character(len=len(label) + 1) :: ended

    if (.not. c_associated(self%heartbeat)) return
    ended = trim(label) // nul
    call show_progress(self%heartbeat, ended, 0, -1, 0)
  end subroutine detail

  !> Removes the progress line and ends its thread.
  subroutine finish(self)
    class(progress_t), intent(inout) :: self

    if (c_associated(self%heartbeat)) call end_progress(self%heartbeat)
    self%heartbeat = c_null_ptr
  end subroutine finish

  !> A time [s] as text with about two digits and a unit.
  function duration(time) result(text)
    real(wp), intent(in) :: time
    character(len=:), allocatable :: text
    character(kind=c_char, len=32) :: buffer

    call tell_duration(real(time, c_double), buffer, len(buffer))
    text = buffer(:index(buffer, nul) - 1)
  end function duration

end module progress
