!> The grammar of namelists: finds the groups and assignments of a deck, and their positions.
!>
!> The compiler's own namelist reader is not used because of compiler note 9.
module deck_scan
  use failure, only: failure_t
  use text, only: lower
  use deck_source, only: source_t, unprintable
  use deck_characters, only: newline, blank, skip_blank, next_is_equals, plain, is_name
  implicit none
  private
  public :: span_t, deck_entry_t, scan_t, scan_deck

  !> A part of the text, given by its first and last position.
  type :: span_t
    integer :: first = 0
    integer :: last = -1
  end type span_t

  !> One assignment `name = items` in group number `group`, with the values
  !> `items(first_item : first_item + n_items - 1)`.
  type :: deck_entry_t
    integer :: group = 0
    type(span_t) :: name
    integer :: first_item = 1
    integer :: n_items = 0
  end type deck_entry_t

  !> The content of a deck in its order: names of groups without `&`, assignments, and values with
  !> their quotes. The arrays may be longer than their contents.
  type :: scan_t
    integer :: n_groups = 0, n_entries = 0, n_items = 0
    type(span_t), allocatable :: groups(:)
    type(deck_entry_t), allocatable :: entries(:)
    type(span_t), allocatable :: items(:)
  end type scan_t

contains

  !> Splits the text into groups and assignments. It fails at the first error of grammar.
  subroutine scan_deck(source, found, error)
    type(source_t), intent(in) :: source
    type(scan_t), intent(out) :: found
    type(failure_t), allocatable, intent(out) :: error
    !> The present group, and the key whose values are being read.
    character(len=:), allocatable :: group, key
    !> The present position, the position where the present token begins, and that of the group's
    !> `&`.
    integer :: at, start, group_at
    !> Whether the group has an assignment already, and whether the last token was a comma.
    logical :: assigned, after_comma

    allocate (found%groups(8), found%entries(32), found%items(32))
    at = 1
    do
      call skip_blank(source%text, at)
      if (at > len(source%text)) exit
      start = at
      group = ''
      key = ''
      if (source%text(at:at) /= '&') then
        call complain(at, '', stray(source%text, at, found%n_groups))
        return
      end if
      at = at + 1
      call take_word()
      if (allocated(error)) return
      if (.not. is_name(source%text(start + 1:at - 1))) then
        call complain(start, '', 'a group name must follow "&" at once')
        return
      end if
      if (found%n_groups == size(found%groups)) found%groups = [found%groups, found%groups]
      found%n_groups = found%n_groups + 1
      found%groups(found%n_groups) = span_t(start + 1, at - 1)
      group = lower(source%text(start + 1:min(at - 1, start + 41)))
      group_at = start
      call scan_group()
      if (allocated(error)) return
    end do

  contains

    !> Reads the assignments of the group just opened, up to its `/` or `&end`.
    subroutine scan_group()
      assigned = .false.
      after_comma = .false.
      do while (.not. allocated(error))
        call skip_blank(source%text, at)
        start = at
        if (at > len(source%text)) then
          call complain(group_at, '', 'not closed: no "/" before the end of the file')
          return
        end if
        select case (source%text(at:at))
        case ('/')
          at = at + 1
          call close_entry('no value after "="')
          return
        case ('&')
          call end_by_name()
          return
        case (',')
          at = at + 1
          call take_comma()
        case ('=')
          call complain(start, key, '"=" without the name of a key before it')
        case ('''', '"')
          call take_string()
          if (.not. allocated(error)) call add_value()
        case default
          call take_word()
          if (allocated(error)) return
          if (next_is_equals(source%text, at)) then
            call close_entry('no value between "=" and the next key "' // present_thing() // '"')
            if (.not. allocated(error)) call open_entry()
          else
            call add_value()
          end if
        end select
      end do
    end subroutine scan_group

    !> Handles an `&` inside a group: the old end `&end`, or the beginning of another group.
    subroutine end_by_name()
      at = at + 1
      call take_word()
      if (allocated(error)) return
      if (lower(source%text(start:at - 1)) == '&end') then
        call close_entry('no value after "="')
      else
        call complain(group_at, '', 'not closed: no "/" before the next "' // present_thing() // &
          '"')
      end if
    end subroutine end_by_name

    subroutine take_comma()
      if (.not. assigned .or. after_comma) then
        call complain(start, key, 'a comma with no value before it')
      else if (found%entries(found%n_entries)%n_items == 0) then
        call complain(start, key, 'no value between "=" and the comma')
      end if
      after_comma = .true.
    end subroutine take_comma

    !> Checks that the assignment that ends here has a value. what: the mistake if it has none.
    subroutine close_entry(what)
      character(len=*), intent(in) :: what

      if (.not. assigned) return
      associate (entry => found%entries(found%n_entries))
        if (entry%n_items == 0) call complain(entry%name%first, key, what)
      end associate
    end subroutine close_entry

    !> Begins an assignment to the key just read, and moves `at` behind its "=".
    subroutine open_entry()
      key = lower(present_thing())
      if (index(key, '(') > 0) then
        key = key(:index(key, '(') - 1)
        call complain(start, key, 'subscripts are not accepted; give the whole list after "="')
      else if (.not. is_name(source%text(start:at - 1))) then
        call complain(start, key, 'not the name of a key: letters, digits and "_" only')
      else
        if (found%n_entries == size(found%entries)) found%entries = [found%entries, found%entries]
        found%n_entries = found%n_entries + 1
        found%entries(found%n_entries) = deck_entry_t(found%n_groups, span_t(start, at - 1), &
          found%n_items + 1, 0)
        call skip_blank(source%text, at)
        at = at + 1
        assigned = .true.
        after_comma = .false.
      end if
    end subroutine open_entry

    subroutine add_value()
      if (.not. assigned) then
        call complain(start, key, 'a value without a key; write key = value')
        return
      end if
      if (found%n_items == size(found%items)) found%items = [found%items, found%items]
      found%n_items = found%n_items + 1
      found%items(found%n_items) = span_t(start, at - 1)
      associate (entry => found%entries(found%n_entries))
        entry%n_items = entry%n_items + 1
      end associate
      after_comma = .false.
    end subroutine add_value

    !> Moves `at` behind a word. Parentheses and their contents belong to the word, so that a
    !> message can name a subscript.
    subroutine take_word()
      character(len=1) :: c
      logical :: inside

      inside = .false.
      do while (at <= len(source%text))
        c = source%text(at:at)
        if (c == newline) exit
        if (index(blank // ',=/!&', c) > 0 .and. .not. inside) exit
        if (c == '''' .or. c == '"') call complain(at, '', 'a quote in the middle of a word')
        if (.not. plain(c)) call complain(at, '', unprintable(source%text(at:)))
        if (allocated(error)) return
        if (c == '(') inside = .true.
        if (c == ')') inside = .false.
        at = at + 1
      end do
    end subroutine take_word

    !> Moves `at` behind a string, quotes included.
    subroutine take_string()
      character(len=1) :: quote, c

      quote = source%text(at:at)
      do
        at = at + 1
        c = newline
        if (at <= len(source%text)) c = source%text(at:at)
        if (c == newline) then
          call complain(start, key, 'this string has no closing ' // quote // ' on its line')
          return
        else if (c == quote) then
          at = at + 1
          if (at > len(source%text)) return
          if (source%text(at:at) /= quote) exit
        else if (.not. plain(c)) then
          call complain(at, key, unprintable(source%text(at:)))
          return
        end if
      end do
      if (index(blank // ',/!', source%text(at:at)) == 0) call complain(at, key, &
        'text right after a closing quote; a quote inside a string is written twice')
    end subroutine take_string

    !> The first characters of the token just read.
    pure function present_thing() result(text)
      character(len=:), allocatable :: text

      text = source%text(start:min(at - 1, start + 40))
    end function present_thing

    subroutine complain(where, key, what)
      integer, intent(in) :: where
      character(len=*), intent(in) :: key, what

      call source%complain(where, what, error, group, key)
    end subroutine complain

  end subroutine scan_deck

  !> A description of the mistake that text stands outside every group.
  pure function stray(text, at, n_groups) result(what)
    character(len=*), intent(in) :: text
    integer, intent(in) :: at, n_groups
    character(len=:), allocatable :: what

    if (text(at:at) == '/') then
      what = 'a "/" without a group to close'
    else if (text(at:at) == '$') then
      what = 'text outside a group; a group begins with "&name", not "$name"'
    else if (n_groups == 0) then
      what = 'text before the first group; a group begins with "&name", a comment with "!"'
    else
      what = 'text outside a group, after the "/" that closed the last one; ' // &
             'a group begins with "&name", a comment with "!"'
      if (text(at - 1:at - 1) == '/') what = what // &
        '; numbers have neither units nor fractions in a deck (42 N/m, 2/3)'
    end if
  end function stray

end module deck_scan
