!> How the continuation of the path passes from one mesh to the next.
module mesh_passage
  use kinds, only: wp
  use contact_state, only: state_t, regrid
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use next_mesh, only: radius_for, lay_out_next
  use path_coordinate, only: path_control, coordinate_of
  use mesh_refinement, only: left_in_state
  use arc, only: arc_t
  use continuation, only: continuation_t, add_with_tangent
  implicit none
  private
  public :: has_come_to_next, pass_to_next

  !> Least contact radius, over that of a passage, at which a state is transferred to the next mesh.
  real(wp), parameter :: nearly_passed = 0.8_wp

contains

  !> Whether the contact radius has exceeded the radius of the passage to the next mesh, and that of
  !> the previous state is at least near it. A path stays on its first mesh for two steps, since the
  !> last step before a passage is repeated on the next mesh. If no step converged, the gap on the
  !> axis may have turned: between blunt bodies on layers it may rise again while the contact grows.
  !> Then it is sufficient that the contact grows, if the next mesh is locked to its edge.
  pure logical function has_come_to_next(walker, equations) result(come)
    type(continuation_t), intent(in) :: walker
    type(equations_t), intent(in) :: equations
    real(wp) :: before, now

    associate (meshes => equations%meshes, mesh => walker%mesh, held => walker%held)
      come = held > 2 .and. equations%problem%law%edge_gap > 0 .and. mesh < size(meshes%grid)
      if (.not. come) return
      before = radius_for(equations, mesh, mesh + 1, walker%point(held - 1)%state)
      now = radius_for(equations, mesh, mesh + 1, walker%point(held)%state)
      if (walker%stuck) then
        come = meshes%is_about_axis(mesh) .and. .not. meshes%is_about_axis(mesh + 1) .and. &
          before > 0 .and. now > before
      else
        come = now >= meshes%passage(mesh) .and. before >= nearly_passed*meshes%passage(mesh)
      end if
    end associate
  end function has_come_to_next

  !> Passes to the next mesh if the path has reached it (to be called after each `advance`). The
  !> last two states are transferred, so that the next mesh has the interval between them too. A
  !> mesh that was laid out for predicted gaps is laid out anew for the computed ones if it does not
  !> resolve the first of the two states, or if the path reaches it early. h0 and load must change
  !> in the same sense on both meshes.
  subroutine pass_to_next(walker, solver, lost)
    type(continuation_t), intent(inout) :: walker
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(arc_t) :: next
    logical :: suffices

    lost = .false.
    if (.not. has_come_to_next(walker, solver%equations_t)) return
    suffices = .not. (walker%stuck .or. solver%meshes%waits(walker%mesh + 1))
    if (suffices) then
      call transfer(walker, solver, next, lost)
      suffices = .not. lost
      if (suffices) suffices = &
        left_in_state(solver%equations_t, next%mesh, next%point(1)%state) <= walker%most
    end if
    if (.not. suffices) then
      call lay_out_next(solver%equations_t, walker%arc_t)
      call solver%operator%forget()
      call transfer(walker, solver, next, lost)
    end if
    if (lost .or. next%held < 2) return
    associate (old => walker%point(walker%held - 1)%tangent, new => next%point(1)%tangent)
      if (.not. old%goes_with(new)) return
      ! Where the path enters the next mesh, that mesh may not contain the step of a law. If dF/dh0
      ! differs there, the path stays on this mesh as long as it resolves the load.
      if (solver%problem%law%step_width > 0 .and. .not. old%is_alike(new) .and. &
        left_in_state(solver%equations_t, walker%mesh, walker%point(walker%held - 1)%state) <= &
        walker%most) return
    end associate
    ! Steps in time pass from mesh to mesh by radii alone, so this radius must be the true one.
    if (walker%stuck) solver%meshes%passage(walker%mesh) = next%point(1)%state%scale
    walker%arc_t = next
    walker%step = 0.5_wp*walker%step
    if (walker%stuck) walker%step = next%point(2)%coordinate - next%point(1)%coordinate
    walker%stuck = .false.
  end subroutine pass_to_next

  !> Solves the last two states of an arc on the next mesh. lost: this failed.
  subroutine transfer(arc, solver, next, lost)
    type(continuation_t), intent(in) :: arc
    class(solver_t), intent(inout) :: solver
    type(arc_t), intent(out) :: next
    logical, intent(out) :: lost
    type(state_t) :: state
    integer :: j
    logical :: done

    next%mesh = arc%mesh + 1
    next%moved = arc%moved
    next%extrapolated_from = arc%extrapolated_from
    do j = arc%held - 1, arc%held
      state = arc%point(j)%state
      ! The two states are a step of the path apart, too far for common factors.
      call solver%frozen%forget()
      call move_to_mesh(solver, arc%mesh, next%mesh, state, done)
      lost = .not. done
      if (done) call add_with_tangent(solver, arc%slope_error, state, next, lost)
      if (lost) return
    end do
  end subroutine transfer

  !> Solves a state of one mesh on another mesh, at the same contact radius or axis gap. done =
  !> .false.: the state has no contact edge for the locked mesh, or the iteration did not converge.
  subroutine move_to_mesh(solver, from, to, state, done)
    class(solver_t), intent(inout) :: solver
    integer, intent(in) :: from, to
    type(state_t), intent(inout) :: state
    logical, intent(out) :: done
    real(wp) :: c

    c = radius_for(solver%equations_t, from, to, state)
    done = c > 0
    if (.not. done) return
    associate (problem => solver%problem, meshes => solver%meshes, grid => solver%meshes%grid)
      state = regrid(problem%shape, state, grid(from), grid(to), c)
      call solver%correct(path_control(problem, meshes, to, &
        coordinate_of(problem, meshes, to, state)), state, done)
    end associate
  end subroutine move_to_mesh

end module mesh_passage
