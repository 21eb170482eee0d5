!> Waves J0(k x) on a mesh: the value of each wave at the mesh's positions, and the Hankel
!> transforms of the polynomials that represent pressures. With weights v of a quadrature rule for
!> the wave number k,
!>     Int (Int p(t) J0(k t) t dt) S(k) J0(k x_i) dk = 
!>       Sum_q wave(i, q) v_q S(k_q) Sum_j spectrum(j, q) p_j ,
!>
!> for any smooth function S of the wave number. Waves shorter than the distance of nodes are not
!> contained in pressures that the mesh resolves, but at the nodes alone they cannot be
!> distinguished from long waves. Therefore the polynomials are integrated with as many nodes as the
!> waves need.
module mesh_waves
  use kinds, only: wp
  use quadrature, only: lagrange_basis, wave_rule
  use linear_algebra, only: multiply, multiply_left, add_by_transposed
  use special_functions, only: bessel_t, new_bessel
  use panel_map, only: algebraic_map
  use discretisation, only: discretisation_t, local_nodes_t, gauss_nodes, axis_row, centre_row, &
    first_node
  implicit none
  private
  public :: mesh_waves_t, new_mesh_waves

  !> Outside the mesh's centre, waves whose phase changes by more than `passing` from node to node
  !> are omitted from the transform of pressures, with a smooth transition that begins at the
  !> fraction `from` of this value. In the transition the product with a pressure is multiplied by a
  !> window that moves with the wave; the window must be wide enough for the product to contain
  !> nothing of the wave. Inside the centre, where bodies are in contact, no wave is omitted: for
  !> thin films the second part of the operator is nearly the negative of the first part, which has
  !> all waves.
  real(wp), parameter :: passing = 20, from = 0.6_wp
  !> On a panel to infinity this is valid for pressures that decrease as this power of the position.
  !> Pressures that decrease more slowly are larger where waves are omitted; for these, waves are
  !> omitted only farther out.
  real(wp), parameter :: steep = 6
  !> The displacement of a position outside the centre includes waves whose phase changes by less
  !> than `passing_place` from node to node, a constant and a number per digit, and all waves whose
  !> phase changes by less than `crossing` per digit between the axis and the position; the smooth
  !> transition begins at this fraction. With a smaller constant the end of a path on a coat five
  !> times as stiff as its base needs another mesh.
  real(wp), parameter :: passing_place(2) = [8.0_wp, 1.0_wp], crossing = 2.4_wp, &
    from_of_place = 0.25_wp
  !> Largest change of phase over one panel of wave numbers; number of nodes of a panel over which
  !> the phase does not change, and of a panel over which it changes by `swing` (`wave_rule`), as a
  !> constant and per digit. The number is too small for a product of two waves at one position far
  !> out, where the pressure is small. For a coat a hundred times as stiff as its base and thirty
  !> times thinner than the contact radius, these numbers leave an error of 1e-9 of the load at
  !> accuracy 1e-6; with three nodes fewer the error is 1e-7.
  real(wp), parameter :: swing = 60, nodes_at_first(2) = [5.0_wp, 17.0_wp], &
    nodes_a_digit(2) = [0.8_wp, 1.5_wp]
  !> A panel of n nodes integrates polynomials of degree 2 n - 1. A wave whose phase changes by an
  !> angle over the panel is a polynomial of degree `degrees` times the angle, plus `more_degrees`.
  real(wp), parameter :: degrees = 0.55_wp, more_degrees = 8
  !> Number of nodes of a hat function; ratio of the numbers of nodes for successive groups of
  !> shorter waves.
  integer, parameter :: hat = 2
  real(wp), parameter :: rung = 1.5_wp

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

  !> Adds the transforms of the polynomials of a panel, in ascending order of the waves. For the
  !> longest waves the panel's own nodes are a sufficient rule; the first `whole` waves have at the
  !> nodes the values `wave`, (waves, nodes). For the other waves the panel is divided into pieces,
  !> each about as wide as its distance from the mesh's centre, with more nodes for shorter waves.
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

  !> Adds the contribution of a piece of a panel between two local coordinates.
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
        ! Neighbouring hat functions share a node.
        spectrum(first:last, before + 1:now) = spectrum(first:last, before + 1:now) + part
        deallocate (basis, rows, part)
        before = now
        n = ceiling(rung*n)
      end do
    end associate
  end subroutine add_piece

  !> Number of nodes of a piece of a panel that integrate its polynomials times waves, ascending.
  pure function nodes_for(grid, p, ends, k) result(nodes)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: ends(2), k(:)
    integer :: nodes(size(k))
    real(wp) :: of_pressure, last(2), speed(2)

    associate (panel => grid%panel(p), local => grid%local(grid%which(p)), &
      length => ends(2) - ends(1))
      ! Polynomials oscillate fastest at an end of the panel.
      of_pressure = min(1.0_wp*size(local%node), sqrt(length)*size(local%node) + more_degrees)
      ! On a panel to infinity the phase of the last included wave changes equally at all places.
      associate (places => merge(min(ends, 0.95_wp), ends, panel%kind == algebraic_map))
        last = last_on(grid, p, places, passing)
        speed = panel%speed(places)
      end associate
      nodes = max(hat + 1, ceiling(0.5_wp*(of_pressure + more_degrees + degrees*length* &
        max(min(k, last(1))*speed(1), min(k, last(2))*speed(2)))))
    end associate
  end function nodes_for

  !> The largest wave number that is included at places s of a panel.
  pure function last_on(grid, p, s, passing) result(last)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: s(:), passing
    real(wp) :: last(size(s))

    last = huge(last)
    if (grid%panel(p)%left >= 0) last = passing/step_on(grid, p, s)
    if (grid%panel(p)%kind == algebraic_map) last = last*max(1.0_wp, steep/grid%panel(p)%decay)**2
  end function last_on

  !> The distance between nodes at places s of a panel. A panel to infinity begins with the distance
  !> at the end of the previous panel.
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

  !> J0(k x) with a smooth transition to zero between a fraction of `last` and `last`; k ascending.
  subroutine find_wave(bessel, x, last, from, k, wave)
    type(bessel_t), intent(in) :: bessel
    real(wp), intent(in) :: x, last, from, k(:)
    real(wp), intent(out), contiguous :: wave(:)
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
