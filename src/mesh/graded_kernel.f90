!> Integrals of the elastic kernel over a part of a panel, by quadrature points graded towards the
!> target.
!>
!> The points are Gauss points in v, with distance = length*v**power. A logarithm at distance 0 then
!> becomes as smooth as v**(power - 1) ln(v). A singularity at a small distance stays away from the
!> points in proportion to their spacing. Plain Gauss points are enough for distant targets.
module graded_kernel
  use kinds, only: wp, pi
  use elastic_kernel, only: kernel
  use matrix_products, only: multiply_left, multiply_transposed
  use quadrature, only: gauss_legendre, legendre_values
  use panel_map, only: panel_map_t, linear_map, sinh_map, power_map, algebraic_map
  implicit none
  private
  public :: add_graded

  !> Exponent of the substitution, and number of points for which the error of the integral of
  !> v**(power - 1) ln(v) is of the order of one. With n points the error is proportional to
  !> n**(-2*power).
  integer, parameter :: power = 4
  real(wp), parameter :: least_graded = 1.75_wp
  !> Number of graded points, and of plain points, for each degree of the nodes' polynomials; number
  !> of additional plain points.
  real(wp), parameter :: graded_share = 1.4_wp, plain_share = 0.5_wp
  integer, parameter :: least_plain = 3
  !> Additional digits on a linear panel, where the polynomials of the highest degrees count as
  !> well.
  real(wp), parameter :: for_linear = 1
  !> Length in z of a sinh panel that needs as many points as a power panel.
  real(wp), parameter :: length_of_power = 8
  !> Below this argument the series of sinh is exact, and the difference of exponentials cancels.
  real(wp), parameter :: small = 0.5_wp

  type :: graded_rule_t
    !> The end of the part of the panel, which begins at the panel's left end.
    real(wp) :: part = 1
    !> Points and weights of the substitution on [0, 1].
    real(wp), allocatable :: step(:), step_weight(:)
    !> Plain points on the part, and their weights; none on a tail.
    real(wp), allocatable :: plain(:), plain_weight(:)
  end type graded_rule_t

contains

  !> Adds the integrals of the kernel times Legendre polynomials, (degree + 1, target), with an
  !> accuracy of `digits` digits. They are over the part of the panel from its left end to the local
  !> coordinate `part`, for targets at r = centre + target(i). Points are graded also towards a
  !> target outside the part, if its distance is at most the length of the part; on the axis the
  !> kernel is 2/t. place: local coordinates of the targets, which are exact for targets on the
  !> panel.
  subroutine add_graded(panel, part, digits, centre, target, place, moments)
    type(panel_map_t), intent(in) :: panel
    real(wp), intent(in) :: part, digits, centre, target(:), place(:)
    real(wp), intent(inout) :: moments(:, :)
    type(graded_rule_t) :: rule
    logical, dimension(size(target)) :: inside, far
    ! Graded points: distances from the place towards which they are graded, positions, weights.
    real(wp), allocatable, dimension(:) :: distance, t, weight
    integer :: k

    rule = new_graded_rule(panel, size(moments, 1), part, digits)
    allocate (distance(size(rule%step)), t(size(rule%step)), weight(size(rule%step)))
    inside = place >= 0 .and. place < part .and. centre + target > 0
    do k = 1, size(target)
      if (.not. inside(k)) cycle
      call add_points(place(k), -place(k), [k])
      call add_points(place(k), part - place(k), [k])
    end do
    far = .not. inside
    if (size(rule%plain) == 0) then
      call add_points(0.0_wp, 1.0_wp, chosen(far))
      return
    end if
    far = far .and. (centre + target <= 0 .or. place < -part .or. place > 2*part)
    call add_points(0.0_wp, part, chosen(.not. (inside .or. far) .and. place <= 0))
    call add_points(part, -part, chosen(.not. (inside .or. far) .and. place > 0))
    call add_plain(chosen(far))

  contains

    pure function chosen(mask) result(which)
      logical, intent(in) :: mask(:)
      integer, allocatable :: which(:)
      integer :: i

      which = pack([(i, i=1, size(mask))], mask)
    end function chosen

    !> Adds the integrals with points graded towards a place of the panel, over `length` after it
    !> or, if negative, before it.
    subroutine add_points(from, length, which)
      real(wp), intent(in) :: from, length
      integer, intent(in) :: which(:)
      real(wp) :: f(size(rule%step), size(which)), gap
      integer :: j

      if (size(which) == 0 .or. .not. abs(length) > 0) return
      call find_points(panel, rule, centre, from, length, distance, t, weight)
      do j = 1, size(which)
        gap = 0
        if (.not. inside(which(j))) gap = abs(target(which(j)) - panel%offset(from))
        f(:, j) = weight*kernel(centre + target(which(j)) + t, gap + distance)
      end do
      call add(legendre_values(from + length*rule%step, size(moments, 1)), f, which)
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
      call add(legendre_values(rule%plain, size(moments, 1)), f, which)
    end subroutine add_plain

    subroutine add(legendre, f, which)
      real(wp), intent(in) :: legendre(:, :), f(:, :)
      integer, intent(in) :: which(:)
      real(wp) :: of_these(size(moments, 1), size(which))

      if (size(which) == 1) then
        call multiply_left(f(:, 1), legendre, of_these(:, 1))
      else
        call multiply_transposed(legendre, f, of_these)
      end if
      moments(:, which) = moments(:, which) + of_these
    end subroutine add

  end subroutine add_graded

  !> Rule for a part of a panel and `order` polynomials, with an accuracy of `digits` digits.
  pure function new_graded_rule(panel, order, part, digits) result(rule)
    type(panel_map_t), intent(in) :: panel
    integer, intent(in) :: order
    real(wp), intent(in) :: part, digits
    type(graded_rule_t) :: rule
    real(wp), allocatable :: v(:), v_weight(:)
    real(wp) :: sought, degrees, clear, z_length
    integer :: points

    rule%part = part
    sought = digits
    if (panel%kind == linear_map) sought = digits + for_linear
    z_length = part*panel%z_length
    if (panel%kind == power_map) z_length = length_of_power
    ! The part's share of the degrees: polynomials oscillate uniformly in this angle.
    degrees = order*acos(1 - 2*part)/pi
    ! The kernel is singular at t = r and at t = -r. The latter is as near to the axis as ln(2) in
    ! z, and near the axis the substitution has the fewest points.
    clear = log(2.0_wp)/max(z_length, 1.0_wp)
    points = ceiling(max(least_graded*10.0_wp**(sought/(2*power)), &
      graded_share*degrees + points_against(1 + sqrt(clear), sought)))
    allocate (v(points), v_weight(points))
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight

    clear = min(1.0_wp, clear)
    points = merge(least_plain + ceiling(plain_share*degrees + &
      points_against(1 + 2*clear + 2*sqrt(clear*(1 + clear)), sought)), 0, &
      panel%kind /= algebraic_map)
    allocate (rule%plain(points), rule%plain_weight(points))
    if (points > 0) call gauss_legendre(rule%plain, rule%plain_weight)
    rule%plain = part*rule%plain
    rule%plain_weight = part*rule%plain_weight
  end function new_graded_rule

  !> Number of Gauss points for an integrand with a singularity on the Bernstein ellipse of this sum
  !> of half axes.
  elemental real(wp) function points_against(ellipse, digits) result(points)
    real(wp), intent(in) :: ellipse, digits

    points = digits*log(10.0_wp)/(2*log(ellipse))
  end function points_against

  !> Points graded towards the place `from`, over `length` of the panel after this place or, if
  !> negative, before it. They are given by their distances from the place, their positions, and
  !> weights for integrals of f t dt, with f a tail times a polynomial.
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
    else if (panel%kind == linear_map) then
      distance = (panel%right - panel%left)*abs(length)*rule%step
      t = centre + panel%offset(from) + sign(1.0_wp, length)*distance
      weight = (panel%right - panel%left)*abs(length)*rule%step_weight*t
    else if (panel%kind == power_map) then
      call place_on_power(panel, from, length, rule%step, distance, t, weight)
      weight = weight*abs(length)*rule%step_weight
    else
      call place_in_tail(panel, from, length, rule%step, distance, t, weight)
      weight = weight*abs(length)*rule%step_weight
    end if
  end subroutine find_points

  !> Points along offset = d sinh(z), from z0 to z0 + delta, with delta = 2 half step > 0. The
  !> distances are d (sinh(z0 + delta) - sinh(z0)); the weights are the derivative of the map by z.
  !> grown: exp(z0). The distance contains 2 sinh(delta/2), so that there is no cancellation.
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
