!> Meshes of many panels of equal order without a map: the paper's grid, and panels fixed in space.
module linear_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t, mesh_of_panels
  use local_nodes, only: local_nodes_t, gauss_nodes, given_nodes
  use panel_map, only: panel_map_t, linear_map
  implicit none
  private
  public :: new_uniform_grid, new_panel_grid, graded_ends

  !> Digits of the kernel.
  real(wp), parameter :: all_digits = 14

contains

  !> The mesh of the panels [end(k), end(k+1)] (offsets from the centre), each with the nodes
  !> `local`.
  function new_linear_mesh(centre, panel_end, local, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:)
    type(local_nodes_t), intent(in) :: local
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    type(local_nodes_t) :: nodes(1)
    integer :: panels, k

    panels = size(panel_end) - 1
    nodes(1) = local
    grid = mesh_of_panels(centre, &
      [(panel_map_t(linear_map, panel_end(k), panel_end(k + 1)), k=1, panels)], nodes, &
      spread(1, 1, panels), .true., all_digits, elastic)
  end function new_linear_mesh

  !> The paper's grid, with a pressure that is linear between nodes: `nodes` (2 or more)
  !> equally spaced nodes on [0, extent]; its error is of second order in the spacing.
  function new_uniform_grid(nodes, extent, elastic) result(grid)
    integer, intent(in) :: nodes
    real(wp), intent(in) :: extent
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    integer :: j

    grid = new_linear_mesh(0.0_wp, [(extent*j/(nodes - 1), j=0, nodes - 1)], &
      given_nodes([0.0_wp, 1.0_wp]), elastic)
  end function new_uniform_grid

  !> Composite Gauss-Legendre panels of `order` nodes with the given ends (offsets from the centre,
  !> ascending): spectral convergence with a few hundred nodes.
  function new_panel_grid(centre, panel_end, order, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:)
    integer, intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid

    grid = new_linear_mesh(centre, panel_end, gauss_nodes(order), elastic)
  end function new_panel_grid

  !> Ends of panels from 0 to `length`: the size of a panel is its distance from 0, but between
  !> `finest` and `coarsest`.
  pure function graded_ends(length, finest, coarsest) result(ends)
    real(wp), intent(in) :: length, finest, coarsest
    real(wp), allocatable :: ends(:)
    real(wp) :: size_here, d

    ends = [0.0_wp]
    d = 0
    do while (d < length)
      size_here = min(max(finest, d), coarsest)
      ! A remainder of less than half a panel is added to the last panel.
      if (d + 1.5_wp*size_here >= length) size_here = length - d
      d = d + size_here
      if (d >= length*(1 - 4*epsilon(d))) d = length
      ends = [ends, d]
    end do
  end function graded_ends

end module linear_mesh
