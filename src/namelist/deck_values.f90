!> The value of one key: it is made from the tokens of an assignment, checked against the key's row
!> of the table, and written as text.
module deck_values
  use kinds, only: wp
  use text, only: lower, quoted, unquoted, brief, guess, clip, word_count, word_of, &
    held_blank, spelled, replaced
  use deck_number, only: parse_real, parse_integer, parse_logical
  use number_slips, only: unit_slip, comma_slip
  use deck_source, only: source_t
  use namelist_writer, only: assignment_of, add_item
  use deck_scan, only: span_t
  use deck_keys, only: key_spec, real_value, real_list, integer_value, logical_value, word_value, &
                       text_value, names_value
  implicit none
  private
  public :: value_t, unset, assumed, following, given, interpret, convert, outside, assignment_text

  !> Source of a value: there is none, the table, other keys of the deck, the deck itself.
  integer, parameter :: unset = 0, assumed = 1, following = 2, given = 3
  !> The value of one key. Only the component for the key's kind is used; names are in `text`,
  !> separated by blanks. For the row of a group, `at` is the position of the group in the deck.
  type :: value_t
    integer :: status = unset
    integer :: at = 0
    !> The name that the deck uses for the key, if the deck gives it.
    character(len=:), allocatable :: name
    real(wp), allocatable :: reals(:)
    integer :: whole = 0
    logical :: flag = .false.
    character(len=:), allocatable :: text
    !> Checksum of the file that the value names, written as a comment after the value; not
    !> allocated if no file was read.
    character(len=:), allocatable :: remark
  end type value_t

contains

  !> Converts the items of an assignment to a value of the kind of `spec`. what: the mistake, at the
  !> position `at`; not allocated if there is none.
  subroutine interpret(source, spec, items, value, at, what)
    type(source_t), intent(in) :: source
    type(key_spec), intent(in) :: spec
    type(span_t), intent(in) :: items(:)
    type(value_t), intent(inout) :: value
    integer, intent(inout) :: at
    character(len=:), allocatable, intent(out) :: what
    character(len=:), allocatable :: token
    logical :: literal, wanted
    integer :: i

    if (spec%kind == real_list) then
      allocate (value%reals(0))
    else if (spec%kind == names_value) then
      value%text = ''
    else if (size(items) > 1) then
      at = items(2)%first
      what = slip(2)
      if (what == '') what = brief(size(items)) // ' values where one is expected'
      return
    end if
    wanted = any(spec%kind == [word_value, text_value, names_value])
    do i = 1, size(items)
      at = items(i)%first
      token = source%part(items(i)%first, items(i)%last)
      literal = token(1:1) == '''' .or. token(1:1) == '"'
      if (literal .and. .not. wanted) then
        what = clip(token) // ' is text in quotes'
      else if (wanted .and. .not. literal .and. .not. is_number(spec, token)) then
        what = clip(token) // ' is not in quotes'
      else
        if (literal) token = unquoted(token)
        call convert(spec, token, value, what)
      end if
      if (.not. allocated(what)) cycle
      if (slip(i) /= '') what = slip(i)
      return
    end do

  contains

    !> A suggestion for item i, which should be a number and is not.
    pure function slip(i) result(advice)
      integer, intent(in) :: i
      character(len=:), allocatable :: advice, before, token

      advice = ''
      if (all(spec%kind /= [real_value, real_list])) return
      before = ''
      if (i > 1) before = source%part(items(i - 1)%first, items(i - 1)%last)
      token = source%part(items(i)%first, items(i)%last)
      advice = unit_slip('', token, trim(spec%unit))
      if (advice == '') advice = unit_slip(before, token, trim(spec%unit))
      if (advice /= '' .or. size(items) /= 2 .or. i /= 2 .or. spec%kind /= real_value) return
      if (items(2)%first == items(1)%last + 2 .and. source%part(items(1)%last + 1, &
        items(1)%last + 1) == ',') advice = comma_slip(before, token)
    end function slip

  end subroutine interpret

  !> Whether a token is a word or a name that consists of digits, for which quotes are optional.
  pure logical function is_number(spec, token)
    type(key_spec), intent(in) :: spec
    character(len=*), intent(in) :: token

    is_number = any(spec%kind == [word_value, names_value]) .and. &
      verify(token, '0123456789') == 0
  end function is_number

  !> Converts one token, without quotes, and checks it against the bounds of `spec`. An element of a
  !> list, or a name, is appended to the value.
  subroutine convert(spec, token, value, what)
    type(key_spec), intent(in) :: spec
    character(len=*), intent(in) :: token
    type(value_t), intent(inout) :: value
    character(len=:), allocatable, intent(out) :: what
    real(wp) :: x
    integer :: star, times, i

    select case (spec%kind)
    case (real_value, real_list)
      ! A repeat count such as 3*1.0, which other namelist writers use.
      star = index(token, '*')
      times = 1
      if (star > 0) call parse_integer(token(:star - 1), times, what)
      if (allocated(what) .or. times < 1 .or. star == len(token)) then
        what = clip(token) // ' is not a number'
        return
      end if
      call parse_real(token(star + 1:), x, what)
      if (allocated(what)) return
      if (outside(spec, x)) then
        what = clip(token) // ' is out of range'
      else if (spec%kind == real_value) then
        if (star > 0) what = clip(token) // ' is a list of repeated values where one is expected'
        value%reals = [x]
      else if (times > spec%most - size(value%reals)) then
        what = 'too many values'
      else
        value%reals = [value%reals, [(x, i=1, times)]]
      end if
    case (integer_value)
      call parse_integer(token, value%whole, what)
      if (allocated(what)) return
      if (outside(spec, real(value%whole, wp))) what = clip(token) // ' is out of range'
    case (logical_value)
      call parse_logical(token, value%flag, what)
    case (word_value)
      value%text = trim(lower(token))
      if (len(value%text) > 0 .and. index(' ' // trim(spec%choices) // ' ', ' ' // value%text // &
        ' ') > 0 .and. index(value%text, ' ') == 0) return
      what = quoted(clip(token)) // ' is not known' // guess(value%text, spec%choices, '')
    case (text_value)
      value%text = trim(token)
      if (len(value%text) > spec%most) what = 'the text is too long'
    case (names_value)
      if (word_count(token) == 0 .or. (word_count(token) > 1 .and. .not. spec%spaced)) then
        what = quoted(clip(token)) // ' is not one name'
      else if (word_count(value%text) == spec%most) then
        what = 'too many values'
      else
        value%text = value%text // ' ' // replaced(trim(adjustl(token)), ' ', held_blank)
      end if
    end select
  end subroutine convert

  !> Whether `x` is outside the bounds of `spec`; NaN counts as outside.
  pure logical function outside(spec, x)
    type(key_spec), intent(in) :: spec
    real(wp), intent(in) :: x

    outside = .not. (x >= spec%low .and. x <= spec%high .and. x > spec%above .and. x < spec%below)
  end function outside

  !> An assignment as text for a deck; a long list takes several lines.
  pure function assignment_text(spec, value) result(text)
    type(key_spec), intent(in) :: spec
    type(value_t), intent(in) :: value
    character(len=:), allocatable :: text
    logical, allocatable :: flag
    integer :: column, i

    text = ''
    select case (spec%kind)
    case (real_value, real_list)
      text = assignment_of(trim(spec%key), value%reals)
    case (integer_value)
      call add_item(trim(spec%key), brief(value%whole), text, column)
    case (logical_value)
      flag = value%flag
      text = assignment_of(trim(spec%key), flag)
    case (names_value)
      do i = 1, word_count(value%text)
        call add_item(trim(spec%key), quoted(spelled(word_of(value%text, i))), text, column)
      end do
    case default
      call add_item(trim(spec%key), quoted(value%text), text, column)
    end select
    if (allocated(value%remark)) text = text(:len(text) - 1) // ' ! ' // value%remark // &
      new_line('a')
  end function assignment_text

end module deck_values
