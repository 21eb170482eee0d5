!> The rise of the gap under the pressures on a mesh, equation (14): the product of the bodies'
!> elastic operator with the pressures, its matrix, and its derivative by the scale c of the mesh.
!> With the matrix W of the half-space on the mesh and the additional compliance L - 1 of the bodies
!> (`elastic_body`),
!>
!>     A(c)_ij = 2 coupling c [W_ij + Sum_q wave_iq 2 v_q (L(k_q/c) - 1) spectrum_jq] ,
!>
!> at nodes c x, with weights v of a quadrature rule for wave numbers k and the waves J0(k x) on the
!> mesh (`mesh_waves`). The waves are the same for every c and every body. Rows are those of the
!> kernel: the axis, the centre, the nodes. Homogeneous bodies have no second part and no waves.
module elastic_operator
  use kinds, only: wp
  use matrix_products, only: multiply
  use mesh_digits, only: digits_of_layers
  use mesh_waves, only: mesh_waves_t, new_mesh_waves
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  implicit none
  private
  public :: elastic_operator_t

  !> Range of scales for which waves are made, relative to the present scale. For larger scales
  !> further waves are added.
  real(wp), parameter :: smaller = 0.5_wp, larger = 1.4_wp
  !> Number of meshes whose waves are kept: the path passes from one mesh to the next, and jumps
  !> lead back to earlier meshes.
  integer, parameter :: most_meshes = 8

  type :: elastic_operator_t
    private
    !> The waves of the last meshes, and the index of those of the present mesh.
    type(mesh_waves_t), allocatable :: waves_of(:)
    integer :: now = 1
    !> The scale of the following strengths, and the strengths of the waves, up to the last wave
    !> that is needed.
    real(wp) :: scale = 0
    real(wp), allocatable :: strength(:)
    !> The matrix of the second part, if it was needed.
    real(wp), allocatable :: remainder(:, :)
  contains
    procedure :: forget
    procedure :: deform
    procedure :: matrix
    procedure :: unlike_scaling
    procedure, private :: prepare
  end type elastic_operator_t

contains

  !> Removes the data of the problem; to be called when the problem changes.
  pure subroutine forget(self)
    class(elastic_operator_t), intent(inout) :: self

    self%scale = 0
  end subroutine forget

  !> The rise of the gap, (first_node - 1 + nodes), under the pressures at the first `columns`
  !> nodes; the other pressures are negligible.
  subroutine deform(self, problem, grid, scale, columns, pressure, rise)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, pressure(:)
    integer, intent(in) :: columns
    real(wp), intent(out) :: rise(:)
    real(wp) :: more(size(rise))

    call multiply(grid%kernel, columns, pressure, rise)
    if (.not. problem%body%is_homogeneous()) then
      call self%prepare(problem, grid, scale)
      if (allocated(self%remainder)) then
        call multiply(self%remainder, columns, pressure, more)
      else
        call self%waves_of(self%now)%times(self%strength, pressure(:columns), more)
      end if
      rise = rise + more
    end if
    rise = 2*problem%coupling*scale*rise
  end subroutine deform

  !> a(i, j) = A(c)_rk factor(j) with r = row(i) and k = column(j).
  subroutine matrix(self, problem, grid, scale, factor, row, column, a)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, factor(:)
    integer, intent(in) :: row(:), column(:)
    real(wp), intent(out) :: a(:, :)
    real(wp) :: yielding
    integer :: i, j

    yielding = 2*problem%coupling*scale
    if (problem%body%is_homogeneous()) then
      do j = 1, size(column)
        do i = 1, size(row)
          a(i, j) = yielding*factor(j)*grid%kernel(row(i), column(j))
        end do
      end do
    else
      call self%prepare(problem, grid, scale)
      if (.not. allocated(self%remainder)) &
        call self%waves_of(self%now)%matrix(self%strength, self%remainder)
      do j = 1, size(column)
        do i = 1, size(row)
          a(i, j) = yielding*factor(j)*(grid%kernel(row(i), column(j)) + &
            self%remainder(row(i), column(j)))
        end do
      end do
    end if
  end subroutine matrix

  !> The derivative of the rise by the scale at fixed pressures, minus rise/scale; zero for
  !> homogeneous bodies. For rows `first` to first - 1 + size(more).
  subroutine unlike_scaling(self, problem, grid, scale, pressure, first, more)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale, pressure(:)
    integer, intent(in) :: first
    real(wp), intent(out) :: more(:)
    real(wp) :: rows(first - 1 + size(more))

    more = 0
    if (problem%body%is_homogeneous()) return
    call self%prepare(problem, grid, scale)
    associate (waves => self%waves_of(self%now), n => size(self%strength))
      call waves%times(-2*waves%weight(:n)*problem%body%growth(waves%k(:n)/scale), pressure, rows)
    end associate
    more = 2*problem%coupling*rows(first:)
  end subroutine unlike_scaling

  !> Computes the strengths of the waves for this scale, body and mesh.
  subroutine prepare(self, problem, grid, scale)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale
    real(wp) :: range(2)
    logical :: same

    if (.not. allocated(self%waves_of)) allocate (self%waves_of(most_meshes))
    same = self%waves_of(self%now)%belong_to(grid)
    if (same .and. .not. abs(self%scale - scale) > 0) return
    ! More digits of the mesh for stiff layers need no shorter waves.
    range = scale*problem%body%wave_range(grid%digits - digits_of_layers(problem, scale))
    if (.not. same) call find(self%waves_of, grid, self%now, same)
    associate (waves => self%waves_of(self%now))
      if (same) same = range(1) >= waves%range(1)
      if (.not. same) waves = new_mesh_waves(grid, smaller*range(1))
      if (.not. range(2) <= waves%range(2)) call waves%add(grid, larger*range(2))
      self%scale = scale
      if (allocated(self%remainder)) deallocate (self%remainder)
      ! Beyond the last wave the additional compliance is negligible.
      associate (n => count(waves%k <= range(2)))
        self%strength = 2*waves%weight(:n)*problem%body%beside_half_space(waves%k(:n)/scale)
      end associate
    end associate
  end subroutine prepare

  !> The index of the waves of a mesh; if there are none, the index to be replaced, which is the
  !> next one in turn.
  pure subroutine find(waves, grid, place, there)
    type(mesh_waves_t), intent(in) :: waves(:)
    type(discretisation_t), intent(in) :: grid
    integer, intent(inout) :: place
    logical, intent(out) :: there
    integer :: k

    do k = 1, size(waves)
      there = waves(k)%belong_to(grid)
      if (there) then
        place = k
        return
      end if
    end do
    place = 1 + modulo(place, size(waves))
  end subroutine find

end module elastic_operator
