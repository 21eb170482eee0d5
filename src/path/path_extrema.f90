!> The extrema of Q = weights(1) h0 + weights(2) load between two neighbouring states of an arc of
!> the path. An extremum lies between slopes of opposite signs; two extrema may lie between slopes
!> of equal signs. Near the adhesion strength at which jumps begin, two folds are so close that a
!> step passes over both. Where the polynomial through the states cannot decide, a state is solved
!> and added to the arc.
module path_extrema
  use kinds, only: wp
  use solver, only: solver_t
  use interpolation, only: hermite_t, hermite_through
  use root_finding, only: bracket_t
  use path_point, only: path_point_t
  use arc, only: arc_t, most_points
  use path_search, only: find_place
  implicit none
  private
  public :: find_extrema, may_turn

  !> Number of parts of an interval, at whose ends the slope is evaluated. The sign of the least
  !> slope is in doubt if the slope is below `doubtful` times its error.
  integer, parameter :: places = 16
  real(wp), parameter :: doubtful = 2
  !> Steps of the search for the least slope; fraction of an interval that counts as its end.
  integer, parameter :: golden_steps = 30
  real(wp), parameter :: at_end = 1.0e-5_wp

contains

  !> The extrema of Q between two neighbouring states of an arc, those at the coordinates `ends`, in
  !> order: maxima and minima alternate. lost: a solve failed.
  subroutine find_extrema(solver, arc, ends, weights, extrema, lost)
    class(solver_t), intent(inout) :: solver
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: ends(2), weights(2)
    type(path_point_t), allocatable, intent(out) :: extrema(:)
    logical, intent(out) :: lost
    type(arc_t) :: near
    type(path_point_t) :: found
    real(wp) :: s, expected, error
    integer :: i
    logical :: turns, doubt, done

    allocate (extrema(0))
    lost = .false.
    error = huge(1.0_wp)
    i = findloc(arc%point(:arc%held)%coordinate, ends(1), 1)
    ! Most intervals have no extremum; the arc is copied only for the others.
    call look_at(arc)
    if (.not. (turns .or. doubt)) return
    near = arc
    call solver%frozen%forget()
    do while (near%point(i)%coordinate < ends(2))
      call look_at(near)
      if (doubt .and. near%held < most_points) then
        expected = near%slope(weights, s)
        call near%solve_at(solver, s, found, done)
        lost = .not. done
        if (lost) return
        error = abs(found%tangent%of(weights) - expected)
        call near%add(found)
        cycle
      end if
      if (turns) then
        call find_place(solver, near, near%point(i:i + 1)%coordinate, weights, found, done)
        lost = .not. done
        if (lost) return
        extrema = [extrema, found]
      end if
      i = i + 1
    end do

  contains

    !> Looks for extrema of the arc's polynomial and, if it has none, of the cubic through the two
    !> states alone, which earlier states do not smooth. Two extrema of this cubic alone are in
    !> doubt.
    subroutine look_at(near)
      type(arc_t), intent(in) :: near
      real(wp) :: value(2), slope(2)
      integer :: j

      associate (x => near%point(i:i + 1)%coordinate)
        value = [(near%point(j)%state%of(weights), j=i, i + 1)]
        slope = [(near%point(j)%tangent%of(weights), j=i, i + 1)]
        call look(near%curve(weights, x(1) + 0.5_wp*(x(2) - x(1))), x, slope, error, &
          turns, doubt, s)
        if (turns .or. doubt) return
        call look(hermite_through(x, value, slope), x, slope, 0.0_wp, turns, doubt, s)
      end associate
    end subroutine look_at

  end subroutine find_extrema

  !> Whether there may be extrema between two neighbouring states at the coordinates x; curve: the
  !> polynomial between them.
  pure logical function may_turn(curve, x)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: x(2)
    real(wp) :: s
    logical :: turns, doubt

    call look(curve, x, [curve%slope(x(1)), curve%slope(x(2))], huge(1.0_wp), turns, doubt, s)
    may_turn = turns .or. doubt
  end function may_turn

  !> Whether extrema lie between two neighbouring states at the coordinates x. The slopes `ends` at
  !> the states are exact. turns: there is one extremum. doubt: there may be two more, since the
  !> slope has a minimum at s between the states; the state at s decides. The argument `error` is
  !> the error of the curve's slope, huge if unknown.
  pure subroutine look(curve, x, ends, error, turns, doubt, s)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: x(2), ends(2), error
    logical, intent(out) :: turns, doubt
    real(wp), intent(out) :: s
    real(wp) :: course, least, slope, step
    integer :: k

    ! A zero slope counts as positive, so that an extremum at a state is in one of two intervals
    ! only.
    turns = (ends(1) < 0) .neqv. (ends(2) < 0)
    doubt = .false.
    ! The slope times the sign `course` is positive except between two extrema. If the slopes at the
    ! ends differ in sign, `course` changes its sign at the first extremum.
    course = merge(-1.0_wp, 1.0_wp, ends(1) < 0)
    step = (x(2) - x(1))/places
    least = merge(0.0_wp, minval(abs(ends)), turns)
    s = x(minloc(abs(ends), 1))
    do k = 1, places - 1
      slope = course*curve%slope(x(1) + k*step)
      if (turns .and. slope < 0 .and. (course < 0 .eqv. ends(1) < 0)) then
        course = -course
        slope = -slope
      end if
      if (.not. slope < least) cycle
      least = slope
      s = x(1) + k*step
    end do
    if (turns) then
      doubt = least < 0
      return
    end if
    call descend(curve, course, [max(s - step, x(1)), min(s + step, x(2))], s, least)
    doubt = minval(abs(s - x)) > at_end*(x(2) - x(1)) .and. &
      (least/doubtful < error .or. .not. error < huge(1.0_wp))
  end subroutine look

  !> The least of `course` times the slope of the curve between two places, and the place.
  pure subroutine descend(curve, course, ends, s, least)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: course, ends(2)
    real(wp), intent(out) :: s, least
    type(bracket_t) :: bracket
    integer :: step

    bracket = bracket_t(ends(1), ends(2))
    do step = 1, golden_steps
      associate (points => bracket%golden_points())
        call bracket%keep_larger(-course*[curve%slope(points(1)), curve%slope(points(2))])
      end associate
    end do
    s = bracket%middle()
    least = course*curve%slope(s)
  end subroutine descend

end module path_extrema
