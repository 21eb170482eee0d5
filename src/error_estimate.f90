!> The error of what is reported: the states that it comes from are solved again on a finer mesh, to
!> rounding, and compared. What is left out is the error of the finer mesh, smaller by a factor that
!> the margin covers. What the iteration may have left, which differs from state to state by chance,
!> is added: a residual as large as the tolerance acts like an h0 that is off by as much.
module error_estimate
  use kinds, only: wp
  use problem, only: problem_t
  use discretisation, only: discretisation_t
  use edge_locked, only: mesh_pair_t, new_mesh_pair, resolution_t, regrid
  use tracer, only: node_count
  use equilibrium, only: control_t, state_t, cost_t, at_h0, at_h0_with_edge
  use anderson, only: frozen_t, solve_anderson
  use solver_options, only: solver_options_t
  use quasi_static, only: witness_t
  implicit none
  private
  public :: estimate_locked, estimate_fixed

  !> Panels: nodes that the finer mesh has more in each, and its reach over the mesh's; the error
  !> of the reach falls with its fifth power.
  integer, parameter :: more_nodes = 2
  real(wp), parameter :: farther = 1.6_wp
  !> Differences are raised by this much for the error of the finer mesh: a tenth or less for
  !> panels, a third for a uniform grid, which is of second order and of lower order in places; and
  !> because other states may be somewhat worse than the witnesses. Against a grid twice as coarse
  !> the difference itself is two to three times the error.
  real(wp), parameter :: margin = 2, margin_fixed = 2.5_wp, margin_coarser = 1.2_wp
  !> Rounding of a whole calculation, below which no error is claimed.
  real(wp), parameter :: rounding = 1.0e-13_wp
  !> A residual that leaves no doubt which state it is of; a change of h0 small enough for a
  !> derivative and large against rounding (law's lengths).
  real(wp), parameter :: nearly_solved = 1.0e-6_wp, shift = 1.0e-5_wp
  !> An error that says that nothing is known.
  real(wp), parameter :: most = 1.0e6_wp

contains

  !> Largest relative error over the witnesses of an edge-locked run; H0 range and resolution are
  !> those of its meshes, tolerance that of the iteration. 1 or more where a witness has no
  !> counterpart on the finer mesh.
  function estimate_locked(this, pair, h0_high, h0_low, resolution, tolerance, witnesses, cost) &
    result(error)
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    real(wp), intent(in) :: h0_high, h0_low
    type(resolution_t), intent(in) :: resolution
    real(wp), intent(in) :: tolerance
    type(witness_t), intent(in) :: witnesses(:)
    type(cost_t), intent(inout) :: cost
    real(wp) :: error
    type(mesh_pair_t) :: fine
    type(resolution_t) :: finer
    real(wp) :: c, difference, left
    integer :: i

    finer = resolution
    finer%order = resolution%order + more_nodes
    finer%farther = farther
    fine = new_mesh_pair(this, h0_high, h0_low, finer)
    cost%kernel_entries = cost%kernel_entries + sum(fine%grid%kernel_entries())
    error = rounding
    do i = 1, size(witnesses)
      associate (mesh => witnesses(i)%mesh)
        c = witnesses(i)%state%scale
        call compare(this, pair%grid(mesh), fine%grid(mesh), node_count(fine, mesh, c), &
          witnesses(i), tolerance, difference, left, cost)
        error = max(error, margin*difference + left)
      end associate
    end do
  end function estimate_locked

  !> The same for a run on a fixed mesh, against the mesh given, which is finer or, where that would
  !> cost too much, coarser.
  function estimate_fixed(this, mesh, fine, tolerance, witnesses, cost) result(error)
    type(problem_t), intent(in) :: this
    type(discretisation_t), intent(in) :: mesh, fine
    real(wp), intent(in) :: tolerance
    type(witness_t), intent(in) :: witnesses(:)
    type(cost_t), intent(inout) :: cost
    real(wp) :: error
    real(wp) :: margin_here, difference, left
    integer :: i

    cost%kernel_entries = cost%kernel_entries + fine%kernel_entries()
    margin_here = merge(margin_fixed, margin_coarser, fine%nodes > mesh%nodes)
    error = rounding
    do i = 1, size(witnesses)
      call compare(this, mesh, fine, fine%nodes, witnesses(i), tolerance, difference, left, cost)
      error = max(error, margin_here*difference + left)
    end do
  end function estimate_fixed

  !> Relative difference between a witness and its solution on a finer mesh, in what it is compared
  !> by; and what a residual as large as the tolerance, or as the witness's own, may add to that.
  subroutine compare(this, mesh, fine, nodes, witness, tolerance, difference, left, cost)
    type(problem_t), intent(in) :: this
    type(discretisation_t), intent(in) :: mesh, fine
    integer, intent(in) :: nodes
    type(witness_t), intent(in) :: witness
    real(wp), intent(in) :: tolerance
    real(wp), intent(out) :: difference, left
    type(cost_t), intent(inout) :: cost
    type(solver_options_t) :: options
    type(frozen_t) :: frozen
    type(state_t) :: state, shifted
    type(control_t) :: control
    logical :: converged

    ! As well as rounding allows: the iteration stops at its own floor.
    options%tolerance = 0
    options%patience = 2
    difference = 1
    left = 0
    ! What did not converge has no counterpart.
    if (.not. witness%state%residual < 1) return
    state = regrid(witness%state, mesh, fine, witness%state%scale, nodes)
    call solve_anderson(this, fine, witness%control, options, frozen, state, converged, cost)
    if (.not. (converged .or. state%residual < nearly_solved)) return
    difference = deviation(witness, witness%state, state)
    if (.not. this%coupling > 0) return
    if (all(witness%control%kind /= [at_h0, at_h0_with_edge])) then
      ! H0 is the unknown, and takes up the whole of an equal residual.
      if (witness%h0) left = tolerance/max(abs(state%h0), 1.0_wp)
      return
    end if
    control = witness%control
    control%value = control%value + shift
    shifted = state
    call solve_anderson(this, fine, control, options, frozen, shifted, converged, cost)
    if (converged .or. shifted%residual < nearly_solved) left = &
      deviation(witness, shifted, state)*max(tolerance, witness%state%residual)/shift
  end subroutine compare

  !> Relative difference of a state from the one that is right, in what a witness is compared by.
  pure real(wp) function deviation(witness, state, right)
    type(witness_t), intent(in) :: witness
    type(state_t), intent(in) :: state, right

    deviation = 0
    if (witness%load .and. abs(right%load) > 0) &
      deviation = min(abs(state%load - right%load)/max(abs(right%load), tiny(1.0_wp)), most)
    if (witness%h0) deviation = max(deviation, &
      abs(state%h0 - right%h0)/max(abs(right%h0), 1.0_wp))
    ! A displacement is known relative to the movement that made it, not to itself where it is
    ! small.
    if (witness%displacement) deviation = max(deviation, &
      abs(state%axis_gap - right%axis_gap)/max(abs(right%axis_gap - right%h0), 1.0_wp))
  end function deviation

end module error_estimate
