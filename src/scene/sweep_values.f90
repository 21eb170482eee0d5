!> The values of a key of &sweep. They come from `from`, `to`, `count` and `scale`; or they are the
!> texts in `words`; or the numbers of all curves of a file. If the key names a file, a pattern in
!> `words` stands for all files that match it.
module sweep_values
  use, intrinsic :: iso_c_binding, only: nul => c_null_char
  use kinds, only: wp, long
  use checksums, only: checksum
  use failure, only: failure_t
  use text, only: brief, counted, quoted, spelled, word_count, word_of
  use file_names, only: names_like, is_pattern, bytes_of
  use deck, only: deck_t
  use namelist_writer, only: line_t
  use scene_groups, only: axis_t, sweep_t
  implicit none
  private
  public :: take_ranges, take_texts, take_curves

contains

  !> Takes the values of keys from their ranges; there are none after a mistake.
  subroutine take_ranges(deck, axis, keys)
    type(deck_t), intent(inout) :: deck
    type(axis_t), intent(inout) :: axis(:)
    integer, intent(in) :: keys(:)
    real(wp), allocatable :: from(:), to(:), number(:)
    character(len=:), allocatable :: scales
    integer :: i

    call deck%assume('sweep', 'scale', 'linear')
    call deck%get('sweep', 'from', from)
    call deck%get('sweep', 'to', to)
    call deck%get('sweep', 'count', number)
    call deck%get('sweep', 'scale', scales)
    call check_size('from', size(from))
    call check_size('to', size(to))
    call check_size('count', size(number))
    if (word_count(scales) /= 1) call check_size('scale', word_count(scales))
    if (allocated(deck%error)) return
    do i = 1, size(keys)
      call spread_values(deck, from(i), to(i), number(i), &
        word_of(scales, min(i, word_count(scales))), axis(keys(i))%values)
    end do

  contains

    !> Refuses a list unless it has exactly one item for each key.
    subroutine check_size(key, items)
      character(len=*), intent(in) :: key
      integer, intent(in) :: items

      if (items == size(keys)) return
      if (items == 0) then
        call deck%mistake('sweep', key, 'missing; give from, to and count, or values')
      else
        call deck%mistake('sweep', key, brief(items) // ' for ' // counted(size(keys), 'key') // &
          '; give one for each')
      end if
    end subroutine check_size

  end subroutine take_ranges

  !> Computes the values from `from` to `to`; there are none after a mistake.
  subroutine spread_values(deck, from, to, number, scale, values)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: from, to, number
    character(len=*), intent(in) :: scale
    real(wp), allocatable, intent(inout) :: values(:)
    character(len=*), parameter :: not_positive = ' is not > 0, as scale = ''log'' needs'
    integer :: n, i

    allocate (values(0))
    n = nint(number)
    if (abs(number - n) > 0) then
      call deck%mistake('sweep', 'count', brief(number) // ' is not a whole number')
    else if (scale /= 'log' .and. scale /= 'linear') then
      call deck%mistake('sweep', 'scale', quoted(scale) // ' is neither linear nor log')
    else if (scale == 'log' .and. from <= 0) then
      call deck%mistake('sweep', 'from', brief(from) // not_positive)
    else if (scale == 'log' .and. to <= 0) then
      call deck%mistake('sweep', 'to', brief(to) // not_positive)
    else if (abs(to - from) <= 0) then
      call deck%mistake('sweep', 'to', 'the same as from; a sweep needs two ends')
    else
      if (scale == 'log') then
        values = exp([(log(from) + (log(to) - log(from))*(i - 1)/(n - 1), i=1, n)])
      else
        values = [(from + (to - from)*(i - 1)/(n - 1), i=1, n)]
      end if
      ! The first and last value are set without rounding errors.
      values(1) = from
      values(n) = to
    end if
  end subroutine spread_values

  !> Sets `texts`, and their numbers as the values of the key. Names and sizes of files become a
  !> part of the deck's checksums, so that an interrupted sweep does not continue with other files.
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

    !> Adds names, each of which ends with `nul`. letters: number of letters to remove from the
    !> beginning of a name in the deck's folder.
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

    !> Adds the checksum of the names and sizes of the files to those of the deck.
    subroutine note_files()
      integer(long) :: digest(size(sweep%texts), 2)
      integer :: i

      do i = 1, size(sweep%texts)
        digest(i, :) = [checksum(sweep%texts(i)%text), bytes_of(deck%placed(sweep%texts(i)%text))]
      end do
      call deck%note_checksum('sweep', 'words', checksum(reshape(digest, [size(digest)])))
    end subroutine note_files

  end subroutine take_texts

  !> The numbers of all curves of the file in &measurement.
  subroutine take_curves(deck, sweep, values)
    type(deck_t), intent(inout) :: deck
    type(sweep_t), intent(inout) :: sweep
    real(wp), allocatable, intent(inout) :: values(:)
    type(failure_t), allocatable :: trouble
    character(len=:), allocatable :: names
    integer :: skip

    allocate (values(0))
    skip = 0
    call deck%get('measurement', 'curves', names)
    call deck%get('measurement', 'skip_lines', skip)
    if (word_count(names) == 0 .or. .not. deck%is_set('measurement', 'file')) then
      call deck%mistake('sweep', 'key', 'without values it takes all curves of one file: give ' &
        // 'file and curves in &measurement')
      return
    end if
    call sweep%index%find_curves(deck%path_of('measurement', 'file'), &
      spelled(word_of(names, 1)), skip, trouble)
    if (allocated(trouble)) then
      call deck%mistake('measurement', 'file', trouble%message)
      return
    end if
    call deck%note_file('measurement', 'file', sweep%index%digest)
    values = sweep%index%number
  end subroutine take_curves

end module sweep_values
