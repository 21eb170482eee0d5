!> Folds that lie between two states of a path whose h0 seems to go on falling or rising: near the
!> adhesion strength at which jumps begin, two folds are so close that steps pass over both. They
!> show in the derivative of h0 along the path, which between them has the other sign.
module hidden_folds
  use kinds, only: wp
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use frozen_jacobian, only: frozen_jacobian_t
  use interpolation, only: polynomial_slope
  use root_finding, only: false_position_t
  use path_extremum, only: extremum_t
  use path_slopes, only: slopes_along_path
  use continuation, only: arc_t, state_at, path_control
  implicit none
  private
  public :: find_hidden_folds

  !> The derivative, interpolated, must somewhere fall to this part of the mean one for folds to be
  !> looked for, and is evaluated at so many places.
  real(wp), parameter :: suspicious = 0.15_wp
  integer, parameter :: places = 60
  !> Rounds in which the least derivative is searched, and in which a fold is.
  integer, parameter :: searches = 5, most_steps = 60
  !> Change of the path's coordinate below which a fold is found.
  real(wp), parameter :: near_enough = 1.0e-10_wp

  !> The last three states of an arc: the coordinates between which they lie, and the mean
  !> derivative of h0 there, whose sign is that of its course. lost: a solve failed.
  type :: course_t
    real(wp) :: begin = 0, finish = 0, mean = 0
    logical :: lost = .false.
    type(frozen_jacobian_t) :: frozen
  end type course_t

contains

  !> The two folds between the last three states of an arc along which h0 goes one way; none where
  !> there are none.
  subroutine find_hidden_folds(equations, options, arc, folds)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    type(extremum_t), allocatable, intent(out) :: folds(:)
    type(course_t) :: course
    type(extremum_t) :: first, second
    real(wp) :: inside, least
    logical :: found

    allocate (folds(0))
    if (arc%held < 4) return
    associate (n => arc%held)
      course%begin = arc%coordinate(n - 2)
      course%finish = arc%coordinate(n)
      course%mean = (arc%state(n)%h0 - arc%state(n - 2)%h0)/(course%finish - course%begin)
    end associate
    call find_least_interpolated(arc, course, inside, least)
    if (.not. least < suspicious*abs(course%mean)) return
    call find_reversal(equations, options, arc, course, inside, found)
    if (.not. found) return
    call locate(equations, options, arc, course, course%begin, inside, first)
    call locate(equations, options, arc, course, course%finish, inside, second)
    if (course%lost) return
    ! Along the way h0 first turns against its course, then back to it.
    first%sense = merge(1, -1, arc%state(arc%held)%h0 > arc%state(arc%held - 2)%h0)
    second%sense = -first%sense
    deallocate (folds)
    allocate (folds(2))
    folds(1) = first
    folds(2) = second
  end subroutine find_hidden_folds

  !> Where the derivative of the polynomial through the states is least, in the sense of the course.
  pure subroutine find_least_interpolated(arc, course, place, least)
    type(arc_t), intent(in) :: arc
    type(course_t), intent(in) :: course
    real(wp), intent(out) :: place, least
    real(wp) :: s, value
    integer :: k

    least = huge(1.0_wp)
    place = course%begin
    do k = 1, places - 1
      s = course%begin + (course%finish - course%begin)*k/places
      value = sign(1.0_wp, course%mean)* &
        polynomial_slope(arc%coordinate(:arc%held), arc%state(:arc%held)%h0, s)
      if (value < least) then
        least = value
        place = s
      end if
    end do
  end subroutine find_least_interpolated

  !> Moves `middle`, which is near the least value of the exact derivative, by parabolas to where
  !> that is below zero, if it is anywhere.
  subroutine find_reversal(equations, options, arc, course, middle, found)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    type(course_t), intent(inout) :: course
    real(wp), intent(inout) :: middle
    logical, intent(out) :: found
    real(wp) :: least, width, beside(2)
    integer :: round

    found = .false.
    associate (begin => course%begin, finish => course%finish)
      ! What lies near the newest state is in the middle with the next one, and surrounded then by
      ! what is known.
      width = min(0.1_wp*abs(finish - begin), 0.9_wp*abs(finish - middle), &
        0.9_wp*abs(middle - begin))
      if (width < 0.03_wp*abs(finish - begin)) return
      do round = 1, searches + 1
        call take_slope(equations, options, arc, course, middle, least)
        found = least < 0 .and. .not. course%lost
        if (found .or. course%lost .or. round > searches) return
        call take_slope(equations, options, arc, course, middle - width, beside(1))
        call take_slope(equations, options, arc, course, middle + width, beside(2))
        found = minval(beside) < 0 .and. .not. course%lost
        if (found) middle = middle + merge(-width, width, beside(1) < 0)
        ! A parabola that has no lowest point here has none below zero either.
        if (found .or. course%lost .or. .not. beside(1) - 2*least + beside(2) > 0) return
        middle = middle + 0.5_wp*width*(beside(1) - beside(2))/(beside(1) - 2*least + beside(2))
        width = 0.25_wp*width
        if (.not. (middle - width - begin)*(middle - width - finish) < 0) return
        if (.not. (middle + width - begin)*(middle + width - finish) < 0) return
      end do
    end associate
  end subroutine find_reversal

  !> dh0/ds at a coordinate in the sense of the course, so that it is positive but between folds; up
  !> to a positive factor; and the state there, as a fold.
  subroutine take_slope(equations, options, arc, course, s, slope, fold)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    type(course_t), intent(inout) :: course
    real(wp), intent(in) :: s
    real(wp), intent(out) :: slope
    type(extremum_t), intent(out), optional :: fold
    type(extremum_t) :: here
    real(wp) :: h0_slope
    logical :: solved

    slope = 0
    here%coordinate = s
    call state_at(equations, options, course%frozen, arc, s, here%state, solved)
    if (solved) call slopes_along_path(equations, path_control(equations%problem, arc%mesh, s), &
      here%state, course%frozen, h0_slope, here%load_slope, solved)
    course%lost = course%lost .or. .not. solved
    if (.not. solved) return
    slope = sign(1.0_wp, course%mean)*h0_slope
    if (present(fold)) fold = here
  end subroutine take_slope

  !> The fold between a place where the derivative is positive and one where it is negative.
  subroutine locate(equations, options, arc, course, outside, inside, fold)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    type(course_t), intent(inout) :: course
    real(wp), intent(in) :: outside, inside
    type(extremum_t), intent(out) :: fold
    type(false_position_t) :: search
    real(wp) :: s, slope
    integer :: step

    search = false_position_t(outside, inside)
    call take_slope(equations, options, arc, course, outside, search%at_positive)
    call take_slope(equations, options, arc, course, inside, search%at_negative, fold)
    ! The fold may be just beyond a state; then h0 itself shows it.
    course%lost = course%lost .or. .not. (search%at_positive > 0 .and. search%at_negative < 0)
    do step = 1, most_steps
      if (course%lost .or. abs(search%negative - search%positive) < near_enough) return
      s = search%next()
      call take_slope(equations, options, arc, course, s, slope, fold)
      if (.not. abs(slope) > 0) return
      if (abs(s - merge(search%positive, search%negative, slope > 0)) < near_enough) return
      call search%take(s, slope)
    end do
  end subroutine locate

end module hidden_folds
