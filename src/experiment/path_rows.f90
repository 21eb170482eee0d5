!> The rows that show the equilibrium path: points of it, states at given h0, and between these as
!> many more as make the curve through them smooth.
module path_rows
  use kinds, only: wp
  use contact_state, only: state_t
  use path_coordinate, only: path_control
  use path_span, only: path_span_t, new_path_span
  use straight_lines, only: places_between
  use path_stepper, only: path_stepper_t
  implicit none
  private
  public :: row_t, row_of_point, row_at_h0, rows_between

  !> One row: its state and mesh, the point of the path that it is (0: none), its unstable modes,
  !> and whether it is solved. profile: it was asked for; for_curve: nothing is read off it.
  type :: row_t
    type(state_t) :: state
    integer :: mesh = 1, point = 0, modes = 0
    logical :: converged = .true., profile = .false., for_curve = .false.
  end type row_t

contains

  !> The row of point i.
  function row_of_point(steps, i) result(row)
    type(path_stepper_t), intent(in) :: steps
    integer, intent(in) :: i
    type(row_t) :: row

    row%point = i
    row%modes = steps%known%path%modes_at(i)
    row%mesh = steps%known%path%point(i)%mesh
    row%state = steps%known%path%point(i)%state
  end function row_of_point

  !> The row at h0 between point i and the next.
  function row_at_h0(steps, i, h0) result(row)
    class(path_stepper_t), intent(inout) :: steps
    integer, intent(in) :: i
    real(wp), intent(in) :: h0
    type(row_t) :: row

    row%modes = steps%known%path%point(i)%modes
    call steps%state_at_h0(i, h0, row%mesh, row%state, row%converged)
  end function row_at_h0

  !> The rows between point i and the next, inside the range of h0 from one value to another, in
  !> order: profiles that are asked for, and the rows for the curve; of these such as do not
  !> converge are left out, for the curve can do without. widest: contact radius, lateral units.
  subroutine rows_between(steps, i, from, until, widest, profiles, rows)
    class(path_stepper_t), intent(inout) :: steps
    integer, intent(in) :: i
    real(wp), intent(in) :: from, until, widest, profiles(:)
    type(row_t), allocatable, intent(out) :: rows(:)
    type(path_span_t) :: span
    real(wp), allocatable :: stops(:), stop_at(:), places(:)
    real(wp) :: begin
    integer :: k, stop

    span = new_path_span(steps%known%path, i)
    stops = pack(profiles, (profiles - from)*(profiles - until) < 0)
    stop_at = [(span%at_h0(stops(k)), k=1, size(stops))]
    begin = span%at_h0(from)
    places = places_between(steps%solver_t, span, begin, span%at_h0(until), widest)
    places = along([stop_at, places], begin)
    allocate (rows(size(places)))
    do k = 1, size(places)
      stop = findloc(stop_at, places(k), 1)
      if (stop > 0) then
        rows(k) = row_at_h0(steps, i, stops(stop))
        rows(k)%profile = .true.
      else
        rows(k) = row_for_curve(steps, i, span, places(k))
      end if
    end do
    if (.not. all(rows%converged .or. rows%profile)) &
      rows = pack(rows, rows%converged .or. rows%profile)
  end subroutine rows_between

  !> The row at the coordinate s of the span after point i, as the path predicts it and, where that
  !> is not an equilibrium to the tolerance, corrected.
  function row_for_curve(steps, i, span, s) result(row)
    class(path_stepper_t), intent(inout) :: steps
    integer, intent(in) :: i
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: s
    type(row_t) :: row

    row%for_curve = .true.
    row%modes = steps%known%path%point(i)%modes
    row%mesh = span%mesh
    call span%expected(steps%solver_t, s, row%state)
    call steps%correct(path_control(steps%problem, span%mesh, s), row%state, row%converged)
  end function row_for_curve

  !> Values by their distance from `start`, all on one side of it.
  pure function along(values, start) result(sorted)
    real(wp), intent(in) :: values(:), start
    real(wp), allocatable :: sorted(:)
    real(wp) :: value
    integer :: i, j

    sorted = values
    do i = 2, size(sorted)
      value = sorted(i)
      do j = i - 1, 1, -1
        if (abs(sorted(j) - start) <= abs(value - start)) exit
        sorted(j + 1) = sorted(j)
      end do
      sorted(j + 1) = value
    end do
  end function along

end module path_rows
