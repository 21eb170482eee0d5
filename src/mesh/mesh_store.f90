!> A store of meshes for repeated use: the kernel is the most expensive part of a mesh, and the
!> problems of a sweep often need equal meshes, since the rule's numbers have few values
!> (`mesh_rule`).
module mesh_store
  use kinds, only: long
  use discretisation, only: discretisation_t
  use mapped_mesh, only: new_mapped_mesh
  use mapped_shape, only: mapped_shape_t, same_shape
  implicit none
  private
  public :: mesh_store_t

  type :: kept_t
    type(mapped_shape_t) :: shape
    type(discretisation_t) :: grid
  end type kept_t

  !> The newest meshes, in a ring. Several threads may use the store; access is in critical
  !> sections.
  type :: mesh_store_t
    private
    type(kept_t), allocatable :: kept(:)
    integer :: newest = 0
    integer(long) :: entries = 0
  contains
    procedure :: obtain
    procedure, private :: find
    procedure, private :: keep
  end type mesh_store_t

  !> Largest number of stored meshes, and of entries of their kernels (64 MB).
  integer, parameter :: most_meshes = 1000
  integer(long), parameter :: most_entries = 8000000

contains

  !> The mesh of a shape, with its kernel: the stored one, or a new one, which is then stored.
  subroutine obtain(self, shape, grid)
    class(mesh_store_t), intent(inout) :: self
    type(mapped_shape_t), intent(in) :: shape
    type(discretisation_t), intent(out) :: grid
    integer :: place

    !$omp critical (kept_meshes)
    place = self%find(shape)
    if (place > 0) grid = self%kept(place)%grid
    !$omp end critical (kept_meshes)
    if (place > 0) return
    grid = new_mapped_mesh(shape, .true.)
    !$omp critical (kept_meshes)
    ! Another thread may have stored this mesh in the meantime.
    if (self%find(shape) == 0) call self%keep(shape, grid)
    !$omp end critical (kept_meshes)
  end subroutine obtain

  !> The index of the stored mesh of a shape; 0: there is none. The newest meshes are searched
  !> first.
  pure integer function find(self, shape) result(place)
    class(mesh_store_t), intent(in) :: self
    type(mapped_shape_t), intent(in) :: shape
    integer :: i

    place = 0
    if (.not. allocated(self%kept)) return
    do i = 0, most_meshes - 1
      place = modulo(self%newest - i - 1, most_meshes) + 1
      if (.not. allocated(self%kept(place)%shape%order)) exit
      if (same_shape(self%kept(place)%shape, shape)) return
    end do
    place = 0
  end function find

  !> Stores a mesh; the oldest ones are removed for it.
  subroutine keep(self, shape, grid)
    class(mesh_store_t), intent(inout) :: self
    type(mapped_shape_t), intent(in) :: shape
    type(discretisation_t), intent(in) :: grid
    type(kept_t) :: nothing
    integer :: i, oldest

    if (grid%kernel_entries() > most_entries) return
    if (.not. allocated(self%kept)) allocate (self%kept(most_meshes))
    self%newest = mod(self%newest, most_meshes) + 1
    self%entries = self%entries + grid%kernel_entries()
    do i = 0, most_meshes - 1
      oldest = mod(self%newest - 1 + i, most_meshes) + 1
      if (i > 0 .and. self%entries <= most_entries) exit
      self%entries = self%entries - self%kept(oldest)%grid%kernel_entries()
      self%kept(oldest) = nothing
    end do
    self%kept(self%newest)%shape = shape
    self%kept(self%newest)%grid = grid
  end subroutine keep

end module mesh_store
