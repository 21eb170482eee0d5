!> A measured force curve (`measurement_t`): the deflection of a spring, or the force, while its
!> base moves to the other body and back.
module measured_curve
  use kinds, only: wp
  use noise, only: median_of
  use failure, only: failure_t, fail, bad_input
  use data_table, only: data_table_t, read_data_table
  use fit_request, only: measurement_t
  implicit none
  private
  public :: measured_t, read_measured

  !> Samples in the order of the file, the approach first. The contact point is the z at which
  !> undeformed bodies under a relaxed spring would touch. The position of the drive (`drive_t`) is
  !> facing*(z - contact point); facing is 1 if z falls towards the other body, else -1.
  type, extends(measurement_t) :: measured_t
    real(wp), allocatable :: z(:), signal(:)
    logical, allocatable :: inward(:)
    real(wp) :: facing = 1
    !> Samples far from contact, which show the baseline, once they are known.
    logical, allocatable :: far(:)
    !> Samples in use: neither outliers nor skipped, by the deck or since the base rested.
    logical, allocatable :: usable(:), skipped(:), rested(:)
  contains
    procedure :: outlier
  end type measured_t

  !> Smallest number of samples of a way.
  integer, parameter :: fewest = 20
  !> Median over mean of the changes from part to part of a curve, and the number of parts: a base
  !> moves evenly, and a signal changes mostly near contact. Shortest and longest travel of a base
  !> [m].
  real(wp), parameter :: even = 0.5_wp, uneven = 0.25_wp, shortest = 1.0e-12_wp, longest = 1.0e-3_wp
  integer, parameter :: parts = 20
  !> The part of a way's samples at either end within which a turn does not count, and over which
  !> the ends are averaged.
  real(wp), parameter :: end_part = 0.1_wp

contains

  !> Marks the outliers.
  pure function outlier(self)
    class(measured_t), intent(in) :: self
    logical :: outlier(size(self%z))

    outlier = .not. (self%usable .or. self%skipped)
  end function outlier

  !> Reads the samples of a curve from its file. A third column has the way of each sample: 0
  !> approach, 1 retreat. Without it the ways are separated at the turn of z.
  subroutine read_measured(measured, error)
    type(measured_t), intent(inout) :: measured
    type(failure_t), allocatable, intent(out) :: error
    type(data_table_t) :: table
    logical, allocatable :: wanted(:)
    integer :: i

    call read_data_table(measured%file, measured%columns, table, error)
    if (allocated(error)) return
    table%value(:, 1) = table%value(:, 1)*measured%unit(1)
    table%value(:, 2) = table%value(:, 2)*measured%unit(2)
    associate (z => table%value(:, 1), signal => table%value(:, 2))
      if (size(z) < fewest) then
        call fail(error, bad_input, table%source%file // ': a curve needs 20 samples or more')
        return
      end if
      call check_columns(table%source%file, z, signal, error)
      if (allocated(error)) return
      if (size(measured%columns) > 2) then
        do i = 1, size(z)
          if (any(abs(table%value(i, 3) - [0, 1]) <= 0)) cycle
          call table%source%complain(table%place(i), &
            'the segment is neither 0, approach, nor 1, retreat', error)
          return
        end do
        measured%inward = nint(table%value(:, 3)) == 0
      else
        measured%inward = before_turn(z, measured%segment)
      end if
      ! A row that repeats the one before it tells nothing new.
      wanted = [.true., (abs(z(i) - z(i - 1)) > 0 .or. abs(signal(i) - signal(i - 1)) > 0 .or. &
        (measured%inward(i) .neqv. measured%inward(i - 1)), i=2, size(z))]
      if (measured%segment == 'approach') wanted = wanted .and. measured%inward
      if (measured%segment == 'retreat') wanted = wanted .and. .not. measured%inward
      measured%z = [pack(z, measured%inward .and. wanted), &
        pack(z, wanted .and. .not. measured%inward)]
      measured%signal = [pack(signal, measured%inward .and. wanted), &
        pack(signal, wanted .and. .not. measured%inward)]
      measured%inward = [pack(measured%inward, measured%inward .and. wanted), &
        pack(measured%inward, wanted .and. .not. measured%inward)]
    end associate
    measured%skipped = [(any(measured%z(i) >= measured%skip(1::2) .and. &
      measured%z(i) <= measured%skip(2::2)), i=1, size(measured%z))]
    measured%usable = .not. measured%skipped
    call find_facing(table%source%file, measured, error)
  end subroutine read_measured

  !> Refuses columns that are exchanged, and positions that are not in metres.
  subroutine check_columns(file, z, signal, error)
    character(len=*), intent(in) :: file
    real(wp), intent(in) :: z(:), signal(:)
    type(failure_t), allocatable, intent(inout) :: error

    if (evenness_of(z) < uneven .and. evenness_of(signal) > even) then
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

    !> Median over mean of the changes of a column between the means of its parts.
    pure real(wp) function evenness_of(number) result(evenness)
      real(wp), intent(in) :: number(:)
      real(wp) :: mean(parts)

      mean = means_of(number)
      associate (change => abs(mean(2:) - mean(:parts - 1)))
        evenness = median_of(change)/max(sum(change)/size(change), tiny(1.0_wp))
      end associate
    end function evenness_of

  end subroutine check_columns

  !> Marks the samples before the turn of z; without a turn `segment` decides.
  pure function before_turn(z, segment) result(inward)
    real(wp), intent(in) :: z(:)
    character(len=*), intent(in) :: segment
    logical :: inward(size(z))
    integer :: turn, i, margin

    margin = max(1, nint(end_part*size(z)))
    turn = maxloc(z, 1)
    if (min(turn, size(z) - turn) < margin) turn = minloc(z, 1)
    if (min(turn, size(z) - turn) < margin) turn = merge(0, size(z), segment == 'retreat')
    inward = [(i <= turn, i=1, size(z))]
  end function before_turn

  !> Finds the direction of z on the approach. Fails if a way is too short or goes back, or if both
  !> ways have the same direction.
  subroutine find_facing(file, measured, error)
    character(len=*), intent(in) :: file
    type(measured_t), intent(inout) :: measured
    type(failure_t), allocatable, intent(inout) :: error
    real(wp) :: travel(2)
    integer :: n(2)

    n = [count(measured%inward), count(.not. measured%inward)]
    if (any(n < fewest .and. n > 0) .or. sum(n) == 0) then
      call fail(error, bad_input, file // ': fewer than 20 samples of the approach or the ' // &
        'retreat; segment chooses the branches to fit, and the third entry of ' // &
        'columns is the column of the segments')
      return
    end if
    travel = 0
    if (n(1) > 0) travel(1) = travel_of(measured%z(:n(1)))
    if (n(2) > 0) travel(2) = -travel_of(measured%z(n(1) + 1:))
    if (travel(1)*travel(2) < 0) call fail(error, bad_input, file // ': z goes the same way ' // &
      'in approach and retreat; is the third column 0 for approach and 1 for retreat?')
    if (goes_back(pack(measured%z, measured%inward)) .or. &
      goes_back(pack(measured%z, .not. measured%inward))) call fail(error, bad_input, file // &
      ': z goes back and forth within the approach or the retreat; a file has the rows of one ' // &
      'approach and one retreat, in the order of time')
    measured%facing = merge(1.0_wp, -1.0_wp, sum(travel) < 0)
  end subroutine find_facing

  !> Whether z goes much farther, back and forth, than from one end of a way to the other: rows
  !> that are not in order, or of several curves.
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

  !> The change of z from the begin to the end of a way.
  pure real(wp) function travel_of(z) result(travel)
    real(wp), intent(in) :: z(:)
    integer :: part

    part = max(1, nint(end_part*size(z)))
    travel = (sum(z(size(z) - part + 1:)) - sum(z(:part)))/part
  end function travel_of

end module measured_curve
