!> Meshes mapped to a place, such as the contact edge or the axis. The distance from this place is d
!> sinh(z), and the mesh has Gauss-Legendre panels in z. Beyond some position an algebraic panel
!> extends to infinity, on which the pressure has a power tail. Distances from d to the mesh's
!> length have equal numbers of nodes per factor in distance.
module mapped_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t, mesh_of_panels
  use local_nodes, only: local_nodes_t, gauss_nodes
  use mapped_shape, only: mapped_shape_t
  use panel_map, only: panel_map_t, sinh_panel, power_map, algebraic_map
  implicit none
  private
  public :: new_mapped_mesh

contains

  !> The mesh of a shape; elastic = .false.: without the kernel. Neighbouring panels have exactly
  !> equal ends, and the innermost panel ends exactly at the axis.
  function new_mapped_mesh(shape, elastic) result(grid)
    type(mapped_shape_t), intent(in) :: shape
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    type(panel_map_t), allocatable :: panel(:)
    type(local_nodes_t), allocatable :: local(:)
    real(wp) :: z
    integer :: panels, k

    panels = size(shape%order)
    allocate (panel(panels + merge(1, 0, shape%tail_order > 0)))
    z = -sum(shape%z_length(:shape%inner))
    do k = 1, panels
      if (k == shape%inner + 1) z = 0
      panel(k) = sinh_panel(shape%focus, shape%d, z, shape%z_length(k))
      if (k > 1) panel(k - 1)%right = panel(k)%left
      z = z + shape%z_length(k)
    end do
    panel(1)%left = -shape%centre
    if (shape%axis_power > 1) &
      panel(1) = panel_map_t(power_map, -shape%centre, panel(1)%right, power=shape%axis_power)
    associate (outermost => panel(panels)%right)
      if (shape%tail_order > 0) panel(panels + 1) = panel_map_t(algebraic_map, outermost, &
        huge(1.0_wp), begin=shape%centre + outermost, decay=shape%decay)
    end associate
    allocate (local(size(panel)))
    do k = 1, panels
      local(k) = gauss_nodes(shape%order(k))
    end do
    if (shape%tail_order > 0) local(panels + 1) = gauss_nodes(shape%tail_order)
    grid = mesh_of_panels(shape%centre, panel, local, [(k, k=1, size(panel))], shape%even, &
      shape%digits, elastic)
  end function new_mapped_mesh

end module mapped_mesh
