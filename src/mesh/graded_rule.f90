!> Quadrature on a panel for the elastic kernel, whose logarithm may be at a node, at an end or at
!> any distance from it: with distance = length*v**power from where it is, and Gauss points in v, a
!> logarithm there is as smooth as v**(power - 1) ln(v), and one a little farther off stays away
!> from the points in proportion.
!>
!> Values of the panel's Lagrange polynomials at these points depend on its order alone and are
!> tabulated; on panels mapped by sinh so are the exponentials of the map, for a length in z.
module graded_rule
  use kinds, only: wp
  use quadrature, only: gauss_legendre, barycentric_weights, lagrange_basis
  implicit none
  private
  public :: graded_rule_t, new_graded_rule

  !> Exponent of the substitution: v**3 ln(v) leaves 1e-13 with 40 points, and at the far end, which
  !> the substitution thins out, the points still resolve polynomials of as many degrees.
  integer, parameter :: power = 4

  type :: graded_rule_t
    integer :: order = 0, points = 0
    !> Gauss-Legendre nodes of [0, 1], weights and barycentric weights, (order).
    real(wp), allocatable :: node(:), weight(:), barycentric(:)
    !> Points and weights of the substitution on [0, 1], (points).
    real(wp), allocatable :: step(:), step_weight(:)
    !> basis(j, q): polynomial j at s = step(q), (order, points).
    real(wp), allocatable :: basis(:, :)
    !> after(j, q, i): polynomial j at s = node(i) + (1 - node(i))*step(q), (order, points, order).
    !> Points before a node are those after its mirror image, with polynomials in reverse.
    real(wp), allocatable :: after(:, :, :)
    !> Length in z that the following are for: with delta = z_length*(s - node(i)), exp(delta/2)
    !> and 2 sinh(delta/2) at the same points, (points, order); and from the left end, (points).
    real(wp) :: z_length = 0
    real(wp), allocatable :: growth(:, :), chord(:, :), end_growth(:), end_chord(:)
  end type graded_rule_t

contains

  !> Rule for panels of `order` nodes, with so many points; z_length: of a panel mapped by sinh,
  !> otherwise zero.
  pure function new_graded_rule(order, points, z_length) result(rule)
    integer, intent(in) :: order, points
    real(wp), intent(in) :: z_length
    type(graded_rule_t) :: rule
    real(wp) :: v(points), v_weight(points)
    integer :: i, q

    rule%order = order
    rule%points = points
    rule%z_length = z_length
    allocate (rule%node(order), rule%weight(order))
    allocate (rule%basis(order, points), rule%after(order, points, order))
    call gauss_legendre(rule%node, rule%weight)
    rule%barycentric = barycentric_weights(rule%node)
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight
    do q = 1, points
      rule%basis(:, q) = lagrange_basis(rule%node, rule%barycentric, rule%step(q))
      do i = 1, order
        rule%after(:, q, i) = lagrange_basis(rule%node, rule%barycentric, &
          rule%node(i) + (1 - rule%node(i))*rule%step(q))
      end do
    end do
    if (.not. z_length > 0) return
    rule%end_growth = exp(0.5_wp*z_length*rule%step)
    rule%end_chord = 2*sinh(0.5_wp*z_length*rule%step)
    allocate (rule%growth(points, order), rule%chord(points, order))
    do i = 1, order
      rule%growth(:, i) = exp(0.5_wp*z_length*(1 - rule%node(i))*rule%step)
      rule%chord(:, i) = 2*sinh(0.5_wp*z_length*(1 - rule%node(i))*rule%step)
    end do
  end function new_graded_rule

end module graded_rule
