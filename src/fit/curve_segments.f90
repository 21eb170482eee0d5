!> The segments of a measured curve: which of its rows belong to the approach and which to the
!> retract. The segments follow from labels in the file, or from the direction in which the base
!> moves. During a pause the base rests.
module curve_segments
  use kinds, only: wp
  use failure, only: failure_t, fail, bad_input
  use text, only: counted, listed, quoted
  use curve_rows, only: curve_rows_t, of_approach, of_retreat, of_pause
  use fit_request, only: measurement_t
  implicit none
  private
  public :: find_segments, small_part

  !> Words that instruments write for the segments of a curve, separated by blanks; 0 and 1 are the
  !> numbers that afmformats writes.
  character(len=*), parameter :: words(of_pause:of_retreat) = [character(len=110) :: &
    ' pause hold dwell wait ', &
    ' 0 false approach extend extending ext advance advancing forward load loading ', &
    ' 1 true retreat retract retracting ret withdraw withdrawing backward unload unloading ']
  !> A small part of a curve: ends are averaged over this part of the samples, a turn within it does
  !> not count, and the base rests in a segment if it travels less than this part of its range.
  real(wp), parameter :: small_part = 0.1_wp

contains

  !> Finds the kind of each row's segment. error: the reason why it cannot be found.
  subroutine find_segments(rows, measurement, error)
    type(curve_rows_t), intent(inout) :: rows
    type(measurement_t), intent(in) :: measurement
    type(failure_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: what
    integer, allocatable :: of_label(:)
    logical :: chosen

    ! If the columns stand side by side, approach and retract are known already.
    if (allocated(rows%kind)) return
    chosen = allocated(measurement%approach) .or. allocated(measurement%retreat)
    allocate (of_label(0))
    if (allocated(rows%label)) call know_labels()
    if (allocated(what)) then
      continue
    else if (size(of_label) <= 1 .and. .not. chosen) then
      ! If all rows have one label, the label is useless when the base turns.
      rows%kind = merge(of_approach, of_retreat, before_turn(rows%z, measurement%segment))
      if (size(of_label) == 1 .and. all(rows%kind == rows%kind(1))) then
        if (of_label(1) >= of_approach) rows%kind = of_label(1)
      end if
    else if (all(of_label >= 0)) then
      rows%kind = of_label(rows%code)
    else
      call segments_by_travel(rows%z, rows%code, rows%kind, what)
    end if
    if (allocated(what)) call fail(error, bad_input, rows%file // ': ' // what)

  contains

    !> The kind of segment that each label means, by the deck or as a known word; -1 for an unknown
    !> label.
    subroutine know_labels()
      integer :: k

      of_label = spread(of_pause, 1, size(rows%label))
      if (allocated(measurement%approach)) call mark(measurement%approach, of_approach)
      if (allocated(measurement%retreat)) call mark(measurement%retreat, of_retreat)
      if (chosen) return
      do k = 1, size(of_label)
        of_label(k) = findloc(index(words, ' ' // trim(rows%label(k)) // ' ') > 0, .true., 1) - 1
      end do
    end subroutine know_labels

    subroutine mark(labels, kind)
      character(len=*), intent(in) :: labels(:)
      integer, intent(in) :: kind
      integer :: i, at

      do i = 1, size(labels)
        at = findloc(rows%label == labels(i), .true., 1)
        if (at == 0) then
          what = 'no row has the segment ' // quoted(trim(labels(i))) // &
            '; those of the file are ' // listed(rows%label)
          return
        end if
        of_label(at) = kind
      end do
    end subroutine mark

  end subroutine find_segments

  !> Finds the segments from the motion of the base: each sequence of rows with one label is an
  !> approach, a retract or a pause. The first sequence in which the base moves is the approach.
  subroutine segments_by_travel(z, code, kind, what)
    real(wp), intent(in) :: z(:)
    integer, intent(in) :: code(:)
    integer, allocatable, intent(out) :: kind(:)
    character(len=:), allocatable, intent(inout) :: what
    real(wp) :: range, travel, direction
    integer :: first, last, changes, latest

    allocate (kind(size(z)))
    range = maxval(z) - minval(z)
    direction = 0
    changes = 0
    latest = of_pause
    first = 1
    do while (first <= size(z))
      last = first
      do while (last < size(z))
        if (code(last + 1) /= code(first)) exit
        last = last + 1
      end do
      travel = z(last) - z(first)
      kind(first:last) = of_pause
      if (abs(travel) > small_part*range) then
        if (changes == 0) direction = travel
        kind(first:last) = merge(of_approach, of_retreat, travel*direction > 0)
        if (kind(first) /= latest) changes = changes + 1
        latest = kind(first)
      end if
      first = last + 1
    end do
    if (changes <= 2 .and. changes > 0) return
    what = 'the position goes back and forth in ' // counted(changes, 'segment') // ', where ' // &
      'one approach and one retract are expected; approach and retract choose them by their labels'
  end subroutine segments_by_travel

  !> Marks the samples before the turn of z. If z does not turn, `segment` decides.
  pure function before_turn(z, segment) result(inward)
    real(wp), intent(in) :: z(:)
    character(len=*), intent(in) :: segment
    logical :: inward(size(z))
    integer :: turn, i, margin

    margin = max(1, nint(small_part*size(z)))
    turn = maxloc(z, 1)
    if (min(turn, size(z) - turn) < margin) turn = minloc(z, 1)
    if (min(turn, size(z) - turn) < margin) turn = merge(0, size(z), segment == 'retract')
    inward = [(i <= turn, i=1, size(z))]
  end function before_turn

end module curve_segments
