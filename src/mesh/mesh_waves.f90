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
  use linear_algebra, only: multiply, multiply_left, add_by_transposed
  use bessel, only: bessel_t, new_bessel
  use wave_quadrature, only: wave_rule
  use panel_map, only: panel_map_t, algebraic_map
  use discretisation, only: discretisation_t, local_nodes_t, gauss_nodes, axis_row, centre_row, &
    first_node
  implicit none
  private
  public :: mesh_waves_t, new_mesh_waves

  !> Outside the mesh's centre waves are left out of pressures that turn by more than `passing` from
  !> node to node, smoothly from the part `from` of that on. Between there and here a product with a
  !> pressure is one with a window that moves with the wave, which must be wide enough for the
  !> product to have none of the wave. Inside, where bodies are in contact, nothing is left out: of
  !> thin films the second part of the operator is nearly the negative of the first, which has all.
  real(wp), parameter :: passing = 20, from = 0.6_wp
  !> To infinity that does for pressures that fall as this power of the position. Of what falls less
  !> steeply more lies where waves are left out, and they are so farther out.
  real(wp), parameter :: steep = 6
  !> Places there are moved by waves that turn by less than this from node to node, and by all that
  !> turn less than this between the axis and them, each for a digit; smoothly from that part on.
  real(wp), parameter :: passing_place = 1.4_wp, crossing = 2.4_wp, from_of_place = 0.25_wp
  !> How far a wave turns over a panel of waves at most, and how many nodes one has over which none
  !> turns, and one over which a wave turns by that (`wave_rule`), at first and for each digit. They
  !> need not do for a product of two waves that end in one place, which is far out and has little
  !> pressure: of a coat a hundred times as stiff as its base and thirty times thinner than the
  !> contact is wide three nodes fewer leave a part 1e-7 of the load at accuracy 1e-6, these 1e-9.
  real(wp), parameter :: swing = 60, nodes_at_first(2) = [5.0_wp, 17.0_wp], &
    nodes_a_digit(2) = [0.8_wp, 1.5_wp]
  !> A panel of n nodes integrates polynomials of degree 2 n - 1. A wave that turns by some angle
  !> over it is one of so many times the angle, to this and a few degrees more.
  real(wp), parameter :: degrees = 0.55_wp, more_degrees = 8
  !> The nodes at the ends of a hat function; by how much rules have more nodes for shorter waves.
  integer, parameter :: hat = 2
  real(wp), parameter :: rung = 1.5_wp

  !> Waves that were added at once; `before` were there. wave: (rows, waves) in rows as those of the
  !> mesh's kernel, up to the last that any of them moves; spectrum: (nodes, waves).
  type :: wave_block_t
    integer :: before = 0
    real(wp), allocatable :: wave(:, :), spectrum(:, :)
  end type wave_block_t

  type :: mesh_waves_t
    !> Wave numbers in one over the mesh's scale, in order, and weights, (waves).
    real(wp), allocatable :: k(:), weight(:)
    type(wave_block_t), allocatable, private :: block(:)
    !> Up to the first wave number functions are of low degree; up to the last there are waves.
    real(wp) :: range(2) = 0
    !> The mesh's positions.
    real(wp), allocatable, private :: x(:)
    type(bessel_t), private :: bessel
  contains
    procedure :: belong_to
    procedure :: add
    procedure :: times
    procedure :: matrix
  end type mesh_waves_t

contains

  !> No waves yet.
  pure type(mesh_waves_t) function new_mesh_waves(grid, first) result(waves)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: first

    waves%x = grid%x
    waves%range = [first, 0.0_wp]
    allocate (waves%k(0), waves%weight(0), waves%block(0))
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
    real(wp), allocatable :: k(:), weight(:), rows(:, :), spectrum(:, :)
    type(wave_block_t), allocatable :: blocks(:)
    integer :: i, p, before, moved

    x([axis_row, centre_row]) = [0.0_wp, grid%centre]
    x(first_node:) = grid%x
    last_of(:first_node - 1) = huge(1.0_wp)
    do p = 1, size(grid%panel)
      associate (first => first_node - 1 + grid%first(p), local => grid%local(grid%which(p)))
        last_of(first:first + size(local%node) - 1) = &
          last_on(grid, p, local%node, passing_place*grid%digits)
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
      associate (own => first_node - 1 + grid%first(p) - 1 + &
        [(i, i=1, size(grid%local(grid%which(p))%node))])
        call add_spectrum(self%bessel, grid, p, k, &
          count(k <= from_of_place*minval(last_of(own))), rows(:, own), spectrum)
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

  !> Sum_q wave(i, q) strength(q) Sum_j spectrum(j, q) pressure(j), of as many waves as there are
  !> strengths and for as many rows as there are of `sums`.
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

  !> What the polynomials of a panel have of the waves, in order. Its own nodes do for the longest,
  !> of which `whole` are at the nodes what `wave`, (waves, nodes), says; for others it is cut into
  !> pieces, each about as wide as it is far from the mesh's centre, and these are given the more
  !> nodes the shorter the waves are.
  subroutine add_spectrum(bessel, grid, p, k, whole, wave, spectrum)
    type(bessel_t), intent(in) :: bessel
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p, whole
    real(wp), intent(in) :: k(:), wave(:, :)
    real(wp), intent(inout) :: spectrum(:, :)
    integer :: j, own, piece, pieces

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)))
      own = 0
      if (panel%kind /= algebraic_map .and. size(local%node) > hat) &
        own = min(whole, count(nodes_for(grid, p, [0.0_wp, 1.0_wp], k) <= size(local%node)))
      do j = 1, size(local%node)
        associate (row => grid%first(p) - 1 + j)
          spectrum(row, :own) = grid%weight(row)*wave(:own, j)
        end associate
      end do
      pieces = max(1, ceiling(panel%z_length))
      do piece = 1, pieces
        call add_piece(bessel, grid, p, [piece - 1, piece]/real(pieces, wp), k(own + 1:), &
          spectrum(:, own + 1:))
      end do
    end associate
  end subroutine add_spectrum

  !> Adds what comes of the piece of a panel between two places s.
  subroutine add_piece(bessel, grid, p, ends, k, spectrum)
    type(bessel_t), intent(in) :: bessel
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: ends(2), k(:)
    real(wp), intent(inout) :: spectrum(:, :)
    type(local_nodes_t) :: fine
    real(wp), allocatable :: basis(:, :), rows(:, :), part(:, :), x(:), last_of(:), weight(:)
    integer :: needed(size(k)), i, n, first, last, before, now, waves

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)))
      first = grid%first(p)
      last = first + size(local%node) - 1
      waves = count(k < maxval(last_on(grid, p, ends, passing)))
      needed = nodes_for(grid, p, ends, k)
      before = 0
      n = 0
      do while (before < waves)
        n = max(n, needed(before + 1))
        now = min(waves, count(needed <= n))
        fine = gauss_nodes(n)
        fine%node = ends(1) + (ends(2) - ends(1))*fine%node
        x = grid%centre + panel%offset(fine%node)
        weight = (ends(2) - ends(1))*fine%weight*panel%speed(fine%node)*x
        last_of = last_on(grid, p, fine%node, passing)
        allocate (basis(size(local%node), n), rows(now - before, n))
        allocate (part(size(local%node), now - before), source=0.0_wp)
        do i = 1, n
          basis(:, i) = weight(i)*lagrange_basis(local%node, local%barycentric, fine%node(i))
          if (panel%kind == algebraic_map) basis(:, i) = basis(:, i)* &
            ((1 - fine%node(i))/(1 - local%node))**panel%decay
          call find_wave(bessel, x(i), last_of(i), from, k(before + 1:now), rows(:, i))
        end do
        call add_by_transposed(basis, rows, part)
        ! Neighbours that are hat functions share a node.
        spectrum(first:last, before + 1:now) = spectrum(first:last, before + 1:now) + part
        deallocate (basis, rows, part)
        before = now
        n = ceiling(rung*n)
      end do
    end associate
  end subroutine add_piece

  !> Nodes of a piece of a panel that integrate its polynomials times waves, in order.
  pure function nodes_for(grid, p, ends, k) result(nodes)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: ends(2), k(:)
    integer :: nodes(size(k)), i
    real(wp) :: of_pressure, last(2), speed(2)

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)), &
      length => ends(2) - ends(1))
      ! At an end of the panel polynomials go to and fro the fastest.
      of_pressure = min(1.0_wp*size(local%node), sqrt(length)*size(local%node) + more_degrees)
      ! To infinity the last waves turn by as much anywhere.
      associate (places => merge(min(ends, 0.95_wp), ends, panel%kind == algebraic_map))
        last = last_on(grid, p, places, passing)
        speed = panel%speed(places)
      end associate
      nodes = [(max(hat + 1, ceiling(0.5_wp*(of_pressure + more_degrees + &
        degrees*length*maxval(min(k(i), last)*speed)))), i=1, size(k))]
    end associate
  end function nodes_for

  !> The last wave number that counts at places s of a panel.
  pure function last_on(grid, p, s, passing) result(last)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: s(:), passing
    real(wp) :: last(size(s))

    last = huge(last)
    if (grid%panel(p)%left >= 0) last = passing/step_on(grid, p, s)
    if (grid%panel(p)%kind == algebraic_map) last = last*max(1.0_wp, steep/grid%panel(p)%decay)**2
  end function last_on

  !> The distance between nodes at places s of a panel. On one that goes on to infinity it begins as
  !> it ends on the one before.
  pure function step_on(grid, p, s)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: s(:)
    real(wp) :: step_on(size(s))

    if (grid%panel(p)%kind == algebraic_map) then
      step_on = grid%panel(p - 1)%speed(1.0_wp)/size(grid%local(grid%which(p - 1))%node)/(1 - s)**2
    else
      step_on = grid%panel(p)%speed(s)/size(grid%local(grid%which(p))%node)
    end if
  end function step_on

  !> J0(k x), left out smoothly from a part of `last` up to it; k ascending.
  subroutine find_wave(bessel, x, last, from, k, wave)
    type(bessel_t), intent(in) :: bessel
    real(wp), intent(in) :: x, last, from, k(:)
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
