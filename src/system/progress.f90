!> How far a run is, on standard error: a live line on a terminal, a line now and then elsewhere.
module progress
  use kinds, only: wp
  use clock, only: seconds
  use files, only: is_terminal, write_stderr
  implicit none
  private
  public :: progress_t, duration

  !> Seconds between two updates of the live line, and before the first: nobody needs one that is
  !> gone at once.
  real(wp), parameter :: live_interval = 0.2_wp
  !> Elsewhere: seconds before the first line, the factor by which intervals grow, the longest one.
  real(wp), parameter :: first_line = 5, growth = 2, longest_interval = 600
  !> Seconds of counted steps before which no time left is estimated.
  real(wp), parameter :: too_early = 1
  !> A line that wraps cannot be erased; terminals narrower than this are rare.
  integer, parameter :: widest = 79

  !> Does nothing until started. All text is plain ASCII.
  type :: progress_t
    private
    logical :: active = .false., live = .false.
    !> What every line begins with, and what the last note said.
    character(len=:), allocatable :: name, noted
    !> Steps done, and in all; 0 where that is not known.
    integer :: done = 0, total = 0
    !> Steps among those done that took no time.
    integer :: given = 0
    !> Times [s]: of the start, of the first counted step's start, of the next line, between lines.
    real(wp) :: began = 0, origin = 0, next = 0, interval = 0
    !> Characters of the live line, lines written elsewhere.
    integer :: shown = 0, lines = 0
  contains
    procedure :: start
    procedure :: step
    procedure :: skip
    procedure :: note
    procedure :: finish
    procedure, private :: show
  end type progress_t

contains

  !> Begins. `total` is the number of steps to come, 0 where nobody knows; `name`, the deck's stem
  !> for instance, begins every line; quiet: nothing is ever printed.
  subroutine start(self, total, name, quiet)
    class(progress_t), intent(inout) :: self
    integer, intent(in) :: total
    character(len=*), intent(in) :: name
    logical, intent(in) :: quiet

    call self%finish()
    self%active = .not. quiet
    self%live = is_terminal()
    self%name = name
    self%noted = ''
    self%done = 0
    self%given = 0
    self%total = max(total, 0)
    self%shown = 0
    self%lines = 0
    self%began = seconds()
    self%origin = self%began
    self%interval = merge(live_interval, first_line, self%live)
    self%next = self%began + self%interval
  end subroutine start

  !> Counts one step, of what `label` names (a branch).
  subroutine step(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label

    if (.not. self%active) return
    self%done = self%done + 1
    call self%show(label)
  end subroutine step

  !> Counts one step that an earlier run has done; the estimate of the time begins after it.
  subroutine skip(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label

    if (.not. self%active) return
    self%done = self%done + 1
    self%given = self%done
    self%origin = seconds()
    call self%show(label)
  end subroutine skip

  !> Says what is being done without counting it. What comes before the first step is left out of
  !> the estimate of the time.
  subroutine note(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label

    if (.not. self%active) return
    if (self%done == 0) self%origin = seconds()
    ! What takes long may not come back here for a while.
    if (self%live .and. self%noted /= label) self%next = self%began
    self%noted = label
    call self%show(label)
  end subroutine note

  !> Ends: the live line disappears; elsewhere a last line follows if there was one before.
  subroutine finish(self)
    class(progress_t), intent(inout) :: self

    if (self%active .and. self%shown > 0) &
      call write_stderr(achar(13) // repeat(' ', self%shown) // achar(13))
    if (self%active .and. self%lines > 0) call write_stderr(self%name // ': ended after ' // &
      duration(seconds() - self%began) // new_line('a'))
    self%active = .false.
  end subroutine finish

  !> Prints the line if it is time for one.
  subroutine show(self, label)
    class(progress_t), intent(inout) :: self
    character(len=*), intent(in) :: label
    character(len=:), allocatable :: text
    character(len=12) :: number
    real(wp) :: now
    integer :: length

    now = seconds()
    if (now < self%next) return
    text = self%name // ': ' // label
    if (self%total > 0) then
      ! All done is for `finish` to say.
      write (number, '(i0)') min(99, int(100*real(self%done, wp)/self%total))
      text = text // ', ' // trim(number) // ' %'
      if (self%done > self%given .and. self%done <= self%total .and. &
        now - self%origin >= too_early) text = text // ', ' // duration((now - self%origin)* &
        (self%total - self%done)/(self%done - self%given)) // ' left'
    else if (self%done > 0) then
      write (number, '(i0)') self%done
      text = text // ', ' // trim(number) // ' states'
    end if
    if (self%live) then
      text = text(:min(len(text), widest))
      length = len(text)
      call write_stderr(achar(13) // text // repeat(' ', max(0, self%shown - length)))
      self%shown = length
    else
      call write_stderr(text // ', ' // duration(now - self%began) // ' so far' // new_line('a'))
      self%lines = self%lines + 1
      self%interval = min(growth*self%interval, longest_interval)
    end if
    self%next = now + self%interval
  end subroutine show

  !> A time [s] as people say it, to about two digits.
  pure function duration(time) result(text)
    real(wp), intent(in) :: time
    character(len=:), allocatable :: text
    character(len=24) :: buffer

    ! A hundred days is as good as never, and fits an integer.
    associate (whole => nint(min(max(time, 0.0_wp), 8.64e6_wp)))
      if (whole < 100) then
        write (buffer, '(i0, a)') whole, ' s'
      else if (whole < 100*60) then
        write (buffer, '(i0, a)') nint(whole/60.0_wp), ' min'
      else
        write (buffer, '(i0, a, i2.2, a)') whole/3600, ' h ', mod(whole, 3600)/60, ' min'
      end if
    end associate
    text = trim(buffer)
  end function duration

end module progress
