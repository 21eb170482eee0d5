!> The stretches of the path's curve that are stable under a drive (`driven_pieces`), before their
!> ends are solved. D is what is driven, a combination of h0 and load.
module stable_stretches
  use kinds, only: wp
  use equilibrium, only: equations_t
  use known_path, only: known_path_t
  use curve_states, only: curve_solver_t
  use curve_turns, only: find_turning_places
  implicit none
  private
  public :: edge_t, stretch_t, find_stretches

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

end module stable_stretches
