!> Numbers and texts packed into one array of 64-bit words, and unpacked again bit by bit.
!>
!> A procedure that packs an object calls `pass` once for each component: `pass` writes the
!> component into a record, or reads it from a record that was filled.
module byte_record
  use kinds, only: wp, long
  implicit none
  private
  public :: byte_record_t

  !> Components come out in the order in which they were passed in.
  type :: byte_record_t
    !> words(:held) are in use. To be read only.
    integer(long), allocatable :: words(:)
    integer :: held = 0
    !> Whether `pass` reads. To be read only.
    logical :: reading = .false.
    !> Whether more was read than the record holds; those values are zero or empty.
    logical :: exhausted = .false.
    integer, private :: room = 0, taken = 0
  contains
    procedure :: clear
    procedure :: fill
    procedure :: add
    !> The argument has no intent: it is an input while the record is written, when it may be a
    !> constant, and an output while the record is read.
    generic :: pass => pass_words, pass_integer, pass_real, pass_reals, pass_logical, pass_text
    procedure, private :: pass_words, pass_integer, pass_real, pass_reals, pass_logical, pass_text
  end type byte_record_t

  !> Number of characters in a word.
  integer, parameter :: letters = storage_size(0_long)/8

contains

  !> Empties the record for writing.
  subroutine clear(self)
    class(byte_record_t), intent(inout) :: self

    self%held = 0
    self%taken = 0
    self%reading = .false.
    self%exhausted = .false.
  end subroutine clear

  !> Fills the record with these words for reading.
  subroutine fill(self, words)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(in) :: words(:)

    call self%clear()
    call self%add(words)
    self%reading = .true.
  end subroutine fill

  !> Appends words.
  subroutine add(self, words)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(in) :: words(:)
    integer(long), allocatable :: larger(:)

    if (self%held + size(words) > self%room) then
      allocate (larger(max(256, 2*(self%held + size(words)))))
      if (self%held > 0) larger(:self%held) = self%words(:self%held)
      call move_alloc(larger, self%words)
      self%room = size(self%words)
    end if
    self%words(self%held + 1:self%held + size(words)) = words
    self%held = self%held + size(words)
  end subroutine add

  !> Passes size(words) words.
  subroutine pass_words(self, words)
    class(byte_record_t), intent(inout) :: self
    integer(long) :: words(:)

    if (.not. self%reading) then
      call self%add(words)
    else if (size(words) > self%held - self%taken) then
      words = 0
      self%exhausted = .true.
    else
      words = self%words(self%taken + 1:self%taken + size(words))
      self%taken = self%taken + size(words)
    end if
  end subroutine pass_words

  subroutine pass_integer(self, value)
    class(byte_record_t), intent(inout) :: self
    integer :: value
    integer(long) :: words(1)

    words = value
    call self%pass(words)
    if (self%reading) value = int(words(1))
  end subroutine pass_integer

  subroutine pass_logical(self, value)
    class(byte_record_t), intent(inout) :: self
    logical :: value
    integer(long) :: words(1)

    if (.not. self%reading) words = merge(1_long, 0_long, value)
    call self%pass(words)
    if (self%reading) value = words(1) /= 0
  end subroutine pass_logical

  subroutine pass_real(self, value)
    class(byte_record_t), intent(inout) :: self
    real(wp) :: value
    integer(long) :: words(1)

    words = transfer(value, words)
    call self%pass(words)
    if (self%reading) value = transfer(words(1), value)
  end subroutine pass_real

  !> Passes the number of values, then the values.
  subroutine pass_reals(self, values)
    class(byte_record_t), intent(inout) :: self
    real(wp), allocatable :: values(:)
    integer :: count, i

    if (.not. self%reading) count = size(values)
    call pass_count(self, count)
    if (self%reading) then
      if (allocated(values)) deallocate (values)
      allocate (values(count))
    end if
    do i = 1, count
      call self%pass(values(i))
    end do
  end subroutine pass_reals

  !> Passes the length, then the characters.
  subroutine pass_text(self, text)
    class(byte_record_t), intent(inout) :: self
    character(len=:), allocatable :: text
    integer(long), allocatable :: words(:)
    integer :: length

    if (.not. self%reading) length = len(text)
    call pass_count(self, length)
    if (self%reading) text = repeat(' ', length)
    ! Blanks fill the last word.
    words = transfer(text // repeat(' ', letters - 1), words, (length + letters - 1)/letters)
    call self%pass(words)
    if (self%reading) text = transfer(words, text)
  end subroutine pass_text

  !> Passes a number of items; a number that the record cannot hold counts as exhausted.
  subroutine pass_count(self, count)
    class(byte_record_t), intent(inout) :: self
    integer, intent(inout) :: count

    call self%pass(count)
    if (.not. self%reading .or. (count >= 0 .and. count <= letters*self%held)) return
    self%exhausted = .true.
    count = 0
  end subroutine pass_count

end module byte_record
