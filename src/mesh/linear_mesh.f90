!> Meshes of many panels of equal order without a map: the paper's grid, and panels fixed in space.
module linear_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use panel_map, only: panel_map_t, linear_map
  use quadrature, only: gauss_legendre
  use product_integration, only: panel_rule_t, new_panel_rule, panel_weights
  implicit none
  private
  public :: new_uniform_grid, new_panel_grid, graded_ends

contains

  !> The mesh of the panels [end(k), end(k+1)] (offsets from the centre), each with the nodes
  !> `local_node` on [0, 1]; a node at 1 is shared with the next panel's node at 0. elastic =
  !> .false.: without the kernel.
  function new_linear_mesh(centre, panel_end, local_node, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:), local_node(:)
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    type(panel_rule_t) :: rule
    real(wp), allocatable :: x(:), target(:), weights(:)
    real(wp) :: length
    integer :: panels, order, stride, panel, first, last, i

    order = size(local_node)
    panels = size(panel_end) - 1
    grid%centre = centre
    grid%end = centre + panel_end(panels + 1)
    rule = new_panel_rule(local_node)
    stride = order
    if (local_node(order) >= 1) stride = order - 1
    grid%nodes = panels*stride + (order - stride)
    grid%spacing = minval(panel_end(2:) - panel_end(:panels))/stride
    allocate (grid%panel(panels), grid%local(1))
    grid%panel = [(panel_map_t(linear_map, panel_end(panel), panel_end(panel + 1)), &
      panel=1, panels)]
    grid%first = [(1 + (panel - 1)*stride, panel=1, panels)]
    allocate (grid%which(panels), source=1)
    grid%local(1)%node = local_node
    grid%local(1)%weight = rule%weight
    grid%local(1)%barycentric = rule%barycentric

    allocate (target(first_node - 1 + grid%nodes), x(grid%nodes), grid%weight(grid%nodes))
    grid%weight = 0
    do panel = 1, panels
      first = grid%first(panel)
      last = first + order - 1
      length = panel_end(panel + 1) - panel_end(panel)
      x(first:last) = panel_end(panel) + length*local_node
      if (order > 2) then
        grid%weight(first:last) = length*rule%weight*(centre + x(first:last))
      else
        ! The exact integral of a hat function times x: end values a, b have the weights (2a + b)/6,
        ! (a + 2b)/6.
        grid%weight(first:last) = grid%weight(first:last) + length/6* &
          (centre + x(first:last) + (2*centre + x(first) + x(last)))
      end if
    end do
    grid%x = centre + x
    call grid%note_axis(.true.)
    if (.not. elastic) return

    target(axis_row) = -centre
    target(centre_row) = 0
    target(first_node:) = x
    allocate (grid%kernel(size(target), grid%nodes))
    ! Panels that share a node add to the same column, so the threads divide rows, not panels.
    !$omp parallel do schedule(dynamic, 8) private(panel, first, last, weights)
    do i = 1, size(target)
      allocate (weights(order))
      grid%kernel(i, :) = 0
      do panel = 1, panels
        first = grid%first(panel)
        last = first + order - 1
        call panel_weights(rule, centre, target(i), panel_end(panel), panel_end(panel + 1), &
          weights)
        grid%kernel(i, first:last) = grid%kernel(i, first:last) + weights
      end do
      deallocate (weights)
    end do
    !$omp end parallel do
    call grid%note_kernel()
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
      [0.0_wp, 1.0_wp], elastic)
  end function new_uniform_grid

  !> Composite Gauss-Legendre panels of `order` nodes with the given ends (offsets from the centre,
  !> ascending): spectral convergence with a few hundred nodes.
  function new_panel_grid(centre, panel_end, order, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:)
    integer, intent(in) :: order
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    real(wp) :: node(order), weight(order)

    call gauss_legendre(node, weight)
    grid = new_linear_mesh(centre, panel_end, node, elastic)
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
