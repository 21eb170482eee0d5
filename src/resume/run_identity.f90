!> The identity of a run, and the difference of two identities. The identity is a text with
!> everything on which the numbers of the run depend. Only a run with the same identity can continue
!> an interrupted run.
module run_identity
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  use build_info, only: version, compiler, blas, options
  use c_library, only: c_openblas_config, c_build_id
  use text, only: brief
  use files, only: read_file
  use deck_number, only: parse_real
  implicit none
  private
  public :: identity_of, difference_between, find_finished

  character(len=1), parameter :: nl = new_line('a')
  !> The first words of the lines that stand before the deck.
  character(len=*), parameter :: program_line = 'program: ', libraries_line = 'libraries: '

contains

  !> The identity of a run of `deck`, the text of a resolved deck, by this program. It does not
  !> contain the number of threads, since each case of a sweep has one thread.
  function identity_of(deck) result(text)
    character(len=*), intent(in) :: deck
    character(len=:), allocatable :: text

    text = program_line // version // ' (build ' // build_number() // ')' // nl // &
      libraries_line // compiler // ', ' // blas_in_use() // ', ' // options // nl // deck
  end function identity_of

  !> The first difference between two identities, as text with advice.
  function difference_between(then, now) result(text)
    character(len=*), intent(in) :: then, now
    character(len=:), allocatable :: text
    character(len=:), allocatable :: old, new, group
    integer :: i, j

    i = 1
    j = 1
    group = ''
    do
      call next_line(then, i, old)
      call next_line(now, j, new)
      if (old /= new) exit
      if (i > len(then) .and. j > len(now)) exit
      if (index(old, '&') == 1) group = old
    end do
    if (index(old, program_line) == 1) then
      text = 'program ' // old(len(program_line) + 1:) // ', this is ' // &
        new(len(program_line) + 1:) // '; continue with that one'
    else if (index(old, libraries_line) == 1) then
      text = 'program made of ' // old(len(libraries_line) + 1:) // ', this one is made of ' // &
        new(len(libraries_line) + 1:) // '; continue with that one'
    else
      text = 'deck, ' // change(group, old, new, now) // '; put that back'
    end if
    text = text // ', or start over without --resume'
  end function difference_between

  !> The difference of two decks as text: in a group, one deck has the line `old`, the other (`now`)
  !> has the line `new`.
  function change(group, old, new, now) result(text)
    character(len=*), intent(in) :: group, old, new, now
    character(len=:), allocatable :: text
    integer :: a, b

    a = index(old, ' = ')
    b = index(new, ' = ')
    if (a > 0 .and. b > 0 .and. old(:max(a, 1)) == new(:max(b, 1))) then
      text = group // ' ' // trim(adjustl(old(:a))) // ' = ' // value(old(a + 3:)) // &
        ' instead of ' // value(new(b + 3:))
    else if (index(old, '&') == 1 .and. index(now, nl // old // nl) == 0) then
      text = 'one with ' // old
    else if (index(new, '&') == 1) then
      text = 'one without ' // new
    else
      text = 'another ' // group
    end if
  end function change

  !> The value of an assignment, written with as few digits as possible.
  function value(text) result(short)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: short
    character(len=:), allocatable :: what
    real(wp) :: number

    call parse_real(text, number, what)
    short = text
    if (.not. allocated(what)) short = brief(number)
  end function value

  !> The line of a text that begins at i; i moves to the next line. The line is empty at the end of
  !> the text.
  subroutine next_line(text, i, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: i
    character(len=:), allocatable, intent(out) :: line
    integer :: length

    line = ''
    if (i > len(text)) return
    length = index(text(i:) // nl, nl) - 1
    line = text(i:i + length - 1)
    i = i + length + 1
  end subroutine next_line

  !> The library of the linear algebra. For OpenBLAS it includes the type of processor, which
  !> affects the last digits of results.
  function blas_in_use() result(text)
    character(len=:), allocatable :: text
    character(len=256) :: config

    call c_openblas_config(config, len(config, kind=c_int))
    text = trim(config)
    if (text == '') text = blas
  end function blas_in_use

  !> A number that distinguishes builds of the same version: the first digits of the linker's
  !> checksum of the program, which `readelf -n` shows. Builds from the same sources have the same
  !> number.
  function build_number() result(text)
    character(len=:), allocatable :: text
    character(len=16) :: digits

    call c_build_id(digits, len(digits, kind=c_int))
    text = trim(digits)
    if (text == '') text = 'unknown'
  end function build_number

  !> Whether the folder's summary is that of the deck `resolved` (as text) by this version of the
  !> program. The summary is sufficient, since a run writes it last. converged: whether the run
  !> converged.
  subroutine find_finished(folder, resolved, finished, converged)
    character(len=*), intent(in) :: folder, resolved
    logical, intent(out) :: finished, converged
    character(len=:), allocatable :: text
    integer :: start

    finished = .false.
    converged = .false.
    call read_file(folder // '/summary.nml', text)
    if (.not. allocated(text)) return
    start = len(text) - len(resolved)
    if (start < 1) return
    ! In the summary the groups of results come first, then the deck.
    finished = text(start + 1:) == resolved .and. &
      index(text(:start), nl // '  version = ''' // version // '''' // nl) > 0
    converged = finished .and. index(text(:start), nl // '  converged = .true.' // nl) > 0
  end subroutine find_finished

end module run_identity
