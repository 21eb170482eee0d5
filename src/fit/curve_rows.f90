!> The rows of the file of a measured curve: position and signal in SI units, and the label of the
!> segment.
module curve_rows
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use text, only: counted, quoted, rounded
  use deck_source, only: source_t
  use data_table, only: data_table_t, style_t, take_data_table
  use fit_request, only: measurement_t, of_position, of_separation, of_load, of_segment, &
    of_radius
  use units, only: find_unit
  implicit none
  private
  public :: curve_rows_t, read_curve_rows, fewest, of_pause, of_approach, of_retreat

  !> Kinds of segments.
  integer, parameter :: of_pause = 0, of_approach = 1, of_retreat = 2
  !> Names of the quantities that are lengths.
  character(len=*), parameter :: lengths(of_position:of_radius) = [character(len=14) :: &
    'position', 'separation', '', '', 'contact radius']
  !> Smallest number of samples of a curve, and of its approach or retract.
  integer, parameter :: fewest = 20

  !> z [m] and signal [N, or V] of the complete rows, in the order of the file or with the approach
  !> first. radius [m]: the contact radius, if the file has it in addition; 0 in rows without a
  !> value. Without positions, z is the load and `signal` the contact radius. code: the index of
  !> each row's label in `label`, if the file has a column of segments. kind: the kind of each row's
  !> segment, once it is known. unit: the units of the columns in the file. signal_in: as in
  !> `measurement_t`. incomplete: number of rows left out. columns_read: a description of the
  !> columns for the user.
  type :: curve_rows_t
    character(len=:), allocatable :: file, columns_read
    real(wp), allocatable :: z(:), signal(:), radius(:)
    integer, allocatable :: code(:), kind(:)
    character(len=64), allocatable :: label(:)
    real(wp), allocatable :: unit(:)
    character :: signal_in = ' '
    integer :: incomplete = 0
  end type curve_rows_t

contains

  !> Takes the columns of a measurement from the text of its file.
  subroutine read_curve_rows(measurement, source, rows, error)
    type(measurement_t), intent(in) :: measurement
    type(source_t), intent(in) :: source
    type(curve_rows_t), intent(out) :: rows
    type(failure_t), allocatable, intent(out) :: error
    type(data_table_t) :: table
    type(style_t) :: style
    character(len=:), allocatable :: what
    logical, allocatable :: whole(:), more(:)
    integer :: z, signal, segment, radius, n
    logical :: side_by_side

    n = size(measurement%columns)
    z = findloc(measurement%quantity, of_position, 1)
    if (z == 0) z = findloc(measurement%quantity, of_separation, 1)
    signal = findloc(measurement%quantity, of_load, 1)
    radius = findloc(measurement%quantity, of_radius, 1)
    if (z == 0) then
      z = signal
      signal = radius
      radius = 0
    end if
    segment = findloc(measurement%quantity, of_segment, 1)
    side_by_side = count(measurement%quantity == of_load) == 2
    style%of_instrument = .true.
    style%skip_lines = measurement%skip_lines
    if (segment > 0) style%labels = segment
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
    if (radius > 0) then
      ! A row of the contact whose radius was not measured still has the other quantities.
      where (table%missing(:, radius)) table%value(:, radius) = 0
      table%missing(:, radius) = .false.
    end if
    whole = .not. any(table%missing(:, :merge(2, n, side_by_side)), 2)
    if (measurement%under_loads()) whole = whole .and. table%value(:, signal) > 0
    if (radius > 0) rows%radius = pack(max(table%value(:, radius), 0.0_wp), whole)
    rows%z = pack(table%value(:, z), whole)
    rows%signal = pack(table%value(:, signal), whole)
    rows%incomplete = count(.not. whole)
    if (segment > 0) then
      rows%code = nint(pack(table%value(:, segment), whole))
      rows%label = table%label
    else if (side_by_side) then
      more = .not. any(table%missing(:, 3:), 2)
      rows%kind = [spread(of_approach, 1, count(whole)), spread(of_retreat, 1, count(more))]
      rows%z = [rows%z, pack(table%value(:, 3), more)]
      rows%signal = [rows%signal, pack(table%value(:, 4), more)]
      ! If two segments stand side by side, the shorter one ends before the file does.
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
    rows%columns_read = 'position' // column_text(z)
    if (measurement%has(of_separation)) rows%columns_read = 'separation' // column_text(z)
    if (measurement%under_loads()) then
      rows%columns_read = 'load' // column_text(z) // ', contact radius' // column_text(signal)
    else
      rows%columns_read = rows%columns_read // ', signal' // column_text(signal)
    end if
    if (radius > 0) rows%columns_read = rows%columns_read // ', contact radius' // &
      column_text(radius)

  contains

    !> ' "Force (nN)" in 1e-9 N'.
    function column_text(i) result(text)
      integer, intent(in) :: i
      character(len=:), allocatable :: text

      text = ''
      if (table%name(i) /= '') text = ' ' // quoted(trim(table%name(i)))
      text = text // ' in '
      if (abs(rows%unit(i) - 1) > 0) text = text // rounded(rows%unit(i)) // ' '
      if (measurement%quantity(i) /= of_load) then
        text = text // 'm'
      else if (rows%signal_in == ' ') then
        text = text // 'V or m, times sensitivity'
      else if (rows%signal_in == 'R') then
        text = text // 'N/m, times the radius'
      else
        text = text // rows%signal_in
        if (allocated(measurement%sensitivity)) text = text // ', times sensitivity'
      end if
    end function column_text

  end subroutine read_curve_rows

  !> Number of incomplete rows before the last complete row.
  pure integer function gaps_in(whole) result(gaps)
    logical, intent(in) :: whole(:)

    gaps = count(.not. whole(:findloc(whole, .true., 1, back=.true.)))
    if (.not. any(whole)) gaps = size(whole)
  end function gaps_in

  !> Reverses a retract beside the approach that is sorted by position instead of time. n: number of
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

  !> Scales the columns to SI units by the deck's units, by those in the file, or not at all. unit:
  !> the factors. signal_in: as in `measurement_t`. what: the reason why a unit cannot be right.
  subroutine scale_columns(measurement, table, unit, signal_in, what)
    type(measurement_t), intent(in) :: measurement
    type(data_table_t), intent(inout) :: table
    real(wp), allocatable, intent(out) :: unit(:)
    character, intent(out) :: signal_in
    character(len=:), allocatable, intent(out) :: what
    character :: base
    integer :: i

    signal_in = measurement%signal_in
    allocate (unit(size(measurement%columns)), source=1.0_wp)
    do i = 1, size(unit)
      if (measurement%quantity(i) == of_segment) cycle
      call find_unit(table%unit(i), unit(i), base)
      if (measurement%unit(i) > 0) then
        unit(i) = measurement%unit(i)
      else if (measurement%quantity(i) /= of_load) then
        if (scan(base, 'NVR') > 0) what = 'the ' // &
          trim(lengths(measurement%quantity(i))) // ' ' // quoted(trim(table%name(i))) // &
          ' is not a length; are the two columns exchanged?'
      else if (allocated(measurement%sensitivity)) then
        if (base == 'R') what = 'the signal ' // quoted(trim(table%name(i))) // ' is a force ' // &
          'over a radius, and no deflection with sensitivity'
      else if (scan(base, 'mV') > 0) then
        what = 'the signal ' // quoted(trim(table%name(i))) // ' is no force; sensitivity is ' // &
          'the deflection of the spring for one volt, or 1 for a deflection'
      else if (base == 'R' .and. .not. measurement%radius > 0) then
        what = 'the signal ' // quoted(trim(table%name(i))) // ' is a force over a radius: it ' // &
          'needs radius in &bodies'
      end if
      if (allocated(what)) return
      if (measurement%quantity(i) == of_load .and. signal_in == ' ') signal_in = base
      table%value(:, i) = table%value(:, i)*unit(i)
    end do
    if (signal_in == ' ' .and. .not. allocated(measurement%sensitivity)) signal_in = 'N'
  end subroutine scale_columns

end module curve_rows
