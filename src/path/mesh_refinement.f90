!> Refinement of meshes for laws and shapes that have additional characteristic lengths. A mesh is
!> laid out for predicted gaps; the computed gaps are known once the path has reached the end of the
!> mesh. If the nodes miss too much of the pressure of these gaps, the mesh is laid out anew for the
!> computed gaps, and the path is traced again from its entry into that mesh. Gaps are smoother than
!> pressures, so the gaps on a mesh that is too coarse are accurate enough to lay out a finer one.
module mesh_refinement
  use kinds, only: wp
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use panel_map, only: algebraic_map
  use mapped_mesh, only: new_mapped_mesh
  use edge_locked, only: shape_for
  use mapped_shape, only: mapped_shape_t
  use represented_pressure, only: pressure_on
  use law_panels, only: left_out
  use computed_gaps, only: computed_gaps_t
  use contact_state, only: state_t, gaps_at, felt_load, radius_of_gap, radius_of_step
  use equilibrium, only: equations_t
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: mesh_refiner_t, new_mesh_refiner, left_on_path, left_in_state, too_much

  !> Tolerated quadrature error, over the accuracy, if meshes cannot be refined (for oscillating
  !> laws `left_out` is only an upper bound of it). If t is the relative size of the last Legendre
  !> coefficients of the pressure, the error of the load at a fold is between t^2/1000 and a few
  !> times t^2.
  real(wp), parameter :: too_much = 30

  type :: mesh_refiner_t
    !> Part of the load that the nodes may miss.
    real(wp) :: most = 0
    !> Number of refinements of each mesh.
    integer, allocatable :: rounds(:)
    !> Part of the load that each mesh missed, and its number of nodes, after the last refinement
    !> that reduced this part.
    real(wp), allocatable :: left(:)
    integer, allocatable :: nodes(:)
  contains
    procedure :: refine
  end type mesh_refiner_t

  !> Part of the load, over the accuracy, that nodes may miss under a law with a step.
  real(wp), parameter :: of_steps = 0.1_wp
  !> Part of the load that the panels of a new mesh may miss, over `most`; it is less than 1, since
  !> the path on the new mesh differs slightly.
  real(wp), parameter :: most_of_fit = 0.3_wp
  !> Largest number of refinements of a mesh, and of successive halvings of a panel in one
  !> refinement.
  integer, parameter :: most_rounds = 6, most_halvings = 3
  !> Panels are halved until the number of nodes has grown by this factor; then the path is traced
  !> again. Without this limit the estimated errors of a path that is lost might require any number
  !> of nodes.
  real(wp), parameter :: most_growth = 1.5_wp
  !> A refinement has helped if the quadrature error fell below this fraction of the earlier one.
  !> Otherwise a mesh on which the path is lost is not refined again, and other meshes only until
  !> their number of nodes has grown by `most_growth`.
  real(wp), parameter :: helped = 0.9_wp

contains

  !> The refinement of meshes for a path with a given accuracy. `left_out` counts oscillations in
  !> full, while only a part of their error affects the load. Errors due to a step of the law change
  !> quickly as the step passes from node to node; therefore they change the position of an extremum
  !> of the load more than the load itself.
  pure type(mesh_refiner_t) function new_mesh_refiner(accuracy, law) result(refiner)
    real(wp), intent(in) :: accuracy
    class(force_law_t), intent(in) :: law

    refiner%most = accuracy
    if (law%step_width > 0) refiner%most = of_steps*accuracy
    if (law%period > 0) refiner%most = too_much*accuracy
    allocate (refiner%rounds(0), refiner%left(0), refiner%nodes(0))
  end function new_mesh_refiner

  !> Refines a mesh whose end the path has reached, or on which the path is lost, if the nodes miss
  !> too much of the load. leaving: the path passes to the next mesh; its newest state then counts
  !> for that mesh only. refined: the path has to be traced again from its entry into the mesh.
  subroutine refine(self, equations, path, mesh, leaving, lost, refined)
    class(mesh_refiner_t), intent(inout) :: self
    type(equations_t), intent(inout) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    logical, intent(in) :: leaving, lost
    logical, intent(out) :: refined
    type(mapped_shape_t) :: shape
    real(wp) :: left

    ! Inserted meshes follow all those that were examined before.
    do while (size(self%rounds) < mesh)
      self%rounds = [self%rounds, 0]
      self%left = [self%left, huge(1.0_wp)]
      self%nodes = [self%nodes, 0]
    end do
    left = maxval(left_on_mesh(equations, path, mesh, equations%meshes%grid(mesh), &
      path%held - merge(1, 0, leaving)))
    refined = self%rounds(mesh) < most_rounds .and. left > self%most
    associate (nodes => equations%meshes%grid(mesh)%nodes)
      if (left < helped*self%left(mesh)) then
        self%left(mesh) = left
        self%nodes(mesh) = nodes
      else
        refined = refined .and. .not. lost .and. nodes < most_growth*self%nodes(mesh)
      end if
    end associate
    if (.not. refined) return
    if (.not. (self%rounds(mesh) > 0 .or. lost) .and. equations%problem%law%edge_gap > 0) then
      shape = shape_for_seen(equations, path, mesh, self%most)
    else
      shape = with_short_panels(equations, path, mesh, self%most)
    end if
    self%rounds(mesh) = self%rounds(mesh) + 1
    call equations%meshes%renew(mesh, shape)
    call equations%operator%forget()
    equations%cost%kernel_entries = equations%cost%kernel_entries + &
      equations%meshes%grid(mesh)%kernel_entries()
  end subroutine refine

  !> The part of the load that the nodes of a mesh miss in a state.
  pure real(wp) function left_in_state(equations, mesh, state) result(left)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    associate (problem => equations%problem, grid => equations%meshes%grid(mesh))
      left = maxval(left_of(problem, grid, state%gap, state%scale, felt_load(problem, grid, state)))
    end associate
  end function left_in_state

  !> The largest part of the load that the nodes miss in any state of a path.
  real(wp) function left_on_path(equations, path) result(largest)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer :: mesh

    largest = 0
    do mesh = 1, size(equations%meshes%grid)
      largest = max(largest, maxval(left_on_mesh(equations, path, mesh, &
        equations%meshes%grid(mesh), path%held)))
    end do
  end function left_on_path

  !> The shape of a mesh for the gaps of all its states on the path. It is also for gaps that are
  !> extrapolated to the other radii of the mesh, since the path that is traced next may enter the
  !> mesh at another radius.
  function shape_for_seen(equations, path, mesh, most) result(shape)
    type(equations_t), intent(in), target :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    real(wp), intent(in) :: most
    type(mapped_shape_t) :: shape
    type(computed_gaps_t) :: seen
    real(wp) :: radius
    integer :: i, k, states

    associate (problem => equations%problem, meshes => equations%meshes, &
      grid => equations%meshes%grid(mesh), reach => equations%meshes%reach(:, mesh))
      states = count(path%point(:path%held)%mesh == mesh)
      call seen%begin_on(grid, states, most_of_fit*most)
      k = 0
      do i = 1, path%held
        if (path%point(i)%mesh /= mesh) cycle
        k = k + 1
        associate (state => path%point(i)%state)
          call seen%add(problem%shape, state%gap, state%scale, state%h0, &
            felt_load(problem, grid, state))
          if (.not. grid%centre > 0) then
            radius = radius_of_gap(problem%shape, problem%law%edge_gap, grid, state)
            call seen%try_about_axis(radius, radius)
            cycle
          end if
          call seen%try(state%scale, state%scale, state%scale, 0.0_wp)
          if (k == 1) call seen%try(state%scale, reach(1), state%scale, &
            radius_of_step(problem, grid, state))
          if (k == states) call seen%try(state%scale, state%scale, reach(2), &
            radius_of_step(problem, grid, state))
        end associate
      end do
      shape = shape_for(meshes, problem, mesh, seen)
    end associate
  end function shape_for_seen

  !> The shape of a mesh whose panels are halved, repeatedly, where the nodes miss too much.
  function with_short_panels(equations, path, mesh, most) result(shape)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    real(wp), intent(in) :: most
    type(mapped_shape_t) :: shape
    type(discretisation_t) :: grid
    integer :: halving

    shape = equations%meshes%shape(mesh)
    grid = equations%meshes%grid(mesh)
    do halving = 1, most_halvings
      associate (long => left_on_mesh(equations, path, mesh, grid, path%held) > most)
        if (.not. any(long) .or. &
          grid%nodes > most_growth*size(equations%meshes%grid(mesh)%x)) exit
        shape = shape%halved(long)
      end associate
      grid = new_mapped_mesh(shape, elastic=.false.)
    end do
  end function with_short_panels

  !> For each panel, the largest part of the load that its nodes miss, over the states of a mesh
  !> among the points up to `last`. grid: the mesh itself, or a finer one, to whose nodes the gaps
  !> are interpolated.
  pure function left_on_mesh(equations, path, mesh, grid, last) result(left)
    type(equations_t), intent(in) :: equations
    type(traced_path_t), intent(in) :: path
    integer, intent(in) :: mesh
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: last
    real(wp) :: left(size(grid%panel)), gap(grid%nodes)
    integer :: i

    left = 0
    associate (own => equations%meshes%grid(mesh), problem => equations%problem)
      do i = 1, last
        associate (point => path%point(i))
          if (point%mesh /= mesh) cycle
          ! The path left the mesh before this state.
          if (i < path%held .and. .not. (point%leads_on .or. path%comes_from_before(i))) cycle
          if (grid%nodes == own%nodes) then
            gap = point%state%gap
          else
            gap = gaps_at(problem%shape, own, point%state, grid%x)
          end if
          left = max(left, left_of(problem, grid, gap, point%state%scale, &
            felt_load(problem, own, point%state)))
        end associate
      end do
    end associate
  end function left_on_mesh

  !> The part of the load that the nodes of each panel miss for the pressure of the given gaps.
  pure function left_of(problem, grid, gap, scale, load) result(left)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:), scale, load
    real(wp) :: left(size(grid%panel)), pressure(size(gap))
    logical :: smooth
    integer :: k

    smooth = problem%shape%is_even() .and. .not. problem%shape%smooth_from() > 0
    pressure = pressure_on(problem%law, grid, gap)
    left = 0
    do k = 1, size(grid%panel)
      associate (panel => grid%panel(k), first => grid%first(k), &
        last => grid%first(k) + size(grid%local(k)%node) - 1)
        if (panel%kind == algebraic_map) cycle
        ! `mesh_rule` chooses the panels inside the contact of a shape with kinks.
        if (panel%right <= 0 .and. .not. smooth) cycle
        left(k) = left_out(problem, grid%local(k), &
          scale*(grid%centre + panel%focus), scale*(grid%centre + [panel%left, panel%right]), &
          scale*grid%x(first:last), gap(first:last), pressure(first:last), load)
      end associate
    end do
  end function left_of

end module mesh_refinement
