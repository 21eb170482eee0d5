!> The record of a traced path: its states in order, its folds found, polished and put in their
!> places, and the number of unstable modes of each state.
!>
!> A fold is an extremum of h0 along the path. Whether stability is lost or gained there follows
!> from the sense of turning in the plane of h0 and load (Maddocks, Arch. Rational Mech. Anal. 99,
!> 1987): with primes for derivatives along the path, an eigenvalue of the operator passes zero
!> upward where h0'' F' > 0. Far apart there are none below zero. Alternating signs would not do:
!> of the two folds that follow the jump into contact at large sigma, the first makes a second mode
!> unstable.
module trail
  use kinds, only: wp
  use problem, only: problem_t
  use equilibrium, only: state_t, cost_t
  use solver_options, only: solver_options_t
  use anderson, only: frozen_t
  use edge_locked, only: mesh_pair_t
  use tangent, only: path_slopes
  use interpolation, only: interpolated_maximum
  use tracer, only: tracer_t, state_at, path_control
  use hidden_folds, only: fold_t, find_hidden_folds
  implicit none
  private
  public :: trail_t, extend, collapsed, polish_extremum, quantity_of, of_h0, of_load

  !> The quantities whose extrema are polished.
  integer, parameter :: of_h0 = 1, of_load = 2
  !> Secants for an extremum, and the change of the path's coordinate below which it is found.
  integer, parameter :: most_rounds = 12
  real(wp), parameter :: root_tolerance = 1.0e-10_wp

  type :: trail_t
    integer :: held = 0
    type(state_t), allocatable :: state(:)
    !> Mesh and path coordinate of each state; unstable modes at it; whether it is a fold in h0.
    integer, allocatable :: mesh(:), unstable(:)
    real(wp), allocatable :: coordinate(:)
    logical, allocatable :: fold(:)
  end type trail_t

  !> Without repulsion the bodies fall onto each other once they have jumped, and the path goes on
  !> to no gap at all. What is left of the gap at the first fold when it is followed no farther,
  !> and if there is no fold, how many of the law's lengths.
  real(wp), parameter :: collapse = 0.3_wp

contains

  !> Whether the newest state of a trail is one of collapse.
  pure logical function collapsed(this, trail)
    type(problem_t), intent(in) :: this
    type(trail_t), intent(in) :: trail
    real(wp) :: scale
    integer :: first

    collapsed = .false.
    if (this%law%edge_gap > 0) return
    scale = 1
    first = findloc(trail%fold(:trail%held), .true., 1)
    if (first > 0) scale = trail%state(first)%axis_gap
    collapsed = trail%state(trail%held)%axis_gap < collapse*scale
  end function collapsed

  !> Advances the tracer by a step and appends the new state, and the fold if one has been passed.
  !> A fold between the two newest states is seen only with the next state, so what lies before the
  !> newest but one is final. A new trail begins with the tracer's own newest state. States are
  !> solved as `walking` says, folds as `options` says.
  subroutine extend(trail, walker, this, pair, walking, options, lost, cost)
    type(trail_t), intent(inout) :: trail
    type(tracer_t), intent(inout) :: walker
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    type(solver_options_t), intent(in) :: walking, options
    logical, intent(out) :: lost
    type(cost_t), intent(inout) :: cost
    integer :: n, unstable

    if (trail%held == 0) call insert(trail, 1, walker%past(walker%held), walker%mesh, &
      walker%coordinate(walker%held), 0, .false.)
    call walker%advance(this, pair, walking, lost, cost)
    if (lost) return
    n = walker%held
    unstable = trail%unstable(trail%held)
    call insert(trail, trail%held + 1, walker%past(n), walker%mesh, walker%coordinate(n), &
      unstable, .false.)
    if (n >= 3) then
      if (surrounded(walker%past(n - 2:n)%h0)) then
        call insert_fold(trail, walker, this, pair, options, lost, cost)
      else if (.not. any(trail%fold(max(1, trail%held - 4):trail%held))) then
        call insert_hidden(trail, walker, this, pair, options, cost)
      end if
    end if
    if (.not. lost) call walker%change_mesh(this, pair, walking, lost, cost)
  end subroutine extend

  !> Whether the middle one of three values is an extremum.
  pure logical function surrounded(value)
    real(wp), intent(in) :: value(3)

    surrounded = (value(2) - value(1))*(value(3) - value(2)) < 0
  end function surrounded

  !> Polishes the fold that the walker's last three states surround and puts it in its place.
  subroutine insert_fold(trail, walker, this, pair, options, lost, cost)
    type(trail_t), intent(inout) :: trail
    type(tracer_t), intent(in) :: walker
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    type(cost_t), intent(inout) :: cost
    type(state_t) :: state
    real(wp) :: s, curvature
    integer :: n, place, change, unstable

    n = walker%held
    call polish_extremum(this, pair, walker%mesh, of_h0, walker%coordinate(:n), walker%past(:n), &
      options, s, state, lost, cost)
    if (lost) return
    associate (past => walker%past(n - 2:n))
      curvature = past(1)%h0 - 2*past(2)%h0 + past(3)%h0
      change = merge(-1, 1, curvature*(past(3)%load - past(1)%load) > 0)
    end associate
    ! The newest state is last, the middle one before it; the fold is on either side of the middle.
    place = trail%held
    if ((s - walker%coordinate(n - 1))*(walker%coordinate(n) - walker%coordinate(n - 1)) < 0) &
      place = trail%held - 1
    ! Behind the first state of the trail: it was begun there because that side is known.
    if (place < 2) return
    unstable = trail%unstable(place - 1) + max(change, 0)
    call insert(trail, place, state, walker%mesh, s, unstable, .true.)
    trail%unstable(place + 1:trail%held) = trail%unstable(place + 1:trail%held) + change
  end subroutine insert_fold

  !> Puts folds that the walker's last three states pass over in their places.
  subroutine insert_hidden(trail, walker, this, pair, options, cost)
    type(trail_t), intent(inout) :: trail
    type(tracer_t), intent(in) :: walker
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    type(solver_options_t), intent(in) :: options
    type(cost_t), intent(inout) :: cost
    type(fold_t), allocatable :: folds(:)
    real(wp) :: travel, curvature
    integer :: i, n, place, change

    n = walker%held
    call find_hidden_folds(this, pair, walker%mesh, walker%coordinate(:n), walker%past(:n), &
      options, folds, cost)
    travel = sign(1.0_wp, walker%coordinate(n) - walker%coordinate(n - 1))
    do i = 1, size(folds)
      place = trail%held
      do while ((trail%coordinate(place - 1) - folds(i)%coordinate)*travel > 0)
        place = place - 1
        ! Behind the first state of the trail, or of this mesh.
        if (place < 2) return
        if (trail%mesh(place - 1) /= walker%mesh) return
      end do
      ! Along the way h0 first turns against its course, then back to it.
      curvature = walker%past(n - 2)%h0 - walker%past(n)%h0
      if (i == 2) curvature = -curvature
      change = merge(-1, 1, curvature*travel*folds(i)%load_slope > 0)
      call insert(trail, place, folds(i)%state, walker%mesh, folds(i)%coordinate, &
        trail%unstable(place - 1) + max(change, 0), .true.)
      trail%unstable(place + 1:trail%held) = trail%unstable(place + 1:trail%held) + change
    end do
  end subroutine insert_hidden

  !> The state at the extremum of h0 or load that the last three states surround: a root of its
  !> exact derivative along the path, begun at the extremum of the polynomial through the states
  !> and found by secants. lost: a solve failed or the root escaped.
  subroutine polish_extremum(this, pair, mesh, quantity, coordinate, states, options, s, state, &
    lost, cost)
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    integer, intent(in) :: mesh, quantity
    real(wp), intent(in) :: coordinate(:)
    type(state_t), intent(in) :: states(:)
    type(solver_options_t), intent(in) :: options
    real(wp), intent(out) :: s
    type(state_t), intent(out) :: state
    logical, intent(out) :: lost
    type(cost_t), intent(inout) :: cost
    type(state_t) :: trial
    type(frozen_t) :: frozen
    real(wp) :: slopes(2), slope, slope_size, slope_before, s_before, s_next, s_best, low, high
    integer :: round, sense, n
    logical :: converged

    n = size(states)
    associate (value => quantity_of(quantity, states))
      sense = merge(1, -1, value(n - 1) > value(n))
      low = minval(coordinate(n - 2:))
      high = maxval(coordinate(n - 2:))
      s = interpolated_maximum(coordinate, sense*value, low, high)
    end associate
    slope_size = huge(1.0_wp)
    do round = 1, most_rounds
      call state_at(this, pair, mesh, s, coordinate, states, options, frozen, trial, converged, &
        cost)
      lost = .not. converged
      if (lost) return
      call path_slopes(this, pair%grid(mesh), path_control(this, mesh, s), trial, frozen, &
        slopes(1), slopes(2), converged, cost)
      lost = .not. converged
      if (lost) return
      slope = slopes(quantity)
      if (abs(slope) < slope_size) then
        slope_size = abs(slope)
        state = trial
        s_best = s
      else if (round > 2) then
        ! Rounding rules once the derivative no longer falls; the first two only set the secant up.
        exit
      end if
      ! A maximum has its rising side before it.
      if ((slope > 0) .eqv. (sense > 0)) then
        low = s
      else
        high = s
      end if
      if (round == 1) then
        s_next = s + sign(1.0e-4_wp*(high - low) + 1.0e-7_wp, sense*slope)
      else if (abs(slope - slope_before) > tiny(slope)) then
        s_next = s - slope*(s - s_before)/(slope - slope_before)
      else
        exit
      end if
      if (s_next < low .or. s_next > high) s_next = 0.5_wp*(low + high)
      if (abs(s_next - s) < root_tolerance) exit
      s_before = s
      slope_before = slope
      s = s_next
    end do
    s = s_best
  end subroutine polish_extremum

  !> H0 or load of states.
  pure function quantity_of(quantity, states) result(value)
    integer, intent(in) :: quantity
    type(state_t), intent(in) :: states(:)
    real(wp) :: value(size(states))

    if (quantity == of_h0) then
      value = states%h0
    else
      value = states%load
    end if
  end function quantity_of

  !> Puts a state in the given place, later ones move up.
  subroutine insert(trail, place, state, mesh, coordinate, unstable, fold)
    type(trail_t), intent(inout) :: trail
    integer, intent(in) :: place, mesh, unstable
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: coordinate
    logical, intent(in) :: fold
    integer :: j

    if (.not. allocated(trail%state)) then
      allocate (trail%state(64), trail%mesh(64), trail%coordinate(64), trail%unstable(64), &
        trail%fold(64))
    else if (trail%held == size(trail%mesh)) then
      trail%state = [trail%state, trail%state]
      trail%mesh = [trail%mesh, trail%mesh]
      trail%coordinate = [trail%coordinate, trail%coordinate]
      trail%unstable = [trail%unstable, trail%unstable]
      trail%fold = [trail%fold, trail%fold]
    end if
    do j = trail%held, place, -1
      trail%state(j + 1) = trail%state(j)
      trail%mesh(j + 1) = trail%mesh(j)
      trail%coordinate(j + 1) = trail%coordinate(j)
      trail%unstable(j + 1) = trail%unstable(j)
      trail%fold(j + 1) = trail%fold(j)
    end do
    trail%held = trail%held + 1
    trail%state(place) = state
    trail%mesh(place) = mesh
    trail%coordinate(place) = coordinate
    trail%unstable(place) = unstable
    trail%fold(place) = fold
  end subroutine insert

end module trail
