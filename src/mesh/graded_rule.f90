!> Quadrature on a panel for the elastic kernel, whose logarithm may be at a node, at an end or at
!> any distance from it.
!>
!> Where it is near, points are graded towards it: with distance = length*v**power and Gauss points
!> in v, a logarithm there is as smooth as v**(power - 1) ln(v), and one a little farther off stays
!> away from the points in proportion. A long panel is divided into cells: near are those of the
!> logarithm and of its neighbours, and on the others plain Gauss points serve every target.
!>
!> Integrals are taken against Legendre polynomials, whose values follow from a recurrence; those
!> against the panel's Lagrange polynomials are combinations of them.
module graded_rule
  use kinds, only: wp, pi
  use quadrature, only: gauss_legendre, legendre_values
  implicit none
  private
  public :: graded_rule_t, new_graded_rule

  !> Exponent of the substitution, and points with which v**(power - 1) ln(v) leaves some parts of
  !> one: the error falls with twice the exponent.
  integer, parameter :: power = 4
  real(wp), parameter :: least_graded = 1.75_wp
  !> Length of a cell in z, about; a panel of fewer cells is all near. How many cells are near on
  !> either side of a place: its own and the next.
  real(wp), parameter :: cell_length = 1.8_wp
  integer, parameter :: fewest_cells = 4, near_cells = 2
  !> Points for each degree of the nodes' polynomials: on graded points and on a cell's; and what a
  !> cell has besides, where the polynomials' last digits are of higher degrees.
  real(wp), parameter :: near_share = 1.4_wp, far_share = 0.5_wp
  integer, parameter :: least_points = 3

  type :: graded_rule_t
    integer :: order = 0
    !> The panel's nodes on [0, 1], (order).
    real(wp), allocatable :: node(:)
    !> Points and weights of the substitution on [0, 1], (points).
    real(wp), allocatable :: step(:), step_weight(:)
    !> Cells of equal length, the cell of each node (order), and Gauss points and weights of all
    !> cells, as places on the panel, with the cell of each (far points).
    integer :: cells = 1
    integer, allocatable :: cell_of_node(:), cell(:)
    real(wp), allocatable :: far(:), far_weight(:)
    !> lagrange(m, j): part of the Legendre polynomial of degree m - 1 in the Lagrange polynomial of
    !> node j, (order, order). Of the panel's mirror image parts of odd degree have the other sign,
    !> parity(m).
    real(wp), allocatable :: lagrange(:, :), parity(:)
  contains
    procedure :: far_from
    procedure :: last_near
    procedure :: reach
  end type graded_rule_t

contains

  !> Rule for a panel with the Gauss-Legendre nodes `node` of [0, 1] and their weights, for so many
  !> digits; z_length: of a panel mapped by sinh, otherwise zero.
  pure function new_graded_rule(node, weight, z_length, digits) result(rule)
    real(wp), intent(in) :: node(:), weight(:), z_length, digits
    type(graded_rule_t) :: rule
    real(wp), allocatable :: v(:), v_weight(:)
    integer :: points, m

    rule%order = size(node)
    rule%node = node
    rule%cells = nint(z_length/cell_length)
    if (rule%cells < fewest_cells) rule%cells = 1
    rule%cell_of_node = min(rule%cells, 1 + int(rule%cells*node))
    points = points_for(rule%order, rule%cells, z_length, digits)
    allocate (v(points), v_weight(points))
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight
    call add_cells(rule, z_length, digits)
    ! The nodes' own rule is exact for products of two polynomials of theirs.
    rule%lagrange = transpose(legendre_values(node, rule%order))
    do m = 1, rule%order
      rule%lagrange(m, :) = (2*m - 1)*weight*rule%lagrange(m, :)
    end do
    rule%parity = [(real((-1)**(m - 1), wp), m=1, rule%order)]
  end function new_graded_rule

  !> The far points of a target: up to `last_before` and from `first_after` on. k: the node that it
  !> is, if it is one of the panel's; otherwise it lies beyond the left end or the right one.
  pure subroutine far_from(self, k, left, last_before, first_after)
    class(graded_rule_t), intent(in) :: self
    integer, intent(in) :: k
    logical, intent(in) :: left
    integer, intent(out) :: last_before, first_after
    integer :: first, last

    if (k >= 1 .and. k <= self%order) then
      first = self%cells + 1 - self%last_near(self%order + 1 - k)
      last = self%last_near(k)
    else if (left) then
      first = 1
      last = near_cells
    else
      first = self%cells + 1 - near_cells
      last = self%cells
    end if
    last_before = count(self%cell < first)
    first_after = count(self%cell <= last) + 1
  end subroutine far_from

  !> The last cell that is near a node, whose image has this for the first.
  elemental integer function last_near(self, k)
    class(graded_rule_t), intent(in) :: self
    integer, intent(in) :: k

    last_near = min(self%cells, self%cell_of_node(k) + near_cells - 1)
  end function last_near

  !> The part of the panel that is near its end.
  pure real(wp) function reach(self)
    class(graded_rule_t), intent(in) :: self

    reach = min(1.0_wp, real(near_cells, wp)/self%cells)
  end function reach

  !> The Gauss points of the cells of a long panel.
  pure subroutine add_cells(rule, z_length, digits)
    type(graded_rule_t), intent(inout) :: rule
    real(wp), intent(in) :: z_length, digits
    real(wp), allocatable :: v(:), v_weight(:)
    integer :: k

    allocate (rule%far(0), rule%far_weight(0), rule%cell(0))
    if (rule%cells == 1) return
    do k = 1, rule%cells
      allocate (v(far_points(rule, k, z_length, digits)))
      allocate (v_weight(size(v)))
      call gauss_legendre(v, v_weight)
      rule%far = [rule%far, (k - 1 + v)/rule%cells]
      rule%far_weight = [rule%far_weight, v_weight/rule%cells]
      rule%cell = [rule%cell, spread(k, 1, size(v))]
      deallocate (v, v_weight)
    end do
  end subroutine add_cells

  !> Gauss points of the k-th cell: half as many as the degrees that the nodes' polynomials amount
  !> to there, and more for a kernel that is singular a cell away or, beyond an axis at the panel's
  !> end, at t = -r.
  pure integer function far_points(rule, k, z_length, digits) result(points)
    type(graded_rule_t), intent(in) :: rule
    integer, intent(in) :: k
    real(wp), intent(in) :: z_length, digits
    real(wp) :: distance, degrees

    ! In units of half the cell, from its middle.
    distance = 3
    if (k == 1 .or. k == rule%cells) distance = 1 + 2*log(2.0_wp)*rule%cells/z_length
    distance = min(3.0_wp, distance)
    degrees = 0.5_wp*rule%order*(angle(k) - angle(k - 1))
    points = least_points + &
      ceiling(far_share*degrees + points_against(distance + sqrt(distance**2 - 1), digits))

  contains

    !> Where the k-th cell ends, as the angle that makes the polynomials' waves equal.
    pure real(wp) function angle(k)
      integer, intent(in) :: k

      angle = acos(1 - 2*real(k, wp)/rule%cells)
    end function angle

  end function far_points

  !> Points that integrate a logarithm times the nodes' polynomials over what is near, to the
  !> digits. The kernel is singular not only at t = r but at t = -r too, which comes as near to the
  !> end of a panel at the axis as ln(2) in z: that end is where the substitution has the fewest
  !> points.
  pure integer function points_for(order, cells, z_length, digits) result(points)
    integer, intent(in) :: order, cells
    real(wp), intent(in) :: z_length, digits
    real(wp) :: part

    part = min(1.0_wp, real(near_cells, wp)/cells)
    points = ceiling(max(least_graded*10.0_wp**(digits/(2*power)), &
      near_share*order*acos(1 - 2*part)/pi + &
      points_against(1 + sqrt(log(2.0_wp)/max(part*z_length, 1.0_wp)), digits)))
  end function points_for

  !> Gauss points against a singularity on a Bernstein ellipse of that sum of half axes.
  elemental real(wp) function points_against(ellipse, digits) result(points)
    real(wp), intent(in) :: ellipse, digits

    points = digits*log(10.0_wp)/(2*log(ellipse))
  end function points_against

end module graded_rule
