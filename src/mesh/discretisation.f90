!> The discretised half-space: nodes, quadrature weights and the matrix of the elastic kernel.
!> Solvers, cycle and path do not depend on the way its panels are laid out (`linear_mesh`,
!> `mapped_mesh`).
!>
!> All lengths are lateral and relative to a scale c. The kernel is homogeneous, so one matrix is
!> valid for every scale (see `elastic_operator`).
module discretisation
  use kinds, only: wp, long
  use lapack, only: idamax
  use panel_map, only: panel_map_t, power_map, algebraic_map
  use panel_kernel, only: add_panel
  use interpolation, only: polynomial_weights
  use local_nodes, only: local_nodes_t
  implicit none
  private
  public :: discretisation_t, mesh_of_panels, axis_row, centre_row, first_node

  !> Number of nodes from which the value on the axis is interpolated.
  integer, parameter :: nodes_at_axis = 6

  !> Rows of the kernel matrix.
  integer, parameter :: axis_row = 1, centre_row = 2, first_node = 3

  type :: discretisation_t
    integer :: nodes = 0
    !> Position of the mesh's centre: 0 for the axis, 1 for the contact edge.
    real(wp) :: centre = 0
    !> Position of the mesh's end; huge if the mesh extends to infinity.
    real(wp) :: end = 0
    !> Radial positions of the nodes (ascending), (nodes).
    real(wp), allocatable :: x(:)
    !> integral f x dx = sum(weight*f), (nodes).
    real(wp), allocatable :: weight(:)
    !> matmul(kernel, p) = integral k(r, t) p(t) t dt, (first_node - 1 + nodes, nodes). Row axis_row
    !> is for r on the axis, row centre_row for r at the mesh's centre, and the rows from first_node
    !> on are for the nodes. Not allocated for rigid bodies.
    real(wp), allocatable :: kernel(:, :)
    !> The largest absolute value in each column of the kernel, (nodes).
    real(wp), allocatable :: largest(:)
    !> Weights of nodal values in the interpolated value on the axis, (nodes).
    real(wp), allocatable :: at_axis(:)
    !> The panels from the axis outward, the first node of each, and the index in `local` of its
    !> nodes.
    type(panel_map_t), allocatable :: panel(:)
    integer, allocatable :: first(:), which(:)
    type(local_nodes_t), allocatable :: local(:)
    !> Smallest distance between neighbouring nodes of a panel; the mean distance for the finest
    !> panel.
    real(wp) :: spacing = 0
    !> Digits of the kernel.
    real(wp) :: digits = 14
  contains
    procedure :: interpolate
    procedure :: interpolate_all
    procedure :: on_one_panel
    procedure :: crossing
    procedure :: is_bounded
    procedure :: in_tail
    procedure :: panel_tails
    procedure :: panel_at
    procedure :: kernel_entries
  end type discretisation_t

contains

  !> The mesh of panels from the axis outward; panel k has the nodes local(which(k)). A node at a
  !> panel's end, 1, is the next panel's node at 0. even: whether functions are even in the distance
  !> from the axis; near the axis they are then interpolated by polynomials of the squared distance,
  !> which converge faster than the panel's. digits: of the kernel; elastic = .false.: without the
  !> kernel.
  function mesh_of_panels(centre, panel, local, which, even, digits, elastic) result(grid)
    real(wp), intent(in) :: centre, digits
    type(panel_map_t), intent(in) :: panel(:)
    type(local_nodes_t), intent(in) :: local(:)
    integer, intent(in) :: which(:)
    logical, intent(in) :: even, elastic
    type(discretisation_t) :: grid
    real(wp), allocatable :: offset(:)
    integer :: k, shared

    grid%centre = centre
    grid%digits = digits
    grid%panel = panel
    grid%local = local
    grid%which = which
    associate (outermost => panel(size(panel)))
      grid%end = merge(huge(1.0_wp), centre + outermost%right, outermost%kind == algebraic_map)
    end associate
    shared = merge(1, 0, .not. local(1)%node(size(local(1)%node)) < 1)
    allocate (grid%first(size(panel)))
    grid%first(1) = 1
    do k = 1, size(panel)
      grid%nodes = grid%first(k) + size(local(which(k))%node) - 1
      if (k < size(panel)) grid%first(k + 1) = grid%nodes + 1 - shared
    end do
    allocate (offset(grid%nodes), grid%weight(grid%nodes), source=0.0_wp)
    grid%spacing = huge(1.0_wp)
    do k = 1, size(panel)
      associate (nodes => local(which(k)), first => grid%first(k))
        associate (last => first + size(nodes%node) - 1)
          offset(first:last) = panel(k)%offset(nodes%node)
          grid%weight(first:last) = grid%weight(first:last) + &
            nodes%weight*panel(k)%speed(nodes%node)*(centre + offset(first:last))
          ! The integral of a hat function times x: end values a, b have the weights (2a + b)/6.
          if (shared > 0) grid%weight([first, last]) = grid%weight([first, last]) + &
            (panel(k)%right - panel(k)%left)**2/6*[1, -1]
        end associate
        ! The dense nodes of a power panel at the axis resolve no edge.
        if (panel(k)%kind /= power_map) grid%spacing = min(grid%spacing, &
          minval(panel(k)%speed(nodes%node))/(size(nodes%node) - shared))
      end associate
    end do
    grid%x = centre + offset
    allocate (grid%at_axis(grid%nodes), source=0.0_wp)
    associate (n => min(nodes_at_axis, grid%nodes))
      grid%at_axis(:n) = polynomial_weights(grid%x(:n)**merge(2, 1, even), 0.0_wp)
    end associate
    if (elastic) call add_kernel(grid, shared > 0, [-centre, 0.0_wp, offset])
  end function mesh_of_panels

  !> Adds the kernel, for targets at these offsets. Panels that share a node add to the same column,
  !> so threads make first every other panel, then those between.
  subroutine add_kernel(grid, shared, target)
    type(discretisation_t), intent(inout) :: grid
    logical, intent(in) :: shared
    real(wp), intent(in) :: target(:)
    real(wp), allocatable :: block(:, :)
    integer :: j, k, begin, last

    allocate (grid%kernel(size(target), grid%nodes), source=0.0_wp)
    do begin = 1, 2
      !$omp parallel do schedule(dynamic) private(block, last) if (shared)
      do k = begin, size(grid%panel), 2
        associate (local => grid%local(grid%which(k)), first => grid%first(k))
          last = first + size(local%node) - 1
          allocate (block(size(target), size(local%node)))
          call add_panel(grid%panel(k), local, grid%digits, grid%centre, target, &
            first_node - 1 + first, block)
          grid%kernel(:, first:last) = grid%kernel(:, first:last) + block
          deallocate (block)
        end associate
      end do
      !$omp end parallel do
    end do
    allocate (grid%largest(grid%nodes))
    do j = 1, grid%nodes
      grid%largest(j) = abs(grid%kernel(idamax(size(target), grid%kernel(1, j), 1), j))
    end do
  end subroutine add_kernel

  !> The tail of a pressure (`local_nodes`) on each panel. It is divided by the largest pressure or
  !> by the unit of pressure (about the law's largest tension), whichever is larger; it is 0 on a
  !> panel to infinity.
  pure function panel_tails(self, pressure) result(tails)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: pressure(:)
    real(wp) :: tails(size(self%panel))
    integer :: k

    tails = 0
    do k = 1, size(self%panel)
      if (self%panel(k)%kind == algebraic_map) cycle
      associate (local => self%local(self%which(k)), first => self%first(k))
        tails(k) = local%tail(pressure(first:first + size(local%node) - 1))
      end associate
    end do
    tails = tails/max(maxval(abs(pressure)), 1.0_wp)
  end function panel_tails

  !> Value at position x of the function with the given nodal values, by the panel's polynomial. On
  !> a panel to infinity the polynomial is in the inverse position, so the function must be bounded.
  !> Outside the mesh the nearest panel's polynomial extrapolates.
  pure function interpolate(self, values, x) result(value)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: values(:), x
    real(wp) :: value
    integer :: k

    k = self%panel_at(x)
    associate (local => self%local(self%which(k)), first => self%first(k))
      value = local%value(values(first:first + size(local%node) - 1), &
        self%panel(k)%local(x - self%centre))
    end associate
  end function interpolate

  !> Interpolated values at many positions in any order, faster if neighbours are mostly on one
  !> panel.
  pure function interpolate_all(self, values, x) result(value)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: values(:), x(:)
    real(wp) :: value(size(x))
    integer :: i, last, k

    last = 0
    do while (last < size(x))
      i = last + 1
      last = i
      k = self%panel_at(x(i))
      associate (panel => self%panel(k), local => self%local(self%which(k)), &
        first => self%first(k))
        do while (last < size(x))
          associate (next => x(last + 1) - self%centre)
            if (next < panel%left .or. next >= panel%right) exit
          end associate
          last = last + 1
        end do
        value(i:last) = local%values(values(first:first + size(local%node) - 1), &
          panel%locals(x(i:last) - self%centre))
      end associate
    end do
  end function interpolate_all

  !> Whether node j and the next one are on the same panel, and this panel does not extend to
  !> infinity.
  pure logical function on_one_panel(self, j)
    class(discretisation_t), intent(in) :: self
    integer, intent(in) :: j
    integer :: k

    k = self%panel_at(self%x(j))
    on_one_panel = self%panel(k)%kind /= algebraic_map .and. &
      j + 1 < self%first(k) + size(self%local(self%which(k))%node)
  end function on_one_panel

  !> The position between node j and the next one, on the same panel, at which the polynomial of
  !> nodal values reaches a level between the two values.
  pure real(wp) function crossing(self, values, level, j) result(x)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: values(:), level
    integer, intent(in) :: j
    integer :: k

    k = self%panel_at(self%x(j))
    associate (local => self%local(self%which(k)), first => self%first(k))
      x = self%centre + self%panel(k)%offset(local%reaching( &
        values(first:first + size(local%node) - 1), level, local%node(j + 1 - first:j + 2 - first)))
    end associate
  end function crossing

  !> The panel that contains a position; outside the mesh the nearest panel.
  pure integer function panel_at(self, x) result(low)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: x
    integer :: high, middle

    low = 1
    high = size(self%panel) + 1
    do while (high - low > 1)
      middle = (low + high)/2
      if (self%panel(middle)%left <= x - self%centre) then
        low = middle
      else
        high = middle
      end if
    end do
  end function panel_at

  !> Whether a position is on a panel that extends to infinity.
  pure logical function in_tail(self, x)
    class(discretisation_t), intent(in) :: self
    real(wp), intent(in) :: x

    in_tail = self%panel(self%panel_at(x))%kind == algebraic_map
  end function in_tail

  !> Whether the mesh has a finite end.
  elemental logical function is_bounded(self)
    class(discretisation_t), intent(in) :: self

    is_bounded = self%end < huge(1.0_wp)
  end function is_bounded

  !> Number of computed kernel entries.
  elemental integer(long) function kernel_entries(self)
    class(discretisation_t), intent(in) :: self

    kernel_entries = 0
    if (allocated(self%kernel)) kernel_entries = size(self%kernel, kind=long)
  end function kernel_entries

end module discretisation
