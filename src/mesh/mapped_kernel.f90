!> The matrix of the elastic kernel on mapped panels.
module mapped_kernel
  use kinds, only: wp
  use elastic_kernel, only: kernel
  use linear_algebra, only: multiply_transposed
  use quadrature, only: legendre_values
  use panel_map, only: panel_map_t, sinh_map
  use graded_rule, only: graded_rule_t
  implicit none
  private
  public :: add_panel

  !> Points of a panel, graded towards a place: distances from it, positions, and weights for
  !> integrals of f t dt in which f is a tail times a polynomial.
  type :: points_t
    real(wp), allocatable :: distance(:), t(:), weight(:)
  end type points_t

  !> Below it the series of sinh is exact, and exponentials cancel.
  real(wp), parameter :: small = 0.5_wp

contains

  !> matrix(i, j) = integral of k(r, t) b_j(t) t dt over the panel, for r = centre + target(i) and
  !> the j-th of its basis functions: Lagrange polynomials of its local coordinate on the rule's
  !> nodes, times the tail where it has one. own: the place of its first node among the targets.
  subroutine add_panel(panel, rule, centre, target, own, matrix)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target(:)
    integer, intent(in) :: own
    real(wp), intent(out) :: matrix(:, :)
    ! Integrals against Legendre polynomials, (order, targets).
    real(wp) :: moments(rule%order, size(target)), legendre(size(rule%step), rule%order)
    integer, allocatable :: others(:)
    integer :: i, k

    moments = 0
    if (rule%cells > 1) call add_far(panel, rule, centre, target, own, moments)
    call add_nodes(panel, rule, centre, target, own, moments)
    legendre = legendre_values(rule%reach()*rule%step, rule%order)
    others = [(i, i=1, own - 1), (i, i=own + rule%order, size(target))]
    call add_others(.true., pack(others, target(others) <= panel%left))
    call add_others(.false., pack(others, .not. target(others) <= panel%left))
    call multiply_transposed(moments, rule%lagrange, matrix)
    if (.not. panel%decay > 0) return
    do k = 1, rule%order
      matrix(:, k) = matrix(:, k)/(1 - rule%node(k))**panel%decay
    end do

  contains

    !> Moments of targets that are beyond the left end or the right one.
    subroutine add_others(left, which)
      logical, intent(in) :: left
      integer, intent(in) :: which(:)
      type(points_t) :: points
      real(wp) :: f(size(rule%step), size(which)), of_these(rule%order, size(which)), gap
      integer :: j

      if (size(which) == 0) return
      points = points_from_end(panel, rule, centre, left)
      do j = 1, size(which)
        gap = merge(panel%left - target(which(j)), target(which(j)) - panel%right, left)
        f(:, j) = integrand(points, centre + target(which(j)), gap)
      end do
      call multiply_transposed(legendre, f, of_these)
      do j = 1, size(which)
        if (.not. left) of_these(:, j) = rule%parity*of_these(:, j)
        moments(:, which(j)) = moments(:, which(j)) + of_these(:, j)
      end do
    end subroutine add_others

  end subroutine add_panel

  !> Adds what the cells far from a target give: for targets beyond an end, all but those near it.
  subroutine add_far(panel, rule, centre, target, own, moments)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target(:)
    integer, intent(in) :: own
    real(wp), intent(inout) :: moments(:, :)
    real(wp) :: f(size(rule%far), size(target)), of_these(rule%order, size(target))
    real(wp), dimension(size(rule%far)) :: offset, weight
    integer :: i, last_before, first_after

    offset = panel%offset(rule%far)
    weight = rule%far_weight*panel%speed(rule%far)*(centre + offset)
    do i = 1, size(target)
      call rule%far_from(i - own + 1, target(i) <= panel%left, last_before, first_after)
      call fill(f(:last_before, i), 1, last_before)
      f(last_before + 1:first_after - 1, i) = 0
      call fill(f(first_after:, i), first_after, size(offset))
    end do
    call multiply_transposed(legendre_values(rule%far, rule%order), f, of_these)
    moments = moments + of_these

  contains

    !> Weights times kernel of the points from `first` to `last`.
    subroutine fill(part, first, last)
      real(wp), intent(out) :: part(:)
      integer, intent(in) :: first, last

      part = weight(first:last)*kernel(2*centre + target(i) + offset(first:last), &
        abs(target(i) - offset(first:last)))
    end subroutine fill

  end subroutine add_far

  !> Moments of what is near the panel's own nodes: the part after node k and, its mirror image, the
  !> part before the image of node k have their points at the same local distances.
  subroutine add_nodes(panel, rule, centre, target, own, moments)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, target(:)
    integer, intent(in) :: own
    real(wp), intent(inout) :: moments(:, :)
    real(wp) :: f(size(rule%step), 2), of_both(rule%order, 2)
    real(wp) :: legendre(size(rule%step), rule%order), length
    real(wp), dimension(size(rule%step)) :: growth, chord
    integer :: k, image

    do k = 1, rule%order
      image = rule%order + 1 - k
      length = real(rule%last_near(k), wp)/rule%cells - rule%node(k)
      if (panel%kind == sinh_map) &
        call exponentials(0.5_wp*panel%z_length*length*rule%step, growth, chord)
      legendre = legendre_values(rule%node(k) + length*rule%step, rule%order)
      f(:, 1) = integrand(points_from_node(panel, rule, centre, k, length, growth, chord), &
        centre + target(own + k - 1), 0.0_wp)
      f(:, 2) = integrand(points_from_node(panel, rule, centre, image, -length, growth, chord), &
        centre + target(own + image - 1), 0.0_wp)
      call multiply_transposed(legendre, f, of_both)
      moments(:, own + k - 1) = moments(:, own + k - 1) + of_both(:, 1)
      moments(:, own + image - 1) = moments(:, own + image - 1) + rule%parity*of_both(:, 2)
    end do
  end subroutine add_nodes

  !> Weights times kernel for the target at r, which is `gap` away from where the points begin.
  pure function integrand(points, r, gap) result(f)
    type(points_t), intent(in) :: points
    real(wp), intent(in) :: r, gap
    real(wp) :: f(size(points%t))

    f = points%weight*kernel(r + points%t, gap + points%distance)
  end function integrand

  !> Points graded towards the left or the right end.
  pure function points_from_end(panel, rule, centre, left) result(points)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre
    logical, intent(in) :: left
    type(points_t) :: points
    real(wp), dimension(size(rule%step)) :: growth, chord
    real(wp) :: z

    if (panel%kind /= sinh_map) then
      points = points_of_tail(panel, 0.0_wp, rule%step, rule%step_weight)
      return
    end if
    z = merge(panel%z_left, -(panel%z_left + panel%z_length), left)
    call exponentials(0.5_wp*panel%z_length*rule%reach()*rule%step, growth, chord)
    points = points_along_sinh(panel%d, exp(z), growth, chord)
    ! On the axis centre and end cancel, and the distance is the position.
    points%t = merge((centre + panel%left) + points%distance, &
      (centre + panel%right) - points%distance, left)
    points%weight = points%weight*panel%z_length*rule%reach()*rule%step_weight*points%t
  end function points_from_end

  !> Points graded towards node k: over the part `length` of the panel after it or, below zero,
  !> before it. growth, chord: their `exponentials` on a panel mapped by sinh.
  pure function points_from_node(panel, rule, centre, k, length, growth, chord) result(points)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, length, growth(:), chord(:)
    integer, intent(in) :: k
    type(points_t) :: points
    real(wp) :: z

    if (panel%kind == sinh_map) then
      z = panel%z_left + panel%z_length*rule%node(k)
      points = points_along_sinh(panel%d, exp(sign(1.0_wp, length)*z), growth, chord)
      points%t = centre + panel%d*sinh(z) + sign(1.0_wp, length)*points%distance
      points%weight = points%weight*panel%z_length*abs(length)*rule%step_weight*points%t
    else
      points = points_of_tail(panel, rule%node(k), length*rule%step, abs(length)*rule%step_weight)
    end if
  end function points_from_node

  !> exp(x) and 2 sinh(x) of x > 0, without cancellation.
  pure subroutine exponentials(x, growth, chord)
    real(wp), intent(in) :: x(:)
    real(wp), intent(out) :: growth(:), chord(:)
    real(wp), dimension(size(x)) :: square
    integer :: k

    growth = exp(x)
    square = x**2
    chord = 1
    do k = 15, 3, -2
      chord = 1 + chord*(square*(1.0_wp/(k*(k - 1))))
    end do
    chord = merge(2*x*chord, growth - 1/growth, x < small)
  end subroutine exponentials

  !> Along offset = d sinh(z) from z0 by delta > 0: distances d (sinh(z0 + delta) - sinh(z0)) and,
  !> as weights, the map's derivative by z; of exp(z0), exp(delta/2) and 2 sinh(delta/2), so that
  !> nothing cancels. Positions are left to the caller.
  pure function points_along_sinh(d, grown, growth, chord) result(points)
    real(wp), intent(in) :: d, grown, growth(:), chord(:)
    type(points_t) :: points
    real(wp), dimension(size(growth)) :: middle

    middle = grown*growth
    points%distance = 0.5_wp*d*chord*(middle + 1/middle)
    middle = middle*growth
    points%weight = 0.5_wp*d*(middle + 1/middle)
  end function points_along_sinh

  !> In the tail from s by `by` (either sign): position = begin/(1 - s).
  pure function points_of_tail(panel, s, by, weight) result(points)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s, by(:), weight(:)
    type(points_t) :: points
    real(wp) :: left(size(by))

    left = (1 - s) - by
    points%t = panel%begin/left
    points%distance = abs(by)*points%t/(1 - s)
    points%weight = weight*panel%begin**2*left**(panel%decay - 3)
  end function points_of_tail

end module mapped_kernel
