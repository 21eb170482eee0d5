!> Follows the equilibrium path from afar into contact, stable and unstable, in coordinates in which
!> it has no folds: the gap on the axis before contact, the contact radius in contact
!> (`edge_locked`). Each step is
!> extrapolated from the last states and corrected by the accelerated iteration.
module continuation
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use interpolation, only: polynomial_weights
  use equilibrium, only: control_t, state_t, equations_t, at_axis_gap, at_edge_radius, &
    radius_of_gap
  use solver_options, only: solver_options_t
  use anderson, only: solve_anderson
  use frozen_jacobian, only: frozen_jacobian_t
  use edge_locked, only: approach
  use regridding, only: regrid
  implicit none
  private
  public :: arc_t, continuation_t, new_continuation, path_control, coordinate_of, state_at, &
    between, most_states

  !> States of an arc; of them those kept for the extrapolation; and limits of a step (relative
  !> change of the coordinate).
  integer, parameter :: most_states = 6, memory = 4
  real(wp), parameter :: smallest_step = 1.0e-6_wp
  !> The least contact radius over that of a passage for a state to be taken to the next mesh.
  real(wp), parameter :: nearly_passed = 0.5_wp

  !> Some states of the path on one mesh and their coordinates, in order.
  type :: arc_t
    integer :: mesh = approach, held = 0
    real(wp) :: coordinate(most_states) = 0
    type(state_t) :: state(most_states)
  end type arc_t

  !> The last states on the mesh in use, newest last.
  type, extends(arc_t) :: continuation_t
    real(wp) :: step = 0.05_wp, largest_step = 0.15_wp
    type(frozen_jacobian_t) :: frozen
  contains
    procedure :: advance
    procedure, private :: remember
    procedure :: change_mesh
  end type continuation_t

contains

  !> A tracer that starts from an equilibrium on one of the meshes.
  function new_continuation(problem, state, mesh, largest_step) result(tracer)
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    real(wp), intent(in) :: largest_step
    type(continuation_t) :: tracer

    tracer%mesh = mesh
    tracer%largest_step = largest_step
    tracer%step = 0.3_wp*largest_step
    call tracer%remember(problem, state)
  end function new_continuation

  !> Whether the coordinate grows along the way towards contact: the gap on the axis shrinks, the
  !> contact radius grows.
  pure integer function sense_of(self)
    class(continuation_t), intent(in) :: self

    sense_of = merge(-1, 1, self%mesh == approach)
  end function sense_of

  !> The next state of the path, on the same mesh. lost: no step, however small, converged.
  subroutine advance(self, equations, options, lost)
    class(continuation_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    type(state_t) :: trial
    real(wp) :: s
    logical :: converged

    lost = .false.
    self%step = min(self%step, longest_step(equations%problem, self))
    do
      s = self%coordinate(self%held) + sense_of(self)*self%step
      call state_at(equations, options, self%frozen, self%arc_t, s, trial, converged)
      if (converged) exit
      equations%cost%rejected_steps = equations%cost%rejected_steps + 1
      self%frozen%factors%valid = .false.
      self%step = 0.3_wp*self%step
      lost = self%step < smallest_step
      if (lost) return
    end do
    if (trial%iterations <= 6) self%step = min(1.4_wp*self%step, self%largest_step)
    if (trial%iterations > 12) self%step = 0.7_wp*self%step
    call self%remember(equations%problem, trial)
  end subroutine advance

  !> The longest step of the path's coordinate. Where the axis passes a step of the pressure all
  !> changes over the width of it, and h0 may turn several times.
  pure real(wp) function longest_step(problem, self) result(longest)
    type(problem_t), intent(in) :: problem
    class(continuation_t), intent(in) :: self
    !> Parts of the step's width that are passed at once, and reach of the step in its widths.
    real(wp), parameter :: at_once = 0.25_wp, reach = 4

    longest = self%largest_step
    if (self%mesh /= approach .or. .not. problem%law%step_width > 0) return
    associate (law => problem%law, gap => self%state(self%held)%axis_gap)
      longest = min(longest, max(at_once*law%step_width, &
        0.5_wp*(abs(gap - law%step_at) - reach*law%step_width))/(gap - 0.9_wp*law%rest_gap))
    end associate
  end function longest_step

  !> The control that prescribes the path's coordinate s on a mesh: the logarithm of the gap on the
  !> axis above nine tenths of the gap at rest, or of the contact radius.
  pure function path_control(problem, mesh, s) result(control)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(control_t) :: control

    control%mesh = mesh
    if (mesh == approach) then
      control%kind = at_axis_gap
      control%value = exp(s) + 0.9_wp*problem%law%rest_gap
    else
      control%kind = at_edge_radius
      control%value = exp(s)
    end if
  end function path_control

  !> Inverse of `path_control` for a state.
  pure real(wp) function coordinate_of(problem, mesh, state) result(s)
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    if (mesh == approach) then
      ! Nearer than nine tenths no state is on this mesh, but one may be asked about.
      s = log(max(state%axis_gap - 0.9_wp*problem%law%rest_gap, tiny(1.0_wp)))
    else
      s = log(state%scale)
    end if
  end function coordinate_of

  !> Solves a state of one mesh again on the other, at the same contact radius or axis gap.
  !> done = .false. where it has no contact edge to lock to, or did not converge.
  subroutine move_to_mesh(equations, options, frozen, from, to, state, done)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    integer, intent(in) :: from, to
    type(state_t), intent(inout) :: state
    logical, intent(out) :: done
    real(wp) :: c

    associate (problem => equations%problem, meshes => equations%meshes)
      c = radius_for(equations, from, to, state)
      done = c > 0
      if (.not. done) return
      state = regrid(problem%shape, state, meshes%grid(from), meshes%grid(to), c)
      call solve_anderson(equations, options, frozen, &
        path_control(problem, to, coordinate_of(problem, to, state)), state, done)
    end associate
  end subroutine move_to_mesh

  !> State at the coordinate s: interpolated or extrapolated from those of an arc and corrected.
  subroutine state_at(equations, options, frozen, arc, s, state, converged)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: s
    type(state_t), intent(out) :: state
    logical, intent(out) :: converged

    state = between(arc%coordinate(:arc%held), arc%state(:arc%held), s)
    call solve_anderson(equations, options, frozen, path_control(equations%problem, arc%mesh, s), &
      state, converged)
  end subroutine state_at

  !> The polynomial through states of one mesh at the given coordinates, evaluated at s.
  pure function between(coordinate, states, s) result(guess)
    real(wp), intent(in) :: coordinate(:), s
    type(state_t), intent(in) :: states(:)
    type(state_t) :: guess
    real(wp) :: weight(size(states)), h0, scale
    real(wp) :: gap(size(states(1)%gap))
    integer :: j

    gap = 0
    h0 = 0
    scale = 0
    weight = polynomial_weights(coordinate, s)
    do j = 1, size(states)
      gap = gap + weight(j)*states(j)%gap
      h0 = h0 + weight(j)*states(j)%h0
      scale = scale + weight(j)*states(j)%scale
    end do
    ! An extrapolation that leaves the law's domain is worth less than the nearest state.
    guess = states(minloc(abs(coordinate - s), 1))
    guess%pressure = 0*gap
    if (minval(gap) < 0.5_wp*minval(guess%gap) .and. minval(guess%gap) > 0) return
    guess%gap = gap
    guess%h0 = h0
    if (scale > 0.5_wp*guess%scale) guess%scale = scale
  end function between

  !> Makes a state the newest.
  subroutine remember(self, problem, state)
    class(continuation_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state

    if (self%held == memory) then
      self%state(:memory - 1) = self%state(2:memory)
      self%coordinate(:memory - 1) = self%coordinate(2:memory)
    else
      self%held = self%held + 1
    end if
    self%state(self%held) = state
    self%coordinate(self%held) = coordinate_of(problem, self%mesh, state)
  end subroutine remember

  !> Passes to the next mesh once the contact radius has crossed the passage to it (to be called
  !> after each `advance`), taking the last two states along, so that three neighbours on one mesh
  !> surround every fold. That mesh must not be too coarse for the first of the two.
  subroutine change_mesh(self, equations, options, lost)
    class(continuation_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    type(state_t) :: taken(2)
    integer :: j
    logical :: done(2)

    lost = .false.
    associate (meshes => equations%meshes, next => self%mesh + 1)
      if (.not. equations%problem%law%edge_gap > 0 .or. self%mesh == size(meshes%grid)) return
      if (radius_for(equations, self%mesh, next, self%state(self%held)) < &
        meshes%passage(self%mesh)) return
      if (radius_for(equations, self%mesh, next, self%state(max(1, self%held - 1))) < &
        nearly_passed*meshes%passage(self%mesh)) return
    end associate
    self%frozen%factors%valid = .false.
    done(1) = .false.
    do j = max(1, self%held - 1), self%held
      taken(2 - self%held + j) = self%state(j)
      call move_to_mesh(equations, options, self%frozen, self%mesh, self%mesh + 1, &
        taken(2 - self%held + j), done(2 - self%held + j))
    end do
    lost = .not. done(2)
    self%mesh = self%mesh + 1
    self%held = 0
    do j = 1, 2
      if (done(j)) call self%remember(equations%problem, taken(j))
    end do
    self%step = 0.5_wp*self%step
  end subroutine change_mesh

  !> Radius, lateral units, of what one mesh is locked to for a state on another; 0 where the state
  !> has none.
  pure real(wp) function radius_for(equations, from, to, state) result(c)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: from, to
    type(state_t), intent(in) :: state

    associate (problem => equations%problem, meshes => equations%meshes)
      c = state%scale
      associate (gap => meshes%locked_gap(problem%law, to))
        if (from > approach .and. .not. abs(gap - meshes%locked_gap(problem%law, from)) > 0) return
        c = radius_of_gap(problem%shape, gap, meshes%grid(from), state)
      end associate
    end associate
  end function radius_for

end module continuation
