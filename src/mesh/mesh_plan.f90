!> Which meshes the equilibrium path needs, and to what they are locked.
!>
!> Before contact the mesh is about the axis, and the gap on the axis is the coordinate of the path.
!> In contact meshes are locked to the contact edge: positions are in units of the contact radius c,
!> the edge stays at 1, and c is the coordinate. Both coordinates are monotonic along the path. (If
!> the gap on the axis is not monotonic, the path passes early to the mesh of the edge:
!> `mesh_passage`.) A mesh is for a band of contact radii; the path passes from one mesh to the
!> next. If a step of the pressure pulls the bodies together, further meshes between the approach
!> and contact are locked to the front of the step (`step_front`) in the same way. While the path is
!> traced, meshes may be inserted before contact, about the axis or locked to the edge of an outer
!> contact (`mesh_insertion`).
module mesh_plan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use shape_panels, only: rim_passed_at
  use step_front, only: front_leads, first_front, last_front
  use contact_scales, only: largest_radius, contact_level, cohesive_width, lost_in_rounding
  implicit none
  private
  public :: mesh_plan_t, new_mesh_plan, is_narrow
  public :: approach, contact, band_of_waves

  !> The mesh before contact, and the first of those in contact or about a front.
  integer, parameter :: approach = 1, contact = 2

  !> Largest ratio of the contact radii of one mesh: wider bands need more nodes, narrower bands
  !> more meshes. Under a law that oscillates or has a step, short panels cover the positions of the
  !> law's special gaps at all radii of the band, and `next_mesh` may divide bands.
  real(wp), parameter :: widest_band = 30, band_of_waves = 2, band_of_steps = 4

  !> The meshes are in the order of the path.
  type :: mesh_plan_t
    !> Radius, in lateral units, at which the path passes to the next mesh: that of the edge or the
    !> front to which the next mesh is locked. For the last mesh it is the largest expected radius.
    !> 0: the path passes at once.
    real(wp), allocatable :: passage(:)
    !> Whether the path can be traced: the law attracts. Otherwise there is one mesh for contact,
    !> and `hertz_scale` prescribes its scale.
    logical :: traceable = .true.
    !> Least and largest radius of each mesh, lateral units; for the approach the largest H0.
    real(wp), allocatable :: reach(:, :)
    !> Whether a mesh is laid out only when the path reaches it, for the gaps of the bodies there
    !> (`lay_out_next`); until then it has no kernel.
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
    !> Whether meshes between the approach and contact are locked to the front of a step.
    logical :: fronts = .false.
    !> Whether meshes may be inserted while the path is traced (`insert`). Experiments in time pass
    !> from mesh to mesh by radii alone, and need plans without inserted meshes.
    logical :: grows = .true.
  contains
    procedure :: in_contact
    procedure :: is_about_axis
    procedure :: is_in_outer_contact
    procedure :: is_fixed
    procedure :: locked_gap
    procedure :: next_passage
    procedure :: insert
    procedure :: divide
  end type mesh_plan_t

contains

  !> The plan of meshes for H0 from h0_high down to h0_low. fronts: whether meshes may be locked to
  !> the front of a step. further: whether meshes may be inserted later.
  type(mesh_plan_t) function new_mesh_plan(problem, h0_high, h0_low, fronts, further) result(plan)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low
    logical, intent(in) :: fronts, further
    real(wp) :: widest
    real(wp), allocatable :: low(:), high(:)
    integer :: k, about_front

    plan%traceable = problem%law%adhesion > 0
    if (.not. plan%traceable) plan%level = contact_level(problem)
    widest = largest_radius(problem, h0_low, plan%level)
    allocate (low(0), high(0))
    about_front = 0
    plan%fronts = fronts .and. front_leads(problem%law)
    if (.not. plan%traceable) then
      call add_bands(1.0_wp, widest, 1, low, high)
    else if (problem%law%edge_gap > 0) then
      associate (first => min(passage_to_contact(problem, plan%fronts, further, widest), widest))
        ! Where rounding hides the contact, the path ends at its first fold.
        if (lost_in_rounding(problem, widest)) widest = widest_band*first
        if (plan%fronts) call add_bands(first_front(problem), last_front(problem), &
          bands_for(problem, first_front(problem), last_front(problem)), low, high)
        about_front = size(low)
        call add_bands(first, widest, bands_for(problem, first, widest), low, high)
      end associate
    end if
    plan%passage = [low, widest]
    plan%reach = reshape([h0_high, 0.0_wp, (low(k), high(k), k=1, size(low))], &
      [2, approach + size(low)])
    plan%edge_gap = problem%law%edge_gap
    plan%locked = [0.0_wp, spread(problem%law%step_at, 1, about_front), &
      spread(problem%law%edge_gap, 1, size(low) - about_front)]
    allocate (plan%inserted(size(plan%locked)), source=.false.)
    plan%waits = plan%inserted
    if (plan%traceable) plan%waits(contact:) = is_narrow(problem)
  end function new_mesh_plan

  !> Whether short panels cover all places with the law's special gaps, so that each mesh is for a
  !> narrower band of radii and is laid out for computed gaps.
  pure logical function is_narrow(problem)
    type(problem_t), intent(in) :: problem

    is_narrow = problem%law%period > 0 .or. problem%law%step_width > 0
  end function is_narrow

  !> Inserts a mesh after another one: locked to a gap (0: about the axis), for radii of this gap
  !> between low and high. The path passes to this mesh at once from the mesh before.
  pure subroutine insert(self, after, locked, low, high)
    class(mesh_plan_t), intent(inout) :: self
    integer, intent(in) :: after
    real(wp), intent(in) :: locked, low, high

    self%locked = [self%locked(:after), locked, self%locked(after + 1:)]
    self%waits = [self%waits(:after), .true., self%waits(after + 1:)]
    self%inserted = [self%inserted(:after), .true., self%inserted(after + 1:)]
    self%passage = [self%passage(:after), self%passage(after:)]
    self%passage(after) = 0
    self%reach = reshape([self%reach(:, :after), [low, high], self%reach(:, after + 1:)], &
      [2, size(self%locked)])
  end subroutine insert

  !> Divides the band of a mesh that waits: the mesh is for radii up to `middle`, and a new one
  !> after it for the others.
  pure subroutine divide(self, mesh, middle)
    class(mesh_plan_t), intent(inout) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: middle

    call self%insert(mesh, self%locked(mesh), middle, self%reach(2, mesh))
    self%inserted(mesh + 1) = .false.
    self%passage(mesh) = middle
    self%reach(2, mesh) = middle
  end subroutine divide

  !> Number of bands of equal ratio between two radii.
  pure integer function bands_for(problem, first, last) result(bands)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: first, last

    real(wp) :: ratio

    ratio = widest_band
    if (problem%law%period > 0) ratio = band_of_waves
    if (problem%law%step_width > 0) ratio = band_of_steps
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

  !> Whether a mesh is locked to the contact edge.
  pure logical function in_contact(self, mesh)
    class(mesh_plan_t), intent(in) :: self
    integer, intent(in) :: mesh

    in_contact = mesh >= contact .and. allocated(self%locked)
    if (in_contact) in_contact = .not. abs(self%locked(mesh) - self%edge_gap) > 0
  end function in_contact

  !> Whether a mesh is about the axis: locked to nothing.
  pure logical function is_about_axis(self, mesh)
    class(mesh_plan_t), intent(in) :: self
    integer, intent(in) :: mesh

    is_about_axis = .not. (self%in_contact(mesh) .or. self%locked_gap(mesh) > 0)
  end function is_about_axis

  !> Whether a mesh is locked to the edge of a contact in an outer minimum.
  pure logical function is_in_outer_contact(self, mesh)
    class(mesh_plan_t), intent(in) :: self
    integer, intent(in) :: mesh

    is_in_outer_contact = self%inserted(mesh) .and. self%locked_gap(mesh) > 0
  end function is_in_outer_contact

  !> The radius of the contact at which the path leaves a mesh and those inserted after it; 0 if
  !> there is no contact.
  pure real(wp) function next_passage(self, mesh) result(radius)
    class(mesh_plan_t), intent(in) :: self
    integer, intent(in) :: mesh
    integer :: k

    radius = 0
    if (.not. self%edge_gap > 0) return
    do k = mesh, size(self%passage)
      radius = self%passage(k)
      if (radius > 0) exit
    end do
  end function next_passage

  !> Whether the meshes are fixed in space, and locked to nothing.
  pure logical function is_fixed(self)
    class(mesh_plan_t), intent(in) :: self

    is_fixed = .not. allocated(self%locked)
  end function is_fixed

  !> The gap to which a mesh is locked; 0 for meshes about the axis or fixed in space.
  pure real(wp) function locked_gap(self, mesh) result(gap)
    class(mesh_plan_t), intent(in) :: self
    integer, intent(in) :: mesh

    gap = 0
    if (allocated(self%locked)) gap = self%locked(mesh)
  end function locked_gap

  !> Contact radius at which the edge becomes too sharp for the mesh of the approach. It is a
  !> fraction of two lengths: the width of the cohesive zone, and the radius over which the gap
  !> between rigid bodies increases from the equilibrium separation to that of largest tension. If
  !> meshes are locked to a front, the result is half the last radius of the front, inside which the
  !> pressure is smooth. If further meshes may be inserted, the result is at least the radius up to
  !> which the edge stays on meshes about the axis (`rim_passed_at`). widest: the largest radius.
  pure real(wp) function passage_to_contact(problem, fronts, further, widest) result(c)
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: fronts, further
    real(wp), intent(in) :: widest

    if (fronts) then
      c = 0.5_wp*last_front(problem)
      return
    end if
    c = 0.25_wp*cohesive_width(problem)
    if (problem%law%edge_gap > 0) &
      c = min(c, 0.25_wp*problem%shape%position_of( &
      0.5_wp*(problem%law%edge_gap - problem%law%rest_gap)))
    if (further) c = max(c, rim_passed_at(problem, widest))
  end function passage_to_contact

end module mesh_plan
