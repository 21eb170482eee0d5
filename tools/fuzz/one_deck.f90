!> The promises for every deck, good or bad.
module one_deck
  use, intrinsic :: iso_c_binding, only: c_char, c_null_char
  use failure, only: failure_t, bad_input
  use scene, only: scene_t, read_scene
  use deck, only: deck_t
  use deck_values, only: unset
  implicit none
  private
  public :: read_one

contains

  !> Reads the deck `path` like `snapin --check` and stops with an error if a promise is broken: a
  !> refusal names the file and is short printable text; an accepted deck, written with its
  !> defaults, is accepted again with the same output.
  subroutine read_one(path) bind(c)
    character(kind=c_char), intent(in) :: path(*)
    type(scene_t) :: scene, again
    type(failure_t), allocatable :: error
    character(len=:), allocatable :: file
    integer :: n, unit

    n = 0
    do while (path(n + 1) /= c_null_char)
      n = n + 1
    end do
    allocate (character(len=n) :: file)
    file = transfer(path(:n), file)
    call read_scene(file, scene, error)
    if (allocated(error)) then
      call check_message(error, file)
      return
    end if
    open (newunit=unit, file=file // '.resolved', status='replace', action='write', &
      access='stream', form='unformatted')
    write (unit) scene%deck%resolved()
    close (unit)
    call read_scene(file // '.resolved', again, error)
    if (allocated(error)) then
      print '(a)', error%message
      error stop 'the resolved deck is refused'
    end if
    if (.not. same(scene%deck, again%deck)) error stop 'the resolved deck says something else'
  end subroutine read_one

  !> A message for users: about this file, of moderate length, without control characters.
  subroutine check_message(error, file)
    type(failure_t), intent(in) :: error
    character(len=*), intent(in) :: file
    integer, parameter :: longest = 40000
    integer :: i

    if (error%kind /= bad_input) error stop 'not a mistake in the deck'
    if (index(error%message, file // ':') /= 1) error stop 'a message without the file'
    if (len(error%message) > longest) error stop 'an endless message'
    do i = 1, len(error%message)
      ! Strings may contain tabs.
      if (any(error%message(i:i) == [new_line('a'), achar(9)])) cycle
      if (iachar(error%message(i:i)) < 32 .or. iachar(error%message(i:i)) > 126) &
        error stop 'a message with control characters'
    end do
  end subroutine check_message

  !> Whether two decks give all keys the same values.
  pure logical function same(a, b)
    type(deck_t), intent(in) :: a, b
    integer :: i

    same = .false.
    do i = 1, size(a%values)
      associate (x => a%values(i), y => b%values(i))
        if (a%specs(i)%key == '') cycle
        if ((x%status == unset) .neqv. (y%status == unset)) return
        if (x%status == unset) cycle
        if (allocated(x%reals) .neqv. allocated(y%reals)) return
        if (allocated(x%reals)) then
          if (size(x%reals) /= size(y%reals)) return
          if (any(abs(x%reals - y%reals) > 0)) return
        end if
        if (x%whole /= y%whole .or. (x%flag .neqv. y%flag)) return
        if (allocated(x%text) .neqv. allocated(y%text)) return
        if (allocated(x%text)) then
          if (x%text /= y%text .or. len(x%text) /= len(y%text)) return
        end if
      end associate
    end do
    same = .true.
  end function same

end module one_deck
