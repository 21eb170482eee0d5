!> Integrals of functions given at the nodes of a mesh, from the axis to each node and from each
!> node to infinity. They are sums of integrals of the panels' polynomials: over whole panels, and
!> over the node's own panel as far as the node. On a panel to infinity, with u = begin/position,
!> the functions of the first integral are bounded polynomials in u, and those of the second are
!> position**(-6) times a polynomial in u.
module running_integrals
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use local_nodes, only: local_nodes_t
  use matrix_products, only: add_by_transposed
  use panel_map, only: algebraic_map
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: running_integral_t, running_integrals_t, new_running_integrals

  !> Integrals in one direction. first, last: nodes of the panels in this direction. own(j, i): the
  !> weight of node j in the integral over the panel of node i as far as node i; j counts the nodes
  !> of this panel. whole: the weights in integrals over whole panels. factor: a factor of the
  !> integral at each node.
  type :: running_integral_t
    private
    integer, allocatable :: first(:), last(:)
    real(wp), allocatable :: own(:, :), whole(:), factor(:)
  contains
    procedure :: of
    procedure :: after
  end type running_integral_t

  !> gathered%of(f): x_i**(-2) Int_0^x_i f x dx, and beyond%of(g): Int_x_i^infinity g x dx.
  type :: running_integrals_t
    type(running_integral_t) :: gathered, beyond
  end type running_integrals_t

  !> The functions of the integral to infinity decrease as this power.
  integer, parameter :: power = 6
  !> Number of quadrature points in the logarithm of the position on a panel to infinity.
  integer, parameter :: points = 48

contains

  !> The integrals of a mesh.
  pure function new_running_integrals(grid) result(integrals)
    type(discretisation_t), intent(in) :: grid
    type(running_integrals_t) :: integrals
    real(wp), allocatable :: up(:, :), area(:)
    integer :: k, i, m

    associate (gathered => integrals%gathered, beyond => integrals%beyond, n => grid%nodes, &
      panels => size(grid%panel))
      gathered%first = grid%first(:panels)
      gathered%last = [gathered%first(2:) - 1, n]
      allocate (gathered%own(maxval(1 + gathered%last - gathered%first), n), source=0.0_wp)
      gathered%whole = grid%weight(:n)
      gathered%factor = 1/grid%x(:n)**2
      beyond = gathered
      beyond%first = gathered%first(panels:1:-1)
      beyond%last = gathered%last(panels:1:-1)
      beyond%factor = 1
      do k = 1, panels
        associate (local => grid%local(grid%which(k)), panel => grid%panel(k), &
          a => gathered%first(k), b => gathered%last(k))
          m = 1 + b - a
          if (panel%kind == algebraic_map) then
            gathered%own(:m, a:b) = to_infinity(local, panel%begin)
            call from_infinity(local, panel%begin, grid%x(a:b), beyond%own(:m, a:b), &
              beyond%whole(a:b))
            cycle
          end if
          up = cumulative(local)
          area = grid%x(a:b)*panel%speed(local%node)
          do i = 1, m
            gathered%own(:m, a - 1 + i) = up(:, i)*area
            beyond%own(:m, a - 1 + i) = (local%weight - up(:, i))*area
          end do
        end associate
      end do
    end associate
  end function new_running_integrals

  !> The integral of a function at each node.
  pure function of(self, f) result(integral)
    class(running_integral_t), intent(in) :: self
    real(wp), intent(in) :: f(:)
    real(wp) :: integral(size(f)), before
    integer :: k, i

    before = 0
    do k = 1, size(self%first)
      associate (a => self%first(k), b => self%last(k))
        do i = a, b
          integral(i) = self%factor(i)*(before + dot_product(self%own(:1 + b - a, i), f(a:b)))
        end do
        before = before + dot_product(self%whole(a:b), f(a:b))
      end associate
    end do
  end function of

  !> The product of a matrix (rows, nodes) and the matrix of the integral.
  function after(self, matrix) result(product)
    class(running_integral_t), intent(in) :: self
    real(wp), intent(in) :: matrix(:, :)
    real(wp), allocatable :: product(:, :), part(:, :), behind(:)
    integer :: k, i

    allocate (product(size(matrix, 1), size(matrix, 2)))
    allocate (behind(size(matrix, 1)), source=0.0_wp)
    do k = size(self%first), 1, -1
      associate (a => self%first(k), b => self%last(k))
        part = matrix(:, a:b)*spread(self%factor(a:b), 1, size(behind))
        do i = a, b
          product(:, i) = self%whole(i)*behind
        end do
        call add_by_transposed(part, self%own(:1 + b - a, a:b), product(:, a:b))
        behind = behind + sum(part, 2)
      end associate
    end do
  end function after

  !> The column up(:, i) has the weights of the integral of the nodes' polynomial from 0 to node i.
  pure function cumulative(local) result(up)
    type(local_nodes_t), intent(in) :: local
    real(wp) :: up(size(local%node), size(local%node))
    real(wp), dimension(size(local%node)) :: at, weight
    integer :: i

    call gauss_legendre(at, weight)
    do i = 1, size(local%node)
      up(:, i) = local%node(i)*matmul(local%bases(local%node(i)*at), weight)
    end do
  end function cumulative

  !> For a panel from `begin` to infinity, its part of Int f x dx up to each node: with x = begin
  !> exp(y), an integral over y of a smooth function.
  pure function to_infinity(local, begin) result(up)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: begin
    real(wp) :: up(size(local%node), size(local%node))
    real(wp) :: at(points), weight(points), y(points), length
    integer :: i

    call gauss_legendre(at, weight)
    do i = 1, size(local%node)
      length = -log(1 - local%node(i))
      y = length*at
      up(:, i) = length*begin**2*matmul(local%bases(1 - exp(-y)), weight*exp(2*y))
    end do
  end function to_infinity

  !> For such a panel, Int g x dx from each node to infinity, and over the whole panel: g = u**6
  !> times a polynomial, and x dx = -begin**2 u**(-3) du.
  pure subroutine from_infinity(local, begin, x, up, whole)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: begin, x(:)
    real(wp), intent(out) :: up(:, :), whole(:)
    real(wp), dimension(size(x)) :: unscaled
    integer :: i

    unscaled = begin**2*(x/begin)**power
    do i = 1, size(x)
      up(:, i) = from_zero(1 - local%node(i))*unscaled
    end do
    whole = from_zero(1.0_wp)*unscaled

  contains

    pure function from_zero(u) result(part)
      real(wp), intent(in) :: u
      real(wp) :: part(size(x)), at(size(x)), weight(size(x))

      call gauss_legendre(at, weight)
      part = u*matmul(local%bases(1 - u*at), weight*(u*at)**(power - 3))
    end function from_zero

  end subroutine from_infinity

end module running_integrals
