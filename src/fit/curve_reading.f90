!> Reads a measured force curve: takes its samples from the rows of a file, finds approach and
!> retract, and refuses columns that cannot be those of a curve.
module curve_reading
  use kinds, only: wp
  use order_statistics, only: median_of
  use failure, only: failure_t, fail, bad_input
  use text, only: counted
  use deck_source, only: source_t
  use curve_rows, only: curve_rows_t, read_curve_rows, fewest, of_approach, of_retreat, of_pause
  use curve_segments, only: find_segments, small_part
  use fit_request, only: of_separation, of_load, of_radius, of_segment
  use measured_curve, only: measured_curve_t
  implicit none
  private
  public :: read_measured

  !> A base moves evenly, while a signal changes mostly near contact. Smallest ratio of the median
  !> to the mean of the changes from part to part of a curve in an even column (in an uneven one it
  !> is less than half of this), and the number of parts. Shortest and longest travel of a base [m].
  real(wp), parameter :: even = 0.5_wp, shortest = 1.0e-12_wp, longest = 1.0e-3_wp
  integer, parameter :: parts = 20

contains

  !> Reads the samples of a curve from the text of its file. If the file has separations and the
  !> device a spring, the positions of the base are computed once the direction towards the other
  !> body is known.
  subroutine read_measured(measured, source, error)
    type(measured_curve_t), intent(inout) :: measured
    type(source_t), intent(in) :: source
    type(failure_t), allocatable, intent(out) :: error
    type(failure_t), allocatable :: other
    type(measured_curve_t) :: trial
    type(curve_rows_t) :: rows, moved
    real(wp) :: facing
    integer :: i

    call read_curve_rows(measured%measurement_t, source, rows, error)
    if (allocated(error)) return
    if (.not. measured%under_loads()) call check_columns(rows%file, rows%z, rows%signal, error)
    if (allocated(error)) return
    if (.not. measured%has(of_separation) .or. .not. measured%spring_constant > 0) then
      call take_rows(measured, rows, error)
      return
    end if
    facing = likely_facing(rows%z)
    do i = 1, 2
      trial = measured
      moved = rows
      ! The deflection of the spring moves the bodies, but not the base.
      moved%z = rows%z - facing*deflection_of(measured, rows)
      call take_rows(trial, moved, other)
      if (.not. allocated(other) .and. trial%facing*facing > 0) then
        measured = trial
        if (allocated(error)) deallocate (error)
        return
      end if
      if (.not. allocated(error)) then
        if (allocated(other)) then
          error = other
        else
          call fail(error, bad_input, rows%file // ': with the deflection of the spring, the ' // &
            'base moves back and forth; check spring_constant, and whether the separation has ' // &
            'the deflection in it')
        end if
      end if
      facing = -facing
    end do

  end subroutine read_measured

  !> 1 if positions that begin far away fall towards the other body, otherwise -1.
  pure real(wp) function likely_facing(z) result(facing)
    real(wp), intent(in) :: z(:)
    real(wp) :: begin

    begin = sum(z(:max(1, nint(small_part*size(z)))))/max(1, nint(small_part*size(z)))
    facing = sign(1.0_wp, begin - z(maxloc(abs(z - begin), 1)))
  end function likely_facing

  !> The deflection of the spring in each row [m], positive under repulsion.
  pure function deflection_of(measured, rows) result(deflection)
    type(measured_curve_t), intent(in) :: measured
    type(curve_rows_t), intent(in) :: rows
    real(wp) :: deflection(size(rows%z)), newtons

    newtons = 1
    if (rows%signal_in == 'R') newtons = measured%radius
    if (allocated(measured%sensitivity)) newtons = measured%sensitivity*measured%spring_constant
    deflection = rows%signal*newtons/measured%spring_constant
  end function deflection_of

  !> Takes samples from rows.
  subroutine take_rows(measured, rows, error)
    type(measured_curve_t), intent(inout) :: measured
    type(curve_rows_t), intent(inout) :: rows
    type(failure_t), allocatable, intent(out) :: error
    logical, allocatable :: wanted(:), repeated(:)
    integer :: i

    if (measured%has(of_segment) .or. .not. measured%under_loads()) then
      call find_segments(rows, measured%measurement_t, error)
      if (allocated(error)) return
    else
      rows%kind = spread(of_retreat, 1, size(rows%z))
    end if
    associate (z => rows%z, signal => rows%signal, kind => rows%kind)
      ! A row that repeats the row before it has no new information.
      repeated = [.false., (.not. (abs(z(i) - z(i - 1)) > 0 .or. abs(signal(i) - signal(i - 1)) > &
        0 .or. kind(i) /= kind(i - 1)), i=2, size(z))]
      wanted = .not. repeated .and. kind /= of_pause
      if (measured%segment == 'approach') wanted = wanted .and. kind == of_approach
      if (measured%segment == 'retract') wanted = wanted .and. kind == of_retreat
      measured%z = [pack(z, wanted .and. kind == of_approach), pack(z, wanted .and. kind == &
        of_retreat)]
      measured%signal = [pack(signal, wanted .and. kind == of_approach), pack(signal, wanted .and. &
        kind == of_retreat)]
      measured%inward = [(.true., i=1, count(wanted .and. kind == of_approach)), &
        (.false., i=1, count(wanted .and. kind == of_retreat))]
    end associate
    if (allocated(rows%radius)) measured%contact_radius = [pack(rows%radius, wanted .and. &
      rows%kind == of_approach), pack(rows%radius, wanted .and. rows%kind == of_retreat)]
    measured%observed = spread(merge(of_radius, of_load, measured%under_loads()), 1, &
      size(measured%z))
    measured%unit = rows%unit
    measured%signal_in = rows%signal_in
    measured%skipped = [(any(measured%z(i) >= measured%skip(1::2) .and. &
      measured%z(i) <= measured%skip(2::2)), i=1, size(measured%z))]
    measured%usable = .not. measured%skipped
    if (measured%under_loads()) then
      ! Under dead loads there is one contact at each load, and the position is minus the load.
      measured%inward = spread(.false., 1, size(measured%z))
      measured%facing = -1
    else
      call find_facing(rows%file, measured, error)
    end if
    if (.not. allocated(error)) call describe()

  contains

    !> Describes how the file was understood.
    subroutine describe()
      measured%understood = rows%file // ': ' // rows%columns_read // '; '
      if (measured%under_loads()) then
        measured%understood = measured%understood // counted(size(measured%z), 'sample')
      else
        measured%understood = measured%understood // &
          counted(count(measured%inward), 'sample') // ' of the approach, ' // &
          counted(count(.not. measured%inward), 'sample') // ' of the retract'
      end if
      if (allocated(measured%contact_radius)) measured%understood = measured%understood // ', ' // &
        counted(count(measured%contact_radius > 0), 'row') // ' with a contact radius'
      call add(rows%incomplete, 'with an empty cell or NaN')
      call add(count(rows%kind == of_pause), 'of pauses or other segments')
      call add(count(repeated), 'like the row before')
      call add(count(measured%skipped), 'in skip')
    end subroutine describe

    subroutine add(n, which)
      integer, intent(in) :: n
      character(len=*), intent(in) :: which

      if (n == 0) return
      if (index(measured%understood, '; left out: ') == 0) then
        measured%understood = measured%understood // '; left out: '
      else
        measured%understood = measured%understood // ', '
      end if
      measured%understood = measured%understood // counted(n, 'row') // ' ' // which
    end subroutine add

  end subroutine take_rows

  !> Refuses columns that are exchanged, and positions that cannot be in metres.
  subroutine check_columns(file, z, signal, error)
    character(len=*), intent(in) :: file
    real(wp), intent(in) :: z(:), signal(:)
    type(failure_t), allocatable, intent(inout) :: error

    if (evenness_of(z) < even/2 .and. evenness_of(signal) > even) then
      call fail(error, bad_input, file // ': the signal changes evenly, the position does ' // &
        'not; are the two columns exchanged? columns gives their order')
    else if (maxval(z) - minval(z) > longest) then
      call fail(error, bad_input, file // ': positions span more than a millimetre; if they ' // &
        'are not in metres, give units, such as units = ''nm'', ''nN''')
    else if (maxval(z) - minval(z) < shortest) then
      call fail(error, bad_input, file // ': positions span less than a picometre; check ' // &
        'units and columns')
    end if

  contains

    !> The ratio of the median to the mean of the changes of a column between the means of its
    !> parts.
    pure real(wp) function evenness_of(number) result(evenness)
      real(wp), intent(in) :: number(:)
      real(wp) :: mean(parts)

      mean = means_of(number)
      associate (change => abs(mean(2:) - mean(:parts - 1)))
        evenness = median_of(change)/max(sum(change)/size(change), tiny(1.0_wp))
      end associate
    end function evenness_of

  end subroutine check_columns

  !> Finds the direction of z on the approach. Fails if a segment is too short or goes back, or if
  !> both segments have the same direction.
  subroutine find_facing(file, measured, error)
    character(len=*), intent(in) :: file
    type(measured_curve_t), intent(inout) :: measured
    type(failure_t), allocatable, intent(inout) :: error
    real(wp) :: travel(2)
    integer :: n(2)

    n = [count(measured%inward), count(.not. measured%inward)]
    if (any(n < fewest .and. n > 0) .or. sum(n) == 0) then
      call fail(error, bad_input, file // ': fewer than ' // counted(fewest, 'sample') // &
        ' of the approach or the retract (' // counted(n(1), 'sample') // ' of the approach, ' // &
        counted(n(2), 'sample') // ' of the retract); segment chooses the branches to fit, ' // &
        'and the third entry of columns is the column of the segments')
      return
    end if
    travel = 0
    if (n(1) > 0) travel(1) = travel_of(measured%z(:n(1)))
    if (n(2) > 0) travel(2) = -travel_of(measured%z(n(1) + 1:))
    if (travel(1)*travel(2) < 0) call fail(error, bad_input, file // ': z goes the same way ' // &
      'in approach and retract; is the third column 0 for approach and 1 for retract?')
    if (goes_back(pack(measured%z, measured%inward)) .or. &
      goes_back(pack(measured%z, .not. measured%inward))) call fail(error, bad_input, file // &
      ': z goes back and forth within the approach or the retract; a file has the rows of one ' // &
      'approach and one retract, in the order of time')
    measured%facing = merge(1.0_wp, -1.0_wp, sum(travel) < 0)
  end subroutine find_facing

  !> Whether z moves back and forth by much more than the distance between the ends of a segment. If
  !> so, the rows are not in order, or belong to several curves.
  pure logical function goes_back(z)
    real(wp), intent(in) :: z(:)
    real(wp), parameter :: much = 1.5_wp
    real(wp) :: mean(parts)

    goes_back = .false.
    if (size(z) < fewest) return
    mean = means_of(z)
    goes_back = sum(abs(mean(2:) - mean(:parts - 1))) > much*abs(mean(parts) - mean(1))
  end function goes_back

  pure function means_of(number) result(mean)
    real(wp), intent(in) :: number(:)
    real(wp) :: mean(parts)
    integer :: i, n

    n = size(number)
    mean = [(sum(number(1 + (i - 1)*n/parts:i*n/parts))/(i*n/parts - (i - 1)*n/parts), i=1, parts)]
  end function means_of

  !> The change of z from the beginning to the end of a segment.
  pure real(wp) function travel_of(z) result(travel)
    real(wp), intent(in) :: z(:)
    integer :: part

    part = max(1, nint(small_part*size(z)))
    travel = (sum(z(size(z) - part + 1:)) - sum(z(:part)))/part
  end function travel_of

end module curve_reading
