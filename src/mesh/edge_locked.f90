!> Makes the meshes that resolve the whole equilibrium path at any adhesion strength: those of a
!> `mesh_plan_t`, laid out by `mesh_rule`.
module edge_locked
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, calm_gap
  use discretisation, only: discretisation_t
  use mapped_mesh, only: new_mapped_mesh
  use mapped_shape, only: mapped_shape_t
  use mesh_store, only: mesh_store_t
  use mesh_rule, only: approach_shape, contact_shape
  use mesh_plan, only: new_mesh_plan, approach, contact
  use mesh_family, only: mesh_family_t
  use law_panels, only: about_front, about_edge
  use computed_gaps, only: computed_gaps_t
  implicit none
  private
  public :: new_mesh_family, shape_for

contains

  !> Meshes for H0 from h0_high down to h0_low, accurate to the given number of digits
  !> (`mesh_rule`). store: earlier meshes, to which these are added. coarser: meshes of fewer digits
  !> for the same problem and range; keep: their panels are kept if they were laid out for computed
  !> gaps. fronts: whether meshes may be locked to the front of a step (`step_front`); further:
  !> whether meshes may be inserted later; both .true. if absent.
  function new_mesh_family(problem, h0_high, h0_low, digits, store, coarser, keep, fronts, &
    further) result(meshes)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low, digits
    logical, intent(in), optional :: keep, fronts, further
    type(mesh_store_t), intent(inout), optional :: store
    type(mesh_family_t), intent(in), optional :: coarser
    type(mesh_family_t) :: meshes
    logical :: kept, follow_fronts, may_insert
    integer :: k

    follow_fronts = .true.
    if (present(fronts)) follow_fronts = fronts
    may_insert = .true.
    if (present(further)) may_insert = further
    kept = .false.
    if (present(keep)) kept = keep
    if (present(coarser) .and. kept) then
      meshes%mesh_plan_t = coarser%mesh_plan_t
    else
      meshes%mesh_plan_t = new_mesh_plan(problem, h0_high, h0_low, follow_fronts, may_insert)
    end if
    allocate (meshes%grid(size(meshes%locked)), meshes%shape(size(meshes%locked)))
    meshes%digits = digits
    do k = merge(approach, contact, meshes%traceable), size(meshes%grid)
      if (present(coarser)) call follow(meshes, coarser, k, problem, kept)
      if (.not. allocated(meshes%shape(k)%order)) meshes%shape(k) = shape_for(meshes, problem, k)
      call make_mesh(meshes%shape(k), .not. meshes%waits(k), meshes%grid(k), store)
    end do
  end function new_mesh_family

  !> The shape of a mesh of a family. seen: gaps of computed states on it.
  type(mapped_shape_t) function shape_for(meshes, problem, mesh, seen) result(shape)
    type(mesh_family_t), intent(in) :: meshes
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(computed_gaps_t), intent(in), optional :: seen
    integer :: about

    if (meshes%is_about_axis(mesh)) then
      shape = approach_shape(problem, max(meshes%reach(1, mesh), calm_gap(problem)), &
        meshes%next_passage(mesh), meshes%digits, seen)
    else
      about = about_edge
      if (problem%law%step_width > 0 .and. &
        abs(meshes%locked_gap(mesh) - problem%law%step_at) <= 0) about = about_front
      shape = contact_shape(problem, about, &
        meshes%reach(1, mesh), meshes%reach(2, mesh), meshes%level, meshes%digits, seen)
    end if
  end function shape_for

  !> Makes a mesh; elastic: with its kernel, from the store if present.
  subroutine make_mesh(shape, elastic, grid, store)
    type(mapped_shape_t), intent(in) :: shape
    logical, intent(in) :: elastic
    type(discretisation_t), intent(out) :: grid
    type(mesh_store_t), intent(inout), optional :: store

    if (present(store) .and. elastic) then
      call store%obtain(shape, grid)
    else
      grid = new_mapped_mesh(shape, elastic)
    end if
  end subroutine make_mesh

  !> Makes the shape of a mesh from that of a coarser one, with more nodes on its panels. This is
  !> done if a new layout would have fewer nodes and thus no smaller error. Meshes for computed gaps
  !> are laid out anew, since their panels may be the cause of an error, unless they are to be kept.
  subroutine follow(meshes, coarser, mesh, problem, keep)
    type(mesh_family_t), intent(inout) :: meshes
    type(mesh_family_t), intent(in) :: coarser
    integer, intent(in) :: mesh
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: keep
    type(mapped_shape_t) :: richer
    logical :: for_computed

    if (size(coarser%shape) /= size(meshes%shape)) return
    if (.not. allocated(coarser%grid(mesh)%kernel)) return
    for_computed = coarser%inserted(mesh) .or. coarser%has_short_panels(mesh)
    if (for_computed .and. .not. keep) return
    richer = coarser%shape(mesh)%enriched(meshes%digits/coarser%digits, &
      meshes%digits - coarser%digits)
    if (.not. for_computed) then
      meshes%shape(mesh) = shape_for(meshes, problem, mesh)
      if (meshes%has_short_panels(mesh)) return
      if (.not. sum(meshes%shape(mesh)%order) < sum(richer%order)) return
    end if
    meshes%shape(mesh) = richer
  end subroutine follow

end module edge_locked
