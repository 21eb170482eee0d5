!> The values of the key of a sweep that holds a text: those of `words` in &sweep. If the key names
!> a file, a pattern among them stands for all files that it matches.
module sweep_texts
  use, intrinsic :: iso_c_binding, only: nul => c_null_char
  use kinds, only: wp, long
  use checksums, only: checksum
  use text, only: quoted, spelled, word_of
  use file_names, only: names_like, is_pattern, bytes_of
  use deck, only: deck_t
  use namelist_writer, only: line_t
  use scene_groups, only: sweep_t
  implicit none
  private
  public :: take_texts

contains

  !> Sets `texts`, and their numbers as the values of the key. What the files are becomes a part of
  !> the deck's checksums: an interrupted sweep does not go on with other files.
  subroutine take_texts(deck, sweep)
    type(deck_t), intent(inout) :: deck
    type(sweep_t), intent(inout) :: sweep
    character(len=:), allocatable :: words, key, names
    logical :: of_files
    integer :: first, last, next, i

    call deck%get('sweep', 'words', words)
    key = word_of(sweep%names, sweep%text_key)
    of_files = index(key, '.file') == len(key) - 4
    allocate (sweep%texts(0))
    next = 1
    do
      first = next - 1 + verify(words(next:), ' ')
      if (first < next) exit
      last = first - 2 + scan(words(first:) // ' ', ' ')
      next = min(last + 1, len(words))
      if (of_files .and. is_pattern(words(first:last))) then
        call names_like(deck%placed(spelled(words(first:last))), names)
        if (len(names) == 0) call deck%mistake('sweep', 'words', 'no file is like ' // &
          quoted(spelled(words(first:last))))
        call add_names(names, len(deck%source%folder))
      else
        call add_names(spelled(words(first:last)) // nul, 0)
      end if
      if (last >= len(words)) exit
    end do
    if (allocated(deck%error)) return
    sweep%axis(sweep%text_key)%values = [(real(i, wp), i=1, size(sweep%texts))]
    if (of_files) call note_files()

  contains

    !> Adds names, each with `nul` behind it, without their first letters.
    subroutine add_names(names, letters)
      character(len=*), intent(in) :: names
      integer, intent(in) :: letters
      type(line_t), allocatable :: more(:)
      integer :: at, i

      allocate (more(size(sweep%texts) + count([(names(i:i) == nul, i=1, len(names))])))
      do i = 1, size(sweep%texts)
        call move_alloc(sweep%texts(i)%text, more(i)%text)
      end do
      at = 1
      do i = size(sweep%texts) + 1, size(more)
        more(i)%text = names(at:at - 2 + index(names(at:), nul))
        at = at + len(more(i)%text) + 1
        if (letters > 0 .and. index(more(i)%text, deck%source%folder) == 1) &
          more(i)%text = more(i)%text(letters + 1:)
      end do
      call move_alloc(more, sweep%texts)
    end subroutine add_names

    !> Notes the checksum of the names and sizes of the files.
    subroutine note_files()
      integer(long) :: digest(size(sweep%texts), 2)
      integer :: i

      do i = 1, size(sweep%texts)
        digest(i, :) = [checksum(sweep%texts(i)%text), bytes_of(deck%placed(sweep%texts(i)%text))]
      end do
      call deck%note_checksum('sweep', 'words', checksum(reshape(digest, [size(digest)])))
    end subroutine note_files

  end subroutine take_texts

end module sweep_texts
