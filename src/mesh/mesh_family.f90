!> A family of meshes: a `mesh_plan_t` and its meshes, in the order of the path.
module mesh_family
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use mapped_mesh, only: new_mapped_mesh
  use mapped_shape, only: mapped_shape_t
  use mesh_plan, only: mesh_plan_t
  implicit none
  private
  public :: mesh_family_t

  type, extends(mesh_plan_t) :: mesh_family_t
    !> The meshes in the order of the path.
    type(discretisation_t), allocatable :: grid(:)
    !> The number of accurate digits for which the meshes are made.
    real(wp) :: digits = 0
    !> The shapes of these meshes.
    type(mapped_shape_t), allocatable :: shape(:)
  contains
    procedure :: insert
    procedure :: has_short_panels
    procedure :: renew
  end type mesh_family_t

contains

  !> Replaces a mesh by a new one with the given shape, for elastic bodies.
  subroutine renew(self, mesh, shape)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: mesh
    type(mapped_shape_t), intent(in) :: shape

    self%shape(mesh) = shape
    self%grid(mesh) = new_mapped_mesh(shape, elastic=.true.)
    self%waits(mesh) = .false.
  end subroutine renew

  !> Whether a mesh has short or halved panels: more than one on a side of its centre.
  pure logical function has_short_panels(self, mesh)
    class(mesh_family_t), intent(in) :: self
    integer, intent(in) :: mesh

    has_short_panels = .false.
    associate (shape => self%shape(mesh))
      if (allocated(shape%order)) &
        has_short_panels = size(shape%order) > merge(2, 1, shape%inner > 0)
    end associate
  end function has_short_panels

  !> Inserts a mesh after another one. Until it is laid out, it has the shape of that one.
  pure subroutine insert(self, after, locked, low, high)
    class(mesh_family_t), intent(inout) :: self
    integer, intent(in) :: after
    real(wp), intent(in) :: locked, low, high
    type(discretisation_t), allocatable :: grid(:)
    real(wp), allocatable :: kernel(:, :)
    integer :: k, to

    call self%mesh_plan_t%insert(after, locked, low, high)
    allocate (grid(size(self%grid) + 1))
    do k = 1, size(self%grid)
      to = k + merge(0, 1, k <= after)
      ! A kernel is moved, since a copy would take as long as the solution of a state.
      call move_alloc(self%grid(k)%kernel, kernel)
      if (k == after) grid(k + 1) = self%grid(k)
      grid(to) = self%grid(k)
      call move_alloc(kernel, grid(to)%kernel)
    end do
    call move_alloc(grid, self%grid)
    self%shape = self%shape([(k, k=1, after), (k, k=after, size(self%shape))])
  end subroutine insert

end module mesh_family
