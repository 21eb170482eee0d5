!> The equilibrium path as a result. It leads from large separation, or from a given h0, to a
!> contact at a given h0. It has stable and unstable states, every fold in h0, every extremum of the
!> load, and enough points between these for a smooth curve.
module path
  use kinds, only: wp
  use force_law, only: of_pressure
  use contact_state, only: state_t
  use traced_path, only: traced_path_t
  use ending, only: state_lost
  use path_end, only: outer_end
  use largest_tension, only: lower, lower_along
  use stepper, only: stepper_t, known_path_t
  use path_point, only: path_point_t
  use path_rows, only: row_at_h0, rows_between
  use reported_place, only: place_t, place_of_state, of_h0
  use places, only: places_t
  use records, only: observer_t, record_t, branch_t, record_of, stable_yes, stable_no
  implicit none
  private
  public :: path_t, follow_path

  !> The path, in the order from large separations inward. Its largest tension is the pull-off at
  !> controlled load; `finish` is the last state, if it is stable.
  type, extends(branch_t) :: path_t
    !> Number of unstable modes after each fold in h0.
    integer, allocatable :: unstable_after(:)
    !> The least h0 at which the bodies are stable outside a barrier, if this is below the requested
    !> end; otherwise the requested end.
    real(wp) :: deepest_outside = 0
    !> Whether the path ends in a collapse of the bodies.
    logical :: fallen = .false.
  end type path_t

contains

  !> The part of the known path from h0_start, or from its beginning if h0_start is absent, to the
  !> contact at h0_end. The observer receives the states, and profiles where the path crosses the
  !> values `profiles`. Folds, extrema of the load and states with profiles become places of the
  !> table, in the order of the path. curve: whether there are rows between the points for a smooth
  !> curve.
  subroutine follow_path(steps, h0_end, profiles, curve, observer, path, places, h0_start)
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_end, profiles(:)
    logical, intent(in) :: curve
    class(observer_t), intent(inout) :: observer
    type(path_t), intent(out) :: path
    type(places_t), intent(inout) :: places
    real(wp), intent(in), optional :: h0_start
    type(path_point_t) :: row
    type(path_point_t), allocatable :: between(:)
    logical, allocatable :: profile(:)
    type(place_t) :: reported
    real(wp) :: until, widest, start
    integer :: i, k, first, last
    logical :: ends_between

    allocate (path%unstable_after(0))
    path%deepest_outside = h0_end
    start = huge(start)
    path%fallen = steps%known%fallen
    if (.not. path%fallen) path%ending = steps%known%ending
    first = steps%known%path%undeformed + 1
    if (present(h0_start)) first = first_crossing(steps%known%path, h0_start)
    call find_end(steps, h0_end, last, ends_between)
    if (last < first) return
    widest = steps%known%path%point(last)%state%scale
    do i = first, last
      row = steps%known%path%point(i)
      row%interval = i
      row%modes = steps%known%path%modes_at(i)
      if (i == first .and. present(h0_start)) &
        row = row_at_h0(steps%solver_t, steps%known%path, i, h0_start)
      if (i == first) path%first_piece = piece_of(steps%known, i)
      ! Where the path passes to another mesh, two points exist on both.
      if (i == first .or. steps%known%path%comes_from_before(i)) &
        call take(row, profile=any(abs(profiles - row%state%h0) <= 0))
      if (i == last .and. .not. ends_between) exit
      if (.not. steps%known%path%point(i)%leads_on) cycle
      until = h0_end
      if (i < last) until = steps%known%path%point(i + 1)%state%h0
      call rows_between(steps%solver_t, steps%known%path, i, row%state%h0, until, &
        merge(widest, 0.0_wp, curve), profiles, between, profile)
      do k = 1, size(between)
        call take(between(k), profile(k), for_curve=.not. profile(k))
      end do
      if (i < last) cycle
      row = row_at_h0(steps%solver_t, steps%known%path, i, h0_end)
      call take(row, profile=any(abs(profiles - h0_end) <= 0))
    end do
    ! The tension is largest at an extremum or an end. States with which the path passes to another
    ! mesh do not count: the errors of the meshes would decide which of them is the extremum.
    if (row%converged) then
      reported = place_of_row(row)
      call lower_along(steps%known%path, first, last, path%lowest)
      call lower(path%lowest, reported)
      call path%compare_ends(start, row%state%h0)
      if (row%modes == 0) path%finish = reported
    end if
    call enter_ends()
    path%last_piece = piece_of(steps%known, last)
    steps%cost%states = steps%cost%states + path%states

  contains

    !> Enters the largest tension and the end of a path.
    subroutine enter_ends()
      type(place_t) :: fall

      if (allocated(path%lowest)) then
        call places%enter('path_tension', 1, path%lowest)
        call places%enter_tension(path%lowest)
      end if
      if (.not. allocated(path%finish)) return
      if (path%fallen) then
        ! The end of a collapse has no error, since it is on no mesh.
        fall%at = path%finish%at
        call places%enter('end', 1, fall)
      else
        call places%enter('path_end', 1, path%finish)
        call places%enter('end', 1, path%finish)
      end if
    end subroutine enter_ends

    !> The first point after which the path reaches h0; the number after the last point if it never
    !> does.
    pure integer function first_crossing(path, h0) result(i)
      type(traced_path_t), intent(in) :: path
      real(wp), intent(in) :: h0

      do i = path%undeformed + 1, path%held - 1
        if (path%point(i)%leads_on .and. path%point(i)%state%h0 >= h0 .and. &
          path%point(i + 1)%state%h0 <= h0) return
      end do
      i = path%held + 1
    end function first_crossing

    !> The stable piece on which the path continues from point i; 0 if it is unstable there.
    pure integer function piece_of(known, i) result(k)
      type(known_path_t), intent(in) :: known
      integer, intent(in) :: i

      do k = size(known%stable%piece), 1, -1
        associate (piece => known%stable%piece(k))
          if (i >= piece%first%interval .and. i <= piece%last%interval + 1) return
        end associate
      end do
    end function piece_of

    !> Gives a row to the observer and stores its reported places. Folds are exact. profile: its
    !> profile is requested; for_curve: the row serves only for the curve.
    subroutine take(row, profile, for_curve)
      type(path_point_t), intent(in) :: row
      logical, intent(in) :: profile
      logical, intent(in), optional :: for_curve
      type(place_t) :: reported
      type(record_t) :: record

      associate (grid => steps%meshes%grid(row%mesh), state => row%state)
        record = record_of('path', steps%problem, grid, state, &
          merge(stable_yes, stable_no, row%modes == 0), row%converged)
        call path%quality%cover(record, steps%problem, grid, state, &
          steps%meshes%in_contact(row%mesh))
        call observer%take(record, steps%problem, grid, state, profile)
        path%states = path%states + 1
      end associate
      if (.not. row%converged) then
        if (.not. path%ending%early()) path%ending%cause = state_lost
        return
      end if
      if (row%modes == 0) call look_outside(row%state)
      if (present(for_curve)) then
        if (for_curve) return
      end if
      reported = place_of_row(row)
      if (profile) call places%add('profiles', reported)
      if (path%states == 1) then
        path%lowest = reported
        start = reported%at(of_h0)
      end if
      if (row%load_extremum) call places%add('load_folds', reported)
      if (.not. row%fold) return
      ! The first fold is the snap-in only if the path begins on the outermost piece.
      if (path%first_piece == 1 .and. .not. places%has('folds')) &
        call places%enter('jump_in', 1, reported)
      call places%add('folds', reported)
      call places%forget('jump_out')
      associate (after => steps%known%path%point(row%interval)%modes)
        if (after == 0) call places%enter('jump_out', 1, reported)
        path%unstable_after = [path%unstable_after, after]
      end associate
    end subroutine take

    !> Records how far below the requested end the path continues while a barrier keeps the bodies
    !> apart.
    subroutine look_outside(state)
      type(state_t), intent(in) :: state

      associate (law => steps%problem%law)
        if (.not. (state%h0 < path%deepest_outside .and. law%rest_gap > 0 .and. &
          state%axis_gap > law%edge_gap)) return
        if (law%at(of_pressure, state%axis_gap) > 0) path%deepest_outside = state%h0
      end associate
    end subroutine look_outside

  end subroutine follow_path

  !> The last point before the stable contact at h0_end (`path_end`); ends_between: the end is
  !> between this point and the next one.
  subroutine find_end(steps, h0_end, last, ends_between)
    class(stepper_t), intent(inout) :: steps
    real(wp), intent(in) :: h0_end
    integer, intent(out) :: last
    logical, intent(out) :: ends_between
    integer :: k

    associate (known => steps%known)
      last = outer_end(steps%solver_t, known%path, h0_end)
      ends_between = last > 0
      if (ends_between) return
      last = known%path%held
      k = known%stable%piece_with(h0_end, size(known%stable%piece) + 1, .false.)
      ends_between = k > 0 .and. .not. known%ending%early()
      if (ends_between) last = known%interval_at(k, h0_end)
    end associate
  end subroutine find_end

  !> The place of a row. If h0 or the load has an extremum there, it is the place of a point of the
  !> path.
  pure type(place_t) function place_of_row(row) result(reported)
    type(path_point_t), intent(in) :: row

    reported = place_of_state(row%mesh, row%state)
    if (row%fold .or. row%load_extremum) reported%point = row%interval
  end function place_of_row

end module path
