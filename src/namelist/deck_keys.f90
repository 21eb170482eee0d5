!> The table of all groups and keys that a deck may hold, and its printed form.
module deck_keys
  use kinds, only: wp
  use text, only: brief, listing
  implicit none
  private
  public :: key_spec, group_row, ignored_group, real_value, real_list, integer_value, &
    logical_value, word_value, text_value, names_value, allowed, names_of, is_of, is_called, &
    keys_text

  !> Kinds of row: a group, an ignored group, and seven kinds of key.
  integer, parameter :: group_row = 0, ignored_group = 1
  integer, parameter :: real_value = 2, real_list = 3, integer_value = 4
  integer, parameter :: logical_value = 5, word_value = 6, text_value = 7
  integer, parameter :: names_value = 8

  !> One row of the table. The row of a group comes before those of its keys.
  type :: key_spec
    character(len=24) :: group = ''
    character(len=24) :: key = ''
    integer :: kind = group_row
    character(len=224) :: meaning = ''
    character(len=8) :: unit = ''
    !> The value of a key that the deck does not give; blank if there is none.
    character(len=32) :: default = ''
    !> What a blank default means, in words ("as in &loading"); it is shown, but never read.
    character(len=48) :: otherwise = ''
    !> For a key of kind `word_value`: the blank-separated words that it may hold. A group has no
    !> such words; for a group, the component has an example line of a deck, which is shown but
    !> never read. (Each deck has a copy of the table; a separate component for the example would
    !> cost 28 kB per deck.)
    character(len=80) :: choices = ''
    !> The bounds of a number. The values `low` and `high` are allowed; the values `above` and
    !> `below` are not.
    real(wp) :: low = -huge(1.0_wp), high = huge(1.0_wp), above = -huge(1.0_wp), &
      below = huge(1.0_wp)
    !> Largest number of values in a list of numbers or names; largest number of characters in a
    !> text.
    integer :: most = 1
    logical :: required = .false.
    !> For names: whether they may contain blanks.
    logical :: spaced = .false.
    !> For a group: its defaults apply and are written even if the deck does not name it.
    logical :: always = .false.
    !> An earlier name of the key, which decks may use instead.
    character(len=24) :: former = ''
  end type key_spec

contains

  !> A description of the values that a key may have.
  pure function allowed(spec) result(text)
    type(key_spec), intent(in) :: spec
    character(len=:), allocatable :: text

    select case (spec%kind)
    case (real_value)
      text = 'a number' // bounds(spec)
    case (real_list)
      text = 'up to ' // brief(spec%most) // ' numbers' // bounds(spec)
    case (integer_value)
      text = 'a whole number' // bounds(spec)
    case (logical_value)
      text = '.true. or .false.'
    case (word_value)
      text = 'one of ' // listing(spec%choices, "'", "'")
    case (text_value)
      text = 'text in quotes, at most ' // brief(spec%most) // ' characters'
    case (names_value)
      text = 'up to ' // brief(spec%most) // ' names in quotes'
    case default
      text = ''
    end select
  end function allowed

  !> The bounds of a number with its unit: " > 0 m", " from 2 to 60", or an empty text.
  pure function bounds(spec) result(text)
    type(key_spec), intent(in) :: spec
    character(len=:), allocatable :: text
    real(wp) :: least, most
    logical :: bounded(2), open(2)

    least = max(spec%low, spec%above)
    most = min(spec%high, spec%below)
    open = [spec%above > spec%low, spec%below < spec%high]
    bounded = [least > -huge(least), most < huge(most)]
    text = ''
    if (all(bounded) .and. .not. any(open)) then
      text = ' from ' // brief(least) // ' to ' // brief(most)
    else
      if (bounded(1)) text = merge(' > ', ' >=', open(1))
      if (bounded(1)) text = trim(text) // ' ' // brief(least)
      if (all(bounded)) text = text // ' and'
      if (bounded(2)) text = text // trim(merge(' < ', ' <=', open(2))) // ' ' // brief(most)
    end if
    if (len_trim(spec%unit) > 0) then
      if (any(bounded)) then
        text = text // ' ' // trim(spec%unit)
      else
        text = text // ' in ' // trim(spec%unit)
      end if
    end if
  end function bounds

  !> A text that says whether a key may be left out, and its default.
  pure function default_text(spec) result(text)
    type(key_spec), intent(in) :: spec
    character(len=:), allocatable :: text

    if (spec%required) then
      text = 'required'
    else if (len_trim(spec%default) > 0) then
      text = 'default ' // trim(spec%default)
    else if (len_trim(spec%otherwise) > 0) then
      text = 'default: ' // trim(spec%otherwise)
    else
      text = 'optional'
    end if
  end function default_text

  !> The table as text. For each group there are lines with `&group`, meaning and example, then two
  !> lines for each of its keys.
  pure function keys_text(specs) result(text)
    type(key_spec), intent(in) :: specs(:)
    character(len=:), allocatable :: text
    character(len=1), parameter :: nl = new_line('a')
    integer :: i

    text = ''
    do i = 1, size(specs)
      associate (spec => specs(i))
        select case (spec%kind)
        case (group_row)
          text = text // nl // '&' // trim(spec%group) // &
            trim(merge(' (required)', '           ', spec%required)) // nl
          text = text // '    ' // trim(spec%meaning) // nl
          if (spec%choices /= '') text = text // '    Example: ' // trim(spec%choices) // nl
        case (ignored_group)
          text = text // nl // '&' // trim(spec%group) // ' (skipped)' // nl
          text = text // '    ' // trim(spec%meaning) // nl
        case default
          text = text // '  ' // spec%key // allowed(spec) // '; ' // default_text(spec) // nl
          text = text // repeat(' ', 26) // trim(spec%meaning)
          if (spec%former /= '') text = text // ' Formerly ' // trim(spec%former) // '.'
          text = text // nl
        end select
      end associate
    end do
  end function keys_text

  !> Whether a row belongs to the key `name`, by its present or its former name. The row of a group
  !> has the key ''.
  elemental logical function is_called(spec, name)
    type(key_spec), intent(in) :: spec
    character(len=*), intent(in) :: name

    is_called = spec%key == name .or. (name /= '' .and. spec%former == name)
  end function is_called

  !> For each row, whether it belongs to the group or key `name`, given as 'group' or 'group.key'.
  pure function is_of(specs, name) result(rows)
    type(key_spec), intent(in) :: specs(:)
    character(len=*), intent(in) :: name
    logical :: rows(size(specs))
    integer :: dot

    dot = index(name // '.', '.')
    rows = specs%group == name(:dot - 1)
    if (dot < len(name)) rows = rows .and. (is_called(specs, name(dot + 1:)) .or. &
      specs%kind == group_row .and. any(rows .and. is_called(specs, name(dot + 1:))))
  end function is_of

  !> Blank-separated names of the keys of `group`, or of all groups if `group` is ''.
  pure function names_of(specs, group) result(names)
    type(key_spec), intent(in) :: specs(:)
    character(len=*), intent(in) :: group
    character(len=:), allocatable :: names
    integer :: i

    names = ''
    do i = 1, size(specs)
      if (specs(i)%kind == ignored_group) cycle
      if (group == '' .and. specs(i)%kind == group_row) names = names // ' ' // specs(i)%group
      if (group /= '' .and. specs(i)%group == group) names = names // ' ' // specs(i)%key
      names = trim(names)
    end do
  end function names_of

end module deck_keys
