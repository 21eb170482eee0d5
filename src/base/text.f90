!> Text tools: parts of messages, and numbers and strings as in a deck.
module text
  use kinds, only: wp
  use decimal, only: put_real, put_whole, longest_real
  implicit none
  private
  public :: lower, quoted, unquoted, brief, counted, rounded, rounded_to, full, guess, clip, &
    listing, listed, printable, word_count, word_of, first_line, held_blank, spelled, replaced

  !> Stands for a blank within a name, where blanks separate the names of a list.
  character, parameter :: held_blank = achar(31)
  !> Whole numbers below the first value and other numbers between the last two are written without
  !> an exponent.
  real(wp), parameter :: whole_below = 2.0e9_wp, plain(2) = [1.0e-3_wp, 1.0e4_wp]

  !> brief(x), brief(n): a number for a message, with the fewest digits that read back as the same.
  interface brief
    module procedure :: brief_real, brief_integer
  end interface brief

contains

  !> `text` in lower case (ASCII).
  pure function lower(text) result(small)
    character(len=*), intent(in) :: text
    character(len=len(text)) :: small
    integer :: i

    small = text
    do i = 1, len(text)
      if (text(i:i) >= 'A' .and. text(i:i) <= 'Z') small(i:i) = achar(iachar(text(i:i)) + 32)
    end do
  end function lower

  !> `text`, such as a file's name, on one line and without control sequences for the terminal:
  !> control characters become question marks, also those of UTF-8 (U+0080 to U+009F). Other
  !> characters stay as they are; so do the ends of lines if `lines` is .true.
  pure function printable(text, lines) result(clean)
    character(len=*), intent(in) :: text
    logical, intent(in), optional :: lines
    character(len=len(text)) :: clean
    logical :: on_one_line
    integer :: i

    on_one_line = .true.
    if (present(lines)) on_one_line = .not. lines
    clean = text
    do i = 1, len(text)
      if (text(i:i) == new_line('a') .and. .not. on_one_line) cycle
      if (iachar(text(i:i)) < 32 .or. iachar(text(i:i)) == 127) clean(i:i) = '?'
      if (i == 1) cycle
      if (text(i - 1:i - 1) == char(194) .and. text(i:i) >= char(128) .and. &
        text(i:i) <= char(159)) clean(i - 1:i) = '??'
    end do
  end function printable

  !> `text` as a namelist string: in single quotes, or in the quotes `mark`. Quotes of the same kind
  !> inside the text are doubled.
  pure function quoted(text, mark) result(literal)
    character(len=*), intent(in) :: text
    character, intent(in), optional :: mark
    character(len=:), allocatable :: literal
    character :: quote
    integer :: i

    quote = "'"
    if (present(mark)) quote = mark
    literal = quote
    do i = 1, len(text)
      literal = literal // text(i:i)
      if (text(i:i) == quote) literal = literal // quote
    end do
    literal = literal // quote
  end function quoted

  !> The text inside the quotes of `literal`, with doubled quotes made single.
  pure function unquoted(literal) result(text)
    character(len=*), intent(in) :: literal
    character(len=:), allocatable :: text
    character(len=len(literal)) :: buffer
    integer :: i, n

    i = 2
    n = 0
    do while (i < len(literal))
      n = n + 1
      buffer(n:n) = literal(i:i)
      i = i + merge(2, 1, literal(i:i) == literal(1:1))
    end do
    text = buffer(:n)
  end function unquoted

  !> `x` with 17 significant digits, enough to read `x` back.
  pure function full(x) result(text)
    real(wp), intent(in) :: x
    character(len=:), allocatable :: text
    character(len=longest_real) :: buffer
    integer :: length

    call put_real(x, buffer, length)
    text = buffer(:length)
  end function full

  pure function brief_real(x) result(text)
    real(wp), intent(in) :: x
    character(len=:), allocatable :: text
    character(len=40) :: buffer, form
    real(wp) :: back
    integer :: digits, status, mark, order

    if (abs(x) < whole_below .and. abs(x - anint(x)) <= 0.0_wp) then
      text = brief(nint(x))
      return
    end if
    do digits = 0, 16
      if (abs(x) >= plain(1) .and. abs(x) < plain(2)) then
        write (form, '(a, i0, a)') '(f30.', digits, ')'
      else
        write (form, '(a, i0, a)') '(es30.', digits, 'e3)'
      end if
      write (buffer, form) x
      read (buffer, *, iostat=status) back
      if (status == 0 .and. abs(back - x) <= 0.0_wp) exit
    end do
    text = trim(adjustl(buffer))
    ! 1.E-09 becomes 1e-9.
    mark = index(text, 'E')
    if (mark == 0) return
    read (text(mark + 1:), *, iostat=status) order
    if (status /= 0) return
    if (text(mark - 1:mark - 1) == '.') text(mark - 1:mark - 1) = ' '
    text = trim(text(:mark - 1)) // 'e' // brief(order)
  end function brief_real

  pure function brief_integer(n) result(text)
    integer, intent(in) :: n
    character(len=:), allocatable :: text
    character(len=longest_real) :: buffer
    integer :: length

    call put_whole(n, buffer, length)
    text = buffer(:length)
  end function brief_integer

  !> '1 case', '3 cases' for the noun 'case'.
  pure function counted(n, noun) result(text)
    integer, intent(in) :: n
    character(len=*), intent(in) :: noun
    character(len=:), allocatable :: text

    text = brief(n) // ' ' // noun
    if (n /= 1) text = text // 's'
  end function counted

  !> `x` for a message to three digits.
  pure function rounded(x) result(text)
    real(wp), intent(in) :: x
    character(len=:), allocatable :: text

    text = rounded_to(x, 0.0_wp)
  end function rounded

  !> `x` for a message, down to the second digit of its `error`, but with three digits at least.
  pure function rounded_to(x, error) result(text)
    real(wp), intent(in) :: x, error
    character(len=:), allocatable :: text
    character(len=32) :: buffer, form
    real(wp) :: near
    integer :: digits

    digits = 2
    if (abs(x) > 0 .and. error > 0) digits = max(2, min(15, floor(log10(abs(x))) - &
      floor(log10(error)) + 1))
    if (abs(x) < error) digits = 1
    write (form, '(a, i0, a)') '(es32.', digits, ')'
    write (buffer, form) x
    read (buffer, *) near
    text = brief(near)
  end function rounded_to

  !> Number of blank-separated words in `list`.
  pure integer function word_count(list) result(n)
    character(len=*), intent(in) :: list
    character(len=len(list) + 1) :: padded
    integer :: i

    padded = ' ' // list
    n = count([(padded(i:i) == ' ' .and. padded(i + 1:i + 1) /= ' ', i=1, len(list))])
  end function word_count

  !> Word number `n` of the blank-separated `list`.
  pure function word_of(list, n) result(word)
    character(len=*), intent(in) :: list
    integer, intent(in) :: n
    character(len=:), allocatable :: word
    integer :: i, first, length

    first = 1
    length = 0
    do i = 1, n
      first = first + verify(list(first:) // '#', ' ') - 1
      length = scan(list(first:) // ' ', ' ') - 1
      if (i < n) first = first + length
    end do
    word = list(first:first + length - 1)
  end function word_of

  !> A name from a list, with the blanks that it had.
  pure function spelled(word) result(name)
    character(len=*), intent(in) :: word
    character(len=len(word)) :: name

    name = replaced(word, held_blank, ' ')
  end function spelled

  !> `text` with the character `new` in place of each `old`.
  pure function replaced(text, old, new) result(other)
    character(len=*), intent(in) :: text
    character, intent(in) :: old, new
    character(len=len(text)) :: other
    integer :: i

    other = text
    do i = 1, len(text)
      if (text(i:i) == old) other(i:i) = new
    end do
  end function replaced

  !> Names for a message, in quotes; of many the first ones, and the number of the others.
  pure function listed(names) result(text)
    character(len=*), intent(in) :: names(:)
    character(len=:), allocatable :: text
    integer, parameter :: most = 12
    integer :: i

    text = ''
    do i = 1, min(most, size(names))
      if (i > 1) text = text // ', '
      text = text // quoted(trim(names(i)))
    end do
    if (size(names) > most) text = text // ' and ' // brief(size(names) - most) // ' more'
  end function listed

  !> The words of `list` as `<before>w1<after>, <before>w2<after>, ...`.
  pure function listing(list, before, after) result(text)
    character(len=*), intent(in) :: list, before, after
    character(len=:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, word_count(list)
      if (i > 1) text = text // ', '
      text = text // before // word_of(list, i) // after
    end do
  end function listing

  !> The word of the blank-separated `list` that `word` was probably meant to be, or ''.
  pure function likely(word, list) result(best)
    character(len=*), intent(in) :: word, list
    character(len=:), allocatable :: best
    integer :: i, distance, smallest

    best = ''
    if (len(word) > 63) return
    ! A word with up to a third of its letters wrong counts as misspelt, with more as another word.
    smallest = max(1, (len(word) + 1)/3) + 1
    do i = 1, word_count(list)
      distance = edits(lower(word), word_of(list, i))
      if (distance >= smallest) cycle
      smallest = distance
      best = word_of(list, i)
    end do
  end function likely

  !> ' (did you mean "x"?)' where one of the `names` is near `word`, else ''.
  pure function guess(word, names, before) result(text)
    character(len=*), intent(in) :: word, names, before
    character(len=:), allocatable :: text

    text = likely(word, names)
    if (len(text) > 0) text = ' (did you mean "' // before // text // '"?)'
  end function guess

  !> Fewest insertions, deletions, changes and swaps of neighbours that turn `a` into `b`.
  pure integer function edits(a, b)
    character(len=*), intent(in) :: a, b
    integer :: d(0:len(a), 0:len(b)), i, j

    d(:, 0) = [(i, i=0, len(a))]
    d(0, :) = [(j, j=0, len(b))]
    do j = 1, len(b)
      do i = 1, len(a)
        d(i, j) = min(d(i - 1, j) + 1, d(i, j - 1) + 1, &
                      d(i - 1, j - 1) + merge(0, 1, a(i:i) == b(j:j)))
        if (i < 2 .or. j < 2) cycle
        if (a(i:i) == b(j - 1:j - 1) .and. a(i - 1:i - 1) == b(j:j)) &
          d(i, j) = min(d(i, j), d(max(i - 2, 0), max(j - 2, 0)) + 1)
      end do
    end do
    edits = d(len(a), len(b))
  end function edits

  !> The beginning of a token, enough of it to be recognised in a message.
  pure function clip(token) result(text)
    character(len=*), intent(in) :: token
    character(len=:), allocatable :: text

    text = token
    if (len(token) > 40) text = token(:37) // '...'
  end function clip

  !> `text` up to the end of its first line.
  pure function first_line(text) result(line)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line

    line = text(:index(text // new_line('a'), new_line('a')) - 1)
  end function first_line

end module text
