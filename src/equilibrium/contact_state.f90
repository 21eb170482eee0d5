!> A dimensionless state of the two bodies at the nodes of a mesh, its transfer to another mesh, and
!> the search for the radius of a given gap.
module contact_state
  use kinds, only: wp, pi
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t, contact_level_of
  use discretisation, only: discretisation_t
  use root_finding, only: root_search_t, new_root_search
  implicit none
  private
  public :: state_t, undeformed_state, too_near, regrid, load_reach, gap_at_end, gap_at, gaps_at, &
    radius_of_gap, radius_of_step, contact_radius_of, felt_load, far_gap

  !> At gaps above this value, in the law's lengths, forces do not depend on the last digits.
  real(wp), parameter :: far_gap = 1000
  !> The smallest gap of a useful guess, relative to the smallest gap of the known state.
  real(wp), parameter :: least_of_known = 0.5_wp

  type :: state_t
    real(wp), allocatable :: gap(:), pressure(:)
    real(wp) :: h0 = 0, scale = 1
    real(wp) :: axis_gap = 0, load = 0
    !> Largest |G|, in the law's lengths; relative to the gap for gaps above `far_gap`.
    real(wp) :: residual = huge(1.0_wp)
    !> Number of operator products for this state.
    integer :: iterations = 0
  contains
    procedure :: become
    procedure :: of => weighted
  end type state_t

contains

  !> Copies another state into the allocated arrays, without a new allocation.
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

  !> The combination weights(1) h0 + weights(2) load.
  pure real(wp) function weighted(self, weights)
    class(state_t), intent(in) :: self
    real(wp), intent(in) :: weights(2)

    weighted = dot_product(weights, [self%h0, self%load])
  end function weighted

  !> The undeformed bodies at h0, on a mesh of the given scale.
  pure type(state_t) function undeformed_state(shape, grid, h0, scale) result(state)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: h0, scale

    state%h0 = h0
    state%axis_gap = h0
    state%scale = scale
    state%gap = h0 + shape%height(scale*grid%x(:grid%nodes))
    allocate (state%pressure(grid%nodes), source=0.0_wp)
  end function undeformed_state

  !> Whether guessed gaps are much smaller than those of a known state, so that the law may have no
  !> pressure there, or an enormous one. Known gaps below zero do not limit the guess.
  pure logical function too_near(guess, known)
    real(wp), intent(in) :: guess(:), known(:)
    real(wp) :: nearest

    nearest = minval(known)
    too_near = nearest > 0 .and. minval(guess) < least_of_known*nearest
  end function too_near

  !> Radius of the end of a bounded mesh, lateral units.
  pure real(wp) function load_reach(grid, state)
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    load_reach = state%scale*grid%end
  end function load_reach

  !> The load over 2 pi to which errors of a state are relative: its own load or the adhesion,
  !> whichever is larger, but at most the load of the absolute pressures.
  pure real(wp) function felt_load(problem, grid, state) result(load)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    load = max(abs(state%load)/(2*pi), min(problem%law%adhesion, &
      state%scale**2*sum(grid%weight*abs(state%pressure))), epsilon(1.0_wp)*problem%law%adhesion)
  end function felt_load

  !> The gap at the end of a bounded mesh, with the deformation at the last node.
  pure real(wp) function gap_at_end(shape, grid, state) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    gap = state%gap(grid%nodes) + (shape%height(load_reach(grid, state)) - &
      shape%height(state%scale*grid%x(grid%nodes)))
  end function gap_at_end

  !> Whether the gap at a position is interpolated as the difference of gap and shape, which is
  !> bounded on an unbounded mesh, and smooth for bodies that may end within a panel.
  pure logical function as_difference(shape, grid, x)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: x

    as_difference = .not. shape%parabolic .or. grid%in_tail(x)
  end function as_difference

  !> The gap of a state at a position on its mesh.
  pure real(wp) function gap_at(shape, grid, state, x) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: x

    if (as_difference(shape, grid, x)) then
      gap = shape%height(state%scale*x) + &
        grid%interpolate(state%gap - shape%height(state%scale*grid%x), x)
    else
      gap = grid%interpolate(state%gap, x)
    end if
  end function gap_at

  !> The same at many positions, in ascending order.
  pure function gaps_at(shape, grid, state, x) result(gap)
    class(shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: x(:)
    real(wp) :: gap(size(x))
    integer :: n

    do n = size(x), 1, -1
      if (.not. as_difference(shape, grid, x(n))) exit
    end do
    gap(:n) = grid%interpolate_all(state%gap, x(:n))
    if (n == size(x)) return
    gap(n + 1:) = shape%height(state%scale*x(n + 1:)) + &
      grid%interpolate_all(state%gap - shape%height(state%scale*grid%x), x(n + 1:))
  end function gaps_at

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

  !> The radius at which the gap of a state is that of the law's step; 0: there is none.
  pure real(wp) function radius_of_step(problem, grid, state) result(c)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    c = 0
    if (problem%law%step_width > 0) &
      c = radius_of_gap(problem%shape, problem%law%step_at, grid, state)
  end function radius_of_step

  !> Contact radius of a state, lateral units; 0 without contact.
  pure real(wp) function contact_radius_of(problem, grid, state) result(radius)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    radius = radius_of_gap(problem%shape, contact_level_of(problem), grid, state)
  end function contact_radius_of

  !> The state on another mesh at a given scale. Gaps are interpolated; beyond the old mesh the
  !> deformation decays as 1/r.
  pure type(state_t) function regrid(shape, state, from, to, scale) result(new)
    class(shape_t), intent(in) :: shape
    type(state_t), intent(in) :: state
    type(discretisation_t), intent(in) :: from, to
    real(wp), intent(in) :: scale
    real(wp) :: raised
    integer :: within

    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(to%nodes), new%pressure(to%nodes))
    new%pressure = 0
    new%scale = scale
    associate (x => to%x*(scale/state%scale), gap => new%gap)
      within = count(x <= from%end)
      gap(:within) = gaps_at(shape, from, state, x(:within))
      if (within == to%nodes) return
      raised = gap_at(shape, from, state, from%end) - state%h0 - &
        shape%height(state%scale*from%end)
      gap(within + 1:) = state%h0 + raised*from%end/x(within + 1:) + &
        shape%height(state%scale*x(within + 1:))
    end associate
  end function regrid

end module contact_state
