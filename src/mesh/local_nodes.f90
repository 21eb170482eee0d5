!> The nodes of a panel, in its local coordinate: roots of a Legendre polynomial on [0, 1], or any
!> others, and the polynomials through values at these nodes.
module local_nodes
  use kinds, only: wp
  use root_finding, only: root_search_t, new_root_search
  use quadrature, only: gauss_legendre, barycentric_weights
  implicit none
  private
  public :: local_nodes_t, gauss_nodes, given_nodes

  !> Added to distances from nodes, so that none is 0; other distances are unchanged.
  real(wp), parameter :: at_node = 1.0e-100_wp

  !> Nodes of panels on [0, 1], weights of the integral, and barycentric weights.
  type :: local_nodes_t
    real(wp), allocatable :: node(:), weight(:), barycentric(:)
  contains
    procedure :: value => value_at
    procedure :: values => values_at
    procedure :: reaching
    procedure :: tail
    procedure :: bases
  end type local_nodes_t

contains

  !> The Gauss-Legendre nodes of a panel.
  pure function gauss_nodes(order) result(local)
    integer, intent(in) :: order
    type(local_nodes_t) :: local
    integer :: k

    allocate (local%node(order), local%weight(order))
    call gauss_legendre(local%node, local%weight)
    ! In a Gauss rule the weight of a node determines the slope of the node polynomial there.
    local%barycentric = [((-1)**k*sqrt(local%node(k)*(1 - local%node(k))*local%weight(k)), &
      k=1, order)]
  end function gauss_nodes

  !> Given nodes on [0, 1], with the weights of the integral of the polynomial through them.
  pure function given_nodes(node) result(local)
    real(wp), intent(in) :: node(:)
    type(local_nodes_t) :: local
    real(wp), dimension(size(node)) :: x, weight

    local%node = node
    local%barycentric = barycentric_weights(node)
    call gauss_legendre(x, weight)
    local%weight = matmul(local%bases(x), weight)
  end function given_nodes

  !> The polynomial through values at the nodes, evaluated at s by the barycentric formula.
  pure real(wp) function value_at(self, values, s)
    class(local_nodes_t), intent(in) :: self
    real(wp), intent(in) :: values(:), s
    real(wp) :: share, shares
    integer :: j

    value_at = 0
    shares = 0
    do j = 1, size(values)
      if (abs(s - self%node(j)) <= tiny(s)) then
        value_at = values(j)
        return
      end if
      share = self%barycentric(j)/(s - self%node(j))
      shares = shares + share
      value_at = value_at + share*values(j)
    end do
    value_at = value_at/shares
  end function value_at

  !> The same at many points, faster.
  pure function values_at(self, values, s) result(value)
    class(local_nodes_t), intent(in) :: self
    real(wp), intent(in) :: values(:), s(:)
    real(wp), dimension(size(s)) :: value, share, shares
    integer :: j

    value = 0
    shares = 0
    do j = 1, size(values)
      ! At a node, its term exceeds the others by more than the digits of a number.
      share = self%barycentric(j)/(s - self%node(j) + at_node)
      shares = shares + share
      value = value + share*values(j)
    end do
    value = value/shares
  end function values_at

  !> The point between two others at which the polynomial through values at the nodes reaches a
  !> level between its values at the two points.
  pure real(wp) function reaching(self, values, level, between) result(s)
    class(local_nodes_t), intent(in) :: self
    real(wp), intent(in) :: values(:), level, between(2)
    type(root_search_t) :: search

    search = new_root_search(between(1), self%value(values, between(1)) - level, &
      between(2), self%value(values, between(2)) - level)
    do while (search%is_open())
      call search%note(search%place(), self%value(values, search%place()) - level)
    end do
    s = search%root
  end function reaching

  !> The larger of the last two Legendre coefficients of a function given at the nodes; small if the
  !> polynomial represents the function well. On n nodes, roots of P_n, the node's weight times
  !> P_(n-1) is 2/n of the barycentric weight except for the sign, and P_(n-2) is (2 n - 1)/(n - 1)
  !> times x P_(n-1).
  pure real(wp) function tail(self, value)
    class(local_nodes_t), intent(in) :: self
    real(wp), intent(in) :: value(:)
    integer :: n

    n = size(value)
    associate (weighted => self%barycentric*value)
      tail = 2*(2*n - 1.0_wp)/n*max(abs(sum(weighted)), &
        (2*n - 3.0_wp)/max(n - 1, 1)*abs(sum((2*self%node - 1)*weighted)))
    end associate
  end function tail

  !> The Lagrange polynomials of a panel at points, (nodes, points).
  pure function bases(self, s) result(basis)
    class(local_nodes_t), intent(in) :: self
    real(wp), intent(in) :: s(:)
    real(wp) :: basis(size(self%node), size(s))
    real(wp) :: share(size(s), size(self%node)), shares(size(s)), apart(size(s))
    integer :: j

    shares = 0
    do j = 1, size(self%node)
      apart = s - self%node(j)
      ! At a node its own polynomial is 1 and the others are negligible.
      share(:, j) = self%barycentric(j)/merge(apart, tiny(1.0_wp), abs(apart) > tiny(1.0_wp))
      shares = shares + share(:, j)
    end do
    do j = 1, size(self%node)
      basis(j, :) = share(:, j)/shares
    end do
  end function bases

end module local_nodes
