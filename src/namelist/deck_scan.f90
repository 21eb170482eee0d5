!> Namelist grammar: finds the groups and assignments of a deck and where each of them stands.
!>
!> The compiler's own namelist reader is not used: compiler note 9.
module deck_scan
  use failure, only: failure_t
  use text, only: lower
  use deck_source, only: source_t
  use deck_token, only: skip_blank, next_is_equals, take_word, take_string, is_name
  implicit none
  private
  public :: span_t, entry_t, scan_t, scan_deck

  !> A piece of the text: its first and last position.
  type :: span_t
    integer :: first = 0
    integer :: last = -1
  end type span_t

  !> One assignment `name = items`, where `items(first_item : first_item + n_items - 1)` are its
  !> values.
  type :: entry_t
    integer :: group = 0
    type(span_t) :: name
    integer :: first_item = 1
    integer :: n_items = 0
  end type entry_t

  !> What a deck says, in the order in which it says it.
  type :: scan_t
    integer :: n_groups = 0, n_entries = 0, n_items = 0
    !> Names of the groups, without `&`.
    type(span_t), allocatable :: groups(:)
    type(entry_t), allocatable :: entries(:)
    !> Values, quotes included.
    type(span_t), allocatable :: items(:)
  end type scan_t

  !> Where in a group the scanner is: the group and where its `&` stands, the key whose values are
  !> being read, and whether the last thing was a comma.
  type :: place_t
    character(len=:), allocatable :: group, key
    integer :: group_at = 0
    logical :: assigned = .false., after_comma = .false.
  end type place_t

contains

  !> Splits the text into groups and assignments; fails at the first break of the grammar.
  subroutine scan_deck(source, scan, error)
    type(source_t), intent(in) :: source
    type(scan_t), intent(out) :: scan
    type(failure_t), allocatable, intent(out) :: error
    integer :: at, start

    allocate (scan%groups(8), scan%entries(32), scan%items(32))
    at = 1
    do
      call skip_blank(source%text, at)
      if (at > len(source%text)) exit
      start = at
      if (source%text(at:at) /= '&') then
        call source%complain(at, '', '', stray(source%text, at, scan%n_groups), error)
        return
      end if
      at = at + 1
      call take_word(source, at, '', error)
      if (allocated(error)) return
      if (.not. is_name(source%text(start + 1:at - 1))) then
        call source%complain(start, '', '', 'a group name must follow "&" at once', error)
        return
      end if
      call push(scan%groups, scan%n_groups, span_t(start + 1, at - 1))
      call scan_group(source, at, scan, error)
      if (allocated(error)) return
    end do
  end subroutine scan_deck

  !> Says what is wrong with text that stands outside every group.
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
    end if
  end function stray

  !> Reads the assignments of the group just opened, up to its `/` or `&end`.
  subroutine scan_group(source, at, scan, error)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: at
    type(scan_t), intent(inout) :: scan
    type(failure_t), allocatable, intent(inout) :: error
    type(place_t) :: place
    integer :: start

    place%group_at = scan%groups(scan%n_groups)%first - 1
    place%group = lower(source%text(place%group_at + 1: &
      min(scan%groups(scan%n_groups)%last, place%group_at + 41)))
    place%key = ''
    do
      call skip_blank(source%text, at)
      start = at
      if (at > len(source%text)) then
        call source%complain(place%group_at, place%group, '', &
                             'not closed: no "/" before the end of the file', error)
        return
      end if
      select case (source%text(at:at))
      case ('/')
        at = at + 1
        call close_entry(source, start, at, scan, place, .true., error)
        return
      case ('&')
        call end_by_name(source, at, scan, place, error)
        return
      case (',')
        at = at + 1
        call take_comma(source, start, scan, place, error)
      case ('=')
        call source%complain(start, place%group, place%key, &
                             '"=" without the name of a key before it', error)
      case ('''', '"')
        call take_string(source, at, place%group, place%key, error)
        if (.not. allocated(error)) call add_value(source, start, at, scan, place, error)
      case default
        call take_word(source, at, place%group, error)
        if (allocated(error)) return
        if (next_is_equals(source%text, at)) then
          call close_entry(source, start, at, scan, place, .false., error)
          if (.not. allocated(error)) call open_entry(source, start, at, scan, place, error)
        else
          call add_value(source, start, at, scan, place, error)
        end if
      end select
      if (allocated(error)) return
    end do
  end subroutine scan_group

  !> At an `&` inside a group: the old end `&end`, or another group's beginning.
  subroutine end_by_name(source, at, scan, place, error)
    type(source_t), intent(in) :: source
    integer, intent(inout) :: at
    type(scan_t), intent(in) :: scan
    type(place_t), intent(in) :: place
    type(failure_t), allocatable, intent(inout) :: error
    integer :: start

    start = at
    at = at + 1
    call take_word(source, at, place%group, error)
    if (allocated(error)) return
    if (lower(source%text(start:at - 1)) == '&end') then
      call close_entry(source, start, at, scan, place, .true., error)
    else
      call source%complain(place%group_at, place%group, '', 'not closed: no "/" before the next "' &
                           // source%text(start:min(at - 1, start + 40)) // '"', error)
    end if
  end subroutine end_by_name

  !> Checks that the comma at `start` follows a value.
  subroutine take_comma(source, start, scan, place, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    type(scan_t), intent(in) :: scan
    type(place_t), intent(inout) :: place
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. place%assigned .or. place%after_comma) then
      call source%complain(start, place%group, place%key, 'a comma with no value before it', error)
    else if (scan%entries(scan%n_entries)%n_items == 0) then
      call source%complain(start, place%group, place%key, 'no value between "=" and the comma', &
                           error)
    end if
    place%after_comma = .true.
  end subroutine take_comma

  !> Checks that the assignment has a value that ends before text(start:at - 1): another key or, if
  !> `closing`, the end of the group.
  subroutine close_entry(source, start, at, scan, place, closing, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start, at
    type(scan_t), intent(in) :: scan
    type(place_t), intent(in) :: place
    logical, intent(in) :: closing
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: what

    if (.not. place%assigned) return
    if (scan%entries(scan%n_entries)%n_items > 0) return
    what = 'no value after "="'
    if (.not. closing) what = 'no value between "=" and the next key "' // &
      source%text(start:min(at - 1, start + 40)) // '"'
    call source%complain(scan%entries(scan%n_entries)%name%first, place%group, place%key, what, &
                         error)
  end subroutine close_entry

  !> Begins the assignment to the key text(start:at - 1) and goes beyond its "=".
  subroutine open_entry(source, start, at, scan, place, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start
    integer, intent(inout) :: at
    type(scan_t), intent(inout) :: scan
    type(place_t), intent(inout) :: place
    type(failure_t), allocatable, intent(inout) :: error

    place%key = lower(source%text(start:min(at - 1, start + 40)))
    if (index(place%key, '(') > 0) then
      place%key = place%key(:index(place%key, '(') - 1)
      call source%complain(start, place%group, place%key, &
                           'subscripts are not accepted; give the whole list after "="', error)
    else if (.not. is_name(source%text(start:at - 1))) then
      call source%complain(start, place%group, place%key, &
                           'not the name of a key: letters, digits and "_" only', error)
    end if
    if (allocated(error)) return
    call add_entry(scan, span_t(start, at - 1))
    call skip_blank(source%text, at)
    at = at + 1
    place%assigned = .true.
    place%after_comma = .false.
  end subroutine open_entry

  !> Adds the value text(start:at - 1) to the present assignment.
  subroutine add_value(source, start, at, scan, place, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: start, at
    type(scan_t), intent(inout) :: scan
    type(place_t), intent(inout) :: place
    type(failure_t), allocatable, intent(inout) :: error

    if (.not. place%assigned) then
      call source%complain(start, place%group, place%key, &
                           'a value without a key; write key = value', error)
      return
    end if
    call push(scan%items, scan%n_items, span_t(start, at - 1))
    associate (entry => scan%entries(scan%n_entries))
      entry%n_items = entry%n_items + 1
    end associate
    place%after_comma = .false.
  end subroutine add_value

  !> Appends `span` to the first `n` of `list`, which grows as needed.
  pure subroutine push(list, n, span)
    type(span_t), allocatable, intent(inout) :: list(:)
    integer, intent(inout) :: n
    type(span_t), intent(in) :: span
    type(span_t), allocatable :: more(:)

    if (n == size(list)) then
      allocate (more(2*n))
      more(:n) = list
      call move_alloc(more, list)
    end if
    n = n + 1
    list(n) = span
  end subroutine push

  !> Appends an assignment to the group now open; its values follow.
  subroutine add_entry(scan, name)
    type(scan_t), intent(inout) :: scan
    type(span_t), intent(in) :: name
    type(entry_t), allocatable :: more(:)

    if (scan%n_entries == size(scan%entries)) then
      allocate (more(2*scan%n_entries))
      more(:scan%n_entries) = scan%entries
      call move_alloc(more, scan%entries)
    end if
    scan%n_entries = scan%n_entries + 1
    scan%entries(scan%n_entries) = entry_t(scan%n_groups, name, scan%n_items + 1, 0)
  end subroutine add_entry

end module deck_scan
