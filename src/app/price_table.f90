!> The text of the table of accuracy and cost: its rows, and the sentences below it.
module price_table
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp, nan
  use text, only: brief, rounded
  use sweep_case, only: case_t
  implicit none
  private
  public :: price_row_t, keys, head_of, text_of_row, conclusion_of

  !> The numbers whose errors are shown, and the names of their columns.
  character(len=*), parameter :: keys(*) = [character(len=17) :: 'max_tension', 'jump_in_h0', &
    'jump_out_h0', 'energy_lost', 'energy_dissipated', 'end_load']
  character(len=*), parameter :: names(*) = [character(len=11) :: 'pull-off', 'jump in', &
    'jump out', 'energy lost', 'dissipated', 'end load']
  !> Errors for each of which the table names the cheapest row.
  real(wp), parameter :: aims(*) = [1e-2_wp, 1e-3_wp, 1e-6_wp, 1e-9_wp]
  character(len=*), parameter :: aim_names(*) = [character(len=15) :: 'errors of 1 %', &
    'errors of 0.1 %', 'six digits', 'nine digits']
  integer, parameter :: width = 13
  character(len=1), parameter :: nl = new_line('a')

  !> One row: its case, time [s], estimated error, and the shown numbers with their relative errors.
  type :: price_row_t
    type(case_t) :: case
    real(wp) :: seconds = nan, nodes = nan, states = nan, products = nan, estimate = nan
    real(wp) :: value(size(keys)) = nan, error(size(keys)) = nan
  end type price_row_t

contains

  !> The title and the names of the columns. varied: the key whose values the rows have. shown:
  !> which of `keys` are columns.
  function head_of(name, varied, shown) result(text)
    character(len=*), intent(in) :: name, varied
    logical, intent(in) :: shown(:)
    character(len=:), allocatable :: text
    character(len=width) :: cells(6)

    cells = [character(len=width) :: varied(index(varied, '.') + 1:), 'time', 'nodes', 'states', &
      'products', 'error']
    text = name//': processor time without start and files, and estimated relative errors'//nl// &
      line_of([cells, pack([character(len=width) :: names], shown)])
  end function head_of

  !> The text of a row. Below it stands the reason of a failure, or the first warning unless it was
  !> `told` before.
  function text_of_row(row, shown, told) result(text)
    type(price_row_t), intent(in) :: row
    logical, intent(in) :: shown(:), told
    character(len=:), allocatable :: text
    character(len=width) :: cells(6 + count(shown))
    integer :: i, k

    cells = '-'
    cells(1) = brief(row%case%values(1))
    cells(2) = time_of(row%seconds)
    if (.not. ieee_is_nan(row%nodes)) cells(3) = brief(nint(row%nodes))
    if (.not. ieee_is_nan(row%states)) cells(4) = brief(nint(row%states))
    if (.not. ieee_is_nan(row%products)) cells(5) = brief(row%products)
    if (.not. ieee_is_nan(row%estimate)) cells(6) = two_digits(row%estimate)
    k = 6
    do i = 1, size(shown)
      if (.not. shown(i)) cycle
      k = k + 1
      if (.not. ieee_is_nan(row%error(i))) cells(k) = two_digits(row%error(i))
    end do
    text = line_of(cells)
    if (row%case%failure /= '') text = text//'    failed: '//trim(row%case%failure)//nl
    if (row%case%warning /= '' .and. .not. told) &
      text = text//'    warning: '//trim(row%case%warning)//nl
  end function text_of_row

  !> The sentences below the table: which row suffices for which error, what a further digit costs,
  !> and whether the rows agree.
  function conclusion_of(varied, row) result(text)
    character(len=*), intent(in) :: varied
    type(price_row_t), intent(in) :: row(:)
    character(len=:), allocatable :: text, key, purpose
    logical :: good(size(row))
    integer :: i, k, first, last
    real(wp) :: digits, off

    text = ''
    key = varied(index(varied, '.') + 1:)
    good = [(row(i)%case%converged .and. .not. ieee_is_nan(row(i)%estimate), i=1, size(row))]
    first = findloc(good, .true., dim=1)
    last = findloc(good, .true., dim=1, back=.true.)
    if (first == 0) return
    do i = 1, size(row)
      purpose = ''
      do k = 1, size(aims)
        if (first_below(aims(k)) == i) purpose = trim(aim_names(k))
      end do
      if (purpose == '') cycle
      text = text//key//' = '//brief(row(i)%case%values(1))//' is enough for '//purpose//': '// &
        time_of(row(i)%seconds)//nl
    end do
    if (text == '') text = 'no row has an estimated error below 1 %'//nl
    if (row(first)%estimate > 0 .and. row(last)%estimate > 0) then
      digits = log10(row(first)%estimate/row(last)%estimate)
      if (digits > 0.5_wp .and. row(last)%seconds > row(first)%seconds) &
        text = text//'each further digit costs '// &
        time_of((row(last)%seconds - row(first)%seconds)/digits)//', a factor of '// &
        rounded((row(last)%seconds/row(first)%seconds)**(1/digits))//nl
    end if
    do i = 1, last - 1
      if (.not. good(i)) cycle
      do k = 1, size(keys)
        if (index(keys(k), '_h0') > 0 .or. any(ieee_is_nan([row(i)%error(k), row(last)%error(k), &
          row(i)%value(k), row(last)%value(k)]))) cycle
        if (.not. abs(row(last)%value(k)) > 0) cycle
        off = abs(row(i)%value(k)/row(last)%value(k) - 1)
        if (off > row(i)%error(k) + row(last)%error(k)) text = text//'note: '// &
          trim(names(k))//' at '//brief(row(i)%case%values(1))// &
          ' differs from the last row by '//two_digits(off)//', more than estimated'//nl
      end do
    end do

  contains

    !> The index of the first row with an error of at most `aim`; 0 if there is none.
    pure integer function first_below(aim)
      real(wp), intent(in) :: aim

      do first_below = 1, size(row)
        if (.not. good(first_below)) cycle
        if (row(first_below)%estimate <= aim) return
      end do
      first_below = 0
    end function first_below

  end function conclusion_of

  !> A time as text with three digits.
  function time_of(seconds) result(text)
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: text

    if (ieee_is_nan(seconds)) then
      text = '-'
    else if (seconds < 1) then
      text = rounded(1000*seconds)//' ms'
    else
      text = rounded(seconds)//' s'
    end if
  end function time_of

  function two_digits(x) result(text)
    real(wp), intent(in) :: x
    character(len=:), allocatable :: text
    character(len=16) :: buffer

    write (buffer, '(es9.1e2)') x
    if (buffer(6:6) == 'E') buffer(6:6) = 'e'
    text = trim(adjustl(buffer))
  end function two_digits

  !> The line of the table with these cells.
  function line_of(cells) result(line)
    character(len=*), intent(in) :: cells(:)
    character(len=:), allocatable :: line
    integer :: i

    line = cells(1)
    do i = 2, size(cells)
      line = line//adjustr(cells(i)(:width - 1))//' '
    end do
    line = trim(line)//nl
  end function line_of

end module price_table
