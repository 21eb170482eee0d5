!> A deck in memory: the value of each key, its position in the file, and the deck as text.
module deck_store
  use kinds, only: wp, long
  use failure, only: failure_t
  use files, only: whole_path, is_absolute
  use text_file, only: plain
  use deck_source, only: source_t
  use deck_keys, only: key_spec, group_row, is_called
  use deck_values, only: value_t, unset, following, given, assignment_text
  implicit none
  private
  public :: deck_t

  !> A deck that has been read. `read_deck` fills the components; others use the procedures.
  type :: deck_t
    type(source_t) :: source
    type(key_spec), allocatable :: specs(:)
    type(value_t), allocatable :: values(:)
    !> Whether runs of this deck vary its numbers. `resolved` then writes defaults that depend on
    !> other keys as comments, so that runs of the written deck derive them again.
    logical :: varied = .false.
    !> The mistakes found so far.
    type(failure_t), allocatable :: error
  contains
    procedure :: has_group
    procedure :: is_set
    procedure, private :: get_real, get_reals, get_integer, get_logical, get_text
    !> `call deck%get(group, key, value)`: the value in the deck, or the default. If there is
    !> neither, a scalar keeps its value, a list becomes empty and a text ''. `value` is a real, an
    !> allocatable list of reals, an integer, a logical or an allocatable text, according to the
    !> table.
    generic :: get => get_real, get_reals, get_integer, get_logical, get_text
    procedure, private :: assume_real, assume_reals, assume_text
    !> `call deck%assume(group, key, value)`: sets the default of a key that depends on other keys.
    !> `resolved` writes this default; a value in the deck has precedence.
    generic :: assume => assume_real, assume_reals, assume_text
    procedure, private :: get_optional_real, get_optional_integer
    !> The same as `get` for a scalar that is allocated only if the key has a value.
    generic :: get_optional => get_optional_real, get_optional_integer
    procedure :: path_of
    procedure :: placed
    procedure :: note_file
    procedure :: note_checksum
    procedure :: in_use
    procedure :: drop_group
    procedure :: mistake
    procedure :: resolved
    procedure :: row_of
    procedure, private :: held, silent
    procedure, private :: place, name_in_deck
  end type deck_t

contains

  !> Whether the deck holds `&group`.
  pure logical function has_group(self, group)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group

    has_group = self%is_set(group, '')
  end function has_group

  !> Whether the deck itself, and not a default, gives the key a value; for the key '', whether the
  !> deck opens the group.
  pure logical function is_set(self, group, key)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer :: row

    is_set = .false.
    row = self%row_of(group, key)
    if (row > 0) is_set = self%values(row)%status == given
  end function is_set

  !> Position of the key in the text. If the deck does not give the key, or if `key` is '', the
  !> position of the group; 0 if the deck gives neither.
  pure integer function place(self, group, key)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer :: row

    place = 0
    row = self%row_of(group, key)
    if (row > 0) place = self%values(row)%at
    if (place > 0) return
    row = self%row_of(group, '')
    if (row > 0) place = self%values(row)%at
  end function place

  !> Adds a mistake of `group` and `key` (both may be '') to the deck's error.
  pure subroutine mistake(self, group, key, what)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key, what

    call self%source%complain(self%place(group, key), what, self%error, group, &
      self%name_in_deck(group, key))
  end subroutine mistake

  !> The name that the deck uses for a key: its present or its former one.
  pure function name_in_deck(self, group, key) result(name)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    character(len=:), allocatable :: name
    integer :: row

    name = key
    row = self%row_of(group, key)
    if (row == 0) return
    if (allocated(self%values(row)%name)) name = self%values(row)%name
  end function name_in_deck

  pure subroutine get_real(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    real(wp), intent(inout) :: value
    integer :: row

    row = self%held(group, key)
    if (row > 0) value = self%values(row)%reals(1)
  end subroutine get_real

  pure subroutine get_reals(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    real(wp), allocatable, intent(inout) :: value(:)
    integer :: row

    value = [real(wp) ::]
    row = self%held(group, key)
    if (row > 0) value = self%values(row)%reals
  end subroutine get_reals

  pure subroutine get_integer(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(inout) :: value
    integer :: row

    row = self%held(group, key)
    if (row > 0) value = self%values(row)%whole
  end subroutine get_integer

  pure subroutine get_logical(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    logical, intent(inout) :: value
    integer :: row

    row = self%held(group, key)
    if (row > 0) value = self%values(row)%flag
  end subroutine get_logical

  pure subroutine get_text(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    character(len=:), allocatable, intent(inout) :: value
    integer :: row

    value = ''
    row = self%held(group, key)
    if (row > 0) value = self%values(row)%text
  end subroutine get_text

  pure subroutine get_optional_real(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    real(wp), allocatable, intent(out) :: value
    integer :: row

    row = self%held(group, key)
    if (row > 0) value = self%values(row)%reals(1)
  end subroutine get_optional_real

  pure subroutine get_optional_integer(self, group, key, value)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, allocatable, intent(out) :: value
    integer :: row

    row = self%held(group, key)
    if (row > 0) value = self%values(row)%whole
  end subroutine get_optional_integer

  pure subroutine assume_real(self, group, key, value)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    real(wp), intent(in) :: value

    call self%assume(group, key, [value])
  end subroutine assume_real

  pure subroutine assume_reals(self, group, key, value)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    real(wp), intent(in) :: value(:)
    integer :: row

    row = self%silent(group, key)
    if (row == 0) return
    self%values(row)%reals = value
    self%values(row)%status = following
  end subroutine assume_reals

  pure subroutine assume_text(self, group, key, value)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key, value
    integer :: row

    row = self%silent(group, key)
    if (row == 0) return
    self%values(row)%text = value
    self%values(row)%status = following
  end subroutine assume_text

  !> Path of the file that a key names.
  pure function path_of(self, group, key) result(path)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    character(len=:), allocatable :: path

    call self%get(group, key, path)
    path = self%placed(path)
  end function path_of

  !> A path of the deck. A relative path begins at the folder of the deck.
  pure function placed(self, path)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: placed

    placed = path
    if (.not. is_absolute(path)) placed = self%source%folder // path
  end function placed

  !> Stores the checksum of the file that a key names, and the file's absolute path, which is also
  !> valid in other folders. `resolved` writes both, so that a deck with a changed file counts as
  !> another deck.
  subroutine note_file(self, group, key, digest)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    integer(long), intent(in) :: digest
    character(len=:), allocatable :: path
    integer :: row

    row = self%row_of(group, key)
    path = whole_path(self%path_of(group, key))
    ! If a deck cannot hold the absolute path, the path is not replaced.
    if (len(path) <= self%specs(row)%most .and. plain(path) == path) self%values(row)%text = path
    call self%note_checksum(group, key, digest)
  end subroutine note_file

  !> Stores a checksum of what a key names.
  subroutine note_checksum(self, group, key, digest)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    integer(long), intent(in) :: digest
    character(len=8) :: number

    write (number, '(z8.8)') digest
    self%values(self%row_of(group, key))%remark = 'checksum ' // number
  end subroutine note_checksum

  !> Whether the deck has a group, or the group's defaults always apply.
  pure logical function in_use(self, group)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group

    in_use = self%has_group(group) .or. self%specs(self%row_of(group, ''))%always
  end function in_use

  !> Removes `&group` and its keys.
  subroutine drop_group(self, group)
    class(deck_t), intent(inout) :: self
    character(len=*), intent(in) :: group
    integer :: i

    do i = 1, size(self%specs)
      if (self%specs(i)%group == group) self%values(i) = value_t()
    end do
  end subroutine drop_group

  !> The deck as read, with defaults, as text that can be read again. It has the groups that the
  !> deck names, and the groups whose defaults always apply.
  pure function resolved(self) result(text)
    class(deck_t), intent(in) :: self
    character(len=:), allocatable :: text
    integer :: i, j

    text = ''
    do i = 1, size(self%specs)
      if (self%specs(i)%kind /= group_row) cycle
      if (.not. (self%specs(i)%always .or. self%values(i)%status == given)) cycle
      text = text // '&' // trim(self%specs(i)%group) // new_line('a')
      do j = i + 1, size(self%specs)
        if (self%specs(j)%group /= self%specs(i)%group) exit
        if (self%values(j)%status == unset) cycle
        if (self%varied .and. self%values(j)%status == following) text = text // '  !'
        text = text // assignment_text(self%specs(j), self%values(j))
      end do
      text = text // '/' // new_line('a')
    end do
  end function resolved

  !> Row of a key that has a value; 0 if the key has none.
  pure integer function held(self, group, key) result(row)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key

    row = self%row_of(group, key)
    if (row == 0) return
    if (self%values(row)%status == unset) row = 0
  end function held

  !> Row of a key to which the deck itself gives no value; 0 if the deck gives one.
  pure integer function silent(self, group, key) result(row)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key

    row = self%row_of(group, key)
    if (row == 0) return
    if (self%values(row)%status == given) row = 0
  end function silent

  !> Row of `group` and `key` (present or former name) in the table, or of the group itself if `key`
  !> is ''; 0 if there is no such row.
  pure integer function row_of(self, group, key)
    class(deck_t), intent(in) :: self
    character(len=*), intent(in) :: group, key

    do row_of = 1, size(self%specs)
      if (self%specs(row_of)%group == group .and. is_called(self%specs(row_of), key)) return
    end do
    row_of = 0
  end function row_of

end module deck_store
