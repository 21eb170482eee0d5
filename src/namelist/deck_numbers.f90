!> The numbers of a deck by their names, "group.key" or "group.key(2)". Sweeps, sensitivities and
!> fits vary them. A sweep may also vary a word, represented by its number among the words of its
!> key, counted from 1; and a text, such as the name of a file.
module deck_numbers
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use text, only: lower, quoted, brief, guess, listing, clip, word_count, word_of
  use deck_keys, only: real_value, real_list, integer_value, word_value, text_value, allowed
  use deck_values, only: value_t, given, outside
  use deck_store, only: deck_t
  implicit none
  private
  public :: find_number, present_name, set_number, set_text, guess_number, words_of, &
    number_of_word, holds_text

  !> Kinds of keys that hold numbers.
  integer, parameter :: numeric(3) = [real_value, real_list, integer_value]

contains

  !> Finds the row of the key `path` ("force.hamaker") and the number of the list element in its
  !> name ("hydration.pressure(2)"), which is 0 without one. It fails if the table has no such key,
  !> if the key holds no numbers or too few, or if the deck lacks its group. `error` then has no
  !> position in the file; the caller adds the position. words: whether the key may also hold words,
  !> or a text.
  subroutine find_number(deck, path, row, term, error, words)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: path
    integer, intent(out) :: row, term
    type(failure_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: words
    character(len=:), allocatable :: name, group
    logical :: fits
    integer :: dot

    name = trim(lower(path))
    call take_off_term(name, term)
    dot = index(name // '.', '.')
    group = name(:dot - 1)
    row = 0
    if (dot < len(name)) row = deck%row_of(group, name(dot + 1:))
    if (row > 0) then
      fits = any(deck%specs(row)%kind == numeric)
      if (present(words)) fits = fits .or. (words .and. &
        any(deck%specs(row)%kind == [word_value, text_value]))
      if (.not. fits) row = 0
    end if
    if (row == 0) then
      call fail(error, bad_input, quoted(clip(path)) // ' is not a key that holds a number' // &
        guess_number(name, numbers_of(deck)) // '; allowed: ' // listing(numbers_of(deck), '', ''))
    else if (.not. deck%in_use(group)) then
      call fail(error, bad_input, 'the deck has no &' // group // ' for ' // quoted(name))
    else if (term > terms_in(deck%values(row))) then
      call fail(error, bad_input, quoted(name) // ' has no such term as ' // quoted(clip(path)))
    end if
  end subroutine find_number

  !> ' (did you mean "x"?)' if one of the blank-separated `names` resembles `name`, or equals `name`
  !> preceded by a group; otherwise ''.
  pure function guess_number(name, names) result(text)
    character(len=*), intent(in) :: name, names
    character(len=:), allocatable :: text
    integer :: i

    text = guess(name, names, '')
    if (index(name, '.') > 0) return
    do i = 1, word_count(names)
      if (index(word_of(names, i) // ' ', '.' // name // ' ') == 0) cycle
      text = ' (did you mean "' // word_of(names, i) // '"?)'
      return
    end do
  end function guess_number

  !> The key `path` with its present name, if `path` has a former name.
  pure function present_name(deck, path) result(name)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name
    integer :: dot, ending, row

    name = path
    dot = index(path, '.')
    ending = index(path // '(', '(')
    row = deck%row_of(path(:dot - 1), path(dot + 1:ending - 1))
    if (row > 0) name = path(:dot) // trim(deck%specs(row)%key) // path(ending:)
  end function present_name

  !> Removes an index such as "(2)" from the end of a name. term: the index; 0 if there is none.
  subroutine take_off_term(name, term)
    character(len=:), allocatable, intent(inout) :: name
    integer, intent(out) :: term
    integer :: opens, status

    term = 0
    opens = index(name, '(')
    if (opens < 2 .or. index(name, ')') /= len(name)) return
    read (name(opens + 1:len(name) - 1), '(i9)', iostat=status) term
    if (status /= 0 .or. term < 1) term = huge(term)
    name = name(:opens - 1)
  end subroutine take_off_term

  !> The words that the key `path` may hold, blank-separated; '' if it is no key that holds words.
  pure function words_of(deck, path) result(words)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: path
    character(len=len(deck%specs%choices)) :: words
    integer :: i

    words = ''
    do i = 1, size(deck%specs)
      if (deck%specs(i)%kind /= word_value) cycle
      if (trim(deck%specs(i)%group) // '.' // trim(deck%specs(i)%key) /= lower(path)) cycle
      words = deck%specs(i)%choices
    end do
  end function words_of

  !> Whether the key `path` holds a text.
  pure logical function holds_text(deck, path)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: path
    integer :: dot, row

    dot = index(path, '.')
    row = deck%row_of(lower(path(:dot - 1)), lower(path(dot + 1:)))
    holds_text = row > 0
    if (holds_text) holds_text = deck%specs(row)%kind == text_value
  end function holds_text

  !> The number of a word among the blank-separated `words`. what: the mistake if the word is not
  !> among them.
  subroutine number_of_word(word, words, number, what)
    character(len=*), intent(in) :: word, words
    real(wp), intent(out) :: number
    character(len=:), allocatable, intent(out) :: what
    integer :: i

    number = 0
    do i = 1, word_count(words)
      if (lower(trim(word)) == word_of(words, i)) number = i
    end do
    if (number <= 0) what = quoted(clip(word)) // ' is not known' // guess(lower(word), words, '') &
      // '; allowed: ' // listing(trim(words), "'", "'")
  end subroutine number_of_word

  !> How many numbers a key holds.
  pure integer function terms_in(value)
    type(value_t), intent(in) :: value

    terms_in = 0
    if (allocated(value%reals)) terms_in = size(value%reals)
  end function terms_in

  !> Blank-separated names 'group.key' of all keys that hold numbers, in the groups in use.
  pure function numbers_of(deck) result(names)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: names
    integer :: i

    names = ''
    do i = 1, size(deck%specs)
      if (all(deck%specs(i)%kind /= numeric)) cycle
      if (.not. deck%in_use(trim(deck%specs(i)%group))) cycle
      names = names // ' ' // trim(deck%specs(i)%group) // '.' // trim(deck%specs(i)%key)
    end do
  end function numbers_of

  !> Gives the key `path` a new value, as if the deck had given it. A word is given by its number. A
  !> list gets this single value, or one of its elements gets it. It fails as `find_number` does,
  !> and if the value is out of range.
  subroutine set_number(deck, path, value, error)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: path
    real(wp), intent(in) :: value
    type(failure_t), allocatable, intent(out) :: error
    integer :: row, term
    logical :: refused

    call find_number(deck, path, row, term, error, words=.true.)
    if (allocated(error)) return
    if (deck%specs(row)%kind == word_value) then
      deck%values(row)%text = word_of(trim(deck%specs(row)%choices), nint(value))
      deck%values(row)%status = given
      return
    end if
    associate (spec => deck%specs(row), stored => deck%values(row))
      refused = outside(spec, value)
      ! The values of a range are integers only up to rounding errors.
      if (spec%kind == integer_value .and. .not. refused) &
        refused = abs(value - anint(value)) > sqrt(epsilon(value))*abs(value)
      if (refused) then
        call fail(error, bad_input, brief(value) // ' is out of range for ' // quoted(path) // &
                  '; allowed: ' // allowed(spec))
        return
      end if
      if (spec%kind == integer_value) stored%whole = nint(value)
      if (term > 0) then
        stored%reals(term) = value
      else if (spec%kind /= integer_value) then
        stored%reals = [value]
      end if
      stored%status = given
    end associate
  end subroutine set_number

  !> Gives the key `path`, which holds a text, a new text, as if the deck had given it.
  subroutine set_text(deck, path, text, error)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: path, text
    type(failure_t), allocatable, intent(out) :: error
    integer :: row, term

    call find_number(deck, path, row, term, error, words=.true.)
    if (allocated(error)) return
    if (len(text) > deck%specs(row)%most) then
      call fail(error, bad_input, 'the text is too long for ' // quoted(path))
      return
    end if
    deck%values(row)%text = text
    deck%values(row)%status = given
  end subroutine set_text

end module deck_numbers
