!> The paper's grid: equal spacing from the axis, pressure linear between nodes.
module uniform_grid
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use linear_mesh, only: new_linear_mesh
  implicit none
  private
  public :: new_uniform_grid

contains

  !> A mesh of `nodes` (2 or more) equally spaced nodes on [0, extent]; its error is of second order
  !> in the spacing.
  function new_uniform_grid(nodes, extent, elastic) result(grid)
    integer, intent(in) :: nodes
    real(wp), intent(in) :: extent
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    integer :: j

    grid = new_linear_mesh(0.0_wp, [(extent*j/(nodes - 1), j=0, nodes - 1)], &
      [0.0_wp, 1.0_wp], elastic)
  end function new_uniform_grid

end module uniform_grid
