!> The matrix of the elastic kernel on mapped panels.
module mapped_kernel
  use kinds, only: wp
  use elastic_kernel, only: kernel
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
    type(points_t) :: from_left, from_right, before, after
    real(wp) :: r
    integer :: i, k

    associate (n => rule%order)
      from_left = points_from_end(panel, rule, centre, .true.)
      if (panel%right < huge(1.0_wp)) from_right = points_from_end(panel, rule, centre, .false.)
      do i = 1, size(target)
        r = centre + target(i)
        k = i - own + 1
        if (k >= 1 .and. k <= n) then
          after = points_from_node(panel, rule, centre, k, .true.)
          before = points_from_node(panel, rule, centre, k, .false.)
          matrix(i, :) = matmul(rule%after(:, :, k), integrand(after, r, 0.0_wp)) + &
            reversed(matmul(rule%after(:, :, n + 1 - k), integrand(before, r, 0.0_wp)))
        else if (target(i) <= panel%left) then
          matrix(i, :) = matmul(rule%basis, integrand(from_left, r, panel%left - target(i)))
        else
          matrix(i, :) = reversed(matmul(rule%basis, &
            integrand(from_right, r, target(i) - panel%right)))
        end if
      end do
      if (panel%decay > 0) then
        do k = 1, n
          matrix(:, k) = matrix(:, k)/(1 - rule%node(k))**panel%decay
        end do
      end if
    end associate
  end subroutine add_panel

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
    real(wp) :: z

    if (panel%kind /= sinh_map) then
      points = points_of_tail(panel, 0.0_wp, rule%step, rule%step_weight)
      return
    end if
    z = merge(panel%z_left, -(panel%z_left + panel%z_length), left)
    points = points_along_sinh(panel%d, exp(z), rule%end_growth, rule%end_chord)
    ! On the axis centre and end cancel, and the distance is the position.
    points%t = merge((centre + panel%left) + points%distance, &
      (centre + panel%right) - points%distance, left)
    points%weight = points%weight*panel%z_length*rule%step_weight*points%t
  end function points_from_end

  !> Points graded towards node k, after it or before it.
  pure function points_from_node(panel, rule, centre, k, after) result(points)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre
    integer, intent(in) :: k
    logical, intent(in) :: after
    type(points_t) :: points
    real(wp) :: z, length
    integer :: image

    image = merge(k, rule%order + 1 - k, after)
    length = 1 - rule%node(image)
    if (panel%kind == sinh_map) then
      z = panel%z_left + panel%z_length*rule%node(k)
      points = points_along_sinh(panel%d, exp(merge(z, -z, after)), rule%growth(:, image), &
        rule%chord(:, image))
      points%t = centre + panel%d*sinh(z) + merge(points%distance, -points%distance, after)
      points%weight = points%weight*panel%z_length*length*rule%step_weight*points%t
    else
      points = points_of_tail(panel, rule%node(k), merge(length, -length, after)*rule%step, &
        length*rule%step_weight)
    end if
  end function points_from_node

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

  pure function reversed(values)
    real(wp), intent(in) :: values(:)
    real(wp) :: reversed(size(values))

    reversed = values(size(values):1:-1)
  end function reversed

end module mapped_kernel
