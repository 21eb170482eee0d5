!> Quadrature on a panel for the elastic kernel, whose logarithm may be at a node, at an end or at
!> any distance from it: with distance = length*v**power from where it is, and Gauss points in v, a
!> logarithm there is as smooth as v**(power - 1) ln(v), and one a little farther off stays away
!> from the points in proportion.
!>
!> Values of the panel's Lagrange polynomials at these points, and on panels mapped by sinh the
!> exponentials of the map, are the same whatever the target, and tabulated.
module graded_rule
  use kinds, only: wp
  use quadrature, only: gauss_legendre, lagrange_basis
  implicit none
  private
  public :: graded_rule_t, new_graded_rule

  !> Exponent of the substitution: v**3 ln(v) leaves 1e-13 with 40 points, and at the far end, which
  !> the substitution thins out, the points still resolve polynomials of as many degrees.
  integer, parameter :: power = 4

  type :: graded_rule_t
    integer :: order = 0, points = 0
    !> The panel's nodes on [0, 1], (order).
    real(wp), allocatable :: node(:)
    !> Points and weights of the substitution on [0, 1], (points).
    real(wp), allocatable :: step(:), step_weight(:)
    !> basis(j, q): polynomial j at s = step(q), (order, points).
    real(wp), allocatable :: basis(:, :)
    !> after(j, q, i): polynomial j at s = node(i) + (1 - node(i))*step(q), (order, points, order).
    !> Points before a node are those after its mirror image, with polynomials in reverse.
    real(wp), allocatable :: after(:, :, :)
    !> Of a panel mapped by sinh: with delta = z_length*(s - node(i)), exp(delta/2) and
    !> 2 sinh(delta/2) at the same points, (points, order); and from the left end, (points).
    real(wp), allocatable :: growth(:, :), chord(:, :), end_growth(:), end_chord(:)
  end type graded_rule_t

contains

  !> Rule for a panel with the Gauss-Legendre nodes `node` of [0, 1], for so many digits; z_length:
  !> of a panel mapped by sinh, otherwise zero.
  pure function new_graded_rule(node, barycentric, z_length, digits) result(rule)
    real(wp), intent(in) :: node(:), barycentric(:), z_length, digits
    type(graded_rule_t) :: rule
    real(wp), allocatable :: v(:), v_weight(:)
    integer :: i, q

    rule%order = size(node)
    rule%points = points_for(rule%order, z_length, digits)
    rule%node = node
    associate (order => rule%order, points => rule%points)
      allocate (v(points), v_weight(points))
      allocate (rule%basis(order, points), rule%after(order, points, order))
    end associate
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight
    do q = 1, rule%points
      rule%basis(:, q) = lagrange_basis(node, barycentric, rule%step(q))
      do i = 1, rule%order
        rule%after(:, q, i) = lagrange_basis(node, barycentric, &
          rule%node(i) + (1 - rule%node(i))*rule%step(q))
      end do
    end do
    if (.not. z_length > 0) return
    rule%end_growth = exp(0.5_wp*z_length*rule%step)
    rule%end_chord = 2*sinh(0.5_wp*z_length*rule%step)
    allocate (rule%growth(rule%points, rule%order), rule%chord(rule%points, rule%order))
    do i = 1, rule%order
      rule%growth(:, i) = exp(0.5_wp*z_length*(1 - node(i))*rule%step)
      rule%chord(:, i) = 2*sinh(0.5_wp*z_length*(1 - node(i))*rule%step)
    end do
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
