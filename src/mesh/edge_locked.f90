!> The meshes that resolve the whole equilibrium path at any adhesion strength.
!>
!> Before contact the mesh is mapped to the axis, and the gap on the axis is the coordinate of the
!> path. In contact meshes are locked to the contact edge: positions are in units of the contact
!> radius c, the edge stays at 1, and c is the coordinate. Both coordinates are monotonic along the
!> path. A mesh is for a band of contact radii; the path passes from one mesh to the next. If a step
!> of the pressure pulls the bodies together, further meshes between the approach and contact are
!> locked to the front of the step (`step_front`) in the same way.
module edge_locked
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, calm_gap
  use discretisation, only: discretisation_t
  use mapped_mesh, only: mapped_shape_t, new_mapped_mesh
  use mesh_store, only: mesh_store_t
  use mesh_rule, only: approach_shape, contact_shape, is_narrow, rim_passed_at
  use law_panels, only: about_front, about_edge
  use seen_gaps, only: seen_gaps_t
  use step_front, only: front_leads, has_constant_tension, first_front, last_front
  use force_law, only: force_law_t
  use contact_scales, only: largest_radius, contact_level, cohesive_width, lost_in_rounding
  implicit none
  private
  public :: mesh_family_t, new_mesh_family
  public :: approach, contact, band_of_waves

  !> The mesh before contact, and the first of those in contact or about a front.
  integer, parameter :: approach = 1, contact = 2

  !> Largest ratio of the contact radii of one mesh: wider bands need more nodes, narrower bands
  !> more meshes. Under a law that oscillates or has a step, short panels cover all places that the
  !> law's special gaps have at any radius of the band.
  real(wp), parameter :: widest_band = 30, band_of_waves = 2, band_of_steps = 1.5_wp
  !> Where the tension is nearly constant up to the step, the nodes outside the step hardly add to
  !> the cost of a state, and wider bands are cheaper.
  real(wp), parameter :: band_of_constant_tension = 4
  !> Fraction of the radius at which a front becomes sharp; above it a mesh is locked to the front.
  real(wp), parameter :: early = 0.25_wp

  type :: mesh_family_t
    !> The meshes in the order of the path.
    type(discretisation_t), allocatable :: grid(:)
    !> The number of accurate digits for which the meshes are made.
    real(wp) :: digits = 0
    !> The shapes of these meshes.
    type(mapped_shape_t), allocatable :: shape(:)
    !> Radius, in lateral units, at which the path passes to the next mesh: of the edge or the front
    !> to which the next mesh is locked; for the last mesh the largest expected radius.
    real(wp), allocatable :: passage(:)
    !> Whether the path can be traced: the law attracts. Otherwise there is one mesh for contact,
    !> and `hertz_scale` prescribes its scale.
    logical :: traceable = .true.
    !> Least and largest radius of each mesh, lateral units; for the approach the largest H0.
    real(wp), allocatable :: reach(:, :)
    !> Whether a mesh is laid out only when the path reaches it, for the gaps of the bodies there
    !> (`lay_out`); until then it has no kernel.
    logical, allocatable :: waits(:)
    !> Whether a mesh was inserted while the path was traced (`insert`).
    logical, allocatable :: inserted(:)
    !> Gap at which a law without a contact edge begins to deform the bodies.
    real(wp) :: level = -huge(1.0_wp)
    !> The gap to which each mesh is locked: at the contact edge, at the front of a step, or outside
    !> a minimum of the energy before contact; 0 for meshes about the axis.
    real(wp), allocatable :: locked(:)
    !> The gap at the contact edge.
    real(wp) :: edge_gap = 0
    !> Whether meshes may be inserted while the path is traced (`insert`).
    logical :: grows = .true.
  contains
    procedure :: in_contact
    procedure :: is_about_axis
    procedure :: is_in_outer_contact
    procedure :: locked_gap
    procedure :: insert
    procedure :: has_short_panels
    procedure :: renew
    procedure :: replace
    procedure :: refine
    procedure :: shape_for
    procedure :: complete
  end type mesh_family_t

contains

  !> Meshes for H0 from h0_high down to h0_low, accurate to the given number of digits
  !> (`mesh_rule`). shape_only: the kernels are left out, because only their size is needed or
  !> because `complete` adds them later. store: earlier meshes, to which these are added. coarser:
  !> meshes of fewer digits for the same problem and range. Where these have halved or short panels,
  !> or as many nodes as those of more digits, their panels are kept and get more nodes, since a new
  !> layout could have fewer nodes and would then not be more accurate.
  function new_mesh_family(problem, h0_high, h0_low, digits, shape_only, store, coarser) &
    result(meshes)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low, digits
    logical, intent(in), optional :: shape_only
    type(mesh_store_t), intent(inout), optional :: store
    type(mesh_family_t), intent(in), optional :: coarser
    type(mesh_family_t) :: meshes
    logical :: elastic
    integer :: k

    elastic = .true.
    if (present(shape_only)) elastic = .not. shape_only
    if (present(coarser)) then
      meshes = coarser
      deallocate (meshes%grid, meshes%shape)
    else
      call plan(problem, h0_high, h0_low, meshes)
    end if
    allocate (meshes%grid(size(meshes%locked)), meshes%shape(size(meshes%locked)))
    meshes%digits = digits
    do k = merge(approach, contact, meshes%traceable), size(meshes%grid)
      if (present(coarser)) call follow(meshes, coarser, k, problem)
      if (.not. allocated(meshes%shape(k)%order)) meshes%shape(k) = meshes%shape_for(problem, k)
      call make_mesh(meshes%shape(k), elastic .and. .not. meshes%waits(k), meshes%grid(k), store)
    end do
  end function new_mesh_family

  !> Plans the meshes for H0 from h0_high down to h0_low: their bands, and to what they are locked.
  subroutine plan(problem, h0_high, h0_low, meshes)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low
    type(mesh_family_t), intent(inout) :: meshes
    real(wp) :: widest
    real(wp), allocatable :: low(:), high(:)
    integer :: k, fronts

    meshes%traceable = problem%law%adhesion > 0
    if (.not. meshes%traceable) meshes%level = contact_level(problem)
    widest = largest_radius(problem, h0_low, meshes%level)
    allocate (low(0), high(0))
    fronts = 0
    if (.not. meshes%traceable) then
      call add_bands(1.0_wp, widest, 1, low, high)
    else if (problem%law%edge_gap > 0) then
      associate (first => min(passage_to_contact(problem), widest))
        ! Where rounding hides the contact, the path ends at its first fold.
        if (lost_in_rounding(problem, widest)) widest = widest_band*first
        if (front_leads(problem%law)) call add_bands(early*first_front(problem), &
          last_front(problem), bands_for(problem, early*first_front(problem), &
          last_front(problem)), low, high)
        fronts = size(low)
        call add_bands(first, widest, bands_for(problem, first, widest), low, high)
      end associate
    end if
    meshes%passage = [low, widest]
    meshes%reach = reshape([h0_high, 0.0_wp, (low(k), high(k), k=1, size(low))], &
      [2, approach + size(low)])
    meshes%edge_gap = problem%law%edge_gap
    meshes%locked = [0.0_wp, spread(problem%law%step_at, 1, fronts), &
      spread(problem%law%edge_gap, 1, size(low) - fronts)]
    allocate (meshes%inserted(size(meshes%locked)), source=.false.)
    meshes%waits = meshes%inserted
    if (meshes%traceable) meshes%waits(contact:) = is_narrow(problem)
  end subroutine plan

  !> The shape of a mesh. seen: gaps of computed states on it.
  type(mapped_shape_t) function shape_for(self, problem, mesh, seen) result(shape)
    class(mesh_family_t), intent(in) :: self
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(seen_gaps_t), intent(in), optional :: seen
    integer :: about

    if (self%is_about_axis(mesh)) then
      shape = approach_shape(problem, max(self%reach(1, mesh), calm_gap(problem)), self%digits, &
        seen)
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

  !> Adds the kernel to a mesh that was made without it, for elastic bodies.
  subroutine complete(self, mesh, store)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mesh_store_t), intent(inout), optional :: store

    call make_mesh(self%shape(mesh), .true., self%grid(mesh), store)
  end subroutine complete

  !> Number of bands of equal ratio between two radii.
  pure integer function bands_for(problem, first, last) result(bands)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: first, last

    real(wp) :: ratio

    ratio = widest_band
    if (problem%law%period > 0) ratio = band_of_waves
    if (problem%law%step_width > 0) ratio = band_of_steps
    if (has_constant_tension(problem%law)) ratio = band_of_constant_tension
    bands = ceiling(log(last/first)/log(ratio))
  end function bands_for

  !> Adds bands between two radii.
  pure subroutine add_bands(first, last, bands, low, high)
    real(wp), intent(in) :: first, last
    integer, intent(in) :: bands
    real(wp), allocatable, intent(inout) :: low(:), high(:)
    real(wp) :: border(0:bands)
    integer :: k

    border = [first, (first*(last/first)**(real(k, wp)/bands), k=1, bands)]
    low = [low, border(:bands - 1)]
    high = [high, border(1:)]
  end subroutine add_bands

  !> Replaces a mesh by a new one with the given shape, for elastic bodies.
  subroutine renew(self, mesh, shape)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mapped_shape_t), intent(in) :: shape

    self%shape(mesh) = shape
    self%grid(mesh) = new_mapped_mesh(shape, elastic=.true.)
    self%waits(mesh) = .false.
  end subroutine renew

  !> Replaces a mesh by one that was made before.
  subroutine replace(self, mesh, shape, grid)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mapped_shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid

    self%shape(mesh) = shape
    self%grid(mesh) = grid
  end subroutine replace

  !> Makes a mesh, without its kernel, that is finer than that of a coarser family.
  subroutine refine(self, problem, mesh, coarser)
    class(mesh_family_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    integer, intent(in) :: mesh
    type(mesh_family_t), intent(in) :: coarser

    call follow(self, coarser, mesh, problem)
    call make_mesh(self%shape(mesh), .false., self%grid(mesh))
  end subroutine refine

  !> Chooses the shape of a mesh from a coarser one with more nodes on its panels: if the coarser
  !> one has short or halved panels, or if a new layout would have fewer nodes than this, as under
  !> laws for which numbers of nodes were tried, and so would have the same error.
  subroutine follow(self, coarser, mesh, problem)
    class(mesh_family_t), intent(inout) :: self
    type(mesh_family_t), intent(in) :: coarser
    integer, intent(in) :: mesh
    type(problem_t), intent(in) :: problem
    type(mapped_shape_t) :: richer

    if (.not. allocated(coarser%grid(mesh)%kernel)) return
    richer = coarser%shape(mesh)%enriched(self%digits/coarser%digits, self%digits - coarser%digits)
    if (.not. coarser%has_short_panels(mesh)) then
      self%shape(mesh) = self%shape_for(problem, mesh)
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

  !> Whether a mesh is locked to the contact edge.
  pure logical function in_contact(self, mesh)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    in_contact = mesh >= contact .and. allocated(self%locked)
    if (in_contact) in_contact = .not. abs(self%locked(mesh) - self%edge_gap) > 0
  end function in_contact

  !> Whether a mesh is about the axis: locked to nothing.
  pure logical function is_about_axis(self, mesh)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    is_about_axis = .not. (self%in_contact(mesh) .or. self%locked_gap(mesh) > 0)
  end function is_about_axis

  !> Whether a mesh is locked to the edge of a contact in an outer minimum.
  pure logical function is_in_outer_contact(self, mesh)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    is_in_outer_contact = self%inserted(mesh) .and. self%locked_gap(mesh) > 0
  end function is_in_outer_contact

  !> The gap to which a mesh is locked; 0 for meshes about the axis or fixed in space.
  pure real(wp) function locked_gap(self, mesh) result(gap)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    gap = 0
    if (allocated(self%locked)) gap = self%locked(mesh)
  end function locked_gap

  !> Inserts a mesh without nodes, locked to a gap (0: about the axis), for radii of this gap
  !> between low and high, after another mesh; from that mesh the path passes to the new one at
  !> once.
  subroutine insert(self, after, locked, low, high)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: after
    real(wp), intent(in) :: locked, low, high
    type(discretisation_t), allocatable :: grid(:)
    integer :: k

    allocate (grid(size(self%grid) + 1))
    grid(:after) = self%grid(:after)
    grid(after + 2:) = self%grid(after + 1:)
    call move_alloc(grid, self%grid)
    self%shape = self%shape([(k, k=1, after + 1), (k, k=after + 1, size(self%shape))])
    self%locked = [self%locked(:after), locked, self%locked(after + 1:)]
    self%waits = [self%waits(:after), .true., self%waits(after + 1:)]
    self%inserted = [self%inserted(:after), .true., self%inserted(after + 1:)]
    self%passage = [self%passage(:after), self%passage(after:)]
    self%passage(after) = 0
    self%reach = reshape([self%reach(:, :after), [low, high], self%reach(:, after + 1:)], &
      [2, size(self%grid)])
  end subroutine insert

  !> Contact radius at which the edge becomes too sharp for the mesh of the approach: a fraction of
  !> the neck, and of the radius over which the gap between rigid bodies increases from the gap at
  !> rest to that of largest tension. If a front leads, nothing inside it is sharp before its last
  !> radius; the rim of a flat face is passed before.
  pure real(wp) function passage_to_contact(problem) result(c)
    type(problem_t), intent(in) :: problem

    if (front_leads(problem%law)) then
      c = 0.5_wp*last_front(problem)
      return
    end if
    c = 0.25_wp*cohesive_width(problem)
    if (problem%law%edge_gap > 0) &
      c = min(c, 0.25_wp*problem%shape%position_of( &
      0.5_wp*(problem%law%edge_gap - problem%law%rest_gap)))
    c = max(c, rim_passed_at(problem))
  end function passage_to_contact

end module edge_locked
