!> The table of all groups and keys that a deck may hold, and its printed form.
module deck_keys
  use kinds, only: wp
  use text, only: brief, listing
  implicit none
  private
  public :: key_spec, group_row, ignored_group
  public :: real_value, real_list, integer_value, logical_value, word_value, text_value
  public :: names_value
  public :: group, real_key, list_key, integer_key, logical_key, word_key, text_key, names_key
  public :: allowed, names_of, is_of, write_keys

  !> Kinds of row: a group, a group that is skipped, and seven kinds of key.
  integer, parameter :: group_row = 0, ignored_group = 1
  integer, parameter :: real_value = 2, real_list = 3, integer_value = 4
  integer, parameter :: logical_value = 5, word_value = 6, text_value = 7
  integer, parameter :: names_value = 8

  !> One row of the table. The row of a group comes before those of its keys.
  type :: key_spec
    character(len=24) :: group = ''
    character(len=24) :: key = ''
    integer :: kind = group_row
    character(len=8) :: unit = ''
    !> The value of a key that the deck does not give; blank if there is none.
    character(len=32) :: default = ''
    !> Meaning of a blank default in words ("as in &loading"); shown, never read.
    character(len=48) :: otherwise = ''
    character(len=240) :: meaning = ''
    !> Blank-separated words that a `word_value` may be.
    character(len=80) :: choices = ''
    real(wp) :: low = -huge(1.0_wp)
    real(wp) :: high = huge(1.0_wp)
    !> Whether the interval excludes the bound itself.
    logical :: low_open = .false.
    logical :: high_open = .false.
    !> Largest number of values in a list, of numbers or names; of characters in a text.
    integer :: most = 1
    logical :: required = .false.
    !> For a group: its defaults hold and are written even if the deck does not name it.
    logical :: always = .false.
  end type key_spec

contains

  !> Row of a group.
  pure type(key_spec) function group(name, meaning, required, always, ignored) result(spec)
    character(len=*), intent(in) :: name, meaning
    logical, intent(in), optional :: required, always, ignored

    spec%group = name
    spec%meaning = meaning
    if (present(required)) spec%required = required
    if (present(always)) spec%always = always
    if (present(ignored)) then
      if (ignored) spec%kind = ignored_group
    end if
  end function group

  !> Row of a real key: `above` and `below` exclude the bound, `low` and `high` include it.
  pure function real_key(group, key, unit, meaning, default, otherwise, above, low, below, high, &
                         required) result(spec)
    character(len=*), intent(in) :: group, key, unit, meaning
    character(len=*), intent(in), optional :: default, otherwise
    real(wp), intent(in), optional :: above, low, below, high
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec = key_row(group, key, real_value, meaning, default, otherwise, required)
    spec%unit = unit
    if (present(low)) spec%low = low
    if (present(high)) spec%high = high
    if (present(above)) then
      spec%low = above
      spec%low_open = .true.
    end if
    if (present(below)) then
      spec%high = below
      spec%high_open = .true.
    end if
  end function real_key

  !> Row of a list of at most `most` reals; bounds as in `real_key`.
  pure function list_key(group, key, unit, meaning, most, otherwise, above, low, below, high, &
                         required) result(spec)
    character(len=*), intent(in) :: group, key, unit, meaning
    integer, intent(in) :: most
    character(len=*), intent(in), optional :: otherwise
    real(wp), intent(in), optional :: above, low, below, high
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec = real_key(group, key, unit, meaning, otherwise=otherwise, above=above, low=low, &
                    below=below, high=high, required=required)
    spec%kind = real_list
    spec%most = most
  end function list_key

  !> Row of a whole number between `low` and `high`.
  pure function integer_key(group, key, meaning, low, high, default, otherwise) result(spec)
    character(len=*), intent(in) :: group, key, meaning
    integer, intent(in) :: low, high
    character(len=*), intent(in), optional :: default, otherwise
    type(key_spec) :: spec

    spec = key_row(group, key, integer_value, meaning, default, otherwise)
    spec%low = low
    spec%high = high
  end function integer_key

  !> Row of a logical key.
  pure type(key_spec) function logical_key(group, key, meaning, default) result(spec)
    character(len=*), intent(in) :: group, key, meaning, default

    spec = key_row(group, key, logical_value, meaning, default)
  end function logical_key

  !> Row of a key that is one of the blank-separated words `choices`.
  pure function word_key(group, key, choices, meaning, default, otherwise, required) result(spec)
    character(len=*), intent(in) :: group, key, choices, meaning
    character(len=*), intent(in), optional :: default, otherwise
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec = key_row(group, key, word_value, meaning, default, otherwise, required)
    spec%choices = choices
  end function word_key

  !> Row of a free text of at most `most` characters.
  pure function text_key(group, key, most, meaning, default, otherwise, required) result(spec)
    character(len=*), intent(in) :: group, key, meaning
    integer, intent(in) :: most
    character(len=*), intent(in), optional :: default, otherwise
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec = key_row(group, key, text_value, meaning, default, otherwise, required)
    spec%most = most
  end function text_key

  !> Row of a list of at most `most` names, without blanks in them.
  pure function names_key(group, key, most, meaning, default, otherwise, required) result(spec)
    character(len=*), intent(in) :: group, key, meaning
    integer, intent(in) :: most
    character(len=*), intent(in), optional :: default, otherwise
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec = key_row(group, key, names_value, meaning, default, otherwise, required)
    spec%most = most
  end function names_key

  !> The components that the rows of all keys have.
  pure function key_row(group, key, kind, meaning, default, otherwise, required) result(spec)
    character(len=*), intent(in) :: group, key, meaning
    integer, intent(in) :: kind
    character(len=*), intent(in), optional :: default, otherwise
    logical, intent(in), optional :: required
    type(key_spec) :: spec

    spec%group = group
    spec%key = key
    spec%kind = kind
    spec%meaning = meaning
    if (present(default)) spec%default = default
    if (present(otherwise)) spec%otherwise = otherwise
    if (present(required)) spec%required = required
  end function key_row

  !> The values that a key may have, in words.
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

  !> The bounds of a number with its unit: " > 0 m", " from 2 to 60", or nothing.
  pure function bounds(spec) result(text)
    type(key_spec), intent(in) :: spec
    character(len=:), allocatable :: text
    logical :: below, above

    below = spec%low > -huge(1.0_wp)
    above = spec%high < huge(1.0_wp)
    text = ''
    if (below .and. above .and. .not. (spec%low_open .or. spec%high_open)) then
      text = ' from ' // brief(spec%low) // ' to ' // brief(spec%high)
    else
      if (below) text = merge(' > ', ' >=', spec%low_open)
      if (below) text = trim(text) // ' ' // brief(spec%low)
      if (below .and. above) text = text // ' and'
      if (above) text = text // trim(merge(' < ', ' <=', spec%high_open)) // ' ' // brief(spec%high)
    end if
    if (len_trim(spec%unit) > 0) then
      if (below .or. above) then
        text = text // ' ' // trim(spec%unit)
      else
        text = text // ' in ' // trim(spec%unit)
      end if
    end if
  end function bounds

  !> Whether a key may be left out, and its default, in words.
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

  !> Prints the table: a line `&group` for each group, then two lines for each of its keys.
  subroutine write_keys(specs, unit)
    type(key_spec), intent(in) :: specs(:)
    integer, intent(in) :: unit
    integer :: i, status

    do i = 1, size(specs)
      associate (spec => specs(i))
        select case (spec%kind)
        case (group_row)
          write (unit, '(/, 3a, /, 4x, a)', iostat=status) '&', trim(spec%group), &
            trim(merge(' (required)', '           ', spec%required)), trim(spec%meaning)
        case (ignored_group)
          write (unit, '(/, 3a, /, 4x, a)', iostat=status) '&', trim(spec%group), ' (skipped)', &
            trim(spec%meaning)
        case default
          write (unit, '(2x, 4a)', iostat=status) spec%key, allowed(spec), '; ', default_text(spec)
          write (unit, '(26x, a)', iostat=status) trim(spec%meaning)
        end select
      end associate
    end do
  end subroutine write_keys

  !> Whether each row belongs to the group or key `name`, 'group' or 'group.key'.
  pure function is_of(specs, name) result(rows)
    type(key_spec), intent(in) :: specs(:)
    character(len=*), intent(in) :: name
    logical :: rows(size(specs))
    integer :: dot

    dot = index(name // '.', '.')
    rows = specs%group == name(:dot - 1)
    if (dot < len(name)) rows = rows .and. (specs%key == name(dot + 1:) .or. &
      specs%kind == group_row .and. any(rows .and. specs%key == name(dot + 1:)))
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
