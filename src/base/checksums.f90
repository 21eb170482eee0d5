!> Checksums, which show whether data have changed.
module checksums
  use kinds, only: long
  implicit none
  private
  public :: checksum

  !> checksum(words), checksum(text): a number of 32 bits; no protection against forgery.
  interface checksum
    module procedure :: of_words, of_text
  end interface checksum

  !> The lower 32 bits.
  integer(long), parameter :: mask = int(z'ffffffff', long)

contains

  !> A checksum of 32 bits. Each half word maps the checksum one to one, so that a single wrong half
  !> word always changes the result. The shift moves upper bits down; without it two wrong signs
  !> could cancel. The products stay below 2^63. (The multiplier is MurmurHash's.) Each product
  !> depends on the one before. To save time, four checksums, each of every fourth word, are
  !> computed side by side and then combined.
  pure integer(long) function of_words(words) result(checksum)
    integer(long), intent(in) :: words(:)
    integer, parameter :: lanes = 4
    integer(long) :: lane(lanes)
    integer :: i, k

    lane = 0
    do i = 1, size(words) - lanes + 1, lanes
      do k = 1, lanes
        lane(k) = with_word(lane(k), words(i + k - 1))
      end do
    end do
    checksum = size(words)
    do i = size(words) - mod(size(words), lanes) + 1, size(words)
      checksum = with_word(checksum, words(i))
    end do
    do k = 1, lanes
      checksum = with_half(checksum, lane(k))
    end do
  end function of_words

  !> A checksum with one more word.
  elemental integer(long) function with_word(checksum, word) result(next)
    integer(long), intent(in) :: checksum, word

    next = with_half(with_half(checksum, iand(word, mask)), ishft(word, -32))
  end function with_word

  !> A checksum with 32 bits more.
  elemental integer(long) function with_half(checksum, half) result(next)
    integer(long), intent(in) :: checksum, half
    integer(long), parameter :: multiplier = int(z'5bd1e995', long)

    next = iand(ieor(checksum, half)*multiplier, mask)
    next = ieor(next, ishft(next, -15))
  end function with_half

  !> The checksum of a text without NUL bytes.
  pure integer(long) function of_text(text) result(checksum)
    character(len=*), intent(in) :: text
    !> Number of characters in a word.
    integer, parameter :: letters = storage_size(0_long)/8

    checksum = of_words(transfer(text // repeat(achar(0), letters - 1), [0_long], &
      (len(text) + letters - 1)/letters))
  end function of_text

end module checksums
