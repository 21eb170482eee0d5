!> Waves J0(k x) on a mesh: the value of each wave at the mesh's positions, and the Hankel
!> transforms of the polynomials that represent pressures. With weights v of a quadrature rule for
!> the wave number k,
!>     Int (Int p(t) J0(k t) t dt) S(k) J0(k x_i) dk = 
!>       Sum_q wave(i, q) v_q S(k_q) Sum_j spectrum(j, q) p_j ,
!>
!> for any smooth function S of the wave number.
module mesh_waves
  use kinds, only: wp
  use quadrature, only: wave_rule
  use matrix_products, only: multiply, multiply_left, add_by_transposed
  use special_functions, only: bessel_t, new_bessel
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use wave_transforms, only: add_spectrum, find_wave, last_on
  implicit none
  private
  public :: mesh_waves_t, new_mesh_waves

  !> The displacement of a position outside the centre includes two kinds of waves. The phase of the
  !> first changes by less than `passing_place` from node to node (a constant, and a number per
  !> digit). The phase of the second changes by less than `crossing` per digit between the axis and
  !> the position. The smooth transition to zero begins at the fraction `from_of_place` of the
  !> largest wave number. With a smaller constant in `passing_place` the end of a path on a coat
  !> five times as stiff as its base needs another mesh.
  real(wp), parameter :: passing_place(2) = [8.0_wp, 1.0_wp], crossing = 2.4_wp, &
    from_of_place = 0.25_wp
  !> Largest change of phase over one panel of wave numbers. Number of nodes of a panel over which
  !> the phase does not change, and of a panel over which it changes by `swing` (`wave_rule`): a
  !> constant, and a number per digit. (These nodes are too few for a product of two waves at one
  !> position far out, but the pressure is small there.) Take a coat a hundred times as stiff as its
  !> base and thirty times thinner than the contact radius, at accuracy 1e-6. With these numbers the
  !> error is 1e-9 of the load; with three nodes fewer it is 1e-7.
  real(wp), parameter :: swing = 60, nodes_at_first(2) = [5.0_wp, 17.0_wp], &
    nodes_a_digit(2) = [0.8_wp, 1.5_wp]

  !> Waves that were added together; `before` is the number of earlier waves. wave: (rows, waves),
  !> with the rows of the mesh's kernel up to the last row that is not zero; spectrum: (nodes,
  !> waves).
  type :: wave_block_t
    integer :: before = 0
    real(wp), allocatable :: wave(:, :), spectrum(:, :)
  end type wave_block_t

  type :: mesh_waves_t
    !> Wave numbers in the inverse of the mesh's scale, ascending, and their weights, (waves).
    real(wp), allocatable :: k(:), weight(:)
    type(wave_block_t), allocatable, private :: block(:)
    !> Functions of the wave number are of low degree below range(1); there are waves up to
    !> range(2).
    real(wp) :: range(2) = 0
    !> The mesh's nodes.
    real(wp), allocatable, private :: x(:)
    type(bessel_t), private :: bessel
  contains
    procedure :: belong_to
    procedure :: add
    procedure :: times
    procedure :: matrix
  end type mesh_waves_t

contains

  !> An empty set of waves.
  pure type(mesh_waves_t) function new_mesh_waves(grid, first) result(waves)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: first

    waves%x = grid%x
    waves%range = [first, 0.0_wp]
    allocate (waves%k(0), waves%weight(0), waves%block(0))
    waves%bessel = new_bessel()
  end function new_mesh_waves

  !> Whether the waves are those of a mesh.
  pure logical function belong_to(self, grid)
    class(mesh_waves_t), intent(in) :: self
    type(discretisation_t), intent(in) :: grid

    belong_to = allocated(self%x)
    if (belong_to) belong_to = size(self%x) == grid%nodes
    if (belong_to) belong_to = all(abs(self%x - grid%x) <= 0)
  end function belong_to

  !> Adds waves up to the wave number `last`.
  subroutine add(self, grid, last)
    class(mesh_waves_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: last
    real(wp) :: x(first_node - 1 + grid%nodes), last_of(first_node - 1 + grid%nodes)
    real(wp), allocatable :: k(:), weight(:), rows(:, :), spectrum(:, :)
    type(wave_block_t), allocatable :: blocks(:)
    integer :: i, p, before, moved

    x([axis_row, centre_row]) = [0.0_wp, grid%centre]
    x(first_node:) = grid%x
    last_of(:first_node - 1) = huge(1.0_wp)
    do p = 1, size(grid%panel)
      associate (first => first_node - 1 + grid%first(p), local => grid%local(grid%which(p)))
        last_of(first:first + size(local%node) - 1) = &
          last_on(grid, p, local%node, passing_place(1) + passing_place(2)*grid%digits)
      end associate
    end do
    where (x > 0) last_of = max(last_of, crossing*grid%digits/x)
    call wave_rule(x, last_of, swing, nodes_at_first + nodes_a_digit*grid%digits, &
      self%range(2), self%range(1), last, k, weight)
    before = size(self%k)
    self%range(2) = last
    self%k = [self%k, k]
    self%weight = [self%weight, weight]
    allocate (rows(size(k), size(x)))
    do i = 1, size(x)
      call find_wave(self%bessel, x(i), last_of(i), from_of_place, k, rows(:, i))
      if (k(1) < last_of(i)) moved = i
    end do
    allocate (spectrum(grid%nodes, size(k)), source=0.0_wp)
    do p = 1, size(grid%panel)
      associate (row => first_node - 1 + grid%first(p), local => grid%local(grid%which(p)))
        i = row + size(local%node) - 1
        call add_spectrum(self%bessel, grid, p, k, &
          count(k <= from_of_place*minval(last_of(row:i))), rows(:, row:i), spectrum)
      end associate
    end do
    allocate (blocks(size(self%block) + 1))
    do i = 1, size(self%block)
      blocks(i)%before = self%block(i)%before
      call move_alloc(self%block(i)%wave, blocks(i)%wave)
      call move_alloc(self%block(i)%spectrum, blocks(i)%spectrum)
    end do
    blocks(i)%before = before
    blocks(i)%wave = transpose(rows(:, :moved))
    call move_alloc(spectrum, blocks(i)%spectrum)
    call move_alloc(blocks, self%block)
  end subroutine add

  !> Sum_q wave(i, q) strength(q) Sum_j spectrum(j, q) pressure(j), over the first size(strength)
  !> waves, for the first size(sums) rows.
  subroutine times(self, strength, pressure, sums)
    class(mesh_waves_t), intent(in) :: self
    real(wp), intent(in) :: strength(:), pressure(:)
    real(wp), intent(out) :: sums(:)
    real(wp) :: amplitude(size(strength)), part(size(sums))
    integer :: b, n, rows

    sums = 0
    do b = 1, size(self%block)
      associate (block => self%block(b), before => self%block(b)%before)
        n = min(size(strength) - before, size(block%wave, 2))
        if (n <= 0) exit
        rows = min(size(sums), size(block%wave, 1))
        call multiply_left(pressure, block%spectrum, amplitude(:n))
        call multiply(block%wave, n, strength(before + 1:before + n)*amplitude(:n), part(:rows))
        sums(:rows) = sums(:rows) + part(:rows)
      end associate
    end do
  end subroutine times

  !> sums(i, j) = Sum_q wave(i, q) strength(q) spectrum(j, q).
  subroutine matrix(self, strength, sums)
    class(mesh_waves_t), intent(in) :: self
    real(wp), intent(in) :: strength(:)
    real(wp), allocatable, intent(out) :: sums(:, :)
    real(wp), allocatable :: strong(:, :)
    integer :: b, n, q

    allocate (sums(first_node - 1 + size(self%x), size(self%x)), source=0.0_wp)
    do b = 1, size(self%block)
      associate (block => self%block(b), before => self%block(b)%before)
        n = min(size(strength) - before, size(block%wave, 2))
        if (n <= 0) exit
        allocate (strong(size(block%wave, 1), n))
        do q = 1, n
          strong(:, q) = strength(before + q)*block%wave(:, q)
        end do
        call add_by_transposed(strong, block%spectrum(:, :n), sums)
        deallocate (strong)
      end associate
    end do
  end subroutine matrix

end module mesh_waves
