!> Extrema of h0, the load or a combination of both between neighbouring states of the equilibrium
!> path. The slopes of the states, which are exact, and the curve through them show them: one where
!> the slopes have opposite signs, and where they have the same, perhaps two. Near the adhesion
!> strength at which jumps begin two folds are so close that steps pass over both; wherever the
!> curve leaves a doubt, a state is solved and joins it.
module path_extremum
  use kinds, only: wp
  use contact_state, only: state_t
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use frozen_jacobian, only: frozen_jacobian_t
  use interpolation, only: hermite_t
  use root_finding, only: bracket_t, secant_root
  use path_tangent, only: tangent_t
  use arc, only: arc_t, most_states
  implicit none
  private
  public :: extremum_t, find_extrema, may_turn

  !> Places of an interval at which the curve's slope is looked at; part of the mean slope to which
  !> it has to fall somewhere for two extrema to be looked for; of the slope's own error, how much
  !> leaves a doubt.
  integer, parameter :: places = 16
  real(wp), parameter :: suspicious = 0.15_wp, doubtful = 2
  !> Steps of the search for the least slope; part of an interval that is its end.
  integer, parameter :: golden_steps = 30
  real(wp), parameter :: at_end = 1.0e-5_wp
  !> Corrections of an extremum's place; the one below which rounding may keep the slope from
  !> falling; and how exactly the curve is asked for its own extremum.
  integer, parameter :: most_rounds = 60
  real(wp), parameter :: rounding_rules = 1.0e-6_wp, root_tolerance = 1.0e-12_wp
  !> The part of an interval over which a tangent tells a state better than the curve does.
  real(wp), parameter :: near_enough = 1.0e-3_wp

  !> An extremum on one of the meshes: its place on the path, its state and tangent; 1 for a maximum
  !> along the way inward, -1 for a minimum.
  type :: extremum_t
    real(wp) :: coordinate = 0
    type(state_t) :: state
    type(tangent_t) :: tangent
    integer :: sense = 1
  end type extremum_t

contains

  !> The extrema of weights(1) h0 + weights(2) load between state `first` of an arc and the next, in
  !> order. lost: a solve failed.
  subroutine find_extrema(equations, options, arc, first, weights, extrema, lost)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: first
    real(wp), intent(in) :: weights(2)
    type(extremum_t), allocatable, intent(out) :: extrema(:)
    logical, intent(out) :: lost
    type(arc_t) :: near
    type(extremum_t) :: found
    type(frozen_jacobian_t) :: frozen
    type(state_t) :: state
    type(tangent_t) :: tangent
    real(wp) :: s, expected, error
    integer :: i, added
    logical :: turns, doubt, solved

    allocate (extrema(0))
    lost = .false.
    error = huge(1.0_wp)
    i = first
    if (i < 1 .or. i >= arc%held) return
    ! Of most intervals nothing is to be told, and no copy is made.
    call look_at(arc)
    if (.not. (turns .or. doubt)) return
    near = arc
    added = 0
    do while (i <= first + added)
      call look_at(near)
      if (doubt .and. near%held < most_states) then
        expected = near%slope(weights, s)
        call near%exact_state_at(equations, options, frozen, s, state, tangent, solved)
        lost = .not. solved
        if (lost) return
        error = abs(tangent%of(weights) - expected)
        call near%add(s, state, tangent)
        added = added + 1
        cycle
      end if
      if (turns) then
        call polish(equations, options, near, i, weights, found, lost)
        if (lost) return
        extrema = [extrema, found]
      end if
      i = i + 1
    end do

  contains

    subroutine look_at(near)
      type(arc_t), intent(in) :: near

      associate (x => near%coordinate(i:i + 1))
        call look(near%curve(weights, x(1) + 0.5_wp*(x(2) - x(1))), x, &
          [near%tangent(i)%of(weights), near%tangent(i + 1)%of(weights)], error, turns, doubt, s)
      end associate
    end subroutine look_at

  end subroutine find_extrema

  !> Whether there may be extrema between two neighbouring states, at the places x, of what has
  !> these slopes there; curve: the polynomial between.
  pure logical function may_turn(curve, x, slopes)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: x(2), slopes(2)
    real(wp) :: s
    logical :: turns, doubt

    call look(curve, x, slopes, huge(1.0_wp), turns, doubt, s)
    may_turn = turns .or. doubt
  end function may_turn

  !> What is between two neighbouring states at the places x, where a curve has slopes that are
  !> exact at these: `turns`, an extremum; `doubt`, perhaps two more, which a state at s would show.
  !> error: of the curve's slope; huge where it is not known.
  pure subroutine look(curve, x, ends, error, turns, doubt, s)
    type(hermite_t), intent(in) :: curve
    real(wp), intent(in) :: x(2), ends(2), error
    logical, intent(out) :: turns, doubt
    real(wp), intent(out) :: s
    real(wp) :: course, mean, least, slope, step
    integer :: k

    ! A slope of zero counts as one above: an extremum that is a state is in one interval of two.
    turns = (ends(1) < 0) .neqv. (ends(2) < 0)
    doubt = .false.
    ! In the sense of its course the slope is above zero but between two extrema; where the ends
    ! differ, up to the first and, turned round, beyond it.
    course = merge(-1.0_wp, 1.0_wp, ends(1) < 0)
    step = (x(2) - x(1))/places
    mean = abs(curve%value(x(2)) - curve%value(x(1)))/(x(2) - x(1))
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
    if (.not. least < suspicious*mean) return
    call descend(curve, course, [max(s - step, x(1)), min(s + step, x(2))], s, least)
    doubt = minval(abs(s - x)) > at_end*(x(2) - x(1)) .and. &
      (least/doubtful < error .or. .not. error < huge(1.0_wp))
  end subroutine look

  !> The least slope of the curve in the sense of its course, and its place, between two places.
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

  !> The extremum between state i of an arc and the next: a root of the exact slope, begun at that
  !> of the curve and found by secants, and by bisection where these do not come nearer, as under a
  !> force that changes by orders of magnitude.
  subroutine polish(equations, options, near, i, weights, found, lost)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: near
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    type(extremum_t), intent(out) :: found
    logical, intent(out) :: lost
    type(bracket_t) :: bracket
    type(hermite_t) :: curve
    type(arc_t) :: beside
    ! Factors made where the curve has the extremum serve all of its corrections.
    type(frozen_jacobian_t) :: frozen
    type(extremum_t) :: tried
    real(wp) :: slope, least, slope_before, s_before, s, width
    integer :: round
    logical :: solved, rising

    associate (x => near%coordinate(i:i + 1))
      rising = .not. near%tangent(i)%of(weights) < 0
      bracket = bracket_t(x(1), x(2))
      width = x(2) - x(1)
      curve = near%curve(weights, x(1) + 0.5_wp*(x(2) - x(1)))
    end associate
    s = root_of_curve()
    beside = near
    least = huge(1.0_wp)
    do round = 1, most_rounds
      call beside%exact_state_at(equations, options, frozen, s, tried%state, tried%tangent, &
        solved)
      lost = .not. solved
      if (lost) return
      tried%coordinate = s
      slope = tried%tangent%of(weights)
      call bracket%narrow((slope < 0) .neqv. rising, s)
      if (.not. abs(slope) < least) then
        if (abs(s - found%coordinate) < rounding_rules) exit
        s = bracket%middle()
        beside = near
        cycle
      end if
      least = abs(slope)
      found = tried
      if (round == 1) then
        s_before = s + 1.0e-4_wp*width
        slope_before = slope + curve%slope(s_before) - curve%slope(s)
      end if
      if (.not. abs(slope - slope_before) > tiny(slope)) exit
      s = bracket%within(secant_root(s, slope, s_before, slope_before))
      if (abs(s - found%coordinate) < options%place_error) exit
      s_before = found%coordinate
      slope_before = slope
      ! So near, the tangent alone tells the next state.
      if (abs(s - s_before) < near_enough*width) then
        beside%held = 0
        call beside%add(s_before, found%state, found%tangent)
      end if
    end do
    found%sense = merge(1, -1, rising)

  contains

    real(wp) function root_of_curve() result(root)
      type(bracket_t) :: halves

      halves = bracket
      do while (halves%is_open() .and. abs(halves%high - halves%low) > root_tolerance)
        call halves%narrow((curve%slope(halves%middle()) < 0) .neqv. rising)
      end do
      root = halves%middle()
    end function root_of_curve

  end subroutine polish

end module path_extremum
