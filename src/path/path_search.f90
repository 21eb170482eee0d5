!> The search for an equilibrium between two states of an arc of the path: an extremum of Q =
!> weights(1) h0 + weights(2) load, or a given value of Q. The states of the arc have exact slopes,
!> and a polynomial through them gives an estimate of the place. The state at this place is solved,
!> and its residual gives the next estimate. The path's coordinate has no folds, so every solve
!> converges.
module path_search
  use kinds, only: wp
  use represented_pressure, only: pressure_slope_t, slope_on
  use solver, only: solver_t
  use interpolation, only: hermite_t
  use root_finding, only: bracket_t, root_search_t, new_root_search, resolution
  use path_point, only: path_point_t
  use arc, only: arc_t, most_points
  implicit none
  private
  public :: find_place, place_on

  !> Largest number of states solved in one search. Change of the coordinate below which rounding
  !> may prevent the residual from decreasing. Largest change of the coordinate, over the length of
  !> the interval, for which a state is moved along its tangent without another solve; the error is
  !> the square of this change.
  integer, parameter :: most_rounds = 60
  real(wp), parameter :: rounding_rules = 1.0e-6_wp, along_tangent = 1.0e-6_wp
  !> Difference between Q and its wanted value that may be due to rounding, relative or in the law's
  !> lengths. Change of the coordinate that the rounding of the load may cause. Largest correction
  !> of the coordinate that may remain at the end of the search.
  real(wp), parameter :: near_enough = 2.0e-13_wp, found_at = 1.0e-12_wp, left_over = 1.0e-5_wp

contains

  !> The equilibrium at which Q has the value `wanted`, between the coordinates `ends`, where Q is
  !> monotonic. If `wanted` is absent, the equilibrium at the only extremum of Q between them. For a
  !> value the iteration is Newton's, since the slope of Q is exact at a state. For an extremum each
  !> state joins the arc, whose polynomial gives the next place. A small last step is along the
  !> tangent, without another solve. If a step does not reduce the residual, for example under a
  !> force that changes by orders of magnitude, the bracket is halved. If rounding puts the value
  !> just outside the bracket, the state at the nearer end is the result. done = .false.: there is
  !> no such state, or a solve failed.
  subroutine find_place(solver, arc, ends, weights, found, done, wanted)
    class(solver_t), intent(inout) :: solver
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: ends(2), weights(2)
    type(path_point_t), intent(out) :: found
    logical, intent(out) :: done
    real(wp), intent(in), optional :: wanted
    type(arc_t) :: near
    type(bracket_t) :: bracket
    type(path_point_t) :: tried
    real(wp) :: s, rate, least_change, change, before, miss, missed
    integer :: round
    logical :: rising, solved

    near = arc
    miss = huge(miss)
    bracket = bracket_t(ends(1), ends(2))
    call look_at_ends()
    before = ends(2) - ends(1)
    solved = .true.
    ! The factors made at the first estimate serve for all corrections.
    call solver%frozen%forget()
    do round = 1, most_rounds
      if (is_there(found)) exit
      call near%solve_at(solver, s, tried, solved)
      if (.not. solved) exit
      missed = miss_of(tried)
      call bracket%narrow((missed < 0) .eqv. rising, s)
      call join(near, tried)
      if (.not. abs(missed) < abs(miss)) then
        if (abs(s - found%coordinate) < rounding_rules) exit
        s = bracket%middle()
        cycle
      end if
      found = tried
      miss = missed
      if (present(wanted)) then
        rate = found%tangent%of(weights)
        if (.not. abs(rate) > tiny(rate)) exit
        s = bracket%within(s - miss/rate)
      else
        s = place_on(near%curve(weights, bracket%middle()), [bracket%low, bracket%high])
      end if
      change = s - found%coordinate
      ! The next step would be smaller by at least the ratio of this one to the last one.
      if (abs(change) < least_change .or. abs(change) < along_tangent*(ends(2) - ends(1)) .and. &
        (present(wanted) .or. change**2 < least_change*before)) then
        call move(found, change, slope_on(solver%problem%law, solver%meshes%grid(near%mesh), &
          found%state%gap))
        if (present(wanted)) miss = miss_of(found)
        exit
      end if
      before = abs(change)
    end do
    done = solved
    if (present(wanted)) done = is_there(found, left_over)

  contains

    !> Begins with the nearer end and with the place on the arc's polynomial.
    subroutine look_at_ends()
      type(hermite_t) :: curve
      integer :: k, j

      curve = near%curve(weights, 0.5_wp*sum(ends))
      if (present(wanted)) then
        rising = curve%value(ends(1)) < wanted
        least_change = 4*resolution(maxval(abs(ends)))
        do k = 1, 2
          j = findloc(near%point(:near%held)%coordinate, ends(k), 1)
          if (j == 0) cycle
          missed = miss_of(near%point(j))
          if (.not. abs(missed) < abs(miss)) cycle
          miss = missed
          found = near%point(j)
        end do
      else
        j = findloc(near%point(:near%held)%coordinate, ends(1), 1)
        rising = near%point(j)%tangent%of(weights) < 0
        least_change = solver%options%place_error
      end if
      s = place_on(curve, ends, wanted)
    end subroutine look_at_ends

    !> Q minus the wanted value or, at an extremum, the slope of Q.
    pure real(wp) function miss_of(tried) result(off)
      type(path_point_t), intent(in) :: tried

      if (present(wanted)) then
        off = tried%state%of(weights) - wanted
      else
        off = tried%tangent%of(weights)
      end if
    end function miss_of

    !> Whether Q of a state has the wanted value, within rounding or, if given, within a change of
    !> the coordinate.
    pure logical function is_there(near, change) result(there)
      type(path_point_t), intent(in) :: near
      real(wp), intent(in), optional :: change
      real(wp) :: least

      there = present(wanted) .and. abs(miss) < huge(1.0_wp)
      if (.not. there) return
      associate (w => abs(weights), slope => abs(near%tangent%of(weights)))
        least = near_enough*(w(1)*max(1.0_wp, abs(near%state%h0)) + w(2)*abs(near%state%load))
        if (w(2) > 0) least = max(least, found_at*slope)
        if (present(change)) least = max(least, change*slope)
      end associate
      there = abs(miss) <= least
    end function is_there

  end subroutine find_place

  !> Moves an equilibrium by a small change of its coordinate. slope: the derivative of the law at
  !> the gaps of the equilibrium.
  subroutine move(found, change, slope)
    type(path_point_t), intent(inout) :: found
    real(wp), intent(in) :: change
    type(pressure_slope_t), intent(in) :: slope

    found%coordinate = found%coordinate + change
    associate (state => found%state, tangent => found%tangent)
      state%pressure = state%pressure + change*slope%times(tangent%gap)
      state%gap = state%gap + change*tangent%gap
      state%h0 = state%h0 + change*tangent%h0
      state%scale = state%scale + change*tangent%scale
      state%axis_gap = state%axis_gap + change*tangent%axis_gap
      state%load = state%load + change*tangent%load
    end associate
  end subroutine move

  !> The coordinate between `ends` at which a curve has the value `wanted` or, if `wanted` is
  !> absent, an extremum. If there is none, the result is the end with the smaller residual.
  pure real(wp) function place_on(curve, ends, wanted) result(s)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: ends(2)
    real(wp), intent(in), optional :: wanted
    type(root_search_t) :: search

    search = new_root_search(ends(1), miss(ends(1)), ends(2), miss(ends(2)))
    do while (search%is_open())
      s = search%place()
      call search%note(s, miss(s))
    end do
    s = search%root

  contains

    pure real(wp) function miss(s)
      real(wp), intent(in) :: s

      if (present(wanted)) then
        miss = curve%value(s) - wanted
      else
        miss = curve%slope(s)
      end if
    end function miss

  end function place_on

  !> Adds a point to an arc; if the arc is full, its end farther from the new point is removed.
  subroutine join(near, point)
    type(arc_t), intent(inout) :: near
    type(path_point_t), intent(in) :: point

    if (near%held == most_points) then
      if (point%coordinate - near%point(1)%coordinate > &
        near%point(near%held)%coordinate - point%coordinate) then
        call near%drop_first()
      else
        near%held = near%held - 1
      end if
    end if
    call near%add(point)
  end subroutine join

end module path_search
