!> Meshes mapped to a place, such as the contact edge or the axis: distance = d sinh(z) from it,
!> Gauss-Legendre panels in z, and beyond some position an algebraic panel to infinity, on which
!> pressures are a power tail. Distances from d to the mesh's length have equal numbers of nodes per
!> factor in distance.
module mapped_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use local_nodes, only: gauss_nodes
  use panel_map, only: panel_map_t, sinh_panel, power_map, algebraic_map
  use mapped_kernel, only: add_panel
  implicit none
  private
  public :: mapped_shape_t, same_shape, new_mapped_mesh

  !> Number of nodes above which a panel counts as long.
  integer, parameter :: long = 16

  !> The parameters of a mapped mesh.
  type :: mapped_shape_t
    !> Position of the centre (0: the axis, 1: the contact edge), and d.
    real(wp) :: centre = 0, d = 1
    !> Nodes of the sinh panels and their lengths in z, from the innermost outward; the first
    !> `inner` panels lie inside the focus and extend to the axis.
    integer :: inner = 0
    integer, allocatable :: order(:)
    real(wp), allocatable :: z_length(:)
    !> Nodes of the algebraic panel (0: the mesh has a finite end) and the exponent of the
    !> pressure's tail on it.
    integer :: tail_order = 0
    real(wp) :: decay = 0
    !> Digits of the kernel matrix.
    real(wp) :: digits = 14
    !> Whether functions are even in the distance from the axis.
    logical :: even = .true.
    !> Exponent of the power panel that replaces the innermost panel; 1: none.
    integer :: axis_power = 1
    !> Offset of the place to which the mesh is mapped.
    real(wp) :: focus = 0
  contains
    procedure :: halved
    procedure :: enriched
    procedure :: node_count
  end type mapped_shape_t

contains

  !> The shape with some of its sinh panels halved. Half of a long panel has fewer nodes than the
  !> whole, but more per length.
  pure type(mapped_shape_t) function halved(self, which) result(shape)
    class(mapped_shape_t), intent(in) :: self
    logical, intent(in) :: which(:)
    integer :: k

    shape = self
    deallocate (shape%order, shape%z_length)
    allocate (shape%order(0), shape%z_length(0))
    do k = 1, size(self%order)
      associate (parts => merge(2, 1, which(k)), order => self%order(k))
        shape%order = [shape%order, spread(merge(max(min(order, long), ceiling(0.7_wp*order)), &
          order, which(k)), 1, parts)]
        shape%z_length = [shape%z_length, spread(self%z_length(k)/parts, 1, parts)]
      end associate
    end do
    shape%inner = self%inner + count(which(:self%inner))
  end function halved

  !> Number of nodes.
  pure integer function node_count(self)
    class(mapped_shape_t), intent(in) :: self

    node_count = sum(self%order) + self%tail_order
  end function node_count

  !> The shape with the number of nodes of each panel multiplied by `times`, and with additional
  !> digits of the kernel.
  pure type(mapped_shape_t) function enriched(self, times, digits) result(shape)
    class(mapped_shape_t), intent(in) :: self
    real(wp), intent(in) :: times, digits

    shape = self
    shape%order = ceiling(times*self%order)
    shape%tail_order = ceiling(times*self%tail_order)
    shape%digits = self%digits + digits
  end function enriched

  !> Whether two shapes are equal to the last digit.
  pure logical function same_shape(a, b) result(same)
    type(mapped_shape_t), intent(in) :: a, b

    same = size(a%order) == size(b%order) .and. a%inner == b%inner .and. &
      a%tail_order == b%tail_order .and. a%axis_power == b%axis_power .and. (a%even .eqv. b%even)
    if (same) same = all(a%order == b%order) .and. all(abs(a%z_length - b%z_length) <= 0) .and. &
      all(abs([a%centre, a%focus, a%d, a%decay, a%digits] - &
      [b%centre, b%focus, b%d, b%decay, b%digits]) <= 0)
  end function same_shape

  !> The mesh of a shape; elastic = .false.: without the kernel.
  function new_mapped_mesh(shape, elastic) result(grid)
    type(mapped_shape_t), intent(in) :: shape
    logical, intent(in) :: elastic
    type(discretisation_t) :: grid
    real(wp), allocatable :: offset(:)
    real(wp) :: target(first_node - 1 + shape%node_count())
    integer :: k

    grid%centre = shape%centre
    grid%digits = shape%digits
    call place_panels(shape, grid)
    call place_nodes(shape, grid, offset)
    if (.not. elastic) return
    target(axis_row) = -grid%centre
    target(centre_row) = 0
    target(first_node:) = offset
    allocate (grid%kernel(size(target), grid%nodes))
    do k = 1, size(grid%panel)
      associate (first => grid%first(k), panel => grid%panel(k), local => grid%local(k))
        call add_panel(panel, local%node, local%weight, shape%digits, grid%centre, target, &
          first_node - 1 + first, grid%kernel(:, first:first + size(local%node) - 1))
      end associate
    end do
    call grid%note_kernel()
  end function new_mapped_mesh

  !> The panels and the end of the mesh. Neighbouring panels have exactly equal ends, and the
  !> innermost panel ends exactly at the axis.
  subroutine place_panels(shape, grid)
    type(mapped_shape_t), intent(in) :: shape
    type(discretisation_t), intent(inout) :: grid
    real(wp) :: z, outermost
    integer :: panels, k

    panels = size(shape%order)
    allocate (grid%panel(panels + merge(1, 0, shape%tail_order > 0)))
    z = -sum(shape%z_length(:shape%inner))
    do k = 1, panels
      if (k == shape%inner + 1) z = 0
      grid%panel(k) = sinh_panel(shape%focus, shape%d, z, shape%z_length(k))
      if (k > 1) grid%panel(k - 1)%right = grid%panel(k)%left
      z = z + shape%z_length(k)
    end do
    grid%panel(1)%left = -shape%centre
    if (shape%axis_power > 1) &
      grid%panel(1) = panel_map_t(power_map, -shape%centre, grid%panel(1)%right, &
        power=shape%axis_power)
    outermost = grid%panel(panels)%right
    grid%end = shape%centre + outermost
    if (shape%tail_order == 0) return
    grid%panel(panels + 1) = panel_map_t(algebraic_map, outermost, huge(1.0_wp), begin=grid%end, &
      decay=shape%decay)
    grid%end = huge(1.0_wp)
  end subroutine place_panels

  !> Sets nodes and weights, and returns the nodes' offsets from the centre.
  subroutine place_nodes(shape, grid, offset)
    type(mapped_shape_t), intent(in) :: shape
    type(discretisation_t), intent(inout) :: grid
    real(wp), allocatable, intent(out) :: offset(:)
    integer :: orders(size(grid%panel)), panels, k, last

    panels = size(grid%panel)
    orders = [shape%order, spread(shape%tail_order, 1, panels - size(shape%order))]
    grid%nodes = shape%node_count()
    allocate (grid%first(panels), grid%local(panels), grid%weight(grid%nodes), offset(grid%nodes))
    grid%which = [(k, k=1, panels)]
    last = 0
    grid%spacing = huge(1.0_wp)
    do k = 1, panels
      grid%first(k) = last + 1
      last = last + orders(k)
      associate (panel => grid%panel(k), at => offset(grid%first(k):last))
        grid%local(k) = gauss_nodes(orders(k))
        associate (local => grid%local(k))
          at = panel%offset(local%node)
          grid%weight(grid%first(k):last) = local%weight*panel%speed(local%node)*(grid%centre + at)
          ! Nodes of a power panel crowd at the axis, which resolves no edge.
          if (panel%kind /= power_map) &
            grid%spacing = min(grid%spacing, minval(panel%speed(local%node))/size(local%node))
        end associate
      end associate
    end do
    grid%x = grid%centre + offset
    call grid%note_axis(shape%even)
  end subroutine place_nodes

end module mapped_mesh
