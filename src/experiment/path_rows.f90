!> The rows of the equilibrium path: points of the path, states at given h0, and further states
!> between them. Straight lines from row to row show load and contact radius against h0 accurately,
!> also near folds and at large separations.
module path_rows
  use kinds, only: wp
  use dimensionless_problem, only: contact_level_of
  use contact_state, only: state_t, contact_radius_of
  use controls, only: control_t, at_axis_gap
  use solver, only: solver_t
  use path_coordinate, only: path_control
  use path_point, only: path_point_t
  use path_span, only: path_span_t, new_path_span
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: row_at_h0, rows_between

  !> Largest distance of the curve from a line, in fractions of h0 and load at the ends of the span
  !> (which are small at large separations) and of the widest contact.
  real(wp), parameter :: allowed = 0.003_wp
  !> Number of parts of a span at whose ends the curve is evaluated; largest number of lines of a
  !> span.
  integer, parameter :: parts = 4, most_lines = 16

contains

  !> The row at h0 between point i and the next.
  type(path_point_t) function row_at_h0(solver, path, i, h0) result(row)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: h0
    type(path_span_t) :: span

    span = new_path_span(path, i)
    call span%solve_at_h0(solver, h0, row)
    row%modes = path%point(i)%modes
  end function row_at_h0

  !> The rows between point i and the next, within a range of h0, in order: requested profiles
  !> (profile = .true.), and rows for the curve. Rows for the curve that do not converge are
  !> omitted. widest: the largest contact radius in lateral units; 0: there are no rows for the
  !> curve.
  subroutine rows_between(solver, path, i, from, until, widest, profiles, rows, profile)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    real(wp), intent(in) :: from, until, widest, profiles(:)
    type(path_point_t), allocatable, intent(out) :: rows(:)
    logical, allocatable, intent(out) :: profile(:)
    type(path_span_t) :: span
    real(wp), allocatable :: stops(:), stop_at(:), places(:)
    real(wp) :: begin, end
    integer :: k, stop

    stops = pack(profiles, (profiles - from)*(profiles - until) < 0)
    allocate (rows(0), profile(0))
    if (size(stops) == 0 .and. .not. widest > 0) return
    deallocate (rows, profile)
    span = new_path_span(path, i)
    stop_at = [(span%at_h0(stops(k)), k=1, size(stops))]
    begin = span%at_h0(from)
    end = span%at_h0(until)
    allocate (places(0))
    if (widest > 0) places = places_between(solver, span, begin, end, widest)
    do k = 1, size(stops)
      stop = count((places - stop_at(k))*(end - begin) < 0)
      places = [places(:stop), stop_at(k), places(stop + 1:)]
    end do
    allocate (rows(size(places)), profile(size(places)))
    do k = 1, size(places)
      stop = findloc(stop_at, places(k), 1)
      profile(k) = stop > 0
      if (profile(k)) then
        rows(k) = row_at_h0(solver, path, i, stops(stop))
      else
        rows(k) = row_for_curve(solver, path, i, span, places(k))
      end if
    end do
    associate (shown => rows%converged .or. profile)
      if (all(shown)) return
      rows = pack(rows, shown)
      profile = pack(profile, shown)
    end associate
  end subroutine rows_between

  !> The row at the coordinate s of the span after point i: the predicted state, corrected if it is
  !> not an equilibrium to the tolerance.
  type(path_point_t) function row_for_curve(solver, path, i, span, s) result(row)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: i
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: s

    row%modes = path%point(i)%modes
    row%mesh = span%mesh
    call span%expected(solver, s, row%state)
    call solver%correct(path_control(solver%problem, solver%meshes, span%mesh, s), &
      row%state, row%converged)
  end function row_for_curve

  !> Coordinates of a span between `from` and `to`, in order, at equal distances, since the distance
  !> of the curve from a line is proportional to the square of the line's length. widest: the
  !> largest contact radius in lateral units.
  pure function places_between(solver, span, from, to, widest) result(places)
    class(solver_t), intent(in) :: solver
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: from, to, widest
    real(wp), allocatable :: places(:)
    real(wp) :: seen(3, 0:parts), chord(3), aside(3), farthest
    integer :: j, lines

    do j = 0, parts
      seen(:, j) = seen_at(from + (to - from)*j/parts)
    end do
    do j = 1, 2
      seen(j, :) = seen(j, :)/max(abs(seen(j, 0)), abs(seen(j, parts)), tiny(1.0_wp))
    end do
    seen(3, :) = seen(3, :)/widest
    chord = seen(:, parts) - seen(:, 0)
    chord = chord/max(norm2(chord), tiny(1.0_wp))
    farthest = 0
    do j = 1, parts - 1
      aside = seen(:, j) - seen(:, 0)
      farthest = max(farthest, norm2(aside - dot_product(aside, chord)*chord))
    end do
    lines = ceiling(min(real(most_lines, wp), sqrt(farthest/allowed)))
    places = [(from + (to - from)*j/lines, j=1, lines - 1)]

  contains

    !> H0, load and contact radius that the span predicts at s.
    pure function seen_at(s) result(values)
      real(wp), intent(in) :: s
      real(wp) :: values(3)
      type(control_t) :: control
      type(state_t) :: state

      control = path_control(solver%problem, solver%meshes, span%mesh, s)
      values = [span%h0_and_load(s), control%value]
      if (control%kind /= at_axis_gap) return
      values(3) = 0
      if (control%value >= contact_level_of(solver%problem)) return
      call span%expected(solver, s, state)
      state%axis_gap = control%value
      values(3) = contact_radius_of(solver%problem, solver%meshes%grid(span%mesh), state)
    end function seen_at

  end function places_between

end module path_rows
