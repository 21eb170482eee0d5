!> Meshes kept for use again: most of what a mesh takes is its kernel, and the problems of a sweep
!> often need the same (`mesh_rule` gives their numbers few values).
module mesh_store
  use kinds, only: long
  use discretisation, only: discretisation_t
  use mapped_mesh, only: mapped_shape_t, same_shape, new_mapped_mesh
  implicit none
  private
  public :: mesh_store_t

  type :: kept_t
    type(mapped_shape_t) :: shape
    type(discretisation_t) :: grid
  end type kept_t

  !> The newest meshes, in a ring. Threads may use one at a time: they come one by one.
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

  !> Meshes that are kept at most, and entries of their kernels (64 MB).
  integer, parameter :: most_meshes = 1000
  integer(long), parameter :: most_entries = 8000000

contains

  !> The mesh of a shape, with its kernel: the one that is kept, or a new one, which then is.
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
    ! Another thread may have been at the same.
    if (self%find(shape) == 0) call self%keep(shape, grid)
    !$omp end critical (kept_meshes)
  end subroutine obtain

  !> Where the mesh of a shape is kept; 0: nowhere. The newest are the likeliest.
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

  !> Keeps a mesh; the oldest make room.
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
