!> Waves J0(k x) on a mesh: what each is at the mesh's positions, and what the polynomials that
!> stand for pressures have of it. With weights v of a rule for wave numbers k,
!>
!>     Int (Int p(t) J0(k t) t dt) S(k) J0(k x_i) dk = 
!>       Sum_q wave(i, q) v_q S(k_q) Sum_j spectrum(j, q) p_j ,
!>
!> for any smooth function S of the wave number. Waves that pass between the nodes of a mesh are no
!> part of pressures that it resolves, but the nodes alone cannot tell them from long ones; so the
!> polynomials are integrated with as many nodes as the waves need.
module mesh_waves
  use kinds, only: wp
  use quadrature, only: lagrange_basis
  use linear_algebra, only: multiply_by_transposed
  use bessel, only: bessel_t, new_bessel
  use wave_quadrature, only: wave_rule
  use panel_map, only: panel_map_t, algebraic_map
  use discretisation, only: discretisation_t, local_nodes_t, gauss_nodes, axis_row, centre_row, &
    first_node
  implicit none
  private
  public :: mesh_waves_t, new_mesh_waves

  !> Waves are left out that turn by more than `passing` from node to node, of pressures smoothly
  !> from the part `from` of that on. Between there and here a product with a pressure is one with a
  !> window that moves with the wave, which must be wide enough for the product to have none of the
  !> wave.
  real(wp), parameter :: passing = 20, from = 0.6_wp
  !> Places are moved by these waves and all that turn less than `crossing` between the axis and
  !> them, smoothly as exp(-(1.6 k/last)^8).
  real(wp), parameter :: crossing = 48, left_out = 1.6_wp
  integer, parameter :: sharpness = 8
  !> A panel of n nodes integrates polynomials of degree 2 n - 1. A wave that turns by some angle
  !> over it is one of so many times the angle, to this and a few degrees more.
  real(wp), parameter :: degrees = 0.55_wp, more_degrees = 8
  !> The nodes at the ends of a hat function.
  integer, parameter :: hat = 2

  type :: mesh_waves_t
    !> Wave numbers in one over the mesh's scale, in order, and weights, (waves).
    real(wp), allocatable :: k(:), weight(:)
    !> (first_node - 1 + nodes, waves) in rows as those of the mesh's kernel; (nodes, waves).
    real(wp), allocatable :: wave(:, :), spectrum(:, :)
    !> Up to the first wave number functions are of low degree; up to the last there are waves.
    real(wp) :: range(2) = 0
    !> The mesh's positions.
    real(wp), allocatable, private :: x(:)
    type(bessel_t), private :: bessel
  contains
    procedure :: belong_to
    procedure :: add
  end type mesh_waves_t

contains

  !> No waves yet.
  pure type(mesh_waves_t) function new_mesh_waves(grid, first) result(waves)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: first

    waves%x = grid%x
    waves%range = [first, 0.0_wp]
    allocate (waves%k(0), waves%weight(0), waves%wave(first_node - 1 + grid%nodes, 0), &
      waves%spectrum(grid%nodes, 0))
    waves%bessel = new_bessel()
  end function new_mesh_waves

  !> Whether they are those of a mesh.
  pure logical function belong_to(self, grid)
    class(mesh_waves_t), intent(in) :: self
    type(discretisation_t), intent(in) :: grid

    belong_to = allocated(self%x)
    if (belong_to) belong_to = size(self%x) == grid%nodes
    if (belong_to) belong_to = all(abs(self%x - grid%x) <= 0)
  end function belong_to

  !> Adds waves to those there are, up to the wave number `last`.
  subroutine add(self, grid, last)
    class(mesh_waves_t), intent(inout) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: last
    real(wp) :: x(first_node - 1 + grid%nodes), last_of(first_node - 1 + grid%nodes)
    real(wp), allocatable :: k(:), weight(:), rows(:, :), wave(:, :), spectrum(:, :)
    integer :: i, p, n, before

    x([axis_row, centre_row]) = [0.0_wp, grid%centre]
    x(first_node:) = grid%x
    last_of(:first_node - 1) = huge(1.0_wp)
    do p = 1, size(grid%panel)
      associate (first => first_node - 1 + grid%first(p), local => grid%local(grid%which(p)))
        last_of(first:first + size(local%node) - 1) = last_on(grid, p, local%node)
      end associate
    end do
    where (x > 0) last_of = max(last_of, crossing/x)
    call wave_rule(x, last_of, self%range(2), self%range(1), last, k, weight)
    before = size(self%k)
    self%range(2) = last
    self%k = [self%k, k]
    self%weight = [self%weight, weight]
    allocate (wave(size(x), size(self%k)))
    allocate (spectrum(grid%nodes, size(self%k)), source=0.0_wp)
    wave(:, :before) = self%wave
    spectrum(:, :before) = self%spectrum
    allocate (rows(size(k), size(x)))
    do i = 1, size(x)
      n = count(k < last_of(i))
      call self%bessel%j0(x(i)*k(:n), rows(:n, i))
      rows(:n, i) = rows(:n, i)*exp(-(k(:n)*left_out/last_of(i))**sharpness)
      rows(n + 1:, i) = 0
    end do
    do i = 1, size(k)
      wave(:, before + i) = rows(i, :)
    end do
    associate (new => spectrum(:, before + 1:))
      do p = 1, size(grid%panel)
        call add_spectrum(self%bessel, grid, p, k, wave(first_node:, before + 1:), new)
      end do
    end associate
    call move_alloc(wave, self%wave)
    call move_alloc(spectrum, self%spectrum)
  end subroutine add

  !> What the polynomials of a panel have of the waves; those of its nodes are known.
  subroutine add_spectrum(bessel, grid, p, k, wave, spectrum)
    type(bessel_t), intent(in) :: bessel
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: k(:), wave(:, :)
    real(wp), intent(inout) :: spectrum(:, :)
    type(local_nodes_t) :: fine
    real(wp), allocatable :: basis(:, :), rows(:, :), part(:, :), x(:), last_of(:), weight(:)
    integer :: i, j, first, last, n

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)))
      first = grid%first(p)
      last = first + size(local%node) - 1
      n = nodes_for(grid, p, k(size(k)))
      if (n <= size(local%node) .and. panel%kind /= algebraic_map) then
        do j = first, last
          spectrum(j, :) = grid%weight(j)*wave(j, :)
        end do
        return
      end if
      fine = gauss_nodes(n)
      x = grid%centre + panel%offset(fine%node)
      weight = fine%weight*panel%speed(fine%node)*x
      last_of = last_on(grid, p, fine%node)
      allocate (basis(size(local%node), n), rows(size(k), n), part(size(local%node), size(k)))
      do i = 1, n
        basis(:, i) = weight(i)*lagrange_basis(local%node, local%barycentric, fine%node(i))
        if (panel%kind == algebraic_map) basis(:, i) = basis(:, i)* &
          ((1 - fine%node(i))/(1 - local%node))**panel%decay
        call find_wave(bessel, x(i), last_of(i), k, rows(:, i))
      end do
      call multiply_by_transposed(basis, rows, part)
      ! Neighbours that are hat functions share a node.
      spectrum(first:last, :) = spectrum(first:last, :) + part
    end associate
  end subroutine add_spectrum

  !> Nodes of a panel that integrate its polynomials times waves up to k.
  pure integer function nodes_for(grid, p, k) result(nodes)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: k
    real(wp) :: turn

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)))
      turn = maxval(min(k, last_on(grid, p, local%node))*panel%speed(local%node))
      nodes = size(local%node)
      nodes = max(nodes, merge(hat + 1, 0, nodes == hat), &
        ceiling(0.5_wp*(nodes + degrees*turn + more_degrees)))
    end associate
  end function nodes_for

  !> The last wave number that is not left out, at places s of a panel. One that goes on to infinity
  !> begins as the one before it ends.
  pure function last_on(grid, p, s) result(last)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: s(:)
    real(wp) :: last(size(s))

    if (grid%panel(p)%kind == algebraic_map) then
      last = passing*size(grid%local(grid%which(p - 1))%node)/grid%panel(p - 1)%speed(1.0_wp)* &
        (1 - s)**2
    else
      last = passing*size(grid%local(grid%which(p))%node)/grid%panel(p)%speed(s)
    end if
  end function last_on

  !> J0(k x) for a pressure; k ascending.
  subroutine find_wave(bessel, x, last, k, wave)
    type(bessel_t), intent(in) :: bessel
    real(wp), intent(in) :: x, last, k(:)
    real(wp), intent(out) :: wave(:)
    real(wp) :: u
    integer :: i, n

    n = count(k < last)
    call bessel%j0(x*k(:n), wave(:n))
    wave(n + 1:) = 0
    do i = 1 + count(k < from*last), n
      u = (1 - k(i)/last)/(1 - from)
      wave(i) = wave(i)*u**5*(126 - u*(420 - u*(540 - u*(315 - 70*u))))
    end do
  end subroutine find_wave

end module mesh_waves
