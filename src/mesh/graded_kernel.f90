!> Integrals of the elastic kernel over the part of a panel near the axis, or over a tail, by
!> quadrature points graded towards the target.
module graded_kernel
  use kinds, only: wp
  use elastic_kernel, only: kernel
  use linear_algebra, only: multiply_transposed
  use quadrature, only: legendre_values
  use panel_map, only: panel_map_t, sinh_map, power_map
  use graded_rule, only: graded_rule_t
  implicit none
  private
  public :: add_graded

  !> Quadrature points of a panel, graded towards a place: distances from the place, positions, and
  !> weights for integrals of f t dt, with f a tail times a polynomial.
  type :: points_t
    real(wp), allocatable :: distance(:), t(:), weight(:)
  end type points_t

  !> Below this argument the series of sinh is exact, and the difference of exponentials cancels.
  real(wp), parameter :: small = 0.5_wp

contains

  !> Adds the integrals of the kernel against Legendre polynomials, (degree + 1, target), over the
  !> rule's part of the panel, for targets at r = centre + target(i). Points are graded also towards
  !> a target outside the part, if its distance is at most the length of the part; on the axis the
  !> kernel is 2/t. place: local coordinates of the targets; own: index of the panel's first node
  !> among the targets.
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

    !> Adds the integrals with points graded towards a place of the panel, over `length` after it
    !> or, if negative, before it.
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

    !> Adds the integrals with plain points.
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

  !> Points graded towards the place `from`, over `length` of the panel after it or, if negative,
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
    else if (panel%kind == power_map) then
      points = points_of_power(panel, from, length*rule%step, abs(length)*rule%step_weight)
    else
      points = points_of_tail(panel, from, length*rule%step, abs(length)*rule%step_weight)
    end if
  end function points_from

  !> exp(x) and 2 sinh(x) for x > 0, without cancellation.
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

  !> Points along offset = d sinh(z), from z0 to z0 + delta with delta > 0: distances d (sinh(z0 +
  !> delta) - sinh(z0)) and, as weights, the derivative of the map by z. The arguments are exp(z0),
  !> exp(delta/2) and 2 sinh(delta/2), so that there is no cancellation. The positions are not set.
  pure function points_along_sinh(d, grown, growth, chord) result(points)
    real(wp), intent(in) :: d, grown, growth(:), chord(:)
    type(points_t) :: points
    real(wp), dimension(size(growth)) :: middle

    middle = grown*growth
    points%distance = 0.5_wp*d*chord*(middle + 1/middle)
    middle = middle*growth
    points%weight = 0.5_wp*d*(middle + 1/middle)
  end function points_along_sinh

  !> Points on a power panel from s to s + by (by of either sign). The distance is a sum of positive
  !> terms: a**n - b**n = (a - b) (a**(n - 1) + a**(n - 2) b + ... + b**(n - 1)).
  pure function points_of_power(panel, s, by, weight) result(points)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s, by(:), weight(:)
    type(points_t) :: points
    integer :: k

    associate (to => s + by, long => panel%right - panel%left, n => panel%power)
      points%t = long*to**n
      points%distance = 0*by
      do k = 0, n - 1
        points%distance = points%distance + s**(n - 1 - k)*to**k
      end do
      points%distance = long*abs(by)*points%distance
      points%weight = weight*n*long*to**(n - 1)*points%t
    end associate
  end function points_of_power

  !> Points in the tail from s to s + by (by of either sign): position = begin/(1 - s).
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

end module graded_kernel
