!> Integrals of the elastic kernel over the part of a panel near the axis, or over a tail, by
!> quadrature points graded towards the target.
module graded_kernel
  use kinds, only: wp
  use elastic_kernel, only: kernel
  use linear_algebra, only: multiply_left, multiply_transposed
  use quadrature, only: legendre_values
  use panel_map, only: panel_map_t, sinh_map, power_map
  use graded_rule, only: graded_rule_t
  implicit none
  private
  public :: add_graded

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
    ! Graded points: distances from the place towards which they are graded, positions, weights.
    real(wp), dimension(size(rule%step)) :: distance, t, weight

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
      real(wp) :: f(size(rule%step), size(which)), gap
      integer :: j

      if (size(which) == 0) return
      call find_points(panel, rule, centre, from, length, distance, t, weight)
      do j = 1, size(which)
        gap = 0
        if (which(j) < own .or. which(j) >= own + inside) &
          gap = abs(target(which(j)) - panel%offset(from))
        f(:, j) = weight*kernel(centre + target(which(j)) + t, gap + distance)
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

      if (size(which) == 1) then
        call multiply_left(f(:, 1), legendre, of_these(:, 1))
      else
        call multiply_transposed(legendre, f, of_these)
      end if
      moments(:, which) = moments(:, which) + of_these
    end subroutine add

  end subroutine add_graded

  !> Points graded towards the place `from`, over `length` of the panel after it or, if negative,
  !> before it: distances from the place, positions, and weights for integrals of f t dt, with f a
  !> tail times a polynomial.
  pure subroutine find_points(panel, rule, centre, from, length, distance, t, weight)
    type(panel_map_t), intent(in) :: panel
    type(graded_rule_t), intent(in) :: rule
    real(wp), intent(in) :: centre, from, length
    real(wp), intent(out) :: distance(:), t(:), weight(:)
    real(wp) :: z, z_length

    if (panel%kind == sinh_map) then
      z = panel%z_left + panel%z_length*from
      z_length = panel%z_length*abs(length)
      call place_along_sinh(panel%d, exp(sign(1.0_wp, length)*z), 0.5_wp*z_length, rule%step, &
        distance, weight)
      t = centre + panel%focus + panel%d*sinh(z) + sign(1.0_wp, length)*distance
      weight = weight*z_length*rule%step_weight*t
    else if (panel%kind == power_map) then
      call place_on_power(panel, from, length, rule%step, distance, t, weight)
      weight = weight*abs(length)*rule%step_weight
    else
      call place_in_tail(panel, from, length, rule%step, distance, t, weight)
      weight = weight*abs(length)*rule%step_weight
    end if
  end subroutine find_points

  !> Points along offset = d sinh(z), from z0 to z0 + delta with delta = 2 half step > 0: distances
  !> d (sinh(z0 + delta) - sinh(z0)) and, as weights, the derivative of the map by z. grown:
  !> exp(z0). The distance contains 2 sinh(delta/2), so that there is no cancellation.
  pure subroutine place_along_sinh(d, grown, half, step, distance, weight)
    real(wp), intent(in) :: d, grown, half, step(:)
    real(wp), intent(out) :: distance(:), weight(:)
    real(wp) :: x, growth, chord, middle
    integer :: i, k

    do i = 1, size(step)
      x = half*step(i)
      growth = exp(x)
      chord = 1
      do k = 15, 3, -2
        chord = 1 + chord*(x**2*(1.0_wp/(k*(k - 1))))
      end do
      chord = merge(2*x*chord, growth - 1/growth, x < small)
      middle = grown*growth
      distance(i) = 0.5_wp*d*chord*(middle + 1/middle)
      middle = middle*growth
      weight(i) = 0.5_wp*d*(middle + 1/middle)
    end do
  end subroutine place_along_sinh

  !> Points on a power panel from s to s + length. The distance is a sum of positive terms: a**n -
  !> b**n = (a - b) (a**(n - 1) + a**(n - 2) b + ... + b**(n - 1)).
  pure subroutine place_on_power(panel, s, length, step, distance, t, weight)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s, length, step(:)
    real(wp), intent(out) :: distance(:), t(:), weight(:)
    integer :: k

    associate (to => s + length*step, long => panel%right - panel%left, n => panel%power)
      t = long*to**n
      distance = 0
      do k = 0, n - 1
        distance = distance + s**(n - 1 - k)*to**k
      end do
      distance = long*abs(length*step)*distance
      weight = n*long*to**(n - 1)*t
    end associate
  end subroutine place_on_power

  !> Points in the tail from s to s + length: position = begin/(1 - s).
  pure subroutine place_in_tail(panel, s, length, step, distance, t, weight)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: s, length, step(:)
    real(wp), intent(out) :: distance(:), t(:), weight(:)

    weight = (1 - s) - length*step
    t = panel%begin/weight
    distance = abs(length*step)*t/(1 - s)
    weight = panel%begin**2*weight**(panel%decay - 3)
  end subroutine place_in_tail

end module graded_kernel
