!> Meshes that are inserted while the path is traced. A new mesh about the axis begins where the
!> present one misses too much of the load, unless meshes are locked to the radius of a step of the
!> pressure. A law with several minima of its energy has metastable contact in a secondary minimum,
!> whose edge is where the tension outside the minimum is largest. While this edge moves faster than
!> the axis, meshes are locked to it.
module mesh_insertion
  use kinds, only: wp
  use force_law, only: force_law_t
  use contact_state, only: radius_of_gap
  use equilibrium, only: equations_t
  use mesh_plan, only: band_of_waves
  use arc, only: arc_t
  use path_coordinate, only: axis_coordinate
  use mesh_refinement, only: left_in_state
  implicit none
  private
  public :: inserted_mesh_t, inserted_mesh

  !> Whether a mesh is to be inserted, the gap to which it is locked (0: about the axis), and its
  !> reach (`mesh_plan_t`).
  type :: inserted_mesh_t
    logical :: wanted = .false.
    real(wp) :: locked = 0, reach(2) = 0
  end type inserted_mesh_t

  !> The next mesh is locked to the edge of an outer contact if the logarithm of the edge's radius
  !> changes this many times faster than the coordinate on the axis. In the opposite case the next
  !> mesh is about the axis.
  real(wp), parameter :: faster = 2
  !> Largest ratio of the change of the axis gap to that of h0 in a contact that grows in a
  !> secondary minimum.
  real(wp), parameter :: resting = 0.2_wp
  !> A mesh about the axis is made for |h0| up to this multiple of the |h0| at which it begins.
  real(wp), parameter :: deeper = 1.5_wp
  !> Least number of states on a mesh before another one is inserted; two of them were transferred
  !> from the previous mesh.
  integer, parameter :: enough = 4
  !> Least change of the coordinate over the states of an arc; if it is smaller, another mesh would
  !> not help.
  real(wp), parameter :: least_progress = 1.0e-4_wp

contains

  !> The mesh on which the path should continue, if it should leave the mesh of the arc. most: part
  !> of the load that the nodes may miss.
  pure type(inserted_mesh_t) function inserted_mesh(equations, arc, most) result(further)
    type(equations_t), intent(in) :: equations
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: most
    real(wp) :: level, radius(2), nearer, wider

    associate (meshes => equations%meshes, law => equations%problem%law, mesh => arc%mesh)
      if (.not. meshes%grows .or. meshes%fronts .or. .not. law%edge_gap > 0) return
      if (meshes%in_contact(mesh) .or. arc%held < enough) return
      if (arc%point(arc%held)%coordinate - arc%point(1)%coordinate < least_progress) return
      if (meshes%passage(mesh) <= 0) return
      associate (before => arc%point(arc%held - 1)%state, now => arc%point(arc%held)%state)
        level = meshes%locked_gap(mesh)
        if (.not. level > 0) level = edge_beyond(law, now%axis_gap)
        radius = [radius_of_gap(equations%problem%shape, level, meshes%grid(mesh), before), &
          radius_of_gap(equations%problem%shape, level, meshes%grid(mesh), now)]
        nearer = axis_coordinate(law, now) - axis_coordinate(law, before)
        wider = 0
        if (minval(radius) > 0) wider = log(radius(2)/radius(1))
        if (meshes%is_about_axis(mesh)) then
          further%wanted = level > law%edge_gap .and. wider > faster*nearer .and. &
            wider < log(band_of_waves) .and. &
            abs(now%axis_gap - before%axis_gap) < resting*abs(now%h0 - before%h0)
          if (.not. further%wanted) level = 0
        else
          further%wanted = nearer > faster*wider
          if (further%wanted) level = 0
          further%wanted = further%wanted .or. radius(2) > meshes%reach(2, mesh)
        end if
        further%wanted = further%wanted .or. left_in_state(equations, mesh, now) > most
      end associate
      further%locked = level
      if (level > 0) then
        further%reach = [radius(1), band_of_waves*radius(2)]
      else
        ! The poles of the pressure have the same distance from the axis at h0 and at -h0.
        further%reach = [max(meshes%reach(1, 1), deeper*abs(arc%point(arc%held)%state%h0)), 0.0_wp]
      end if
    end associate
  end function inserted_mesh

  !> The smallest of the law's gaps at outer edges that is larger than a given gap; 0: there is
  !> none, or the bodies are in contact.
  pure real(wp) function edge_beyond(law, gap) result(edge)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: gap
    integer :: k

    edge = 0
    if (.not. (allocated(law%outer_edges) .and. gap > law%edge_gap)) return
    k = count(law%outer_edges <= gap) + 1
    if (k <= size(law%outer_edges)) edge = law%outer_edges(k)
  end function edge_beyond

end module mesh_insertion
