!> The stretches of the path's curve that are stable under a drive (`driven_pieces`), before their
!> ends are solved. D is what is driven, a combination of h0 and load.
module stable_stretches
  use kinds, only: wp
  use equilibrium, only: equations_t
  use known_path, only: known_path_t
  use path_curve, only: curve_t
  use curve_states, only: curve_solver_t, curve_state_t, place_t
  implicit none
  private
  public :: edge_t, stretch_t, find_stretches, find_turning_places

  !> An end of a stretch, in an interval of the curve at x. turns: D turns round there; between
  !> x - width and x + width it does so nowhere else.
  type :: edge_t
    integer :: interval = 0
    real(wp) :: x = 0, width = 0
    logical :: turns = .false.
  end type edge_t

  !> From afar inward; its ends are where stability ends, or where what is known of the path does.
  type :: stretch_t
    type(edge_t) :: first, last
    logical :: first_turns = .false., last_turns = .true.
  end type stretch_t

  !> Places of an interval at which the slope of D is looked at, and the width below which only its
  !> ends are.
  integer, parameter :: looks = 8
  real(wp), parameter :: narrow_interval = 1.0e-4_wp

contains

  !> All of them, in order.
  subroutine find_stretches(solver, equations, known, weights, stretches)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    real(wp), intent(in) :: weights(2)
    type(stretch_t), allocatable, intent(out) :: stretches(:)
    type(stretch_t) :: stretch
    type(edge_t) :: edge, end_before
    real(wp), allocatable :: x(:), places(:)
    integer :: i, k
    logical :: open, stable

    allocate (stretches(0))
    open = .false.
    do i = 1, size(solver%curve%interval)
      if (solver%curve%interval(i)%modes > 0) then
        ! A fold in h0: the path is no longer stable however stiff the spring is.
        if (open) stretches = [stretches, ended_at(end_before)]
        open = .false.
        cycle
      end if
      call find_turning_places(solver, equations, known, i, weights, places)
      associate (begin => solver%curve%begin_of(i), end => solver%curve%end_of(i))
        x = [begin%x, places, end%x]
        stable = .not. solver%curve%slope(i, weights, begin%x) < 0
      end associate
      do k = 1, size(x) - 1
        stable = .not. stable
        if (stable .eqv. open) cycle
        edge = edge_t(i, x(k), turns=k > 1)
        ! Half the way to the neighbouring edges contains this one alone.
        if (edge%turns) edge%width = 0.5_wp*min(x(k) - x(k - 1), x(k + 1) - x(k))
        if (stable) then
          stretch%first = edge
          stretch%first_turns = edge%turns .or. i > 1
        else
          stretches = [stretches, ended_at(edge)]
        end if
        open = stable
      end do
      end_before = edge_t(i, x(size(x)))
    end do
    if (.not. open) return
    stretch%last_turns = .false.
    stretches = [stretches, ended_at(end_before)]

  contains

    pure type(stretch_t) function ended_at(edge) result(ended)
      type(edge_t), intent(in) :: edge

      ended = stretch
      ended%last = edge
    end function ended_at

  end subroutine find_stretches

  !> Where within an interval a combination of h0 and load turns round, in order. The curve's slope
  !> is exact at the interval's ends alone: where it turns more than once, states between say
  !> whether the path does. A load that grows by orders of magnitude makes polynomials swing.
  subroutine find_turning_places(solver, equations, known, i, weights, places)
    type(curve_solver_t), intent(inout) :: solver
    type(equations_t), intent(inout) :: equations
    type(known_path_t), intent(in) :: known
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    real(wp), allocatable, intent(out) :: places(:)
    type(curve_state_t) :: state
    logical, allocatable :: falls(:)
    integer :: k

    places = turning_places(solver%curve, i, weights)
    if (size(places) < 2) return
    falls = [(mod(k, 2) == 0 .eqv. solver%curve%slope(i, weights, begin_x()) < 0, &
      k=0, size(places))]
    do k = 1, size(places) - 1
      call solver%state_of(equations, known, place_t(i, 0.5_wp*(places(k) + places(k + 1))), state)
      if (state%converged) falls(k + 1) = dot_product(weights, state%slopes) < 0
    end do
    places = pack(places, falls(:size(places)) .neqv. falls(2:))

  contains

    real(wp) function begin_x()
      associate (begin => solver%curve%begin_of(i))
        begin_x = begin%x
      end associate
    end function begin_x

  end subroutine find_turning_places

  !> Where within an interval the curve says that a combination of h0 and load turns round, in
  !> order.
  pure function turning_places(curve, i, weights) result(places)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: i
    real(wp), intent(in) :: weights(2)
    real(wp), allocatable :: places(:)
    real(wp) :: x, x_before, slope, slope_before
    integer :: k, n

    allocate (places(0))
    associate (begin => curve%begin_of(i), end => curve%end_of(i))
      n = merge(looks, 1, end%x - begin%x > narrow_interval)
      x_before = begin%x
      slope_before = curve%slope(i, weights, x_before)
      do k = 1, n
        x = begin%x + (end%x - begin%x)*k/n
        slope = curve%slope(i, weights, x)
        if ((slope < 0) .neqv. (slope_before < 0)) places = [places, &
          x_before + (x - x_before)*slope_before/(slope_before - slope)]
        x_before = x
        slope_before = slope
      end do
    end associate
  end function turning_places

end module stable_stretches
