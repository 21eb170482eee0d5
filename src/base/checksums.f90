!> Checksums, by which it is seen that something has changed.
module checksums
  use kinds, only: long
  implicit none
  private
  public :: checksum

  !> checksum(words), checksum(text): a number of 32 bits; not proof against intent.
  interface checksum
    module procedure :: of_words, of_text
  end interface checksum

contains

  !> A checksum of 32 bits. Every half word changes it one to one, so that a single wrong one never
  !> goes unseen; the shift brings upper bits down, or two wrong signs could cancel. The products
  !> stay below 2^63. (The multiplier is MurmurHash's.)
  pure integer(long) function of_words(words) result(checksum)
    integer(long), intent(in) :: words(:)
    integer(long), parameter :: mask = int(z'ffffffff', long), multiplier = int(z'5bd1e995', long)
    integer :: i

    checksum = size(words)
    do i = 1, size(words)
      call add(iand(words(i), mask))
      call add(ishft(words(i), -32))
    end do

  contains

    pure subroutine add(half)
      integer(long), intent(in) :: half

      checksum = iand(ieor(checksum, half)*multiplier, mask)
      checksum = ieor(checksum, ishft(checksum, -15))
    end subroutine add

  end function of_words

  !> The same of a text without NUL bytes.
  pure integer(long) function of_text(text) result(checksum)
    character(len=*), intent(in) :: text
    !> Characters in a word.
    integer, parameter :: letters = storage_size(0_long)/8
    integer(long) :: words((len(text) + letters - 1)/letters)
    character(len=letters) :: piece
    integer :: i, first, last

    do i = 1, size(words)
      first = letters*(i - 1) + 1
      last = min(letters*i, len(text))
      piece = repeat(achar(0), letters)
      piece(:last - first + 1) = text(first:last)
      words(i) = transfer(piece, words(i))
    end do
    checksum = of_words(words)
  end function of_text

end module checksums
