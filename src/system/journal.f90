!> A file to which a run appends its results, so that another run can continue after an
!> interruption.
!>
!> A journal begins with a text that identifies its owner. Records follow (`journal_frame`), each
!> with the time since the run began. Records are collected and written several times a second. An
!> incomplete last record, left by a run that was killed, is removed. Every few seconds the journal
!> is synchronised to the disk, the first time together with its name, so that a power failure loses
!> only the last seconds. System calls write it for the reason given in `text_file`.
module journal
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_loc, c_f_pointer
  use kinds, only: wp, long
  use failure, only: failure_t, fail, file_trouble
  use c_library, only: c_open, c_write, c_sync, c_close, c_size, c_cut, check_status, &
    as_output, as_kept_output, nul
  use byte_record, only: byte_record_t
  use journal_frame, only: frame_words, word_bytes, read_frame
  use checksums, only: checksum
  use files, only: sync_names
  use clock, only: seconds
  implicit none
  private
  public :: journal_t

  !> A journal, which must not be copied while it is open. After the first error, which is kept in
  !> `trouble`, nothing more is written.
  type :: journal_t
    type(failure_t), allocatable :: trouble
    !> inherited: number of complete records of an earlier run; the time [s] of that run at the last
    !> of them.
    integer :: inherited = 0
    real(wp) :: earlier = 0
    character(len=:), allocatable, private :: path
    integer(c_int), private :: descriptor = -1
    !> Number of records of the earlier run that `next` has not returned yet.
    integer, private :: waiting = 0
    !> Number of words in the file when it was opened.
    integer(long), private :: room = 0
    !> The words to be written are gathered(:held).
    integer(long), allocatable, private :: gathered(:)
    integer, private :: held = 0
    !> Times [s] of opening, of the last writing, and of the last synchronisation.
    real(wp), private :: began = 0, handed = 0, synced = 0
    !> Whether the journal's name has been written to the disk.
    logical, private :: named = .false.
  contains
    procedure :: begin
    procedure :: go_on
    procedure :: is_open
    procedure :: next
    procedure :: append
    procedure :: close => close_journal
    procedure :: drop => let_go
    procedure :: discard
    procedure, private :: put_on_disk
    procedure, private :: hand_over
  end type journal_t

  !> Computing time [s] that a power failure can lose at most. Synchronisation takes a hundredth of
  !> it.
  real(wp), parameter :: sync_interval = 2
  !> Computing time [s] that is lost at most if a run is killed; largest number of collected words.
  !> Most runs end before they write any words.
  real(wp), parameter :: hand_interval = 0.05_wp
  integer, parameter :: most_gathered = 98304

contains

  !> Creates or empties the journal `path` of `owner`.
  subroutine begin(self, path, owner, error)
    class(journal_t), intent(inout) :: self
    character(len=*), intent(in) :: path, owner
    type(failure_t), allocatable, intent(out) :: error
    type(byte_record_t) :: heading
    character(len=:), allocatable :: text

    call start(self, path, as_output, error)
    if (allocated(error)) return
    text = owner
    call heading%pass(text)
    call self%append(heading)
    if (allocated(self%trouble)) error = self%trouble
  end subroutine begin

  !> Opens the journal `path` of an earlier run: `next` returns its records, then `append` adds
  !> more. If its owner is not `owner`, the journal is left closed and unchanged, and `other` is its
  !> owner. A journal without a complete heading is begun again.
  subroutine go_on(self, path, owner, other, error)
    class(journal_t), intent(inout) :: self
    character(len=*), intent(in) :: path, owner
    character(len=:), allocatable, intent(out) :: other
    type(failure_t), allocatable, intent(out) :: error
    type(byte_record_t) :: record
    integer(c_long) :: whole, first
    logical :: found

    call start(self, path, as_kept_output, error)
    if (allocated(error)) return
    whole = 0
    call read_frame(self%descriptor, self%room, record, self%earlier, whole, found)
    if (.not. found) then
      call self%close()
      call self%begin(path, owner, error)
      return
    end if
    call record%pass(other)
    if (other /= owner) then
      call self%close()
      return
    end if
    deallocate (other)
    first = whole
    do
      call read_frame(self%descriptor, self%room, record, self%earlier, whole, found)
      if (.not. found) exit
      self%inherited = self%inherited + 1
    end do
    self%waiting = self%inherited
    call check_status('cannot write ' // path, c_cut(self%descriptor, whole, first), error)
    if (allocated(error)) call self%close()
  end subroutine go_on

  !> Opens the file and sets the times of the journal to the present.
  subroutine start(self, path, how, error)
    class(journal_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(c_int), intent(in) :: how
    type(failure_t), allocatable, intent(out) :: error

    self%began = seconds()
    self%handed = self%began
    self%synced = self%began
    if (.not. allocated(self%gathered)) allocate (self%gathered(most_gathered))
    self%path = path
    self%descriptor = c_open(path // nul, how)
    call check_status('cannot write ' // path, self%descriptor, error)
    if (self%is_open()) self%room = c_size(self%descriptor)/word_bytes
  end subroutine start

  !> Whether records can be read or added.
  pure logical function is_open(self)
    class(journal_t), intent(in) :: self

    is_open = self%descriptor >= 0
  end function is_open

  !> The next record of the earlier run. found = .false.: there are no more records, and `append`
  !> may be called.
  subroutine next(self, record, found)
    class(journal_t), intent(inout) :: self
    type(byte_record_t), intent(inout) :: record
    logical, intent(out) :: found
    integer(c_long) :: whole

    found = .false.
    if (self%waiting == 0 .or. .not. self%is_open()) return
    whole = 0
    call read_frame(self%descriptor, self%room, record, self%earlier, whole, found)
    self%waiting = self%waiting - 1
    ! `go_on` has already read this record successfully.
    if (found) return
    call fail(self%trouble, file_trouble, 'cannot read ' // self%path)
    call self%close()
  end subroutine next

  !> Appends a record, after `next` has returned all records.
  subroutine append(self, record)
    class(journal_t), intent(inout) :: self
    type(byte_record_t), intent(in) :: record
    integer(long), allocatable :: larger(:)
    real(wp) :: now
    integer :: length

    if (.not. self%is_open()) return
    length = frame_words + record%held
    if (self%held + length > size(self%gathered)) then
      allocate (larger(self%held + length))
      larger(:self%held) = self%gathered(:self%held)
      call move_alloc(larger, self%gathered)
    end if
    now = seconds()
    associate (words => self%gathered(self%held + 1:self%held + length))
      words(1) = record%held
      words(2) = 0
      words(3) = transfer(self%earlier + now - self%began, 0_long)
      words(frame_words + 1:) = record%words(:record%held)
    end associate
    self%held = self%held + length
    if (self%held > most_gathered .or. now - self%handed > hand_interval) call self%hand_over(now)
  end subroutine append

  !> Writes the collected records, so that they are kept if this process ends, and synchronises the
  !> file if `sync_interval` has passed. now: the time [s].
  subroutine hand_over(self, now)
    class(journal_t), intent(inout), target :: self
    real(wp), intent(in) :: now
    character(kind=c_char), pointer :: bytes(:)
    integer(c_int) :: status
    integer :: first, last

    first = 1
    do while (first < self%held)
      last = first - 1 + frame_words + int(self%gathered(first))
      self%gathered(first + 1) = checksum(self%gathered(first:last))
      first = last + 1
    end do
    call c_f_pointer(c_loc(self%gathered), bytes, [word_bytes*self%held])
    self%held = 0
    self%handed = now
    status = c_write(self%descriptor, bytes, size(bytes, kind=c_long))
    if (status == 0 .and. now - self%synced > sync_interval) call self%put_on_disk(status)
    if (status == 0) return
    call check_status('cannot write ' // self%path, status, self%trouble)
    call let_go(self)
  end subroutine hand_over

  !> Waits until the journal has been written to the disk; the first time also its name, and the
  !> names of its folder and of the folder above.
  subroutine put_on_disk(self, status)
    class(journal_t), intent(inout) :: self
    integer(c_int), intent(out) :: status
    integer :: place

    status = c_sync(self%descriptor)
    if (.not. self%named) then
      place = index(self%path, '/', .true.)
      if (status == 0) call sync_names(self%path(:place), .true., status)
      if (status == 0) call sync_names(self%path(:place) // '..', .false., status)
    end if
    self%named = .true.
    self%synced = seconds()
  end subroutine put_on_disk

  !> Writes the collected records and closes the journal, if it is open.
  subroutine close_journal(self)
    class(journal_t), intent(inout) :: self

    if (self%is_open() .and. self%held > 0) call self%hand_over(seconds())
    call let_go(self)
  end subroutine close_journal

  !> Closes the journal, if it is open, without writing the records collected last.
  subroutine let_go(self)
    class(journal_t), intent(inout) :: self
    integer(c_int) :: status

    if (.not. self%is_open()) return
    ! If closing fails, only records that were not synchronised are lost.
    status = c_close(self%descriptor)
    self%descriptor = -1
  end subroutine let_go

  !> Empties the journal and closes it, so that no run can continue from its records.
  subroutine discard(self)
    class(journal_t), intent(inout) :: self
    integer(c_int) :: status

    if (.not. self%is_open()) return
    status = c_cut(self%descriptor, 0_c_long, 0_c_long)
    if (status /= 0) call fail(self%trouble, file_trouble, self%path // ' cannot be emptied')
    call let_go(self)
  end subroutine discard

end module journal
