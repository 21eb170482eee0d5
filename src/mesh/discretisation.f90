!> The discretised half-space: nodes, quadrature weights and the matrix of the elastic kernel.
!> Solvers, cycle and path work on this object and do not know how it was built.
!>
!> All lengths are lateral and relative to a scale that the user of the object chooses; because the
!> kernel is homogeneous, the same matrix serves every scale c (see `equilibrium`).
module discretisation
  use kinds, only: wp, long
  use product_integration, only: panel_rule_t, new_panel_rule, panel_weights
  use quadrature, only: lagrange_basis
  implicit none
  private
  public :: discretisation_t, new_discretisation, axis_row, centre_row, first_node

  !> Rows of the kernel matrix.
  integer, parameter :: axis_row = 1, centre_row = 2, first_node = 3

  type :: discretisation_t
    !> Number of nodes, and of nodes from one panel's first to the next one's.
    integer :: nodes = 0, stride = 0
    !> Position of the mesh's centre: 0 for the axis, 1 for the contact edge.
    real(wp) :: centre = 0
    !> Radial positions of the nodes (ascending), (nodes).
    real(wp), allocatable :: x(:)
    !> integral f x dx = sum(weight*f), (nodes).
    real(wp), allocatable :: weight(:)
    !> matmul(kernel, p) = integral k(r, t) p(t) t dt, (first_node - 1 + nodes, nodes): row
    !> axis_row is the axis, row centre_row the mesh's centre, and rows from first_node on are the
    !> nodes, last so that a leading part of rows and columns is the operator of a leading part of
    !> the nodes. Not allocated for rigid bodies.
    real(wp), allocatable :: kernel(:, :)
    !> Ends of the panels as offsets from the centre (ascending), (panels + 1).
    real(wp), allocatable :: panel_end(:)
    !> What all panels have in common.
    type(panel_rule_t) :: rule
    !> Distance between neighbouring nodes of a panel; mean over the finest panel.
    real(wp) :: spacing = 0
  contains
    procedure :: interpolate
    procedure :: end_of
    procedure :: nodes_within
    procedure :: kernel_entries
  end type discretisation_t

contains

  !> Builds the object on the panels [end(k), end(k+1)] (offsets from the centre), each with the
  !> nodes `local_node` of [0, 1]; a node at 1 is shared with the next panel's node at 0.
  !> elastic = .false. leaves the kernel out.
  function new_discretisation(centre, panel_end, local_node, elastic) result(grid)
    real(wp), intent(in) :: centre, panel_end(:), local_node(:)
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    real(wp), allocatable :: x(:), target(:), weights(:)
    real(wp) :: length
    integer :: panels, order, panel, first, last, i

    order = size(local_node)
    panels = size(panel_end) - 1
    grid%centre = centre
    grid%panel_end = panel_end
    grid%rule = new_panel_rule(local_node)
    grid%stride = order
    if (local_node(order) >= 1) grid%stride = order - 1
    grid%nodes = panels*grid%stride + (order - grid%stride)
    grid%spacing = minval(panel_end(2:) - panel_end(:panels))/grid%stride

    allocate (target(first_node - 1 + grid%nodes), x(grid%nodes), grid%weight(grid%nodes))
    grid%weight = 0
    do panel = 1, panels
      first = (panel - 1)*grid%stride + 1
      last = first + order - 1
      length = panel_end(panel + 1) - panel_end(panel)
      x(first:last) = panel_end(panel) + length*local_node
      if (order > 2) then
        grid%weight(first:last) = length*grid%rule%weight*(centre + x(first:last))
      else
        ! The exact integral of hat function times x: end values a, b weigh (2a + b)/6, (a + 2b)/6.
        grid%weight(first:last) = grid%weight(first:last) + length/6* &
          (centre + x(first:last) + (2*centre + x(first) + x(last)))
      end if
    end do
    grid%x = centre + x
    if (.not. elastic) return

    target(axis_row) = -centre
    target(centre_row) = 0
    target(first_node:) = x
    allocate (grid%kernel(size(target), grid%nodes))
    ! Panels that share a node meet in one column, so each thread owns rows, not panels.
    !$omp parallel do schedule(dynamic, 8) private(panel, first, last, weights)
    do i = 1, size(target)
      allocate (weights(order))
      grid%kernel(i, :) = 0
      do panel = 1, panels
        first = (panel - 1)*grid%stride + 1
        last = first + order - 1
        call panel_weights(grid%rule, centre, target(i), panel_end(panel), panel_end(panel + 1), &
          weights)
        grid%kernel(i, first:last) = grid%kernel(i, first:last) + weights
      end do
      deallocate (weights)
    end do
    !$omp end parallel do
  end function new_discretisation

  !> Value at position x of the function with the given nodal values, by the panel's polynomial.
  !> Outside the mesh the nearest panel extrapolates; callers keep inside.
  pure function interpolate(self, values, x) result(value)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: values(:), x
    real(wp) :: value
    real(wp) :: offset, local
    integer :: low, high, middle, order, first

    order = size(self%rule%node)
    offset = x - self%centre
    low = 1
    high = size(self%panel_end)
    do while (high - low > 1)
      middle = (low + high)/2
      if (self%panel_end(middle) <= offset) then
        low = middle
      else
        high = middle
      end if
    end do
    local = (offset - self%panel_end(low))/(self%panel_end(low + 1) - self%panel_end(low))
    first = (low - 1)*self%stride + 1
    value = dot_product(lagrange_basis(self%rule%node, self%rule%barycentric, local), &
      values(first:first + order - 1))
  end function interpolate

  !> Where the panels of the first `nodes` nodes end, from the axis.
  pure real(wp) function end_of(self, nodes)
    class(discretisation_t), intent(in) :: self
    integer, intent(in) :: nodes
    integer :: panels

    panels = (nodes - (size(self%rule%node) - self%stride))/self%stride
    end_of = self%centre + self%panel_end(panels + 1)
  end function end_of

  !> Number of leading nodes whose panels reach to the position x (at least one panel's).
  pure integer function nodes_within(self, x)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: x
    integer :: panels

    panels = max(1, count(self%centre + self%panel_end(:size(self%panel_end) - 1) < x))
    nodes_within = panels*self%stride + (size(self%rule%node) - self%stride)
  end function nodes_within

  !> Number of kernel entries that were computed.
  elemental integer(long) function kernel_entries(self)
    class(discretisation_t), intent(in) :: self

    kernel_entries = 0
    if (allocated(self%kernel)) kernel_entries = size(self%kernel, kind=long)
  end function kernel_entries

end module discretisation
