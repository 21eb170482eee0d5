!> The meshes that resolve the whole equilibrium path at any adhesion strength: those of a
!> `mesh_plan_t`, laid out by `mesh_rule`.
module edge_locked
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, calm_gap
  use discretisation, only: discretisation_t
  use mapped_mesh, only: new_mapped_mesh
  use mapped_shape, only: mapped_shape_t
  use mesh_store, only: mesh_store_t
  use mesh_rule, only: approach_shape, contact_shape
  use mesh_plan, only: mesh_plan_t, new_mesh_plan, approach, contact
  use law_panels, only: about_front, about_edge
  use seen_gaps, only: seen_gaps_t
  implicit none
  private
  public :: mesh_family_t, new_mesh_family

  type, extends(mesh_plan_t) :: mesh_family_t
    !> The meshes in the order of the path.
    type(discretisation_t), allocatable :: grid(:)
    !> The number of accurate digits for which the meshes are made.
    real(wp) :: digits = 0
    !> The shapes of these meshes.
    type(mapped_shape_t), allocatable :: shape(:)
  contains
    procedure :: insert
    procedure :: has_short_panels
    procedure :: renew
    procedure :: shape_for
  end type mesh_family_t

contains

  !> Meshes for H0 from h0_high down to h0_low, accurate to the given number of digits
  !> (`mesh_rule`). store: earlier meshes, to which these are added. coarser: meshes of fewer digits
  !> for the same problem and range; keep: their panels are kept where these were laid out for
  !> computed gaps. fronts: whether meshes may be locked to the front of a step; further: whether
  !> meshes may be inserted later; both .true. if absent.
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
      if (.not. allocated(meshes%shape(k)%order)) meshes%shape(k) = meshes%shape_for(problem, k)
      call make_mesh(meshes%shape(k), .not. meshes%waits(k), meshes%grid(k), store)
    end do
  end function new_mesh_family

  !> The shape of a mesh. seen: gaps of computed states on it.
  type(mapped_shape_t) function shape_for(self, problem, mesh, seen) result(shape)
    class(mesh_family_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(seen_gaps_t), intent(in), optional :: seen
    integer :: about

    if (self%is_about_axis(mesh)) then
      shape = approach_shape(problem, max(self%reach(1, mesh), calm_gap(problem)), &
        self%next_passage(mesh), self%digits, seen)
    else
      about = about_edge
      if (problem%law%step_width > 0 .and. abs(self%locked_gap(mesh) - problem%law%step_at) <= 0) &
        about = about_front
      shape = contact_shape(problem, about, &
        self%reach(1, mesh), self%reach(2, mesh), self%level, self%digits, seen)
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

  !> Replaces a mesh by a new one with the given shape, for elastic bodies.
  subroutine renew(self, mesh, shape)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mapped_shape_t), intent(in) :: shape

    self%shape(mesh) = shape
    self%grid(mesh) = new_mapped_mesh(shape, elastic=.true.)
    self%waits(mesh) = .false.
  end subroutine renew

  !> Chooses the shape of a mesh from a coarser one with more nodes on its panels: if a new layout
  !> would have fewer nodes than this, as under laws for which numbers of nodes were tried, and so
  !> would have the same error. Meshes for computed gaps are laid out anew, since their panels may
  !> be the cause of an error, unless they are to be kept.
  subroutine follow(self, coarser, mesh, problem, keep)
    class(mesh_family_t), intent(inout) :: self
    type(mesh_family_t), intent(in) :: coarser
    integer, intent(in) :: mesh
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: keep
    type(mapped_shape_t) :: richer
    logical :: for_computed

    if (size(coarser%shape) /= size(self%shape)) return
    if (.not. allocated(coarser%grid(mesh)%kernel)) return
    for_computed = coarser%inserted(mesh) .or. coarser%has_short_panels(mesh)
    if (for_computed .and. .not. keep) return
    richer = coarser%shape(mesh)%enriched(self%digits/coarser%digits, self%digits - coarser%digits)
    if (.not. for_computed) then
      self%shape(mesh) = self%shape_for(problem, mesh)
      if (self%has_short_panels(mesh)) return
      if (.not. sum(self%shape(mesh)%order) < sum(richer%order)) return
    end if
    self%shape(mesh) = richer
  end subroutine follow

  !> Whether a mesh has short or halved panels: more than one on a side of its centre.
  pure logical function has_short_panels(self, mesh)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    has_short_panels = .false.
    associate (shape => self%shape(mesh))
      if (allocated(shape%order)) &
        has_short_panels = size(shape%order) > merge(2, 1, shape%inner > 0)
    end associate
  end function has_short_panels

  !> Inserts a mesh after another one. Until it is laid out, it has the shape of that one.
  pure subroutine insert(self, after, locked, low, high)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: after
    real(wp), intent(in) :: locked, low, high
    type(discretisation_t), allocatable :: grid(:)
    real(wp), allocatable :: kernel(:, :)
    integer :: k, to

    call self%mesh_plan_t%insert(after, locked, low, high)
    allocate (grid(size(self%grid) + 1))
    do k = 1, size(self%grid)
      to = k + merge(0, 1, k <= after)
      ! A kernel is moved, since its copy would take as long as a state.
      call move_alloc(self%grid(k)%kernel, kernel)
      if (k == after) grid(k + 1) = self%grid(k)
      grid(to) = self%grid(k)
      call move_alloc(kernel, grid(to)%kernel)
    end do
    call move_alloc(grid, self%grid)
    self%shape = self%shape([(k, k=1, after), (k, k=after, size(self%shape))])
  end subroutine insert

end module edge_locked
