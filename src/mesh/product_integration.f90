!> Integrals of the elastic kernel times Lagrange polynomials over one panel; the logarithmic
!> singularity is integrated exactly.
!>
!> Positions are given as offsets from a common centre, position = centre + offset, so that the
!> distance between two points close to the centre keeps its full relative precision.
module product_integration
  use kinds, only: wp
  use elastic_kernel, only: kernel, kernel_log_coefficient
  use quadrature, only: gauss_legendre, logarithm_weights, barycentric_weights, lagrange_basis
  implicit none
  private
  public :: panel_rule_t, new_panel_rule, panel_weights

  !> Number of points of the inner rule, which is exact for a logarithm times a polynomial of degree
  !> 39: up to 23 for the Lagrange polynomial (order 24), and 16 for the logarithm's coefficient,
  !> whose nearest singularity is at a distance equal to the length of the piece (rho = 5.8, and
  !> 5.8**(-16) is 6e-13, times a small factor). 24 points were exact enough only up to order 14.
  integer, parameter :: inner_points = 40
  !> Number of points of the rules for distant panels, cheapest first; the first rule is replaced by
  !> the panel's own nodes if these are a Gauss rule.
  integer, parameter :: points(3) = [6, 12, inner_points]
  !> Largest ratio of the distances of a piece's far and near ends from the target: its Bernstein
  !> ellipse then has rho = 3.7, which is ample for 2*40 - 24 degrees.
  real(wp), parameter :: reach = 3

  !> A distance, in panel lengths, that marks a rule as useless; all real distances are far below
  !> it.
  real(wp), parameter :: never = 1.0e30_wp

  !> A Gauss rule for targets whose distance from the panel is at least `far` times its length;
  !> there the rule integrates the kernel times a Lagrange polynomial to rounding.
  type :: distant_rule_t
    real(wp) :: far
    real(wp), allocatable :: node(:), weight(:)
    !> basis(j, k): Lagrange polynomial j at node k; not allocated where the nodes are the panel's.
    real(wp), allocatable :: basis(:, :)
  end type distant_rule_t

  !> The data that do not depend on the position of a panel: its nodes on [0, 1] and the rules.
  type :: panel_rule_t
    !> Nodes on [0, 1], the interpolatory weights of these nodes, and their barycentric weights.
    real(wp), allocatable :: node(:), weight(:), barycentric(:)
    !> The inner rule on [0, 1]: nodes, weights, weights against ln(s).
    real(wp) :: inner(inner_points), inner_weight(inner_points), log_weight(inner_points)
    !> Rules for the undivided panel, cheapest first.
    type(distant_rule_t), allocatable :: distant(:)
  end type panel_rule_t

contains

  !> Rule for panels whose nodes on [0, 1] are given: Gauss-Legendre nodes for high order, (0, 1)
  !> for a piecewise linear pressure.
  pure function new_panel_rule(node) result(rule)
    real(wp), intent(in) :: node(:)
    type(panel_rule_t) :: rule
    real(wp) :: inner_basis(size(node), inner_points)
    integer :: k

    rule%node = node
    rule%barycentric = barycentric_weights(node)
    call gauss_legendre(rule%inner, rule%inner_weight)
    rule%log_weight = logarithm_weights(rule%inner, rule%inner_weight)
    do k = 1, inner_points
      inner_basis(:, k) = lagrange_basis(node, rule%barycentric, rule%inner(k))
    end do
    rule%weight = matmul(inner_basis, rule%inner_weight)

    ! One by one: compiler note 1.
    allocate (rule%distant(size(points)))
    do k = 1, size(points)
      rule%distant(k) = new_distant_rule(node, rule%barycentric, points(k))
    end do
    ! Nodes of a Gauss rule need no interpolation.
    if (size(node) > 2) then
      associate (own => rule%distant(1))
        own%node = node
        own%weight = rule%weight
        own%far = distance_for(size(node))
        deallocate (own%basis)
      end associate
    end if
  end function new_panel_rule

  !> The element weights(j) is the integral of k(r, t) L_j(t) t dt over the panel of offsets [left,
  !> right], for a target at any offset `target` (inside, at an end, outside).
  pure subroutine panel_weights(rule, centre, target, left, right, weights)
    type(panel_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target, left, right
    real(wp), intent(out) :: weights(:)
    real(wp) :: gap, length
    integer :: k

    length = right - left
    gap = max(left - target, target - right)
    if (centre + target <= 0) then
      ! On the axis the kernel is 2/t, and its product with t is not singular.
      weights = 2*length*rule%weight
    else
      do k = 1, size(rule%distant)
        ! The rule has too few points for this order at any distance.
        if (rule%distant(k)%far >= never) cycle
        if (gap >= rule%distant(k)%far*length) then
          weights = undivided(rule%distant(k), centre, target, left, length, size(weights))
          return
        end if
      end do
      weights = 0
      if (target < right) weights = weights + &
        one_side(rule, centre, target, left, right, +1, max(left - target, 0.0_wp), right - target)
      if (target > left) weights = weights + &
        one_side(rule, centre, target, left, right, -1, max(target - right, 0.0_wp), target - left)
    end if
  end subroutine panel_weights

  !> The rule of n points for Lagrange polynomials through `node`.
  pure function new_distant_rule(node, barycentric, n) result(rule)
    real(wp), intent(in) :: node(:), barycentric(:)
    integer, intent(in) :: n
    type(distant_rule_t) :: rule
    integer :: k

    allocate (rule%node(n), rule%weight(n), rule%basis(size(node), n))
    call gauss_legendre(rule%node, rule%weight)
    do k = 1, n
      rule%basis(:, k) = lagrange_basis(node, barycentric, rule%node(k))
    end do
    rule%far = distance_for(2*n - size(node))
  end function new_distant_rule

  !> The distance, in panel lengths, at which a polynomial of the given degree approximates the
  !> kernel to 1e-14: the singularity is then on the Bernstein ellipse with rho**(-degree) = 1e-14.
  pure real(wp) function distance_for(degree)
    integer, intent(in) :: degree
    real(wp) :: rho

    distance_for = never
    if (degree < 4) return
    rho = 10.0_wp**(14.0_wp/degree)
    distance_for = (0.5_wp*(rho + 1/rho) - 1)/2
  end function distance_for

  !> The integrals over the whole panel by one rule.
  pure function undivided(rule, centre, target, left, length, nodes) result(weights)
    type(distant_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target, left, length
    integer, intent(in) :: nodes
    real(wp) :: weights(nodes)
    real(wp), dimension(size(rule%node)) :: t, f

    t = left + length*rule%node
    f = length*rule%weight*(centre + t)* &
      kernel(2*centre + target + t, abs((left - target) + length*rule%node))
    if (allocated(rule%basis)) then
      weights = matmul(rule%basis, f)
    else
      weights = f
    end if
  end function undivided

  !> The integrals over the part of the panel on one side of the target, from distance `near` to
  !> `finish`, in pieces that grow away from the target.
  pure function one_side(rule, centre, target, left, right, side, near, finish) result(weights)
    type(panel_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target, left, right, near, finish
    integer, intent(in) :: side
    real(wp) :: weights(size(rule%node))
    real(wp) :: from, to, r
    real(wp) :: s(inner_points), total(inner_points), f(inner_points), x(inner_points)
    logical :: singular
    integer :: k

    weights = 0
    r = centre + target
    from = near
    do while (from < finish)
      singular = from <= 0
      if (singular) then
        ! The piece is so short that the coefficient of the logarithm is analytic well beyond it.
        to = min(finish, merge(r, r/2, side > 0))
      else
        to = min(finish, reach*from)
      end if
      s = from + (to - from)*rule%inner
      total = 2*r + side*s
      f = rule%inner_weight*kernel(total, s)
      if (singular) f = f + kernel_log_coefficient(total, s)* &
        (rule%inner_weight*log(rule%inner) - rule%log_weight)
      f = f*(to - from)*(r + side*s)
      x = ((target - left) + side*s)/(right - left)
      do k = 1, inner_points
        weights = weights + f(k)*lagrange_basis(rule%node, rule%barycentric, x(k))
      end do
      from = to
    end do
  end function one_side

end module product_integration
