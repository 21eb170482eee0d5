!> Quadrature on a panel for the elastic kernel, whose logarithm may be at a node, at an end or at
!> any distance from it: with distance = length*v**power from where it is, and Gauss points in v, a
!> logarithm there is as smooth as v**(power - 1) ln(v), and one a little farther off stays away
!> from the points in proportion.
!>
!> Integrals are taken against Legendre polynomials, whose values follow from a recurrence; those
!> against the panel's Lagrange polynomials are combinations of them.
module graded_rule
  use kinds, only: wp
  use quadrature, only: gauss_legendre, legendre_values
  implicit none
  private
  public :: graded_rule_t, new_graded_rule

  !> Exponent of the substitution: v**3 ln(v) leaves 1e-13 with 40 points, and at the far end, which
  !> the substitution thins out, the points still resolve polynomials of as many degrees.
  integer, parameter :: power = 4

  type :: graded_rule_t
    integer :: order = 0
    !> The panel's nodes on [0, 1], (order).
    real(wp), allocatable :: node(:)
    !> Points and weights of the substitution on [0, 1], (points).
    real(wp), allocatable :: step(:), step_weight(:)
    !> lagrange(m, j): part of the Legendre polynomial of degree m - 1 in the Lagrange polynomial of
    !> node j, (order, order). Of the panel's mirror image parts of odd degree have the other sign,
    !> parity(m).
    real(wp), allocatable :: lagrange(:, :), parity(:)
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
    points = points_for(rule%order, z_length, digits)
    allocate (v(points), v_weight(points))
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight
    ! The nodes' own rule is exact for products of two polynomials of theirs.
    rule%lagrange = transpose(legendre_values(node, rule%order))
    do m = 1, rule%order
      rule%lagrange(m, :) = (2*m - 1)*weight*rule%lagrange(m, :)
    end do
    rule%parity = [(real((-1)**(m - 1), wp), m=1, rule%order)]
  end function new_graded_rule

  !> Points that integrate a logarithm times polynomials of that many nodes to the digits. The
  !> kernel is singular not only at t = r but at t = -r too, which comes as near to the end of a
  !> panel at the axis as ln(2) in z: that end is where the substitution has the fewest points.
  pure integer function points_for(order, z_length, digits) result(points)
    integer, intent(in) :: order
    real(wp), intent(in) :: z_length, digits
    real(wp) :: ellipse

    ! Of the Bernstein ellipse through that singularity, in the variable of the Gauss points.
    ellipse = 1 + sqrt(log(2.0_wp)/max(z_length, 1.0_wp))
    points = order + ceiling(digits*log(10.0_wp)/(2*log(ellipse)))
  end function points_for

end module graded_rule
