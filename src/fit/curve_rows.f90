!> The rows of the file of a measured curve: position and signal in SI, and the segment's label.
module curve_rows
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use text, only: counted, quoted, rounded
  use deck_source, only: source_t
  use data_table, only: data_table_t, style_t, take_data_table
  use fit_request, only: measurement_t
  use units, only: find_unit
  implicit none
  private
  public :: curve_rows_t, read_curve_rows, fewest, of_pause, of_approach, of_retreat

  !> Kinds of segments.
  integer, parameter :: of_pause = 0, of_approach = 1, of_retreat = 2
  !> Smallest number of samples of a curve, and of an approach or a retreat.
  integer, parameter :: fewest = 20

  !> z [m], signal [N, or V] of the complete rows in the order of the file, or first those of the
  !> approach; code: the index of each row's label in `label`, if the file has a column of segments;
  !> kind: of each row's segment, once it is known. unit: of position and signal in the file;
  !> signal_in: as in `measurement_t`.
  !> incomplete: number of rows that are left out. columns_read: a description for the user.
  type :: curve_rows_t
    character(len=:), allocatable :: file, columns_read
    real(wp), allocatable :: z(:), signal(:)
    integer, allocatable :: code(:), kind(:)
    character(len=64), allocatable :: label(:)
    real(wp) :: unit(2) = 1
    character :: signal_in = ' '
    integer :: incomplete = 0
  end type curve_rows_t

contains

  !> Takes the columns of a measurement from the text of its file: position and signal; these and
  !> the segment; or position and signal of the approach and of the retreat, side by side.
  subroutine read_curve_rows(measurement, source, rows, error)
    type(measurement_t), intent(in) :: measurement
    type(source_t), intent(in) :: source
    type(curve_rows_t), intent(out) :: rows
    type(failure_t), allocatable, intent(out) :: error
    type(data_table_t) :: table
    type(style_t) :: style
    character(len=:), allocatable :: what
    logical, allocatable :: whole(:), more(:)
    integer :: n

    style%of_instrument = .true.
    style%skip_lines = measurement%skip_lines
    n = size(measurement%columns)
    if (n == 3) style%labels = 3
    call take_data_table(source, measurement%columns, style, table, error)
    if (allocated(error)) return
    rows%file = table%source%file
    if (size(table%place) == 0) then
      call fail(error, bad_input, rows%file // ': no row of numbers')
      return
    end if
    call scale_columns(measurement, table, rows%unit, rows%signal_in, what)
    if (allocated(what)) then
      call fail(error, bad_input, rows%file // ': ' // what)
      return
    end if
    whole = .not. any(table%missing(:, :min(n, 3)), 2)
    if (n == 4) whole = .not. any(table%missing(:, :2), 2)
    rows%z = pack(table%value(:, 1), whole)
    rows%signal = pack(table%value(:, 2), whole)
    rows%incomplete = count(.not. whole)
    if (n == 3) then
      rows%code = nint(pack(table%value(:, 3), whole))
      rows%label = table%label
    else if (n == 4) then
      more = .not. any(table%missing(:, 3:), 2)
      rows%kind = [spread(of_approach, 1, count(whole)), spread(of_retreat, 1, count(more))]
      rows%z = [rows%z, pack(table%value(:, 3), more)]
      rows%signal = [rows%signal, pack(table%value(:, 4), more)]
      ! The shorter of two ways ends before the file.
      rows%incomplete = gaps_in(whole) + gaps_in(more)
      call put_in_order(count(whole), rows)
    end if
    if (size(rows%z) < fewest) then
      what = 'a curve needs ' // counted(fewest, 'sample') // ' or more; the file has ' // &
        counted(size(rows%z), 'row')
      if (rows%incomplete > 0) what = what // ', and ' // counted(rows%incomplete, 'row') // &
        ' with an empty cell or NaN'
      call fail(error, bad_input, rows%file // ': ' // what)
      return
    end if
    rows%columns_read = 'position' // column_text(1) // ', signal' // column_text(2)

  contains

    !> ' "Force (nN)" in 1e-9 N'.
    function column_text(i) result(text)
      integer, intent(in) :: i
      character(len=:), allocatable :: text

      text = ''
      if (table%name(i) /= '') text = ' ' // quoted(trim(table%name(i)))
      text = text // ' in '
      if (abs(rows%unit(i) - 1) > 0) text = text // rounded(rows%unit(i)) // ' '
      if (i == 1) then
        text = text // 'm'
      else if (rows%signal_in == ' ') then
        text = text // 'V or m, times sensitivity'
      else
        text = text // rows%signal_in
        if (allocated(measurement%sensitivity)) text = text // ', times sensitivity'
      end if
    end function column_text

  end subroutine read_curve_rows

  !> Number of rows without a value before the last row that has one.
  pure integer function gaps_in(whole) result(gaps)
    logical, intent(in) :: whole(:)

    gaps = count(.not. whole(:findloc(whole, .true., 1, back=.true.)))
    if (.not. any(whole)) gaps = size(whole)
  end function gaps_in

  !> A retreat beside the approach may be in the order of the position and not of time. n: number of
  !> rows of the approach.
  pure subroutine put_in_order(n, rows)
    integer, intent(in) :: n
    type(curve_rows_t), intent(inout) :: rows

    associate (z => rows%z, signal => rows%signal)
      if (n < 2 .or. size(z) - n < 2) return
      if ((z(n) - z(1))*(z(size(z)) - z(n + 1)) <= 0) return
      z(n + 1:) = z(size(z):n + 1:-1)
      signal(n + 1:) = signal(size(signal):n + 1:-1)
    end associate
  end subroutine put_in_order

  !> Scales positions and signals to SI by the deck's units, by those in the file, or not at all.
  !> unit: those of the first position and signal. signal_in: as in `measurement_t`. what: why a
  !> unit cannot be right.
  subroutine scale_columns(measurement, table, unit, signal_in, what)
    type(measurement_t), intent(in) :: measurement
    type(data_table_t), intent(inout) :: table
    real(wp), intent(out) :: unit(2)
    character, intent(out) :: signal_in
    character(len=:), allocatable, intent(out) :: what
    real(wp) :: factor
    character :: base
    integer :: i, k

    signal_in = measurement%signal_in
    if (.not. allocated(measurement%sensitivity)) signal_in = 'N'
    do i = 1, size(measurement%columns)
      if (i == 3 .and. size(measurement%columns) == 3) exit
      k = 1 + mod(i - 1, 2)
      call find_unit(table%unit(i), factor, base)
      if (measurement%unit(k) > 0) then
        factor = measurement%unit(k)
      else if (k == 1 .and. scan(base, 'NV') > 0) then
        what = 'the position ' // quoted(trim(table%name(i))) // &
          ' is not a length; are the two columns exchanged?'
        return
      else if (k == 2 .and. scan(base, 'mV') > 0 .and. .not. allocated(measurement%sensitivity)) &
        then
        what = 'the signal ' // quoted(trim(table%name(i))) // ' is no force; sensitivity is ' // &
          'the deflection of the spring for one volt, or 1 for a deflection'
        return
      end if
      if (k == 2 .and. signal_in == ' ') signal_in = base
      table%value(:, i) = table%value(:, i)*factor
      if (i <= 2) unit(i) = factor
    end do
  end subroutine scale_columns

end module curve_rows
