!> Folds that lie between two states of a path whose h0 seems to go on falling or rising: near the
!> adhesion strength at which jumps begin, two folds are so close that steps pass over both. They
!> show in the derivative of h0 along the path, which between them has the other sign.
module hidden_folds
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use equilibrium, only: state_t, cost_t
  use solver_options, only: solver_options_t
  use anderson, only: frozen_jacobian_t
  use edge_locked, only: mesh_pair_t
  use interpolation, only: polynomial_slope
  use root_finding, only: false_position_t
  use path_extremum, only: extremum_t
  use path_slopes, only: slopes_along_path
  use continuation, only: state_at, path_control
  implicit none
  private
  public :: find_hidden_folds

  !> The derivative, interpolated, must somewhere fall to this part of the mean one for folds to be
  !> looked for, and is evaluated at so many places.
  real(wp), parameter :: suspicious = 0.15_wp
  integer, parameter :: places = 60
  !> Rounds in which the least derivative is searched, and in which a fold is.
  integer, parameter :: searches = 5, halvings = 60
  !> Change of the path's coordinate below which a fold is found.
  real(wp), parameter :: near_enough = 1.0e-10_wp

contains

  !> The two folds between the last three of some states of a path, along which h0 goes one way;
  !> none where there are none. Coordinates run one way.
  subroutine find_hidden_folds(problem, pair, mesh, coordinate, states, options, folds, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: pair
    integer, intent(in) :: mesh
    real(wp), intent(in) :: coordinate(:)
    type(state_t), intent(in) :: states(:)
    type(solver_options_t), intent(in) :: options
    type(extremum_t), allocatable, intent(out) :: folds(:)
    type(cost_t), intent(inout) :: cost
    type(frozen_jacobian_t) :: frozen
    type(extremum_t) :: first, second
    real(wp) :: begin, finish, sense, mean, s, least, value, width, middle, beside(2)
    integer :: n, k, round
    logical :: lost

    allocate (folds(0))
    n = size(states)
    if (n < 4) return
    begin = coordinate(n - 2)
    finish = coordinate(n)
    mean = (states(n)%h0 - states(n - 2)%h0)/(finish - begin)
    sense = sign(1.0_wp, mean)
    least = huge(1.0_wp)
    middle = begin
    do k = 1, places - 1
      s = begin + (finish - begin)*k/places
      value = sense*polynomial_slope(coordinate, states%h0, s)
      if (value < least) then
        least = value
        middle = s
      end if
    end do
    if (.not. least < suspicious*abs(mean)) return

    ! The exact derivative's least value, by parabolas, until it is below zero.
    lost = .false.
    ! What lies near the newest state is in the middle with the next one, and surrounded then by
    ! what is known.
    width = min(0.1_wp*abs(finish - begin), 0.9_wp*abs(finish - middle), 0.9_wp*abs(middle - begin))
    if (width < 0.03_wp*abs(finish - begin)) return
    least = derivative(middle)
    do round = 1, searches
      if (lost) return
      if (least < 0) exit
      beside = [derivative(middle - width), derivative(middle + width)]
      if (lost) return
      if (minval(beside) < 0) then
        middle = middle + merge(-width, width, beside(1) < 0)
        least = minval(beside)
        exit
      end if
      ! A parabola that has no lowest point here has none below zero either.
      if (.not. beside(1) - 2*least + beside(2) > 0) return
      s = middle + 0.5_wp*width*(beside(1) - beside(2))/(beside(1) - 2*least + beside(2))
      middle = s
      width = 0.25_wp*width
      if (.not. (middle - width - begin)*(middle - width - finish) < 0) return
      if (.not. (middle + width - begin)*(middle + width - finish) < 0) return
      least = derivative(middle)
    end do
    if (lost .or. .not. least < 0) return
    call locate(begin, middle, first)
    call locate(finish, middle, second)
    if (lost) return
    deallocate (folds)
    allocate (folds(2))
    ! Along the way h0 first turns against its course, then back to it.
    first%sense = merge(1, -1, states(n)%h0 > states(n - 2)%h0)
    second%sense = -first%sense
    folds(1) = first
    folds(2) = second

  contains

    !> dh0/ds in the sense of the path's h0, so that it is positive but between folds; up to a
    !> positive factor, and with the state it is of.
    real(wp) function derivative(s, fold)
      real(wp), intent(in) :: s
      type(extremum_t), intent(out), optional :: fold
      type(state_t) :: state
      real(wp) :: h0_slope, load_slope
      logical :: fine

      derivative = 0
      call state_at(problem, pair, mesh, s, coordinate, states, options, frozen, state, fine, cost)
      if (fine) call slopes_along_path(problem, pair%grid(mesh), path_control(problem, mesh, s), &
        state, &
        frozen, h0_slope, load_slope, fine, cost)
      lost = lost .or. .not. fine
      if (.not. fine) return
      derivative = sense*h0_slope
      if (.not. present(fold)) return
      fold%coordinate = s
      fold%state = state
      fold%load_slope = load_slope
    end function derivative

    !> The fold between a place where the derivative is positive and one where it is negative.
    subroutine locate(outside, inside, fold)
      real(wp), intent(in) :: outside, inside
      type(extremum_t), intent(out) :: fold
      type(false_position_t) :: search
      real(wp) :: s, value
      integer :: step

      search = false_position_t(outside, inside, derivative(outside))
      search%at_negative = derivative(inside, fold)
      ! The fold may be just beyond a state; then h0 itself shows it.
      lost = lost .or. .not. (search%at_positive > 0 .and. search%at_negative < 0)
      do step = 1, halvings
        if (lost .or. abs(search%negative - search%positive) < near_enough) return
        s = search%next()
        value = derivative(s, fold)
        if (.not. abs(value) > 0) return
        if (abs(s - merge(search%positive, search%negative, value > 0)) < near_enough) return
        call search%take(s, value)
      end do
    end subroutine locate

  end subroutine find_hidden_folds

end module hidden_folds
