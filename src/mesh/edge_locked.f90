!> The meshes on which the whole equilibrium path is resolved at any adhesion strength.
!>
!> Before contact the mesh is mapped to the axis and the gap there is the coordinate of the path. In
!> contact meshes are locked to the contact edge: positions are in units of the contact radius c,
!> the edge stays at 1, and c is the coordinate. Both coordinates are monotone along the path. A
!> mesh serves a band of contact radii; the path passes from one to the next.
module edge_locked
  use kinds, only: wp
  use dimensionless_problem, only: problem_t, neck_width, calm_gap
  use discretisation, only: discretisation_t
  use mapped_mesh, only: new_mapped_mesh
  use mesh_rule, only: approach_shape, contact_shape
  use contact_scales, only: largest_radius, contact_level, lost_in_rounding
  implicit none
  private
  public :: mesh_family_t, new_mesh_family
  public :: approach, contact

  !> The mesh before contact, and the first of those in contact.
  integer, parameter :: approach = 1, contact = 2

  !> Largest ratio of the contact radii that one mesh serves: a mesh for wider bands has more nodes,
  !> and more bands have more meshes.
  real(wp), parameter :: widest_band = 30

  type :: mesh_family_t
    !> The meshes in the order of the path.
    type(discretisation_t), allocatable :: grid(:)
    !> Contact radius at which the path passes from a mesh to the next, lateral units; of the last
    !> it is the largest that is expected.
    real(wp), allocatable :: passage(:)
    !> Whether the path can be traced: the law attracts, or the bodies are rigid and it is trivial.
    !> If not, there is one mesh for contact, and its scale is prescribed by `hertz_scale`.
    logical :: traceable = .true.
    !> Gap at which a law without a contact edge begins to deform the bodies.
    real(wp) :: level = -huge(1.0_wp)
  end type mesh_family_t

contains

  !> Meshes for H0 from h0_high down to h0_low, good for so many digits (`mesh_rule`).
  !> shape_only leaves the kernels out, to learn how large they would be.
  function new_mesh_family(problem, h0_high, h0_low, digits, shape_only) result(meshes)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: h0_high, h0_low, digits
    logical, intent(in), optional :: shape_only
    type(mesh_family_t) :: meshes
    real(wp) :: first, widest
    logical :: elastic
    integer :: bands, k

    elastic = .not. problem%rigid
    if (present(shape_only)) elastic = elastic .and. .not. shape_only
    meshes%traceable = problem%law%adhesion > 0 .or. problem%rigid
    if (.not. meshes%traceable) meshes%level = contact_level(problem)
    widest = largest_radius(problem, h0_low, meshes%level)
    first = min(passage_to_contact(problem), widest)
    bands = 0
    if (.not. meshes%traceable) then
      bands = 1
      first = 1
    else if (problem%law%edge_gap > 0 .and. .not. problem%rigid) then
      ! Where rounding hides the contact the path ends at its first fold.
      if (lost_in_rounding(problem, widest)) widest = widest_band*first
      bands = ceiling(log(widest/first)/log(widest_band))
    end if
    allocate (meshes%grid(approach + bands))
    meshes%passage = [first, (first*(widest/first)**(real(k, wp)/bands), k=1, bands)]
    if (meshes%traceable) meshes%grid(approach) = new_mapped_mesh( &
      approach_shape(problem, max(h0_high, calm_gap(problem)), digits), elastic)
    do k = contact, size(meshes%grid)
      meshes%grid(k) = new_mapped_mesh(contact_shape(problem, meshes%passage(k - 1), &
        meshes%passage(k), meshes%level, digits), elastic)
    end do
  end function new_mesh_family

  !> Contact radius at which the edge becomes too sharp for the mesh of the approach: a part of the
  !> neck, and of the radius at which the axis of rigid bodies comes from most tension to rest.
  pure real(wp) function passage_to_contact(problem) result(c)
    type(problem_t), intent(in) :: problem

    c = 0.25_wp*neck_width(problem)
    if (problem%law%edge_gap > 0) &
      c = min(c, 0.25_wp*problem%shape%position_of( &
      0.5_wp*(problem%law%edge_gap - problem%law%rest_gap)))
  end function passage_to_contact

end module edge_locked
