!> How much the gap rises under the pressures on a mesh: the product of the bodies' elastic operator
!> with them, its matrix, and its derivative by the scale c of the mesh. With the matrix W of the
!> half-space on the mesh, weights w and the bodies' remainder D (`elastic_body`), at nodes c x,
!>
!>     A(c)_ij = 2 coupling c [W_ij + c D(c x_i, c x_j) w_j] .
!>
!> Rows are those of the mesh's kernel: the axis, the centre, the nodes. Homogeneous bodies have no
!> D, and nothing is made for them. That of others is kept until the mesh or its scale changes.
module elastic_operator
  use kinds, only: wp
  use linear_algebra, only: multiply
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, first_node
  implicit none
  private
  public :: elastic_operator_t

  type :: elastic_operator_t
    private
    !> The mesh's positions and the scale that what follows was made for: c D w, and what its
    !> product with c has for a derivative by c beside itself.
    real(wp), allocatable :: x(:)
    real(wp) :: scale = 0
    real(wp), allocatable :: remainder(:, :), growth(:, :)
  contains
    procedure :: forget
    procedure :: deform
    procedure :: matrix
    procedure :: unlike_scaling
    procedure, private :: prepare
  end type elastic_operator_t

contains

  !> Is to be called when the problem becomes another one.
  pure subroutine forget(self)
    class(elastic_operator_t), intent(inout) :: self

    if (allocated(self%x)) deallocate (self%x)
  end subroutine forget

  !> The rise of the gap, (first_node - 1 + nodes), under the pressures on the first `columns`
  !> nodes; beyond them there is none.
  subroutine deform(self, problem, grid, scale, columns, pressure, rise)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, pressure(:)
    integer, intent(in) :: columns
    real(wp), intent(out) :: rise(:)

    call multiply(grid%kernel, columns, pressure, rise)
    if (.not. problem%body%is_homogeneous()) then
      call self%prepare(problem, grid, scale)
      rise = rise + matmul(self%remainder(:, :columns), pressure(:columns))
    end if
    rise = 2*problem%coupling*scale*rise
  end subroutine deform

  !> a(:, j) = A(c)_ij factor(j) for rows `first` to first - 1 + size(a, 1).
  subroutine matrix(self, problem, grid, scale, factor, first, a)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, factor(:)
    integer, intent(in) :: first
    real(wp), intent(out) :: a(:, :)
    real(wp) :: yielding
    integer :: j, last

    last = first - 1 + size(a, 1)
    yielding = 2*problem%coupling*scale
    if (problem%body%is_homogeneous()) then
      do j = 1, size(a, 2)
        a(:, j) = yielding*factor(j)*grid%kernel(first:last, j)
      end do
    else
      call self%prepare(problem, grid, scale)
      do j = 1, size(a, 2)
        a(:, j) = yielding*factor(j)*(grid%kernel(first:last, j) + self%remainder(first:last, j))
      end do
    end if
  end subroutine matrix

  !> What the derivative of the rise by the scale, at pressures that stay what they are, has beside
  !> rise/scale; that of homogeneous bodies has nothing. For rows `first` to first - 1 + size(more).
  subroutine unlike_scaling(self, problem, grid, scale, pressure, first, more)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, pressure(:)
    integer, intent(in) :: first
    real(wp), intent(out) :: more(:)

    more = 0
    if (problem%body%is_homogeneous()) return
    call self%prepare(problem, grid, scale)
    more = 2*problem%coupling*matmul(self%growth(first:first - 1 + size(more), :size(pressure)), &
      pressure)
  end subroutine unlike_scaling

  !> Makes what the bodies add to a half-space, on this mesh at this scale.
  subroutine prepare(self, problem, grid, scale)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale
    integer :: j

    if (allocated(self%x)) then
      if (size(self%x) == grid%nodes .and. .not. abs(self%scale - scale) > 0) then
        if (all(abs(self%x - grid%x) <= 0)) return
      end if
    end if
    self%x = grid%x
    self%scale = scale
    if (allocated(self%remainder)) deallocate (self%remainder, self%growth)
    allocate (self%remainder(first_node - 1 + grid%nodes, grid%nodes), &
      self%growth(first_node - 1 + grid%nodes, grid%nodes))
    call problem%body%remainder(scale*[0.0_wp, grid%centre, grid%x], scale*grid%x, &
      self%remainder, self%growth)
    do j = 1, grid%nodes
      ! d/dc of c^2 D(c x, c t) is 2 c D + c (r d/dr + t d/dt) D, and rise/c has one c D of it.
      self%growth(:, j) = scale*grid%weight(j)*(self%remainder(:, j) + self%growth(:, j))
      self%remainder(:, j) = scale*grid%weight(j)*self%remainder(:, j)
    end do
  end subroutine prepare

end module elastic_operator
