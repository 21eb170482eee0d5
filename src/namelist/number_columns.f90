!> A text file of two columns of numbers. Blanks, tabs, commas or semicolons stand between them;
!> what follows a # is a comment.
module number_columns
  use kinds, only: wp
  use checksums, only: checksum
  use failure, only: failure_t
  use deck_number, only: parse_real
  use deck_source, only: source_t, load_source
  use deck_store, only: deck_t
  implicit none
  private
  public :: columns_t, read_columns, uncommented, between

  !> The file; its numbers, and where in its text each row stands.
  type :: columns_t
    type(source_t) :: source
    real(wp), allocatable :: first(:), second(:)
    integer, allocatable :: place(:)
  end type columns_t

  character(len=*), parameter :: newline = new_line('a')
  !> Blank and tab, comma, semicolon.
  character(len=*), parameter :: between = ' '//achar(9)//',;'

contains

  !> Reads the file that a key of the deck names; `error` says what is not two numbers, and where.
  subroutine read_columns(deck, group, key, columns, error)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, key
    type(columns_t), intent(out) :: columns
    type(failure_t), allocatable, intent(out) :: error
    real(wp) :: pair(2)
    integer :: first, last, n

    call load_source(deck%path_of(group, key), columns%source, error)
    if (allocated(error)) return
    call deck%note_file(group, key, checksum(columns%source%text))
    n = count([(columns%source%text(first:first) == newline, first=1, &
      len(columns%source%text))]) + 1
    allocate (columns%first(n), columns%second(n), columns%place(n))
    n = 0
    first = 1
    do while (first <= len(columns%source%text))
      last = first + index(columns%source%text(first:)//newline, newline) - 2
      if (verify(uncommented(columns%source%part(first, last)), between) > 0) then
        call read_pair(columns%source, first, last, pair, error)
        if (allocated(error)) return
        n = n + 1
        columns%first(n) = pair(1)
        columns%second(n) = pair(2)
        columns%place(n) = first
      end if
      first = last + 2
    end do
    columns%first = columns%first(:n)
    columns%second = columns%second(:n)
    columns%place = columns%place(:n)
  end subroutine read_columns

  !> A line without its comment.
  pure function uncommented(line) result(text)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: text

    text = line(:index(line//'#', '#') - 1)
  end function uncommented

  !> The two numbers of the line from `first` to `last`.
  subroutine read_pair(source, first, last, pair, error)
    type(source_t), intent(in) :: source
    integer, intent(in) :: first, last
    real(wp), intent(out) :: pair(2)
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: line, what
    integer :: i, start, finish

    pair = 0
    line = uncommented(source%part(first, last))//' '
    finish = 0
    do i = 1, 2
      start = finish + verify(line(finish + 1:), between)
      if (start == finish) then
        call source%complain(first, '', '', 'one number where two are expected', error)
        return
      end if
      finish = start + scan(line(start:), between) - 2
      call parse_real(line(start:finish), pair(i), what)
      if (allocated(what)) then
        call source%complain(first + start - 1, '', '', what, error)
        return
      end if
    end do
    start = verify(line(finish + 1:), between)
    if (start > 0) call source%complain(first + finish + start - 1, '', '', &
      'more than two numbers', error)
  end subroutine read_pair

end module number_columns
