!> Follows the equilibrium path from afar into contact, stable and unstable, in the coordinate in
!> which it has no folds (`path_coordinate`). Each step is extrapolated from the last states and
!> their tangents, and corrected by the accelerated iteration; how far the correction goes decides
!> how long the next step is.
module continuation
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use contact_state, only: state_t, radius_of_gap
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use edge_locked, only: approach
  use seen_gaps, only: seen_gaps_t
  use contact_state, only: felt_load
  use regridding, only: regrid
  use path_coordinate, only: path_control, coordinate_of
  use path_tangent, only: tangent_t, tangent_along
  use arc, only: arc_t
  implicit none
  private
  public :: continuation_t, radius_for

  !> States kept for the extrapolation; the first step, the shortest and the longest (changes of the
  !> coordinate).
  integer, parameter :: memory = 4
  real(wp), parameter :: first_step = 0.04_wp, shortest_step = 1.0e-6_wp, longest_step = 0.5_wp
  !> How far a guess may be from the state, relative or in the law's lengths, for two or three
  !> iterations to correct it; the power of the step that an extrapolation from four states with
  !> tangents misses by; limits of the change of a step, and its ladder.
  real(wp), parameter :: wanted_miss = 3.0e-4_wp, growth = 2.5_wp, shrinkage = 0.3_wp, &
    rung = 1.2_wp
  integer, parameter :: order = 8
  !> Relative error of slopes that are only to guess states from.
  real(wp), parameter :: slope_error = 1.0e-7_wp
  !> The same of a path whose points are to make a smooth curve, and its longest step.
  real(wp), parameter :: miss_of_curve = 1.0e-7_wp, step_of_curve = 0.12_wp
  !> The least contact radius over that of a passage for a state to be taken to the next mesh; the
  !> largest that a step may lead to on a mesh, which is no good beyond, and how short it is made
  !> for that.
  real(wp), parameter :: nearly_passed = 0.8_wp, beyond_passage = 1.1_wp, shortest_passage = 0.05_wp

  !> The last states on the mesh in use, newest last.
  type, extends(arc_t) :: continuation_t
    real(wp) :: step = first_step, longest_step = longest_step, wanted_miss = wanted_miss, &
      slope_error = slope_error
  contains
    procedure :: follow_closely
    procedure :: take
    procedure :: forget
    procedure :: advance
    procedure :: has_come_to_next
    procedure :: change_mesh
    procedure, private :: next_step
    procedure, private :: step_past_step
  end type continuation_t

contains

  !> Lets the points of the path make a curve that is exact between them to many digits.
  pure subroutine follow_closely(self)
    class(continuation_t), intent(inout) :: self

    self%longest_step = step_of_curve
    self%wanted_miss = miss_of_curve
    self%slope_error = 0
  end subroutine follow_closely

  !> Takes an equilibrium on a mesh for its newest state. lost: it has no tangent.
  subroutine take(self, solver, state, mesh, lost)
    class(continuation_t), intent(inout) :: self
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    logical, intent(out) :: lost

    self%mesh = mesh
    if (self%held == memory) call self%drop_first()
    call add_with_tangent(solver, self%slope_error, state, self%arc_t, lost)
  end subroutine take

  !> Forgets its states and how long steps were.
  pure subroutine forget(self)
    class(continuation_t), intent(inout) :: self
    type(arc_t) :: nothing

    self%arc_t = nothing
    self%step = first_step
  end subroutine forget

  !> Adds a state to an arc of its mesh. lost: it has no tangent.
  subroutine add_with_tangent(solver, slope_error, state, arc, lost)
    class(solver_t), intent(inout) :: solver
    real(wp), intent(in) :: slope_error
    type(state_t), intent(in) :: state
    type(arc_t), intent(inout) :: arc
    logical, intent(out) :: lost
    type(tangent_t) :: tangent
    real(wp) :: s
    logical :: found

    s = coordinate_of(solver%problem, arc%mesh, state)
    call tangent_along(solver, arc%mesh, s, state, tangent, found, slope_error)
    lost = .not. found
    if (found) call arc%add(s, state, tangent)
  end subroutine add_with_tangent

  !> The next state of the path, on the same mesh. lost: no step, however small, converged.
  subroutine advance(self, solver, lost)
    class(continuation_t), intent(inout) :: self
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(state_t) :: state
    type(tangent_t) :: tangent
    real(wp) :: s, miss
    logical :: converged

    lost = .false.
    do
      s = self%coordinate(self%held) + self%next_step(solver%equations_t)
      ! A step is so long that factors made before it are of no use.
      call solver%frozen%forget()
      call self%state_at(solver, s, state, tangent, converged, self%slope_error, miss)
      if (converged) exit
      solver%cost%rejected_steps = solver%cost%rejected_steps + 1
      self%step = shrinkage*self%step
      lost = self%step < shortest_step
      if (lost) return
    end do
    self%step = min(self%longest_step, abs(s - self%coordinate(self%held))* &
      factor_for(self%wanted_miss/max(miss, tiny(1.0_wp))))
    if (self%held == memory) call self%drop_first()
    call self%add(s, state, tangent)
  end subroutine advance

  !> By how much the next step is longer, where the miss may be so many times what it was: in steps
  !> of a ladder, so that rounding does not show in where the path has its points.
  pure real(wp) function factor_for(ratio) result(factor)
    real(wp), intent(in) :: ratio

    factor = rung**floor(log(ratio)/(order*log(rung)))
    factor = min(growth, max(shrinkage, factor))
  end function factor_for

  !> The step that is due, or the longest that the mesh in use is good for.
  pure real(wp) function next_step(self, equations) result(step)
    class(continuation_t), intent(in) :: self
    type(equations_t), intent(in) :: equations
    real(wp) :: s

    step = min(self%step, self%step_past_step(equations%problem))
    if (.not. equations%problem%law%edge_gap > 0) return
    s = self%coordinate(self%held)
    associate (meshes => equations%meshes, &
      passage => equations%meshes%passage(self%mesh)*beyond_passage)
      if (locked_alike(equations, self%mesh, self%mesh + 1)) then
        step = min(step, max(log(passage) - s, shortest_passage))
        return
      end if
      do while (step > shortest_passage)
        if (radius_for(equations, self%mesh, self%mesh + 1, &
          self%guess(equations%problem%shape, meshes%grid(self%mesh), &
          s + step)) <= passage) exit
        step = 0.6_wp*step
      end do
    end associate
  end function next_step

  !> The longest step where the axis passes a step of the pressure: all changes over the width of
  !> that, and h0 may turn several times.
  pure real(wp) function step_past_step(self, problem) result(longest)
    class(continuation_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    !> Parts of the step's width that are passed at once, and reach of the step in its widths.
    real(wp), parameter :: at_once = 0.25_wp, reach = 4

    longest = huge(longest)
    if (self%mesh /= approach .or. .not. problem%law%step_width > 0) return
    associate (law => problem%law, gap => self%state(self%held)%axis_gap)
      longest = max(at_once*law%step_width, &
        0.5_wp*(abs(gap - law%step_at) - reach*law%step_width))/(gap - 0.9_wp*law%rest_gap)
    end associate
  end function step_past_step

  !> Whether the contact radius has crossed the passage to the next mesh, and the last state but one
  !> is near that too.
  pure logical function has_come_to_next(self, equations) result(come)
    class(continuation_t), intent(in) :: self
    type(equations_t), intent(in) :: equations

    associate (meshes => equations%meshes)
      come = self%held > 1 .and. equations%problem%law%edge_gap > 0 .and. &
        self%mesh < size(meshes%grid)
      if (come) come = radius_for(equations, self%mesh, self%mesh + 1, self%state(self%held)) >= &
        meshes%passage(self%mesh)
      if (come) come = radius_for(equations, self%mesh, self%mesh + 1, &
        self%state(self%held - 1)) >= nearly_passed*meshes%passage(self%mesh)
    end associate
  end function has_come_to_next

  !> Passes to the next mesh once the contact radius has crossed the passage to it (to be called
  !> after each `advance`), taking the last two states along: what is between them is known on the
  !> next mesh too. That mesh must not be too coarse for the first of the two, and both meshes must
  !> agree there on which way h0 and load go, or an extremum would be seen twice or not at all.
  subroutine change_mesh(self, solver, lost)
    class(continuation_t), intent(inout) :: self
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(arc_t) :: next
    type(state_t) :: state
    integer :: j
    logical :: done

    lost = .false.
    if (.not. self%has_come_to_next(solver%equations_t)) return
    next%mesh = self%mesh + 1
    if (solver%meshes%waits(next%mesh)) call lay_out(solver%equations_t, self%mesh, next%mesh, &
      self%state(self%held))
    do j = self%held - 1, self%held
      state = self%state(j)
      ! The two are a step apart.
      call solver%frozen%forget()
      call move_to_mesh(solver, self%mesh, next%mesh, state, done)
      lost = .not. done
      if (done) call add_with_tangent(solver, self%slope_error, state, next, lost)
      if (lost) return
    end do
    associate (here => self%tangent(self%held - 1), there => next%tangent(1))
      if (.not. (here%h0*there%h0 > 0 .and. here%load*there%load > 0)) return
    end associate
    self%arc_t = next
    self%step = 0.5_wp*self%step
  end subroutine change_mesh

  !> Lays out the mesh that the path comes to, by the gaps of the state that it comes with.
  subroutine lay_out(equations, from, to, state)
    type(equations_t), intent(inout), target :: equations
    integer, intent(in) :: from, to
    type(state_t), intent(in) :: state
    type(seen_gaps_t) :: seen

    associate (problem => equations%problem, meshes => equations%meshes, cost => equations%cost)
      call seen%begin_on(meshes%grid(from), 1, 10.0_wp**(-meshes%digits))
      call seen%add(problem%shape, state%gap, state%scale, &
        felt_load(problem, meshes%grid(from), state))
      call seen%try_between(radius_for(equations, from, to, state), meshes%reach(1, to), &
        beyond_passage*meshes%reach(2, to))
      call meshes%renew(to, meshes%shape_for(problem, to, seen))
      cost%kernel_entries = cost%kernel_entries + meshes%grid(to)%kernel_entries()
    end associate
  end subroutine lay_out

  !> Solves a state of one mesh again on the other, at the same contact radius or axis gap.
  !> done = .false. where it has no contact edge to lock to, or did not converge.
  subroutine move_to_mesh(solver, from, to, state, done)
    class(solver_t), intent(inout) :: solver
    integer, intent(in) :: from, to
    type(state_t), intent(inout) :: state
    logical, intent(out) :: done
    real(wp) :: c

    c = radius_for(solver%equations_t, from, to, state)
    done = c > 0
    if (.not. done) return
    associate (problem => solver%problem, grid => solver%meshes%grid)
      state = regrid(problem%shape, state, grid(from), grid(to), c)
      call solver%correct(path_control(problem, to, coordinate_of(problem, to, state)), state, done)
    end associate
  end subroutine move_to_mesh

  !> Radius, lateral units, of what one mesh is locked to for a state on another; 0 where the state
  !> has none.
  pure real(wp) function radius_for(equations, from, to, state) result(c)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: from, to
    type(state_t), intent(in) :: state

    c = state%scale
    if (locked_alike(equations, from, to)) return
    associate (problem => equations%problem, meshes => equations%meshes)
      c = radius_of_gap(problem%shape, meshes%locked_gap(problem%law, to), meshes%grid(from), state)
    end associate
  end function radius_for

  !> Whether two meshes are locked to the same: both to the contact edge, or to the front of a step.
  pure logical function locked_alike(equations, from, to)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: from, to

    locked_alike = min(from, to) > approach
    if (locked_alike) locked_alike = equations%meshes%in_contact(from) .eqv. &
      equations%meshes%in_contact(to)
  end function locked_alike

end module continuation
