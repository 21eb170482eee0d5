!> Numbers and texts packed into one row of 64-bit words, and back, bit by bit the same.
module byte_record
  use kinds, only: wp, long
  implicit none
  private
  public :: byte_record_t

  !> What is put in comes out in the same order.
  type :: byte_record_t
    !> words(:held) are in use, of so many as there is room for. To be read only.
    integer(long), allocatable :: words(:)
    integer :: held = 0
    integer, private :: room = 0
    !> Whether more was taken out than had been put in; what was taken then is zero or empty.
    logical :: exhausted = .false.
    integer, private :: taken = 0
  contains
    procedure :: clear
    generic :: put => put_long, put_integer, put_real, put_reals, put_logical, put_text
    generic :: take => take_long, take_integer, take_real, take_reals, take_logical, take_text
    procedure, private :: put_long, put_integer, put_real, put_reals, put_logical, put_text
    procedure, private :: take_long, take_integer, take_real, take_reals, take_logical, take_text
    procedure :: put_words
    procedure :: take_words
  end type byte_record_t

  !> Characters in a word.
  integer, parameter :: letters = storage_size(0_long)/8

contains

  !> Empties it.
  subroutine clear(self)
    class(byte_record_t), intent(inout) :: self

    self%held = 0
    self%taken = 0
    self%exhausted = .false.
  end subroutine clear

  !> Words as they are: what takes them out knows how many.
  subroutine put_words(self, words)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(in) :: words(:)

    call make_room(self, size(words))
    self%words(self%held + 1:self%held + size(words)) = words
    self%held = self%held + size(words)
  end subroutine put_words

  !> Sees to it that so many words more can be put.
  subroutine make_room(self, more)
    type(byte_record_t), intent(inout) :: self
    integer, intent(in) :: more
    integer(long), allocatable :: larger(:)

    if (self%held + more <= self%room) return
    allocate (larger(max(256, 2*(self%held + more))))
    if (self%held > 0) larger(:self%held) = self%words(:self%held)
    call move_alloc(larger, self%words)
    self%room = size(self%words)
  end subroutine make_room

  subroutine put_long(self, value)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(in) :: value

    if (self%held == self%room) call make_room(self, 1)
    self%held = self%held + 1
    self%words(self%held) = value
  end subroutine put_long

  !> As many words as there are in `words`.
  subroutine take_words(self, words)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(out) :: words(:)

    words = 0
    if (size(words) > self%held - self%taken) then
      self%exhausted = .true.
      return
    end if
    words = self%words(self%taken + 1:self%taken + size(words))
    self%taken = self%taken + size(words)
  end subroutine take_words

  subroutine put_integer(self, value)
    class(byte_record_t), intent(inout) :: self
    integer, intent(in) :: value

    call self%put_long(int(value, long))
  end subroutine put_integer

  subroutine put_logical(self, value)
    class(byte_record_t), intent(inout) :: self
    logical, intent(in) :: value

    call self%put_long(merge(1_long, 0_long, value))
  end subroutine put_logical

  subroutine put_real(self, value)
    class(byte_record_t), intent(inout) :: self
    real(wp), intent(in) :: value

    call self%put_long(transfer(value, 0_long))
  end subroutine put_real

  !> The number of values goes with them.
  subroutine put_reals(self, values)
    class(byte_record_t), intent(inout) :: self
    real(wp), intent(in) :: values(:)
    integer :: i

    call self%put(size(values))
    call make_room(self, size(values))
    do i = 1, size(values)
      self%words(self%held + i) = transfer(values(i), 0_long)
    end do
    self%held = self%held + size(values)
  end subroutine put_reals

  !> Its length goes with it.
  subroutine put_text(self, text)
    class(byte_record_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    character(len=letters) :: piece
    integer :: first

    call self%put(len(text))
    do first = 1, len(text), letters
      piece = text(first:min(first + letters - 1, len(text)))
      call self%put_long(transfer(piece, 0_long))
    end do
  end subroutine put_text

  subroutine take_long(self, value)
    class(byte_record_t), intent(inout) :: self
    integer(long), intent(out) :: value
    integer(long) :: words(1)

    call self%take_words(words)
    value = words(1)
  end subroutine take_long

  subroutine take_integer(self, value)
    class(byte_record_t), intent(inout) :: self
    integer, intent(out) :: value
    integer(long) :: words(1)

    call self%take_words(words)
    value = int(words(1))
  end subroutine take_integer

  subroutine take_logical(self, value)
    class(byte_record_t), intent(inout) :: self
    logical, intent(out) :: value
    integer(long) :: words(1)

    call self%take_words(words)
    value = words(1) /= 0
  end subroutine take_logical

  subroutine take_real(self, value)
    class(byte_record_t), intent(inout) :: self
    real(wp), intent(out) :: value
    integer(long) :: words(1)

    call self%take_words(words)
    value = transfer(words(1), value)
  end subroutine take_real

  subroutine take_reals(self, values)
    class(byte_record_t), intent(inout) :: self
    real(wp), allocatable, intent(out) :: values(:)
    integer(long), allocatable :: words(:)
    integer :: count

    call take_count(self, count)
    allocate (words(count), values(count))
    call self%take_words(words)
    values = transfer(words, values, count)
  end subroutine take_reals

  subroutine take_text(self, text)
    class(byte_record_t), intent(inout) :: self
    character(len=:), allocatable, intent(out) :: text
    integer(long), allocatable :: words(:)
    integer :: length, count

    call take_count(self, length)
    count = (length + letters - 1)/letters
    allocate (words(count))
    call self%take_words(words)
    allocate (character(len=length) :: text)
    text = transfer(words, repeat(' ', count*letters))
  end subroutine take_text

  !> A number of items, never more than could be held.
  subroutine take_count(self, count)
    class(byte_record_t), intent(inout) :: self
    integer, intent(out) :: count

    call self%take(count)
    if (count >= 0 .and. count <= letters*self%held) return
    self%exhausted = .true.
    count = 0
  end subroutine take_count

end module byte_record
