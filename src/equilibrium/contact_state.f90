!> A state of the two bodies on the nodes of a mesh, dimensionless, and searches for the position of
!> a given gap.
module contact_state
  use kinds, only: wp, pi
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use root_finding, only: root_search_t, new_root_search
  implicit none
  private
  public :: state_t, state_from, load_reach, gap_at_end, gap_at, radius_of_gap, felt_load, far_gap

  !> At gaps this large, in the law's lengths, no force depends on the last digits.
  real(wp), parameter :: far_gap = 1000

  type :: state_t
    real(wp), allocatable :: gap(:), pressure(:)
    real(wp) :: h0 = 0, scale = 1
    real(wp) :: axis_gap = 0, load = 0
    !> Largest |G|, in units of the law's length; for gaps beyond `far_gap` relative to these.
    real(wp) :: residual = huge(1.0_wp)
    !> Operator products spent on this state.
    integer :: iterations = 0
  contains
    procedure :: become
  end type state_t

contains

  !> Copies another state into the arrays that are already allocated; an assignment would allocate
  !> them again.
  pure subroutine become(self, other)
    class(state_t), intent(inout) :: self
    type(state_t), intent(in) :: other

    self%gap = other%gap
    self%pressure = other%pressure
    self%h0 = other%h0
    self%scale = other%scale
    self%axis_gap = other%axis_gap
    self%load = other%load
    self%residual = other%residual
    self%iterations = other%iterations
  end subroutine become

  !> An empty state on so many nodes.
  pure type(state_t) function state_from(nodes) result(state)
    integer, intent(in) :: nodes

    allocate (state%gap(nodes), state%pressure(nodes), source=0.0_wp)
  end function state_from

  !> Where a bounded mesh ends, lateral units.
  pure real(wp) function load_reach(grid, state)
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    load_reach = state%scale*grid%end
  end function load_reach

  !> The load that errors of a state are measured against, over 2 pi: its own load or, if that is
  !> larger, the adhesion, but no more than all pressures of the state together make.
  pure real(wp) function felt_load(problem, grid, state) result(load)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    load = max(abs(state%load)/(2*pi), min(problem%law%adhesion, &
      state%scale**2*sum(grid%weight*abs(state%pressure))))
  end function felt_load

  !> The gap at the end of a bounded mesh, with the deformation of the last node.
  pure real(wp) function gap_at_end(shape, grid, state) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    gap = state%gap(grid%nodes) + (shape%height(load_reach(grid, state)) - &
      shape%height(state%scale*grid%x(grid%nodes)))
  end function gap_at_end

  !> The gap of a state at a position on its mesh. On an unbounded mesh, or where bodies may end
  !> within a panel, the gap minus the shape is interpolated, which is bounded and smooth.
  pure real(wp) function gap_at(shape, grid, state, x) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: x

    if (grid%in_tail(x) .or. .not. shape%parabolic) then
      gap = shape%height(state%scale*x) + &
        grid%interpolate(state%gap - shape%height(state%scale*grid%x), x)
    else
      gap = grid%interpolate(state%gap, x)
    end if
  end function gap_at

  !> Position, in lateral units, of the outermost point with the given gap; 0 if all gaps are
  !> larger.
  pure real(wp) function radius_of_gap(shape, level, grid, state) result(c)
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: level
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    type(root_search_t) :: search
    real(wp) :: x
    integer :: j

    do j = size(state%gap) - 1, 1, -1
      if (state%gap(j) < level) exit
    end do
    c = 0
    if (j == 0) then
      if (.not. state%axis_gap < level) return
      search = new_root_search(0.0_wp, state%axis_gap - level, grid%x(1), state%gap(1) - level)
    else if (grid%on_one_panel(j)) then
      c = state%scale*grid%crossing(state%gap, level, j)
      return
    else
      search = new_root_search(grid%x(j), state%gap(j) - level, grid%x(j + 1), &
        state%gap(j + 1) - level)
    end if
    do while (search%is_open())
      x = search%place()
      call search%note(x, gap_at(shape, grid, state, x) - level)
    end do
    c = state%scale*search%root
  end function radius_of_gap

end module contact_state
