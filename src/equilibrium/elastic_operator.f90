!> How much the gap rises under the pressures on a mesh: the product of the bodies' elastic operator
!> with them, its matrix, and its derivative by the scale c of the mesh. With the matrix W of the
!> half-space on the mesh, weights w and what the bodies yield beside it, L - 1 (`elastic_body`),
!>
!>     A(c)_ij = 2 coupling c [W_ij + Sum_q J0(k_q x_i) 2 v_q (L(k_q/c) - 1) J0(k_q x_j) w_j] ,
!>
!> at nodes c x, with weights v of a rule for wave numbers k. The waves are the same for every c and
!> every body. Rows are those of the mesh's kernel: the axis, the centre, the nodes. Homogeneous
!> bodies have no second part, and nothing is made for them.
module elastic_operator
  use kinds, only: wp
  use linear_algebra, only: multiply, multiply_transposed
  use wave_quadrature, only: wave_rule
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, first_node
  implicit none
  private
  public :: elastic_operator_t

  !> Waves that pass between nodes are no part of a pressure that these resolve. Of each node they
  !> are left out from `passing` over the distance to the next on, but never less than `crossing`
  !> waves over its radius, and smoothly, as exp(-x^8), which is nothing from 1.6 on.
  real(wp), parameter :: passing = 12, crossing = 30, left_out = 1.6_wp
  integer, parameter :: sharpness = 8
  !> Scales for which waves are found, over the present one. For larger ones some are added.
  real(wp), parameter :: smaller = 0.1_wp, larger = 1.5_wp

  type :: elastic_operator_t
    private
    !> The mesh's positions for which the waves were found; the wave numbers over the scale; J0 of
    !> each at each row, (waves, rows); twice the weights; and the range of wave numbers.
    real(wp), allocatable :: x(:), k(:), wave(:, :), weight(:)
    real(wp) :: range(2) = 0
    !> The scale for which what follows was found, with the strengths of the waves, as many as there
    !> are, and what these change by with the scale.
    real(wp) :: scale = 0
    real(wp), allocatable :: strength(:), growth(:)
    !> The matrix of the second part, where it was needed.
    real(wp), allocatable :: remainder(:, :)
  contains
    procedure :: forget
    procedure :: deform
    procedure :: matrix
    procedure :: unlike_scaling
    procedure, private :: prepare
    procedure, private :: begin_waves
    procedure, private :: add_waves
    procedure, private :: fill_remainder
  end type elastic_operator_t

contains

  !> Is to be called when the problem becomes another one.
  pure subroutine forget(self)
    class(elastic_operator_t), intent(inout) :: self

    self%scale = 0
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
      rise = rise + through_waves(self, self%strength, &
        grid%weight(:columns)*pressure(:columns), size(rise))
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
      call self%fill_remainder(grid)
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
    real(wp) :: rows(first - 1 + size(more))

    more = 0
    if (problem%body%is_homogeneous()) return
    call self%prepare(problem, grid, scale)
    rows = through_waves(self, self%growth, grid%weight(:size(pressure))*pressure, size(rows))
    more = 2*problem%coupling*rows(first:)
  end subroutine unlike_scaling

  !> The first rows of the second part's product with weighted pressures, for waves of these
  !> strengths.
  function through_waves(self, strength, load, rows) result(rise)
    type(elastic_operator_t), intent(in) :: self
    real(wp), intent(in) :: strength(:), load(:)
    integer, intent(in) :: rows
    real(wp) :: rise(rows)
    real(wp) :: amplitude(size(strength))

    associate (n => size(strength))
      amplitude = strength*matmul(self%wave(:n, first_node:first_node - 1 + size(load)), load)
      rise = matmul(amplitude, self%wave(:n, :rows))
    end associate
  end function through_waves

  !> Finds the strengths of the waves at this scale, of this body, on this mesh.
  subroutine prepare(self, problem, grid, scale)
    class(elastic_operator_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: scale
    real(wp), allocatable :: more(:), growth(:)
    real(wp) :: range(2)
    logical :: same
    integer :: waves

    same = allocated(self%x)
    if (same) same = size(self%x) == grid%nodes
    if (same) same = all(abs(self%x - grid%x) <= 0)
    if (same .and. .not. abs(self%scale - scale) > 0) return
    range = scale*problem%body%wave_range()
    if (same) same = range(1) >= self%range(1)
    if (.not. same) call self%begin_waves(grid, smaller*range(1))
    if (.not. range(2) <= self%range(2)) call self%add_waves(grid, larger*range(2))
    self%scale = scale
    if (allocated(self%remainder)) deallocate (self%remainder)
    ! Beyond the last wave there is nothing.
    waves = count(self%k <= range(2))
    allocate (more(waves), growth(waves))
    call problem%body%beside_half_space(self%k(:waves)/scale, more, growth)
    self%strength = self%weight(:waves)*more
    self%growth = -self%weight(:waves)*growth
  end subroutine prepare

  !> Begins with no waves on a mesh; first: up to where what bodies yield is of low degree.
  pure subroutine begin_waves(self, grid, first)
    class(elastic_operator_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: first

    self%x = grid%x
    self%range = [first, 0.0_wp]
    self%k = [real(wp) ::]
    self%weight = [real(wp) ::]
    if (allocated(self%wave)) deallocate (self%wave)
    allocate (self%wave(0, first_node - 1 + grid%nodes))
  end subroutine begin_waves

  !> Adds waves to those there are, up to the wave number `last`.
  subroutine add_waves(self, grid, last)
    class(elastic_operator_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: last
    real(wp) :: x(first_node - 1 + grid%nodes), sharpest(first_node - 1 + grid%nodes)
    real(wp), allocatable :: k(:), weight(:), wave(:, :)
    integer :: i, j, before

    x = [0.0_wp, grid%centre, grid%x]
    sharpest(:first_node - 1) = huge(1.0_wp)
    do i = 1, grid%nodes
      associate (near => grid%x([max(1, i - 1), min(grid%nodes, i + 1)]))
        sharpest(first_node - 1 + i) = max(passing/minval(abs(near - grid%x(i)), &
          abs(near - grid%x(i)) > 0), crossing/max(grid%x(i), tiny(1.0_wp)))
      end associate
    end do
    call wave_rule(x, left_out*sharpest, self%range(2), self%range(1), last, k, weight)
    before = size(self%k)
    self%range(2) = last
    self%k = [self%k, k]
    self%weight = [self%weight, 2*weight]
    allocate (wave(size(self%k), size(x)), source=0.0_wp)
    wave(:before, :) = self%wave
    do i = 1, size(x)
      do j = before + 1, size(self%k)
        if (self%k(j) > left_out*sharpest(i)) exit
        wave(j, i) = bessel_j0(self%k(j)*x(i))*exp(-(self%k(j)/sharpest(i))**sharpness)
      end do
    end do
    call move_alloc(wave, self%wave)
  end subroutine add_waves

  !> Makes the matrix of the second part, unless it is there.
  subroutine fill_remainder(self, grid)
    class(elastic_operator_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), allocatable :: left(:, :), right(:, :)
    integer :: j

    if (allocated(self%remainder)) return
    associate (waves => size(self%strength), rows => first_node - 1 + grid%nodes)
      left = self%wave(:waves, :)
      allocate (right(waves, grid%nodes), self%remainder(rows, grid%nodes))
      do j = 1, grid%nodes
        right(:, j) = grid%weight(j)*self%strength*left(:, first_node - 1 + j)
      end do
      call multiply_transposed(left, right, self%remainder)
    end associate
  end subroutine fill_remainder

end module elastic_operator
