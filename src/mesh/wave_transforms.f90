!> Hankel transforms of the polynomials that represent pressures on a mesh: spectrum(j, q) is the
!> integral of the polynomial of node j times J0(k_q t) t. Waves shorter than the distance of nodes
!> are not contained in pressures that the mesh resolves, but at the nodes alone they cannot be
!> distinguished from long waves. Therefore the polynomials are integrated with as many nodes as the
!> waves need. `last_on` says which waves a place has, and `find_wave` gives their values there;
!> `mesh_waves` uses both for displacements, with other limits.
module wave_transforms
  use kinds, only: wp
  use matrix_products, only: add_by_transposed
  use special_functions, only: bessel_t
  use panel_map, only: algebraic_map
  use discretisation, only: discretisation_t
  use local_nodes, only: local_nodes_t, gauss_nodes
  implicit none
  private
  public :: add_spectrum, find_wave, last_on

  !> Outside the mesh's centre, waves whose phase changes by more than `passing_pressure` from node
  !> to node are omitted from the transform of pressures. The transition is smooth and begins at the
  !> fraction `from_of_pressure` of this value. In the transition the product of a wave and a
  !> pressure is multiplied by a window. The window moves with the wave number, and must be wide
  !> enough to average the product out. Inside the centre, where bodies are in contact, no wave is
  !> omitted: for thin films the second part of the operator is nearly the negative of the first
  !> part, which has all waves.
  real(wp), parameter :: passing_pressure = 20, from_of_pressure = 0.6_wp
  !> On a panel to infinity the limit is valid for pressures that decrease as this power of the
  !> position. Pressures that decrease more slowly are larger where waves are omitted; for these,
  !> waves are omitted only farther out.
  real(wp), parameter :: steep = 6
  !> A panel of n nodes integrates polynomials of degree 2 n - 1. A wave whose phase changes by an
  !> angle over the panel counts as a polynomial of degree `degrees` times the angle, plus
  !> `more_degrees`. On a panel to infinity the end is taken at the local coordinate `nearly_all`.
  real(wp), parameter :: nearly_all = 0.95_wp, degrees = 0.55_wp, more_degrees = 8
  !> A density of nodes at which no wave is omitted; on the axis of a cone it would be infinite.
  real(wp), parameter :: densest = 1.0e100_wp
  !> Number of nodes of a hat function; ratio of the numbers of nodes for successive groups of
  !> shorter waves.
  integer, parameter :: hat = 2
  real(wp), parameter :: rung = 1.5_wp

contains

  !> Adds the transforms of the polynomials of panel p to spectrum(nodes, waves), for the ascending
  !> wave numbers k. For the longest waves the panel's own nodes are a sufficient rule; the first
  !> `whole` waves have at the nodes the values `wave`, (waves, nodes). For the other waves the
  !> panel is divided into pieces, each about as wide as its distance from the mesh's centre, with
  !> more nodes for shorter waves.
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
      waves = count(k < maxval(last_on(grid, p, ends, passing_pressure)))
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
        last_of = last_on(grid, p, fine%node, passing_pressure)
        basis = local%bases(fine%node)
        allocate (rows(now - before, n))
        allocate (part(size(local%node), now - before), source=0.0_wp)
        do i = 1, n
          basis(:, i) = weight(i)*basis(:, i)
          if (panel%kind == algebraic_map) basis(:, i) = basis(:, i)* &
            ((1 - fine%node(i))/(1 - local%node))**panel%decay
          call find_wave(bessel, x(i), last_of(i), from_of_pressure, k(before + 1:now), rows(:, i))
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
      associate (places => merge(min(ends, nearly_all), ends, panel%kind == algebraic_map))
        last = last_on(grid, p, places, passing_pressure)
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
    if (grid%panel(p)%left >= 0) last = passing*density_on(grid, p, s)
    if (grid%panel(p)%kind == algebraic_map) last = last*max(1.0_wp, steep/grid%panel(p)%decay)**2
  end function last_on

  !> Nodes per length at places s of a panel. A panel to infinity begins with the density at the end
  !> of the previous panel.
  pure function density_on(grid, p, s) result(density)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: p
    real(wp), intent(in) :: s(:)
    real(wp) :: density(size(s))

    if (grid%panel(p)%kind == algebraic_map) then
      density = size(grid%local(grid%which(p - 1))%node)/grid%panel(p - 1)%speed(1.0_wp)*(1 - s)**2
    else
      associate (n => size(grid%local(grid%which(p))%node))
        density = n/max(grid%panel(p)%speed(s), n/densest)
      end associate
    end if
  end function density_on

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

end module wave_transforms
