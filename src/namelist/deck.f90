!> Reads any namelist file, and compares it with a table of the groups and keys it may hold.
!>
!> `read_deck` finds every mistake within a single key. The caller checks whether keys are
!> consistent with each other, and reports mistakes with `mistake`, which adds file, line, group and
!> key. The deck keeps all mistakes.
module deck
  use text, only: lower, brief, guess, listing, clip
  use deck_source, only: load_source, take_source
  use deck_scan, only: span_t, deck_entry_t, scan_t, scan_deck
  use deck_keys, only: key_spec, ignored_group, allowed, names_of
  use deck_values, only: assumed, given, interpret, convert
  use deck_store, only: deck_t
  implicit none
  private
  public :: deck_t, read_deck

  !> Largest number of mistakes that are reported.
  integer, parameter :: most_mistakes = 20

contains

  !> Reads `file`, or `text` if it is given, and compares it with the table `specs`. If `text` is
  !> given, `file` is only a name for messages. The deck's error lists the mistakes found, each as
  !> `FILE:LINE: &group: key "x": what is wrong, what is allowed` with the line and a caret below.
  subroutine read_deck(file, specs, deck, text)
    character(len=*), intent(in) :: file
    type(key_spec), intent(in) :: specs(:)
    type(deck_t), intent(out) :: deck
    character(len=*), intent(in), optional :: text
    type(scan_t) :: found
    integer :: mistakes

    deck%specs = specs
    allocate (deck%values(size(specs)))
    if (present(text)) then
      call take_source(file, text, deck%source, deck%error)
    else
      call load_source(file, deck%source, deck%error)
    end if
    if (allocated(deck%error)) return
    call scan_deck(deck%source, found, deck%error)
    if (allocated(deck%error)) return
    call take_entries()
    if (mistakes < most_mistakes) call complete()

  contains

    !> Enters the scanned groups and assignments into the values of the table.
    subroutine take_entries()
      integer :: rows(found%n_groups), i, at
      character(len=:), allocatable :: name, what

      mistakes = 0
      do i = 1, found%n_groups
        call open_group(found%groups(i), rows(i), what)
        if (allocated(what)) call report('', '', found%groups(i)%first - 1, what)
        if (mistakes == most_mistakes) return
      end do
      do i = 1, found%n_entries
        associate (row => rows(found%entries(i)%group))
          ! Keys of a group that is unknown, repeated or ignored are not checked.
          if (row == 0) cycle
          if (deck%specs(row)%kind == ignored_group) cycle
          name = deck%source%part(found%entries(i)%name%first, found%entries(i)%name%last)
          call take_entry(found%entries(i), trim(deck%specs(row)%group), at, what)
          if (allocated(what)) call report(trim(deck%specs(row)%group), lower(clip(name)), at, what)
        end associate
        if (mistakes == most_mistakes) return
      end do
    end subroutine take_entries

    subroutine report(group, key, where, what)
      character(len=*), intent(in) :: group, key, what
      integer, intent(in) :: where

      mistakes = mistakes + 1
      call deck%source%complain(where, what, deck%error, group, key)
      if (mistakes == most_mistakes) deck%error%message = deck%error%message // &
        new_line('a') // 'further mistakes are not shown'
    end subroutine report

    !> Finds the row of a group (0 if the group is unknown or repeated) and marks it as given.
    subroutine open_group(name, row, what)
      type(span_t), intent(in) :: name
      integer, intent(out) :: row
      character(len=:), allocatable, intent(out) :: what
      character(len=:), allocatable :: word

      word = lower(deck%source%part(name%first, name%last))
      row = deck%row_of(word, '')
      if (row == 0) then
        what = 'unknown group "&' // clip(word) // '"' // guess(word, names_of(deck%specs, ''), &
          '&') // '; groups are ' // listing(names_of(deck%specs, ''), '&', '')
      else if (deck%values(row)%status == given) then
        what = 'a second &' // word // '; the first is on line ' // &
          brief(deck%source%line_at(deck%values(row)%at))
        row = 0
      else
        deck%values(row)%status = given
        deck%values(row)%at = name%first - 1
      end if
    end subroutine open_group

    !> Enters one assignment. what: the mistake in it, at the position `at`; not allocated if there
    !> is none.
    subroutine take_entry(entry, group, at, what)
      type(deck_entry_t), intent(in) :: entry
      character(len=*), intent(in) :: group
      integer, intent(out) :: at
      character(len=:), allocatable, intent(out) :: what
      character(len=:), allocatable :: name, keys
      integer :: row

      at = entry%name%first
      name = lower(deck%source%part(entry%name%first, entry%name%last))
      row = deck%row_of(group, name)
      if (row == 0) then
        keys = names_of(deck%specs, group)
        what = 'no such key'
        if (len(keys) == 0) what = what // '; &' // group // ' has no keys'
        if (len(keys) > 0) what = what // guess(name, keys, '') // '; keys of &' // group // &
          ' are ' // listing(keys, '', '')
      else if (deck%values(row)%status == given) then
        what = 'given twice; the first is on line ' // &
          brief(deck%source%line_at(deck%values(row)%at))
        if (deck%values(row)%name /= name) what = what // ', as ' // deck%values(row)%name // &
          ', which means the same'
      else
        deck%values(row)%at = at
        deck%values(row)%name = name
        deck%values(row)%status = given
        call interpret(deck%source, deck%specs(row), found%items(entry%first_item:entry%first_item &
          + entry%n_items - 1), deck%values(row), at, what)
        if (allocated(what)) what = what // '; allowed: ' // allowed(deck%specs(row))
      end if
    end subroutine take_entry

    !> Fills in the table's defaults and reports required groups and keys that are missing.
    subroutine complete()
      character(len=:), allocatable :: group, key, what
      integer :: i

      do i = 1, size(deck%specs)
        if (deck%values(i)%status == given) cycle
        group = trim(deck%specs(i)%group)
        key = trim(deck%specs(i)%key)
        if (deck%specs(i)%required) then
          if (len(key) == 0) then
            call deck%mistake(group, '', 'this group is missing; every deck needs it')
          else if (deck%has_group(group)) then
            call deck%mistake(group, key, 'missing; give it ' // allowed(deck%specs(i)))
          end if
        else if (len_trim(deck%specs(i)%default) > 0) then
          call convert(deck%specs(i), trim(deck%specs(i)%default), deck%values(i), what)
          deck%values(i)%status = assumed
        end if
      end do
    end subroutine complete

  end subroutine read_deck

end module deck
