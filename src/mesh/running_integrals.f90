!> Integrals of functions given at the nodes, over a mesh from the axis to each node, and from each
!> node to infinity: matrices from the integrals of the panels' polynomials. On a panel to infinity,
!> with u = begin/position, the functions of the first integral are bounded polynomials in u, and
!> those of the second are position**(-6) times a polynomial in u.
module running_integrals
  use kinds, only: wp
  use discretisation, only: discretisation_t, local_nodes_t
  use panel_map, only: algebraic_map
  use quadrature, only: gauss_legendre, lagrange_basis
  implicit none
  private
  public :: running_integrals_t, new_running_integrals

  !> matmul(gathered, f): x_i**(-2) Int_0^x_i f x dx, and matmul(beyond, g):
  !> Int_x_i^infinity g x dx, both (nodes, nodes).
  type :: running_integrals_t
    real(wp), allocatable :: gathered(:, :), beyond(:, :)
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
    real(wp), allocatable :: up(:, :), whole(:)
    integer :: k, i, first, last

    associate (n => grid%nodes, x => grid%x)
      allocate (integrals%gathered(n, n), integrals%beyond(n, n), source=0.0_wp)
      do k = 1, size(grid%panel)
        associate (local => grid%local(grid%which(k)), panel => grid%panel(k))
          first = grid%first(k)
          last = first + size(local%node) - 1
          if (panel%kind == algebraic_map) then
            call to_infinity(local, panel%begin, up, whole)
            do i = first, last
              integrals%gathered(i, first:last) = up(:, i - first + 1)
            end do
            call from_infinity(local, panel%begin, x(first:last), up, whole)
          else
            up = cumulative(local)
            do i = first, last
              integrals%gathered(i, first:last) = up(:, i - first + 1)*x(first:last)* &
                panel%speed(local%node)
              integrals%beyond(i, first:last) = (local%weight - up(:, i - first + 1))* &
                x(first:last)*panel%speed(local%node)
            end do
            whole = grid%weight(first:last)
          end if
          do i = last + 1, n
            integrals%gathered(i, first:last) = grid%weight(first:last)
          end do
          if (panel%kind == algebraic_map) then
            do i = first, last
              integrals%beyond(i, first:last) = up(:, i - first + 1)
            end do
          end if
          do i = 1, first - 1
            integrals%beyond(i, first:last) = whole
          end do
        end associate
      end do
      do i = 1, n
        integrals%gathered(i, :) = integrals%gathered(i, :)/x(i)**2
      end do
    end associate
  end function new_running_integrals

  !> The column up(:, i) has the weights of the integral of the nodes' polynomial from 0 to node i.
  pure function cumulative(local) result(up)
    type(local_nodes_t), intent(in) :: local
    real(wp) :: up(size(local%node), size(local%node))
    real(wp), dimension(size(local%node)) :: at, weight
    integer :: i, q

    call gauss_legendre(at, weight)
    up = 0
    do i = 1, size(local%node)
      do q = 1, size(at)
        up(:, i) = up(:, i) + local%node(i)*weight(q)* &
          lagrange_basis(local%node, local%barycentric, local%node(i)*at(q))
      end do
    end do
  end function cumulative

  !> For a panel from `begin` to infinity, its part of Int f x dx up to each node: with x = begin
  !> exp(y), an integral over y of a smooth function. whole: the integral over the whole panel is
  !> infinite; set to 0.
  pure subroutine to_infinity(local, begin, up, whole)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: begin
    real(wp), allocatable, intent(out) :: up(:, :), whole(:)
    real(wp) :: at(points), weight(points), length, y
    integer :: i, q

    call gauss_legendre(at, weight)
    allocate (up(size(local%node), size(local%node)), whole(size(local%node)), source=0.0_wp)
    do i = 1, size(local%node)
      length = -log(1 - local%node(i))
      do q = 1, points
        y = length*at(q)
        up(:, i) = up(:, i) + length*weight(q)*begin**2*exp(2*y)* &
          lagrange_basis(local%node, local%barycentric, 1 - exp(-y))
      end do
    end do
  end subroutine to_infinity

  !> For such a panel, Int g x dx from each node to infinity, and over the whole panel: g = u**6
  !> times a polynomial, and x dx = -begin**2 u**(-3) du.
  pure subroutine from_infinity(local, begin, x, up, whole)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: begin, x(:)
    real(wp), allocatable, intent(out) :: up(:, :), whole(:)
    real(wp), dimension(size(x)) :: unscaled
    integer :: i

    unscaled = begin**2*(x/begin)**power
    allocate (up(size(x), size(x)))
    do i = 1, size(x)
      up(:, i) = from_zero(1 - local%node(i))*unscaled
    end do
    whole = from_zero(1.0_wp)*unscaled

  contains

    pure function from_zero(u) result(part)
      real(wp), intent(in) :: u
      real(wp) :: part(size(x)), at(size(x)), weight(size(x))
      integer :: q

      call gauss_legendre(at, weight)
      part = 0
      do q = 1, size(x)
        part = part + u*weight(q)*(u*at(q))**(power - 3)* &
          lagrange_basis(local%node, local%barycentric, 1 - u*at(q))
      end do
    end function from_zero

  end subroutine from_infinity

end module running_integrals
