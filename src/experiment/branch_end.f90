!> The end of a branch of stable equilibria on a mesh fixed in space.
!>
!> A branch ends at a fold of h0. `follow` solves states along the curve of equilibria, in the
!> coordinate Q of `branch_tangent`, each connected with the one before. The branch ends where
!> dh0/dQ passes zero. Therefore an end is found, or excluded, for any length of the experiment's
!> steps. A state that does not converge is not taken for an end.
module branch_end
  use kinds, only: wp
  use interpolation, only: hermite_t, hermite_through, hermite_weights
  use root_finding, only: bracket_t
  use contact_state, only: state_t, too_near
  use controls, only: control_t
  use fixed_branch, only: expected_at, is_expected, is_pinned, change
  use branch_tangent, only: branch_tangent_t, tangent_at, joins, passing
  use reported_place, only: place_t, place_without_state, of_h0
  use solver_options, only: solver_options_t
  use stepper, only: stepper_t, branch_point_t, remember, error_of_h0
  implicit none
  private
  public :: follow, arrived, at_fold

  !> How `follow` ends: at h0, at a fold before it, or undecided.
  integer, parameter :: lost = 0, arrived = 1, at_fold = 2

  !> A state of the curve, its tangent, and its Q.
  type :: point_t
    type(state_t) :: state
    type(branch_tangent_t) :: tangent
    real(wp) :: q = 0
  end type point_t

  !> Largest difference between the state at h0 and its guess, which is interpolated between two
  !> states; in the law's lengths.
  real(wp), parameter :: beside = 0.05_wp
  !> Largest number of states: where the edge passes node after node, a step needs a hundred.
  integer, parameter :: most_states = 500
  !> The first step over the distance to h0. The factor by which a step is shortened if its state is
  !> not connected with the previous one. The smallest step, over this distance or the law's length,
  !> whichever is smaller.
  real(wp), parameter :: first_step = 0.2_wp, shorter = 1.0_wp/3, least = 1.0e-6_wp
  !> A fold may be near if dh0/dQ is below `steep`. There the deformation may change by at most
  !> `small` (law's lengths) in a step, so that the minimum of dh0/dQ at a pair of folds is not
  !> missed. Steps are planned for the fraction `planned` of this change, since the change grows
  !> towards a fold.
  real(wp), parameter :: steep = 0.5_wp, small = 0.15_wp, planned = 0.9_wp
  !> A step to a predicted fold or to h0, over the distance to it.
  real(wp), parameter :: just_beyond = 1.1_wp
  !> If dh0/dQ of Hermite's polynomial within a step is below `flat` times its values at the ends, a
  !> state is solved there; it shows whether there is a pair of folds. apart: the least distance of
  !> this state from the ends, over the step.
  real(wp), parameter :: flat = 0.5_wp, apart = 0.02_wp
  !> Largest number of states for a fold.
  integer, parameter :: most_rounds = 12

contains

  !> Follows the branch of the position, whose state is an equilibrium, towards h0. last: the state
  !> at h0, or the last stable state before the fold. fold: h0 and load of the fold, with the
  !> uncertainty of its h0. nearest: the state nearest to the fold, on either side of it.
  subroutine follow(self, options, h0, position, outcome, last, fold, nearest)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position
    integer, intent(out) :: outcome
    type(state_t), intent(out) :: last, nearest
    type(place_t), intent(out) :: fold
    type(branch_point_t) :: memory
    type(point_t) :: here, there
    real(wp) :: sense, step, dip
    logical :: good
    integer :: states

    outcome = lost
    memory = position
    here%state = position%state
    call tangent_at(self, control_t(value=here%state%h0), here%state, here%tangent)
    if (.not. here%tangent%regular) return
    sense = sign(1.0_wp, h0 - here%state%h0)
    if (.not. here%tangent%stable) then
      ! Within the tolerance the state is at the end of its branch.
      outcome = at_fold
      last = here%state
      nearest = here%state
      fold = place_without_state(here%state%h0, here%state%load)
      fold%left(of_h0) = options%tolerance
      return
    end if
    step = first_step*abs(h0 - here%state%h0)/here%tangent%h0
    do states = 1, most_states
      if (.not. step > least*min(1.0_wp, abs(h0 - position%state%h0))) return
      call go(here, there, good)
      if (.not. good) then
        step = shorter*step
        cycle
      end if
      if (there%tangent%h0 <= 0) then
        call find_fold(self, options, h0, sense, here, there, outcome, last, fold, nearest)
        return
      end if
      dip = lowest_within(here, there)
      if (dip > 0) then
        step = dip*step
        cycle
      end if
      if ((there%state%h0 - h0)*sense >= 0) then
        call arrive(self, options, h0, sense, here, there, outcome, last)
        return
      end if
      call remember(memory, there%state, 1, .false.)
      step = next_step(here, there, step)
      here = there
    end do

  contains

    !> Takes a step from one point to the next. good: the points are connected.
    subroutine go(here, there, good)
      type(point_t), intent(inout) :: here
      type(point_t), intent(out) :: there
      logical, intent(out) :: good
      type(state_t) :: expected

      step = step*here%tangent%h0
      call here%tangent%turn(passing(here%tangent, is_pinned(self)))
      ! A change of h0 has another length in the new coordinate.
      step = min(step, just_beyond*abs(h0 - here%state%h0))/here%tangent%h0
      if (here%tangent%h0 < steep) step = min(step, &
        planned*small/maxval(abs(here%tangent%gap - here%tangent%h0)))
      here%q = here%state%h0 - dot_product(here%tangent%along, here%state%gap)
      there%q = here%q + sense*step
      if (maxval(abs(here%tangent%along)) > 0) then
        expected = here%state
        expected%h0 = expected%h0 + sense*step*here%tangent%h0
        expected%gap = expected%gap + sense*step*here%tangent%gap
        if (too_near(expected%gap, here%state%gap)) expected = here%state
      else
        if (just_beyond*step > abs(h0 - here%state%h0)) there%q = h0
        expected = expected_at(self, there%q, memory)
      end if
      there%state = expected
      call reach(self, options, here%tangent%along, there, good)
      if (good) good = joins(here%state, here%tangent, there%state, there%tangent) .and. &
        (there%tangent%stable .eqv. there%tangent%h0 > 0)
      if (good .and. min(here%tangent%h0, there%tangent%h0) < steep) good = &
        change(here%state, there%state) <= small
      if (good .and. is_pinned(self)) good = is_expected(here%state, expected, there%state)
    end subroutine go

  end subroutine follow

  !> Solves the state at Q = point%q, beginning with point%state, and its tangent. along: the
  !> weights in Q.
  subroutine reach(self, options, along, point, good)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: along(:)
    type(point_t), intent(inout) :: point
    logical, intent(out) :: good
    type(control_t) :: control

    control%value = point%q
    self%along = along
    call self%correct(control, point%state, good, options)
    if (good) then
      call tangent_at(self, control, point%state, point%tangent)
      good = point%tangent%regular
    end if
    deallocate (self%along)
  end subroutine reach

  !> The part of the step at which the slope dh0/dQ of Hermite's polynomial is lowest, if it is so
  !> low that a state has to be solved there; otherwise 0.
  pure real(wp) function lowest_within(here, there) result(part)
    type(point_t), intent(in) :: here, there
    real(wp) :: slope(3)

    part = 0
    slope = slope_between(here, there)
    if (.not. slope(3) > 0) return
    part = -slope(2)/(2*slope(3))
    if (part < apart .or. part > 1 - apart) then
      part = 0
    else if (slope(1) + part*(slope(2) + part*slope(3)) > &
      flat*min(here%tangent%h0, there%tangent%h0)) then
      part = 0
    end if
  end function lowest_within

  !> The step after the one from `here` to `there`: twice as long, but not farther than just beyond
  !> the fold that the slopes dh0/dQ predict.
  pure real(wp) function next_step(here, there, step) result(next)
    type(point_t), intent(in) :: here, there
    real(wp), intent(in) :: step
    real(wp) :: fall

    next = 2*step
    fall = (here%tangent%h0 - there%tangent%h0)/step
    if (fall*next > there%tangent%h0) next = just_beyond*there%tangent%h0/fall
  end function next_step

  !> Coefficients of the slope dh0/dQ between two points, as a polynomial of the fraction of the
  !> distance.
  pure function slope_between(here, there) result(slope)
    type(point_t), intent(in) :: here, there
    real(wp) :: slope(3)

    associate (a => here%tangent%h0, b => there%tangent%h0, &
      mean => (there%state%h0 - here%state%h0)/(there%q - here%q))
      slope = [a, 6*mean - 4*a - 2*b, 3*(a + b - 2*mean)]
    end associate
  end function slope_between

  !> The fold between two points, of which the second is beyond it. Results: see `follow`.
  subroutine find_fold(self, options, h0, sense, first, second, outcome, last, fold, nearest)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0, sense
    type(point_t), intent(in) :: first, second
    integer, intent(inout) :: outcome
    type(state_t), intent(inout) :: last, nearest
    type(place_t), intent(inout) :: fold
    type(point_t) :: low, high, trial
    real(wp) :: slope(3), part, bend, way
    logical :: good
    integer :: round

    low = first
    high = second
    do round = 1, most_rounds
      slope = slope_between(low, high)
      part = 2*slope(1)/(-slope(2) + sqrt(max(0.0_wp, slope(2)**2 - 4*slope(1)*slope(3))))
      trial = guess_between(low, high, low%q + part*(high%q - low%q))
      call reach(self, options, low%tangent%along, trial, good)
      if (.not. good) return
      bend = abs(slope(2) + 2*part*slope(3))/abs(high%q - low%q)
      way = trial%tangent%h0/bend
      if (trial%tangent%h0 > 0) low = trial
      if (.not. trial%tangent%h0 > 0) high = trial
      if (0.5_wp*abs(trial%tangent%h0*way) < error_of_h0) exit
    end do
    ! The branch may pass h0 before its fold.
    if ((trial%state%h0 - h0)*sense >= 0) then
      call arrive(self, options, h0, sense, first, trial, outcome, last)
      return
    end if
    outcome = at_fold
    last = low%state
    nearest = trial%state
    fold = place_without_state(trial%state%h0 + 0.5_wp*sense*trial%tangent%h0*way, &
      trial%state%load + sense*trial%tangent%load*way)
    fold%left(of_h0) = max(error_of_h0, 0.5_wp*abs(trial%tangent%h0*way)) + trial%state%residual
  end subroutine find_fold

  !> The state at a Q between two points, as a guess: by Hermite's cubics.
  type(point_t) function guess_between(low, high, q) result(guess)
    type(point_t), intent(in) :: low, high
    real(wp), intent(in) :: q
    real(wp), dimension(2) :: of_value, of_slope

    guess = low
    guess%q = q
    call hermite_weights([low%q, high%q], q, of_value, of_slope)
    guess%state%h0 = of_value(1)*low%state%h0 + of_value(2)*high%state%h0 + &
      of_slope(1)*low%tangent%h0 + of_slope(2)*high%tangent%h0
    guess%state%gap = of_value(1)*low%state%gap + of_value(2)*high%state%gap + &
      of_slope(1)*low%tangent%gap + of_slope(2)*high%tangent%gap
    if (too_near(guess%state%gap, low%state%gap)) guess%state%gap = low%state%gap
  end function guess_between

  !> The state at h0 between two points of a branch. Results: see `follow`.
  subroutine arrive(self, options, h0, sense, first, second, outcome, last)
    class(stepper_t), intent(inout) :: self
    type(solver_options_t), intent(in) :: options
    real(wp), intent(in) :: h0, sense
    type(point_t), intent(in) :: first, second
    integer, intent(inout) :: outcome
    type(state_t), intent(inout) :: last
    type(hermite_t) :: h0_of
    type(bracket_t) :: bracket
    type(point_t) :: guess
    logical :: good

    last = second%state
    good = abs(second%state%h0 - h0) <= 0
    if (.not. good) then
      h0_of = hermite_through([first%q, second%q], [first%state%h0, second%state%h0], &
        [first%tangent%h0, second%tangent%h0])
      bracket = bracket_t(first%q, second%q)
      do while (bracket%is_open())
        call bracket%narrow((h0_of%value(bracket%middle()) - h0)*sense < 0)
      end do
      guess = guess_between(first, second, bracket%middle())
      last = guess%state
      call self%frozen%forget()
      call self%correct(control_t(value=h0), last, good, options)
      if (good) good = change(guess%state, last) <= beside
    end if
    if (good) outcome = arrived
  end subroutine arrive

end module branch_end
