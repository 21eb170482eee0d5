!> Numerical continuation of the equilibrium path from large separations into contact, through
!> stable and unstable states, in a coordinate in which the path has no folds (`path_coordinate`).
!> Each step is a prediction, extrapolated from the last states and their tangents, and a correction
!> by the accelerated iteration. The size of the correction determines the length of the next step.
module continuation
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use next_mesh, only: radius_for, locked_alike, beyond_passage
  use path_coordinate, only: coordinate_of, axis_gap_rate
  use path_point, only: path_point_t
  use path_tangent, only: tangent_along
  use arc, only: arc_t
  implicit none
  private
  public :: continuation_t, add_with_tangent

  !> Number of states kept for the extrapolation. Lengths of the first, the shortest and the longest
  !> step, as changes of the coordinate.
  integer, parameter :: memory = 4
  real(wp), parameter :: first_step = 0.04_wp, shortest_step = 1.0e-6_wp, longest_step = 0.5_wp
  !> Largest difference between guess and state that two or three iterations correct: of gaps, h0
  !> and load, relative or in the law's lengths. Largest and smallest ratio of successive steps;
  !> between these limits the ratio is an integer power of `rung`.
  real(wp), parameter :: wanted_miss = 1.5e-3_wp, growth = 2.5_wp, shrinkage = 0.3_wp, &
    rung = 1.2_wp
  !> If guess and state differ by more than `too_far`, the step may have passed folds unnoticed, and
  !> is repeated as a shorter one. Steps below `short` are not repeated.
  real(wp), parameter :: too_far = 0.01_wp, short = 1.0e-3_wp
  !> Relative error of slopes that serve only for predictions.
  real(wp), parameter :: slope_error = 1.0e-7_wp
  !> For a path whose points define a smooth curve: largest difference of h0 and load between guess
  !> and state, longest step, and number of states for the extrapolation. The error of a polynomial
  !> is a thousand times smaller between its points than beyond them.
  real(wp), parameter :: miss_of_curve = 1.0e-7_wp, step_of_curve = 0.12_wp
  integer, parameter :: states_of_curve = 4
  !> Steps longer than `shortest_passage` are multiplied by `shortening` until they end within the
  !> range of the mesh.
  real(wp), parameter :: shortest_passage = 0.05_wp, shortening = 0.6_wp

  !> The last states on the current mesh, newest last.
  type, extends(arc_t) :: continuation_t
    real(wp) :: step = first_step, longest_step = longest_step, miss_of_curve = wanted_miss, &
      slope_error = slope_error
    !> Part of the load that the nodes of a mesh may miss where the path enters it.
    real(wp) :: most = huge(1.0_wp)
    !> Whether no step on the current mesh converged.
    logical :: stuck = .false.
  contains
    procedure :: follow_closely
    procedure :: take
    procedure :: forget
    procedure :: is_full
    procedure :: advance
    procedure, private :: next_step
    procedure, private :: step_past_step
  end type continuation_t

contains

  !> Selects steps so short that the curve between the points of the path is exact to many digits.
  !> looser: factor by which its errors may be larger. The error of the extrapolation from n states
  !> is of order 2 n, so the longest step grows as looser**(1/(2 n)).
  pure subroutine follow_closely(self, looser)
    class(continuation_t), intent(inout) :: self
    real(wp), intent(in) :: looser

    self%longest_step = step_of_curve*looser**(0.5_wp/states_of_curve)
    self%miss_of_curve = miss_of_curve*looser
    self%slope_error = 0
    self%extrapolated_from = states_of_curve
  end subroutine follow_closely

  !> Takes an equilibrium on a mesh as the newest state. lost: the state has no tangent.
  subroutine take(self, solver, state, mesh, lost)
    class(continuation_t), intent(inout) :: self
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    logical, intent(out) :: lost

    self%mesh = mesh
    if (self%is_full()) call self%drop_first()
    call add_with_tangent(solver, self%slope_error, state, self%arc_t, lost)
  end subroutine take

  !> Removes all states and sets the step to the first one.
  pure subroutine forget(self)
    class(continuation_t), intent(inout) :: self
    type(arc_t) :: nothing

    nothing%extrapolated_from = self%extrapolated_from
    self%arc_t = nothing
    self%step = first_step
    self%stuck = .false.
  end subroutine forget

  !> Whether there are as many states as the extrapolation uses.
  pure logical function is_full(self)
    class(continuation_t), intent(in) :: self

    is_full = self%held == memory
  end function is_full

  !> Adds a state on the arc's mesh to an arc. lost: the state has no tangent.
  subroutine add_with_tangent(solver, slope_error, state, arc, lost)
    class(solver_t), intent(inout) :: solver
    real(wp), intent(in) :: slope_error
    type(state_t), intent(in) :: state
    type(arc_t), intent(inout) :: arc
    logical, intent(out) :: lost
    type(path_point_t) :: point
    logical :: found

    point%state = state
    point%mesh = arc%mesh
    point%coordinate = coordinate_of(solver%problem, solver%meshes, arc%mesh, state)
    call tangent_along(solver, point, found, slope_error)
    lost = .not. found
    if (found) call arc%add(point)
  end subroutine add_with_tangent

  !> Computes the next state of the path on the same mesh. lost: no step, however small, converged.
  subroutine advance(self, solver, lost)
    class(continuation_t), intent(inout) :: self
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(path_point_t) :: next
    real(wp) :: step, s, miss(3), off(2)
    logical :: converged

    lost = .false.
    self%stuck = .false.
    do
      step = self%next_step(solver%equations_t)
      s = self%point(self%held)%coordinate + step
      ! After a step of this length the earlier factors are no longer a good approximation.
      call solver%frozen%forget()
      call self%solve_at(solver, s, next, converged, self%slope_error, miss)
      if (converged) then
        ! The better kind of guess for this state is used for the next one.
        self%moved = self%moved .neqv. miss(2) < miss(1)
        off = [minval(miss(:2)), miss(3)]
        self%step = min(self%longest_step, &
          step*factor_for(minval([wanted_miss, self%miss_of_curve]/max(off, tiny(1.0_wp))), &
          2*self%extrapolated_from))
        if (maxval(off) < too_far .or. step < short) exit
      else
        self%step = shrinkage*self%step
      end if
      solver%cost%rejected_steps = solver%cost%rejected_steps + 1
      lost = self%step < shortest_step
      self%stuck = lost
      if (lost) return
    end do
    if (self%is_full()) call self%drop_first()
    call self%add(next)
  end subroutine advance

  !> The ratio of the next step to this one. ratio: the allowed miss over the miss of this step;
  !> order: the order of the error of the extrapolation, two for each state with its tangent. The
  !> result is a power of `rung`, so that rounding does not change the positions of points.
  pure real(wp) function factor_for(ratio, order) result(factor)
    real(wp), intent(in) :: ratio
    integer, intent(in) :: order

    factor = rung**floor(log(ratio)/(order*log(rung)))
    factor = min(growth, max(shrinkage, factor))
  end function factor_for

  !> The length of the next step, limited by the range in which the mesh is accurate.
  pure real(wp) function next_step(self, equations) result(step)
    class(continuation_t), intent(in) :: self
    type(equations_t), intent(in) :: equations
    real(wp) :: s
    logical :: locked

    associate (meshes => equations%meshes, mesh => self%mesh)
      step = min(self%step, self%step_past_step(equations%problem, meshes%is_about_axis(mesh)))
      if (.not. equations%problem%law%edge_gap > 0) return
      s = self%point(self%held)%coordinate
      ! The last mesh has no end if it is about the axis.
      if (mesh == size(meshes%grid) .and. meshes%is_about_axis(mesh)) return
      ! The mesh ends at a known coordinate if it is the last one, or in an outer contact, or locked
      ! to the same radius as the next one.
      locked = mesh == size(meshes%grid) .or. meshes%is_in_outer_contact(mesh)
      if (.not. locked) locked = locked_alike(equations, mesh, mesh + 1)
      if (locked) then
        step = min(step, max(log(beyond_passage*meshes%reach(2, mesh)) - s, shortest_passage))
        return
      end if
      do while (step > shortest_passage)
        if (radius_for(equations, mesh, mesh + 1, self%guess(equations%problem, &
          meshes%grid(mesh), s + step)) <= beyond_passage*meshes%passage(mesh)) exit
        step = shortening*step
      end do
    end associate
  end function next_step

  !> The longest step where the gap on the axis passes a step of the pressure. All quantities change
  !> over the width of that step, and h0 may turn several times.
  pure real(wp) function step_past_step(self, problem, about_axis) result(longest)
    class(continuation_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: about_axis
    !> Largest change of the gap on the axis in one step of the path, near the step of the pressure;
    !> distance from that step up to which a gap counts as near. Both are in widths of the step of
    !> the pressure.
    real(wp), parameter :: at_once = 0.25_wp, reach = 4

    longest = huge(longest)
    if (.not. (about_axis .and. problem%law%step_width > 0)) return
    associate (law => problem%law, gap => self%point(self%held)%state%axis_gap)
      longest = max(at_once*law%step_width, &
        0.5_wp*(abs(gap - law%step_at) - reach*law%step_width))/ &
        abs(axis_gap_rate(law, self%point(self%held)%coordinate))
    end associate
  end function step_past_step

end module continuation
