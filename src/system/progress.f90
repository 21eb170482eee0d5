!> How far a run is, on standard error: a live line on a terminal, a line now and then elsewhere,
!> with the time that it has taken so far and, where steps are counted, what they leave to expect.
!> A thread shows it (`heartbeat.c`), so that the line moves however long a step takes.
module progress
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_long, c_ptr, c_null_ptr, &
    c_associated, nul => c_null_char
  use kinds, only: wp
  use files, only: is_terminal
  implicit none
  private
  public :: progress_t, duration

  !> Does nothing until started. All text is plain ASCII. Not to be copied once it is.
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
    !> Begins to show lines that begin with a name; null where there can be no thread.
    type(c_ptr) function begin_progress(name, total, live) bind(c, name='snapin_begin_progress')
      import :: c_char, c_int, c_long, c_ptr
      character(kind=c_char), intent(in) :: name(*)
      integer(c_long), value :: total
      integer(c_int), value :: live
    end function begin_progress

    !> What is being done; counted: as how many steps; given: 1 where they took no time, -1 where
    !> this is part of a step; failed: how many of the steps.
    subroutine show_progress(heartbeat, label, counted, given, failed) &
        bind(c, name='snapin_progress')
      import :: c_char, c_int, c_ptr
      type(c_ptr), value :: heartbeat
      character(kind=c_char), intent(in) :: label(*)
      integer(c_int), value :: counted, given, failed
    end subroutine show_progress

    !> Ends: the live line disappears; elsewhere a last line follows if there was one before.
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

  !> Begins. `total` is the number of steps to come, 0 where nobody knows; `name`, the deck's stem
  !> for instance, begins every line; quiet: nothing is ever printed.
  subroutine start(self, total, name, quiet)
    class(progress_t), intent(inout) :: self
    integer, intent(in) :: total
    character(len=*), intent(in) :: name
    logical, intent(in) :: quiet

    call self%finish()
    if (.not. quiet) self%heartbeat = begin_progress(name // nul, int(max(total, 0), c_long), &
      merge(1_c_int, 0_c_int, is_terminal()))
  end subroutine start

  !> Counts one step, of what `label` names (a branch). failed: it did; given: an earlier run has
  !> done it, and the estimate of the time begins after it.
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

  !> Says what is being done without counting it.
  subroutine note(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label

    if (c_associated(self%heartbeat)) call show_progress(self%heartbeat, label // nul, 0, 0, 0)
  end subroutine note

  !> The same of a part of a step, whose time belongs to the step. Threads may call it at once.
  subroutine detail(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label
    character(len=len(label) + 1) :: ended

    if (.not. c_associated(self%heartbeat)) return
    ended = trim(label) // nul
    call show_progress(self%heartbeat, ended, 0, -1, 0)
  end subroutine detail

  subroutine finish(self)
    class(progress_t), intent(inout) :: self

    if (c_associated(self%heartbeat)) call end_progress(self%heartbeat)
    self%heartbeat = c_null_ptr
  end subroutine finish

  !> A time [s] as people say it, to about two digits.
  function duration(time) result(text)
    real(wp), intent(in) :: time
    character(len=:), allocatable :: text
    character(kind=c_char, len=32) :: buffer

    call tell_duration(real(time, c_double), buffer, len(buffer))
    text = buffer(:index(buffer, nul) - 1)
  end function duration

end module progress
