!> The pressure that a mesh represents for given gaps. On a panel with Gauss nodes s_i and weights
!> w_i the mesh multiplies pressures by polynomials, and the value at a node stands for
!>
!>     p_i = (1/w_i) Int l_i(s) p(h(s)) ds
!>
!> with the panel's Lagrange polynomials l_i. For a pressure that is a polynomial of lower degree
!> this is the pressure at the node. On a panel where the gap passes a kink of the law, the integral
!> is computed in pieces that end at the kink. The polynomial with the values p_i is then the
!> projection of the pressure: loads and deformations are nearly as accurate as for a smooth
!> pressure, and change smoothly as the kink moves over the nodes. On a panel whose gaps are near a
!> kink, pressures are a mixture of nodal values and projection; the share of the projection grows
!> to 1 as the kink reaches the panel. Otherwise the pressures would jump by the error of the mesh,
!> and iterations would not converge.
module represented_pressure
  use kinds, only: wp
  use interpolation, only: fading
  use force_law, only: force_law_t
  use discretisation, only: discretisation_t
  use local_nodes, only: local_nodes_t, gauss_nodes
  use panel_map, only: algebraic_map
  use matrix_products, only: multiply, multiply_left, add_by_transposed
  implicit none
  private
  public :: pressure_slope_t, pressure_on, slope_on, panel_pressure, pressure_at_nodes

  !> Number of points of the quadrature on a piece of a panel: a constant, and a number for each
  !> node on the piece.
  real(wp), parameter :: points_a_node = 1.5_wp
  integer, parameter :: few_points = 9
  !> If a law has more kinks than this, the projection is used on all panels.
  integer, parameter :: few = 4

  !> The derivatives of a panel's pressures by its gaps, (nodes of the panel, nodes of the panel).
  type :: panel_slope_t
    integer :: first = 0, last = 0
    real(wp), allocatable :: by_gap(:, :)
  end type panel_slope_t

  !> The derivative of the represented pressures by the gaps: at each node the law's slope, except
  !> on the panels of `mixed`.
  type :: pressure_slope_t
    real(wp), allocatable :: at_node(:)
    type(panel_slope_t), allocatable :: mixed(:)
  contains
    procedure :: times
    procedure :: factor
    procedure :: mix
  end type pressure_slope_t

contains

  !> The pressures that a mesh represents for the gaps at its nodes. Positions without panels, as
  !> those of rigid bodies, have the pressures of the law.
  pure function pressure_on(law, grid, gap) result(pressure)
    class(force_law_t), intent(in) :: law
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:)
    real(wp) :: pressure(size(gap))
    integer :: k, last

    if (.not. (allocated(law%kinks) .and. allocated(grid%panel))) then
      pressure = law%pressure(gap)
      return
    end if
    do k = 1, size(grid%panel)
      associate (local => grid%local(grid%which(k)), first => grid%first(k))
        last = first + size(local%node) - 1
        if (can_mix(grid, k)) then
          pressure(first:last) = panel_pressure(law, local, gap(first:last))
        else
          pressure(first:last) = law%pressure(gap(first:last))
        end if
      end associate
    end do
  end function pressure_on

  !> The pressures at the nodes of a state whose represented pressures, which may contain the
  !> pressure of a fluid, are given.
  pure function pressure_at_nodes(law, grid, gap, represented) result(pressure)
    class(force_law_t), intent(in) :: law
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:), represented(:)
    real(wp) :: pressure(size(gap))

    pressure = represented
    if (allocated(law%kinks)) &
      pressure = pressure + (law%pressure(gap) - pressure_on(law, grid, gap))
  end function pressure_at_nodes

  !> The pressures that a panel represents for the gaps at its nodes.
  pure function panel_pressure(law, local, gap) result(pressure)
    class(force_law_t), intent(in) :: law
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: gap(:)
    real(wp) :: pressure(size(gap)), projected(size(gap))
    real(wp), allocatable :: s(:), weight(:), basis(:, :), between(:)
    real(wp) :: share

    share = 0
    if (allocated(law%kinks)) call split(law, local, gap, s, weight, share)
    if (share < 1) pressure = law%pressure(gap)
    if (.not. share > 0) return
    basis = local%bases(s)
    allocate (between(size(s)))
    call multiply_left(gap, basis, between)
    call multiply(basis, size(s), weight*law%pressure(between), projected)
    projected = projected/local%weight
    if (share < 1) projected = pressure + share*(projected - pressure)
    pressure = projected
  end function panel_pressure

  !> The derivative of `pressure_on` by the gaps.
  function slope_on(law, grid, gap) result(slope)
    class(force_law_t), intent(in) :: law
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: gap(:)
    type(pressure_slope_t) :: slope
    type(panel_slope_t) :: panel
    real(wp), allocatable :: s(:), weight(:), basis(:, :), between(:), weighted(:, :)
    real(wp) :: share
    integer :: k, i

    slope%at_node = law%slope(gap)
    allocate (slope%mixed(0))
    if (.not. allocated(law%kinks)) return
    do k = 1, size(grid%panel)
      if (.not. can_mix(grid, k)) cycle
      associate (local => grid%local(grid%which(k)))
        panel%first = grid%first(k)
        panel%last = panel%first + size(local%node) - 1
        call split(law, local, gap(panel%first:panel%last), s, weight, share)
        if (.not. share > 0) cycle
        basis = local%bases(s)
        between = s
        call multiply_left(gap(panel%first:panel%last), basis, between)
        between = share*weight*law%slope(between)
        weighted = basis
        do i = 1, size(s)
          weighted(:, i) = between(i)*basis(:, i)/local%weight
        end do
        if (allocated(panel%by_gap)) deallocate (panel%by_gap)
        allocate (panel%by_gap(size(local%node), size(local%node)), source=0.0_wp)
        call add_by_transposed(weighted, basis, panel%by_gap)
        do i = 1, size(local%node)
          panel%by_gap(i, i) = panel%by_gap(i, i) + (1 - share)*slope%at_node(panel%first - 1 + i)
        end do
        slope%mixed = [slope%mixed, panel]
      end associate
    end do
  end function slope_on

  !> The change of the represented pressures for a change of the gaps.
  pure function times(self, change) result(product)
    class(pressure_slope_t), intent(in) :: self
    real(wp), intent(in) :: change(:)
    real(wp) :: product(size(change))
    integer :: k

    product = self%at_node*change
    do k = 1, size(self%mixed)
      associate (panel => self%mixed(k))
        product(panel%first:panel%last) = matmul(panel%by_gap, change(panel%first:panel%last))
      end associate
    end do
  end function times

  !> The factors of the columns of a matrix that is multiplied from the right by the derivative,
  !> before `mix` completes the product.
  pure function factor(self)
    class(pressure_slope_t), intent(in) :: self
    real(wp) :: factor(size(self%at_node))
    integer :: k

    factor = self%at_node
    do k = 1, size(self%mixed)
      factor(self%mixed(k)%first:self%mixed(k)%last) = 1
    end do
  end function factor

  !> Completes the product of a matrix and the derivative. node: the nodes of the matrix's columns,
  !> all nodes of each mixed panel among them.
  pure subroutine mix(self, node, matrix)
    class(pressure_slope_t), intent(in) :: self
    integer, intent(in) :: node(:)
    real(wp), intent(inout) :: matrix(:, :)
    integer :: k, from, to

    do k = 1, size(self%mixed)
      associate (panel => self%mixed(k))
        from = findloc(node, panel%first, 1)
        to = from + panel%last - panel%first
        matrix(:, from:to) = matmul(matrix(:, from:to), panel%by_gap)
      end associate
    end do
  end subroutine mix

  !> Whether nodal values on a panel are those of a projection: its nodes are Gauss nodes, and the
  !> pressure is a polynomial.
  pure logical function can_mix(grid, k)
    type(discretisation_t), intent(in) :: grid
    integer, intent(in) :: k

    can_mix = grid%panel(k)%kind /= algebraic_map .and. grid%local(grid%which(k))%node(1) > 0
  end function can_mix

  !> Points and weights for integrals over a panel with the gaps h at its nodes, in pieces that end
  !> at the law's kinks. share: the share of the projection in the represented pressure: 1 if there
  !> is a kink on the panel, or if the law has many; 0, without points, if none is near
  !> (`share_near`).
  pure subroutine split(law, local, h, s, weight, share)
    class(force_law_t), intent(in) :: law
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: h(:)
    real(wp), allocatable, intent(out) :: s(:), weight(:)
    real(wp), intent(out) :: share
    real(wp), dimension(0:size(h) + 1) :: x, y
    real(wp), allocatable :: place(:), length(:)
    type(local_nodes_t) :: rule
    logical :: above(size(law%kinks))
    integer :: i

    x = [0.0_wp, local%node, 1.0_wp]
    y = [local%value(h, 0.0_wp), h, local%value(h, 1.0_wp)]
    share = 1
    if (size(law%kinks) <= few) then
      share = maxval([(share_near(law%kinks(i), y), i=1, size(law%kinks))])
      if (.not. share > 0) return
    end if
    place = [0.0_wp]
    do i = 0, size(h)
      above = law%kinks > y(i)
      if (any(above .neqv. law%kinks > y(i + 1))) &
        place = [place, kinks_between(law%kinks, local, h, x(i:i + 1), y(i:i + 1))]
    end do
    length = [place(2:), 1.0_wp] - place
    rule = gauss_nodes(few_points + ceiling(points_a_node*size(h)*maxval(length)))
    s = [(place(i) + length(i)*rule%node, i=1, size(place))]
    weight = [(length(i)*rule%weight, i=1, size(place))]
  end subroutine split

  !> The share of the projection on a panel with the gaps y at its begin, nodes and end. It is 1 if
  !> the kink is between these gaps. Outside these it falls to 0 over the difference of the gaps at
  !> the nearer end of the panel and at the node next to it.
  pure real(wp) function share_near(kink, y) result(share)
    real(wp), intent(in) :: kink, y(0:)
    real(wp) :: off, reach

    share = 1
    off = max(minval(y) - kink, kink - maxval(y))
    if (.not. off > 0) return
    associate (n => ubound(y, 1))
      reach = merge(abs(y(1) - y(0)), abs(y(n) - y(n - 1)), abs(kink - y(0)) < abs(kink - y(n)))
    end associate
    share = fading(off/max(reach, tiny(1.0_wp)))
  end function share_near

  !> The places between two positions x, where the gaps are y, at which the panel's polynomial
  !> passes kinks.
  pure function kinks_between(kinks, local, h, x, y) result(place)
    type(local_nodes_t), intent(in) :: local
    real(wp), intent(in) :: kinks(:), h(:), x(2), y(2)
    real(wp), allocatable :: place(:)
    real(wp) :: level
    integer :: k

    allocate (place(0))
    level = y(1)
    do
      ! The nearest kink on the way that is not passed yet.
      k = minloc(abs(kinks - level), 1, (kinks - level)*(y(2) - y(1)) > 0 .and. &
        (y(2) - kinks)*(y(2) - y(1)) >= 0)
      if (k == 0) return
      level = kinks(k)
      place = [place, local%reaching(h, level, x)]
    end do
  end function kinks_between

end module represented_pressure
