!> The matrix of the elastic kernel on mapped panels.
!>
!> Away from the axis the kernel's logarithm has a coefficient as smooth as the map is, and the
!> nodes' own rule with what it misses of the logarithm (`logarithm_defect`) integrates kernel and
!> pressure as exactly as the nodes resolve the pressure. At the axis the coefficient is singular
!> itself, and in a tail positions are: there points are graded towards the target (`graded_rule`).
module mapped_kernel
  use kinds, only: wp, pi
  use elastic_kernel, only: kernel, kernel_log_coefficient
  use linear_algebra, only: multiply_transposed
  use logarithm_defect, only: logarithm_defects, feels_logarithm
  use quadrature, only: gauss_legendre, legendre_values
  use panel_map, only: panel_map_t, sinh_map
  use graded_rule, only: graded_rule_t, new_graded_rule
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
  !> How far from the axis, in z, points are graded, and the part of a panel that stands for all.
  real(wp), parameter :: about_axis = 1.8_wp, nearly_all = 0.8_wp

contains

  !> matrix(i, j) f(j) summed over j is the integral of k(r, t) f(t) t dt over the panel, for
  !> r = centre + target(i) and f a polynomial of the panel's local coordinate, times the tail where
  !> it has one, that the nodes resolve. node, weight: of Gauss's rule on [0, 1]. own: the place of
  !> the panel's first node among the targets.
  subroutine add_panel(panel, node, weight, digits, centre, target, own, matrix)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: node(:), weight(:), digits, centre, target(:)
    integer, intent(in) :: own
    real(wp), intent(out) :: matrix(:, :)
    ! Integrals against Legendre polynomials, (order, targets); local coordinates of the targets.
    real(wp) :: moments(size(node), size(target)), place(size(target)), part
    integer :: k

    part = 1
    place = 0
    if (panel%kind == sinh_map) then
      place = panel%local(target)
      place(own:own + size(node) - 1) = node
      part = part_about_axis(panel, centre, size(node), digits)
      if (.not. part > 0) then
        matrix = transpose(values_on(panel, node, weight, 0.0_wp, digits, centre, target, place))
        return
      end if
    end if
    moments = 0
    call add_graded(panel, node, new_graded_rule(size(node), part, part*panel%z_length, digits), &
      centre, target, place, own, moments)
    if (part < 1) call add_rest(panel, part, digits, centre, target, place, moments)
    call multiply_transposed(moments, lagrange(node, weight), matrix)
    if (.not. panel%decay > 0) return
    do k = 1, size(node)
      matrix(:, k) = matrix(:, k)/(1 - node(k))**panel%decay
    end do
  end subroutine add_panel

  !> The part of a panel, from its left end, on which the axis is felt: where the logarithm's
  !> coefficient has one itself.
  pure real(wp) function part_about_axis(panel, centre, nodes, digits) result(part)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: centre, digits
    integer, intent(in) :: nodes
    real(wp) :: from_axis

    from_axis = max(0.0_wp, panel%z_left + asinh(centre/panel%d))
    part = 0
    if (from_axis < about_axis .and. feels_logarithm(from_axis/panel%z_length, nodes, digits)) &
      part = (about_axis - from_axis)/panel%z_length
    ! What little is left of a panel is not worth a rule of its own.
    if (part > nearly_all) part = 1
  end function part_about_axis

  !> Weights times kernel, (points, targets), for Gauss points s of the panel beyond the part.
  !> place: local coordinates of the targets.
  function values_on(panel, s, weight, part, digits, centre, target, place) result(f)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s(:), weight(:), part, digits, centre, target(:), place(:)
    real(wp) :: f(size(s), size(target))
    real(wp), dimension(size(s)) :: offset, t, speed, measure, a, total, distance
    real(wp), allocatable :: defect(:, :)
    logical :: near(size(target))
    integer :: i, j, k

    offset = panel%offset(s)
    t = centre + offset
    speed = (1 - part)*panel%speed(s)
    measure = t*speed
    near = feels_logarithm(max(part - place, place - 1, 0.0_wp)/(1 - part), size(s), digits)
    defect = logarithm_defects((s - part)/(1 - part), weight, (pack(place, near) - part)/(1 - part))
    j = 0
    do i = 1, size(target)
      total = 2*centre + target(i) + offset
      distance = abs(target(i) - offset)
      if (near(i)) then
        j = j + 1
        a = kernel_log_coefficient(total, distance)
        ! Of a point itself what is left of the kernel without its logarithm.
        k = minloc(abs(s - place(i)), 1)
        if (.not. abs(s(k) - place(i)) > 0) distance(k) = total(k)
        f(:, i) = measure*(weight*kernel(total, distance) + a*defect(:, j))
        if (.not. abs(s(k) - place(i)) > 0) &
          f(k, i) = measure(k)*a(k)*(weight(k)*log(8*t(k)/speed(k)) + defect(k, j))
      else
        f(:, i) = measure*weight*kernel(total, distance)
      end if
    end do
  end function values_on

  !> Adds the moments of the panel beyond the part about the axis.
  subroutine add_rest(panel, part, digits, centre, target, place, moments)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: part, digits, centre, target(:), place(:)
    real(wp), intent(inout) :: moments(:, :)
    real(wp), allocatable :: s(:), weight(:)
    real(wp) :: of_these(size(moments, 1), size(moments, 2))
    integer :: points

    ! Polynomials wave alike in this angle; the kernel and what they pass on to their neighbours
    ! need a few points more.
    points = ceiling(size(moments, 1)*(1 - acos(1 - 2*part)/pi) + 4 + 2*digits)
    allocate (s(points), weight(points))
    call gauss_legendre(s, weight)
    s = part + (1 - part)*s
    call multiply_transposed(legendre_values(s, size(moments, 1)), &
      values_on(panel, s, weight, part, digits, centre, target, place), of_these)
    moments = moments + of_these
  end subroutine add_rest

  !> Adds the moments of the rule's part of the panel. From a target beyond it that is no farther
  !> off than it is long points are graded too; on the axis the kernel is 2/t.
  subroutine add_graded(panel, node, rule, centre, target, place, own, moments)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: node(:), centre, target(:), place(:)
    integer, intent(in) :: own
    real(wp), intent(inout) :: moments(:, :)
    integer :: beyond(size(target) - count(node < rule%part)), inside, k
    logical :: far(size(target) - count(node < rule%part))

    inside = count(node < rule%part)
    beyond = [(k, k=1, own - 1), (k, k=own + inside, size(target))]
    do k = 1, inside
      call add_points(node(k), -node(k), [own + k - 1])
      call add_points(node(k), rule%part - node(k), [own + k - 1])
    end do
    if (size(rule%plain) == 0) then
      call add_points(0.0_wp, 1.0_wp, beyond)
      return
    end if
    associate (at => place(beyond))
      far = centre + target(beyond) <= 0 .or. at < -rule%part .or. at > 2*rule%part
      call add_points(0.0_wp, rule%part, pack(beyond, .not. far .and. at <= 0))
      call add_points(rule%part, -rule%part, pack(beyond, .not. far .and. at > 0))
    end associate
    call add_plain(pack(beyond, far))

  contains

    !> From points graded towards a place of the panel, over `length` after it or, below zero,
    !> before it.
    subroutine add_points(from, length, which)
      real(wp), intent(in) :: from, length
      integer, intent(in) :: which(:)
      type(points_t) :: points
      real(wp) :: f(size(rule%step), size(which)), gap
      integer :: j

      if (size(which) == 0) return
      points = points_from(panel, rule, centre, from, length)
      do j = 1, size(which)
        gap = 0
        if (which(j) < own .or. which(j) >= own + inside) &
          gap = abs(target(which(j)) - panel%offset(from))
        f(:, j) = points%weight*kernel(centre + target(which(j)) + points%t, gap + points%distance)
      end do
      call add(legendre_values(from + length*rule%step, size(node)), f, which)
    end subroutine add_points

    !> From the plain points.
    subroutine add_plain(which)
      integer, intent(in) :: which(:)
      real(wp) :: f(size(rule%plain), size(which))
      real(wp), dimension(size(rule%plain)) :: offset, weight
      integer :: j

      offset = panel%offset(rule%plain)
      weight = rule%plain_weight*panel%speed(rule%plain)*(centre + offset)
      do j = 1, size(which)
        f(:, j) = weight*kernel(2*centre + target(which(j)) + offset, &
          abs(target(which(j)) - offset))
      end do
      call add(legendre_values(rule%plain, size(node)), f, which)
    end subroutine add_plain

    subroutine add(legendre, f, which)
      real(wp), intent(in) :: legendre(:, :), f(:, :)
      integer, intent(in) :: which(:)
      real(wp) :: of_these(size(node), size(which))

      call multiply_transposed(legendre, f, of_these)
      moments(:, which) = moments(:, which) + of_these
    end subroutine add

  end subroutine add_graded

  !> (m, j): part of the Legendre polynomial of degree m - 1 in the Lagrange polynomial of node j.
  !> The nodes' own rule is exact for products of two polynomials of theirs.
  pure function lagrange(node, weight)
    real(wp), intent(in) :: node(:), weight(:)
    real(wp) :: lagrange(size(node), size(node))
    integer :: m

    lagrange = transpose(legendre_values(node, size(node)))
    do m = 1, size(node)
      lagrange(m, :) = (2*m - 1)*weight*lagrange(m, :)
    end do
  end function lagrange

  !> Points graded towards the place `from`, over `length` of the panel after it or, below zero,
  !> before it.
  pure function points_from(panel, rule, centre, from, length) result(points)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, from, length
    type(points_t) :: points
    real(wp), dimension(size(rule%step)) :: growth, chord
    real(wp) :: z

    if (panel%kind == sinh_map) then
      z = panel%z_left + panel%z_length*from
      call exponentials(0.5_wp*panel%z_length*abs(length)*rule%step, growth, chord)
      points = points_along_sinh(panel%d, exp(sign(1.0_wp, length)*z), growth, chord)
      points%t = centre + panel%d*sinh(z) + sign(1.0_wp, length)*points%distance
      points%weight = points%weight*panel%z_length*abs(length)*rule%step_weight*points%t
    else
      points = points_of_tail(panel, from, length*rule%step, abs(length)*rule%step_weight)
    end if
  end function points_from

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
