!> A position of an experiment in edge-locked coordinates: which mesh of the pair it lives on, how
!> many of its nodes it uses, and how h0 is prescribed there.
module locked_meshes
  use kinds, only: wp
  use problem, only: problem_t
  use equilibrium, only: control_t, state_t, cost_t, radius_of_gap, at_h0_with_edge
  use anderson, only: frozen_t
  use solver_options, only: solver_options_t
  use solver, only: solve_state
  use edge_locked, only: mesh_pair_t, hertz_scale, approach, contact
  use tracer, only: move_to_mesh, node_count
  use quasi_static, only: position_t, remember
  implicit none
  private
  public :: change_mesh, nodes_to_use, h0_control, scale_at

contains

  !> Passes to the other mesh when the contact radius has crossed the passage; a band of a fifth on
  !> either side keeps a state near it from going back and forth.
  subroutine change_mesh(this, pair, options, frozen, position, cost)
    type(problem_t), intent(in) :: this
    type(mesh_pair_t), intent(in) :: pair
    type(solver_options_t), intent(in) :: options
    type(frozen_t), intent(inout) :: frozen
    type(position_t), intent(inout) :: position
    type(cost_t), intent(inout) :: cost
    type(state_t) :: state
    logical :: done
    integer :: to

    if (.not. this%law%edge_gap > 0 .or. this%rigid) return
    if (position%mesh == approach) then
      if (radius_of_gap(this%law%edge_gap, pair%grid(approach), position%state) &
        < 1.2_wp*pair%passage) return
      to = contact
    else
      if (position%state%scale > 0.8_wp*pair%passage) return
      to = approach
    end if
    state = position%state
    frozen%factors%valid = .false.
    call move_to_mesh(this, pair, position%mesh, to, options, frozen, state, done, cost)
    if (.not. done) return
    ! The same contact on the other mesh is at an h0 that differs by the meshes' errors.
    call solve_state(this, pair%grid(to), h0_control(pair, to, position%state%h0), options, &
      frozen, state, done, cost)
    if (done) call remember(position, state, to, .false.)
  end subroutine change_mesh

  !> Nodes for the next state of a position: as many as now while they reach far enough and not
  !> four times too far, so that factorisations keep their size.
  pure integer function nodes_to_use(pair, h0, position) result(n)
    type(mesh_pair_t), intent(in) :: pair
    real(wp), intent(in) :: h0
    type(position_t), intent(in) :: position
    real(wp) :: c

    c = position%state%scale
    if (.not. pair%traceable) c = scale_at(pair, h0)
    n = size(position%state%gap)
    if (n < node_count(pair, position%mesh, c) .or. &
      n > node_count(pair, position%mesh, 0.25_wp*c)) &
      n = node_count(pair, position%mesh, 0.5_wp*c)
  end function nodes_to_use

  !> The control that prescribes h0 on a mesh.
  pure function h0_control(pair, mesh, h0) result(control)
    type(mesh_pair_t), intent(in) :: pair
    integer, intent(in) :: mesh
    real(wp), intent(in) :: h0
    type(control_t) :: control

    control%value = h0
    control%scale = scale_at(pair, h0)
    if (mesh == contact .and. pair%traceable) control%kind = at_h0_with_edge
  end function h0_control

  !> The scale of the mesh at h0 where it is not an unknown.
  pure real(wp) function scale_at(pair, h0)
    type(mesh_pair_t), intent(in) :: pair
    real(wp), intent(in) :: h0

    scale_at = 1
    if (.not. pair%traceable) scale_at = hertz_scale(pair%level, h0)
  end function scale_at

end module locked_meshes
