!> The frame of a record in a journal. Before the words of the record stand their number, the
!> checksum of all other words, and a time.
module journal_frame
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp, long
  use c_library, only: c_read
  use byte_record, only: byte_record_t
  use checksums, only: checksum
  implicit none
  private
  public :: frame_words, word_bytes, read_frame

  !> Number of words in a frame; number of bytes in a word.
  integer, parameter :: frame_words = 3, word_bytes = storage_size(0_long)/8

contains

  !> Reads the record at the present position of a file, and its time [s], and adds its bytes to
  !> `whole`. most: largest number of words in the record. found = .false.: the file ends here, or
  !> the record is not complete.
  subroutine read_frame(descriptor, most, record, time, whole, found)
    integer(c_int), intent(in) :: descriptor
    integer(long), intent(in) :: most
    type(byte_record_t), intent(inout) :: record
    real(wp), intent(inout) :: time
    integer(c_long), intent(inout) :: whole
    logical, intent(out) :: found
    integer(long) :: head(frame_words)
    integer(long), allocatable :: words(:)

    found = .false.
    call record%clear()
    if (.not. read_words(descriptor, head)) return
    if (head(1) < 0 .or. head(1) > most) return
    allocate (words(frame_words + head(1)))
    words(:frame_words) = head
    words(2) = 0
    if (.not. read_words(descriptor, words(frame_words + 1:))) return
    if (checksum(words) /= head(2)) return
    call record%fill(words(frame_words + 1:))
    time = transfer(head(3), time)
    whole = whole + size(words)*word_bytes
    found = .true.
  end subroutine read_frame

  !> Reads words; the result is .false. if the file ends before all are read.
  logical function read_words(descriptor, words) result(complete)
    integer(c_int), intent(in) :: descriptor
    integer(long), intent(out) :: words(:)
    character :: bytes(word_bytes*size(words))

    complete = c_read(descriptor, bytes, size(bytes, kind=c_long)) == size(bytes)
    if (complete) words = transfer(bytes, words)
  end function read_words

end module journal_frame
