!> A mesh fixed in the material, for the internal variables of the bodies. Pressures are
!> interpolated to it from meshes that move with the contact, and the rise of the gap due to these
!> pressures is computed on it. Fine panels resolve the contact edge wherever it may pass. Away from
!> the edge a pressure is smooth; there it is represented on long panels, each of which replaces
!> several fine panels.
module memory_mesh
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use local_nodes, only: local_nodes_t, gauss_nodes
  use matrix_products, only: multiply
  implicit none
  private
  public :: memory_mesh_t, new_memory_mesh

  !> The nodes of the fine mesh are first those inside long panels, in order, then those of the
  !> panels farther out.
  type, extends(discretisation_t) :: memory_mesh_t
    !> Long panels: their number, the number of fine nodes in each, their length, and the nodes of a
    !> long panel (`own`).
    integer :: long = 0, inside = 0
    real(wp) :: length = 0
    type(local_nodes_t) :: own
    !> Matrix that maps values at the own nodes of a long panel to values at its fine nodes,
    !> (inside, own nodes).
    real(wp), allocatable :: spread(:, :)
    !> The columns of the kernel for the own nodes of all long panels.
    real(wp), allocatable :: smooth_kernel(:, :)
    !> Largest high-order part (`tail`) of a pressure that a long panel may represent, relative to
    !> the largest pressure.
    real(wp) :: lacking = 0
  contains
    procedure :: take
  end type memory_mesh_t

  !> Number of fine panels that a long panel replaces; number of nodes by which a long panel exceeds
  !> a fine panel.
  integer, parameter :: together = 8, more_nodes = 2
  !> A pressure smaller than this fraction of the largest pressure is neglected in the deformation.
  real(wp), parameter :: nothing = 1.0e-12_wp

contains

  !> Makes the mesh from `grid`, whose first `equal` panels from the axis have the same length, and
  !> adds long panels. lacking: as in `memory_mesh_t`.
  function new_memory_mesh(grid, equal, lacking) result(material)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: equal
    real(wp), intent(in) :: lacking
    type(memory_mesh_t) :: material
    integer :: order, k, n

    material%discretisation_t = grid
    material%lacking = lacking
    material%long = equal/together
    order = size(grid%local(1)%node)
    material%inside = together*order
    material%length = together*(grid%panel(1)%right - grid%panel(1)%left)
    material%own = gauss_nodes(order + more_nodes)
    n = order + more_nodes
    allocate (material%smooth_kernel(size(grid%kernel, 1), n*material%long))
    if (material%long == 0) then
      ! Fewer panels than a long one replaces.
      allocate (material%spread(0, n))
      return
    end if
    material%spread = transpose(material%own%bases(grid%x(:material%inside)/material%length))
    do k = 1, material%long
      material%smooth_kernel(:, (k - 1)*n + 1:k*n) = matmul( &
        grid%kernel(:, (k - 1)*material%inside + 1:k*material%inside), material%spread)
    end do
  end function new_memory_mesh

  !> Interpolates the pressure of another mesh, with its scale, to the nodes of this mesh
  !> (`values`), and computes the rise of the gap due to this pressure for the rows of the kernel
  !> (`rise`).
  subroutine take(self, grid, scale, pressure, values, rise)
    class(memory_mesh_t), intent(in) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, pressure(:)
    real(wp), allocatable, intent(out) :: values(:), rise(:)
    real(wp) :: own(size(self%spread, 2), self%long), part(size(self%kernel, 1)), largest
    logical :: smooth(self%long)
    integer :: first, last, k, n

    allocate (values(self%nodes), rise(size(self%kernel, 1)))
    n = size(own, 1)
    do k = 1, self%long
      own(:, k) = at((k - 1 + self%own%node)*self%length)
    end do
    largest = maxval(abs(pressure))
    do k = 1, self%long
      smooth(k) = self%own%tail(own(:, k)) <= self%lacking*largest
      associate (here => (k - 1)*self%inside)
        if (smooth(k)) then
          values(here + 1:here + self%inside) = matmul(self%spread, own(:, k))
        else
          values(here + 1:here + self%inside) = at(self%x(here + 1:here + self%inside))
        end if
      end associate
    end do
    values(self%long*self%inside + 1:) = at(self%x(self%long*self%inside + 1:))
    ! One matrix product for each sequence of panels that are all long or all fine, and one for the
    ! panels farther out.
    rise = 0
    first = 1
    do while (first <= self%long)
      last = first
      do while (last < self%long)
        if (smooth(last + 1) .neqv. smooth(first)) exit
        last = last + 1
      end do
      if (smooth(first)) then
        call add(self%smooth_kernel(:, (first - 1)*n + 1:last*n), &
          reshape(own(:, first:last), [n*(last - first + 1)]))
      else
        call add(self%kernel(:, (first - 1)*self%inside + 1:last*self%inside), &
          values((first - 1)*self%inside + 1:last*self%inside))
      end if
      first = last + 1
    end do
    call add(self%kernel(:, self%long*self%inside + 1:), values(self%long*self%inside + 1:))

  contains

    !> The pressure at these radii; 0 beyond the end of its mesh.
    pure function at(radii) result(found)
      real(wp), intent(in) :: radii(:)
      real(wp) :: found(size(radii))
      integer :: j

      found = 0
      do j = 1, size(radii)
        associate (x => radii(j)/scale)
          if (x <= grid%end) found(j) = grid%interpolate(pressure, x)
        end associate
      end do
    end function at

    !> Adds the rise due to columns of the kernel. Columns after the last weight that is not
    !> negligible are left out.
    subroutine add(columns, weights)
      real(wp), intent(in), contiguous :: columns(:, :)
      real(wp), intent(in) :: weights(:)
      integer :: count

      count = findloc(abs(weights) > nothing*largest, .true., 1, back=.true.)
      if (count == 0) return
      call multiply(columns, count, weights, part)
      rise = rise + part
    end subroutine add

  end subroutine take

end module memory_mesh
