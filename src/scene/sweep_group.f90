!> Reads &sweep: the values of keys, from ranges, a list or a file. If several keys have values,
!> every combination of values is a case.
module sweep_group
  use kinds, only: wp
  use failure, only: failure_t
  use text, only: brief, lower, quoted, word_count, word_of
  use deck, only: deck_t
  use deck_numbers, only: words_of, number_of_word, holds_text
  use case_rows, only: case_rows_t
  use deck_keys, only: key_spec, real_list, logical_value, text_value, names_value
  use scene_groups, only: scene_t, sweep_t, case_file_t
  use sweep_values, only: take_ranges, take_texts, take_curves
  implicit none
  private
  public :: sweep_keys, take_sweep

  !> Largest number of keys in a sweep; of values of one key; of words in the deck; of cases.
  integer, parameter :: most_keys = 8, most_values = 10000, most_words = 10000
  real(wp), parameter :: most_cases = 1.0e7_wp
  character(len=*), parameter :: of_range(4) = ['from ', 'to   ', 'count', 'scale']

  !> Groups that only ask for tables and states, which a sweep does not write.
  character(len=*), parameter :: of_tables(*) = [character(len=9) :: 'profiles', 'stability', &
    'table']

  !> The rows of &sweep.
  type(key_spec), parameter :: sweep_keys(*) = [ &
    key_spec('sweep', meaning='The same deck for several values of keys. Either key with ' // &
      'from, to and count, one of each for each key, and then every combination is a case; or ' // &
      'one key with values; or a file.', &
      choices='&sweep key = ''bodies.radius'', values = 1e-7, 1e-6, 1e-5 /'), &
    key_spec('sweep', 'key', names_value, 'The keys to vary, as ''group.key''. The last one ' // &
      'varies fastest.', most=most_keys, otherwise='those of file'), &
    key_spec('sweep', 'from', real_list, 'First value of each, in the unit of the key.', &
      most=most_keys), &
    key_spec('sweep', 'to', real_list, 'Last value of each.', most=most_keys), &
    key_spec('sweep', 'count', real_list, 'Number of values of each.', most=most_keys, low=2.0_wp, &
      high=real(most_values, wp)), &
    key_spec('sweep', 'scale', names_value, 'Spacing of the values, linear or log: one for ' // &
      'each, or one for all.', most=most_keys, otherwise='linear'), &
    key_spec('sweep', 'values', real_list, 'The values of one key, one by one.', &
      most=most_values), &
    key_spec('sweep', 'words', names_value, 'The words of one key that holds a word or a ' // &
      'text; of a key that names a file also patterns: ''map/*.csv''.', most=most_words, &
      otherwise='none', spaced=.true.), &
    key_spec('sweep', 'file', text_value, 'A table of cases: a line of names as ' // &
      '''group.key'', then one case a row; a relative path begins at the deck''s folder.', &
      most=1000), &
    key_spec('sweep', 'costs', logical_value, 'Whether time, work and estimated errors of ' // &
      'each case are measured, into costs.csv; the cases then run one by one.', &
      otherwise='.true. if a key of &numerics is swept')]

contains

  !> Reads &sweep.
  subroutine take_sweep(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i

    scene%deck%varied = .true.
    allocate (scene%sweep)
    do i = 1, size(of_tables)
      if (scene%deck%has_group(trim(of_tables(i)))) call scene%deck%mistake(trim(of_tables(i)), &
        '', 'not together with &sweep, whose results are numbers of each case and no tables; ' // &
        'leave out this group, or run a case alone')
    end do
    call take_cases(scene)
    if (allocated(scene%deck%error)) return
    scene%sweep%costs = .not. scene%deck%has_group('fit') .and. &
      index(' ' // lower(scene%sweep%names), ' numerics.') > 0
    if (scene%deck%is_set('sweep', 'costs')) &
      call scene%deck%get('sweep', 'costs', scene%sweep%costs)
    if (scene%sweep%costs .and. scene%deck%has_group('fit')) call scene%deck%mistake('sweep', &
      'costs', 'not of fits')
  end subroutine take_sweep

  !> Reads the cases from a file, or from keys with values or ranges.
  subroutine take_cases(scene)
    type(scene_t), intent(inout) :: scene
    integer :: i

    associate (deck => scene%deck, sweep => scene%sweep)
      if (deck%is_set('sweep', 'file')) then
        call refuse(deck, ['key   ', 'values', 'words ', of_range//' '], &
          'file, whose columns have the keys and values')
        if (.not. allocated(scene%deck%error)) call take_file(deck, sweep)
        if (.not. allocated(scene%deck%error)) call find_words(deck, sweep)
        return
      end if
      if (.not. deck%is_set('sweep', 'key')) then
        call deck%mistake('sweep', 'key', 'missing; give key, or file')
        return
      end if
      call deck%get('sweep', 'key', sweep%names)
      sweep%names = trim(adjustl(sweep%names))
      allocate (sweep%axis(word_count(sweep%names)))
      call find_words(deck, sweep)
      call take_words(deck, sweep)
      if (.not. allocated(scene%deck%error)) call take_numbers(deck, sweep)
      if (allocated(scene%deck%error)) return
      if (product([(real(size(sweep%axis(i)%values), wp), i=1, size(sweep%axis))]) > most_cases) &
        call deck%mistake('sweep', 'count', 'there are more than ' // brief(most_cases) // ' cases')
    end associate
  end subroutine take_cases

  !> Finds the words that each key may hold, and the key that holds a text.
  subroutine find_words(deck, sweep)
    type(deck_t), intent(in) :: deck
    type(sweep_t), intent(inout) :: sweep
    integer :: i

    allocate (sweep%words(word_count(sweep%names)))
    do i = 1, size(sweep%words)
      sweep%words(i) = words_of(deck, word_of(sweep%names, i))
      if (sweep%text_key == 0 .and. holds_text(deck, word_of(sweep%names, i))) sweep%text_key = i
    end do
  end subroutine find_words

  !> Reads the values of the key that holds a word or a text.
  subroutine take_words(deck, sweep)
    type(deck_t), intent(inout) :: deck
    type(sweep_t), intent(inout) :: sweep
    character(len=:), allocatable :: words, what
    logical :: wordy(size(sweep%words))
    integer :: i, k

    call deck%get('sweep', 'words', words)
    wordy = wordy_keys(sweep)
    k = findloc(wordy, .true., dim=1)
    if (count(wordy) > 1) then
      call deck%mistake('sweep', 'key', 'only one of the keys may hold a word; for more give ' // &
        'a file')
    else if (k == 0) then
      if (deck%is_set('sweep', 'words')) call deck%mistake('sweep', 'words', &
        quoted(sweep%names) // ' does not hold a word')
    else if (word_count(words) == 0) then
      call deck%mistake('sweep', 'words', 'missing; ' // quoted(word_of(sweep%names, k)) // &
        ' holds a ' // trim(merge('text', 'word', k == sweep%text_key)))
    else if (k == sweep%text_key) then
      call take_texts(deck, sweep)
    else
      allocate (sweep%axis(k)%values(word_count(words)))
      do i = 1, word_count(words)
        call number_of_word(word_of(words, i), sweep%words(k), sweep%axis(k)%values(i), what)
        if (allocated(what)) call deck%mistake('sweep', 'words', what)
        if (allocated(deck%error)) return
      end do
    end if
  end subroutine take_words

  !> Marks the keys that hold a word or a text.
  pure function wordy_keys(sweep) result(wordy)
    type(sweep_t), intent(in) :: sweep
    logical :: wordy(size(sweep%words))

    wordy = sweep%words /= ''
    if (sweep%text_key > 0) wordy(sweep%text_key) = .true.
  end function wordy_keys

  !> Reads the values of the keys that hold numbers: a list for one key, or ranges.
  subroutine take_numbers(deck, sweep)
    type(deck_t), intent(inout) :: deck
    type(sweep_t), intent(inout) :: sweep
    real(wp), allocatable :: values(:)
    logical :: wordy(size(sweep%words))
    integer, allocatable :: of_numbers(:)
    integer :: i

    wordy = wordy_keys(sweep)
    of_numbers = pack([(i, i=1, size(sweep%axis))], .not. wordy)
    call deck%get('sweep', 'values', values)
    if (size(of_numbers) == 0) then
      call refuse(deck, ['values', of_range//' '], 'a key that holds a word; give words')
    else if (size(values) == 0 .and. all(of_numbers == position_of(sweep, 'measurement.curve')) &
      .and. .not. any([(deck%is_set('sweep', trim(of_range(i))), i=1, size(of_range))])) then
      call take_curves(deck, sweep, sweep%axis(of_numbers(1))%values)
    else if (size(values) == 0) then
      call take_ranges(deck, sweep%axis, of_numbers)
    else if (size(of_numbers) > 1) then
      call deck%mistake('sweep', 'values', 'values are those of one key; for several give ' // &
        'from, to and count, or file')
    else
      call refuse(deck, of_range, 'values; give from, to and count, or values')
      sweep%axis(of_numbers(1))%values = values
    end if
  end subroutine take_numbers

  !> The number of a key; 0 if the sweep does not vary it.
  pure integer function position_of(sweep, key) result(k)
    type(sweep_t), intent(in) :: sweep
    character(len=*), intent(in) :: key

    do k = word_count(sweep%names), 1, -1
      if (lower(word_of(sweep%names, k)) == key) return
    end do
  end function position_of

  !> Refuses keys of &sweep that contradict the key `other`.
  subroutine refuse(deck, keys, other)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: keys(:), other
    integer :: i

    do i = 1, size(keys)
      if (deck%is_set('sweep', trim(keys(i)))) call deck%mistake('sweep', trim(keys(i)), &
        'not together with ' // other)
    end do
  end subroutine refuse

  !> Reads the cases of a file once, to check that every row is a valid case.
  subroutine take_file(deck, sweep)
    type(deck_t), intent(inout) :: deck
    type(sweep_t), intent(inout) :: sweep
    type(failure_t), allocatable :: trouble
    type(case_rows_t) :: rows
    type(case_file_t) :: file
    real(wp), allocatable :: values(:)
    logical :: found

    file%path = deck%path_of('sweep', 'file')
    call rows%open(file%path, deck, trouble)
    do while (.not. allocated(trouble))
      call rows%next(values, found, trouble)
      if (allocated(trouble) .or. .not. found) exit
      if (file%cases == nint(most_cases)) then
        call deck%mistake('sweep', 'file', quoted(file%path) // ' has more than ' // &
          brief(most_cases) // ' cases')
        exit
      end if
      call note_case(file, values, rows%text)
    end do
    call rows%close()
    call deck%note_file('sweep', 'file', rows%digest)
    if (allocated(trouble)) then
      call deck%mistake('sweep', 'file', trouble%message)
    else if (file%cases == 0) then
      call deck%mistake('sweep', 'file', quoted(file%path) // ' has no cases')
    else
      sweep%names = rows%names
      file%digest = rows%digest
      sweep%file = file
    end if
  end subroutine take_file

  !> Counts a case of a file, and keeps those values that show whether all values are allowed: the
  !> smallest, the largest, and the first that is not an integer.
  subroutine note_case(file, values, text)
    type(case_file_t), intent(inout) :: file
    real(wp), intent(in) :: values(:)
    character(len=*), intent(in) :: text
    logical :: telling(3)
    integer :: k

    file%cases = file%cases + 1
    file%last = values
    file%last_text = text
    if (file%cases == 1) then
      file%first = values
      file%first_text = text
      file%telling = spread(values, 1, size(telling))
      allocate (file%of_case(size(telling), size(values)), source=1)
      return
    end if
    do k = 1, size(values)
      associate (known => file%telling(:, k))
        telling = [values(k) < known(1), values(k) > known(2), &
          is_whole(known(3)) .and. .not. is_whole(values(k))]
        where (telling) known = values(k)
        where (telling) file%of_case(:, k) = file%cases
      end associate
    end do
  end subroutine note_case

  elemental logical function is_whole(value)
    real(wp), intent(in) :: value

    is_whole = .not. abs(value - anint(value)) > 0
  end function is_whole

end module sweep_group
