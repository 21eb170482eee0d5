!> Gauss-Legendre rules, the companion rule for a logarithm at the left end, and barycentric
!> weights. Rules for integrals over wave numbers k of a smooth function times
!> products of waves, cos(k x) or J0(k x), at several abscissas x, each with a largest wave number
!> that matters.
module quadrature
  use kinds, only: wp, pi
  implicit none
  private
  public :: gauss_legendre, legendre_values, logarithm_weights, barycentric_weights, &
    wave_rule

  !> Ratio of the ends of panels that are short against the wavelengths.
  real(wp), parameter :: ratio = 3
  !> After a step to the roots that is at most this, their errors and those of the slopes there are
  !> below rounding.
  real(wp), parameter :: last_step = 1.0e-10_wp

contains

  !> Nodes (ascending) and weights of the rule of size(x) points on [0, 1];
  !> exact for polynomials of degree 2 size(x) - 1.
  pure subroutine gauss_legendre(x, w)
    real(wp), intent(out) :: x(:), w(:)
    real(wp), dimension((size(x) + 1)/2) :: z, value, slope, curvature, step
    integer :: i, n, iteration

    n = size(x)
    ! Tricomi's estimate of the roots in [0, 1), largest first.
    z = [((1 - (1 - 1.0_wp/n)/(8.0_wp*n**2))*cos(pi*(i - 0.25_wp)/(n + 0.5_wp)), i=1, size(z))]
    do iteration = 1, 20
      call legendre(n, z, value, slope)
      ! Legendre's equation has the second derivative. With it, the iteration converges cubically.
      curvature = (2*z*slope - n*(n + 1)*value)/(1 - z**2)
      step = value/slope*(1 + 0.5_wp*value*curvature/slope**2)
      z = z - step
      if (maxval(abs(step)) <= last_step) exit
    end do
    slope = slope - step*curvature
    do i = 1, size(z)
      x(i) = 0.5_wp*(1 - z(i))
      x(n + 1 - i) = 0.5_wp*(1 + z(i))
      w(i) = 1/((1 - z(i)**2)*slope(i)**2)
      w(n + 1 - i) = w(i)
    end do
  end subroutine gauss_legendre

  !> values(i, m): the Legendre polynomial of degree m - 1, shifted to [0, 1], at x(i), for degrees
  !> below `count`.
  pure function legendre_values(x, count) result(values)
    real(wp), intent(in) :: x(:)
    integer, intent(in) :: count
    real(wp) :: values(size(x), count), z(size(x)), forward
    integer :: m

    z = 2*x - 1
    values(:, 1) = 1
    if (count > 1) values(:, 2) = z
    do m = 2, count - 1
      forward = (2*m - 1)*(1.0_wp/m)
      values(:, m + 1) = forward*z*values(:, m) - (forward - 1)*values(:, m - 1)
    end do
  end function legendre_values

  !> Weights v for the Gauss-Legendre nodes x of [0, 1], whose own weights are w. For every
  !> polynomial f of degree below size(x), sum(v*f(x)) is the integral of f(s) ln(s) over [0, 1]. To
  !> find v, f is expanded in shifted Legendre polynomials. The integral of such a polynomial times
  !> ln(s) is -1 for degree 0 and (-1)**(m+1)/(m(m+1)) for degree m.
  pure function logarithm_weights(x, w) result(v)
    real(wp), intent(in) :: x(:), w(:)
    real(wp) :: v(size(x)), before(size(x)), now(size(x)), next(size(x)), z(size(x))
    integer :: m

    z = 2*x - 1
    before = 0
    now = 1
    v = -w
    do m = 1, size(x) - 1
      next = ((2*m - 1)*z*now - (m - 1)*before)/m
      before = now
      now = next
      v = v + w*(2*m + 1)*now*real((-1)**(m + 1), wp)/(real(m, wp)*(m + 1))
    end do
  end function logarithm_weights

  !> Barycentric weights of the nodes x, scaled to a largest magnitude of 1.
  pure function barycentric_weights(x) result(b)
    real(wp), intent(in) :: x(:)
    real(wp) :: b(size(x)), width
    integer :: j, k

    ! Differences are measured in quarters of the width (the interval's capacity), which
    ! keeps the products near 1 for any order in use.
    width = max(maxval(x) - minval(x), tiny(1.0_wp))/4
    do j = 1, size(x)
      b(j) = 1
      do k = 1, size(x)
        if (k /= j) b(j) = b(j)*width/(x(j) - x(k))
      end do
    end do
    b = b/maxval(abs(b))
  end function barycentric_weights

  !> The Legendre polynomial of degree n on [-1, 1] and its slope.
  pure subroutine legendre(n, z, value, slope)
    integer, intent(in) :: n
    real(wp), intent(in) :: z(:)
    real(wp), intent(out) :: value(:), slope(:)
    real(wp) :: other(size(z)), forward(2)
    integer :: m

    ! Two degrees at a time, so that no array is copied.
    other = modulo(n, 2)
    value = z**modulo(n, 2)
    do m = 1 + modulo(n, 2), n - 1, 2
      forward = (2*[m, m + 1] - 1)*(1.0_wp/[m, m + 1])
      other = forward(1)*z*value - (forward(1) - 1)*other
      value = forward(2)*z*other - (forward(2) - 1)*value
    end do
    slope = n*(z*value - other)/(z**2 - 1)
  end subroutine legendre

  !> Nodes in ascending order from `start` to `last`, and weights. sharpest: the largest k that
  !> matters for each x. The function must be close to a polynomial of low degree up to `first`, and
  !> between k and 3 k. Over a panel the phase k x of no wave that matters changes by more than
  !> `swing`. A panel has nodes(2) nodes if the largest change of phase is `swing`, nodes(1) nodes
  !> if it is zero, and a proportional number between. For a product of two waves an error of 1e-12
  !> needs 20 nodes if their phases change by 16, and 48 nodes if they change by 60. Fewer nodes are
  !> enough where the weight of x decreases as k grows.
  pure subroutine wave_rule(x, sharpest, swing, nodes, start, first, last, k, weight)
    real(wp), intent(in) :: x(:), sharpest(:), swing, nodes(2), start, first, last
    real(wp), allocatable, intent(out) :: k(:), weight(:)
    real(wp), allocatable :: node(:), part(:)
    real(wp) :: from, to, turned
    integer :: n, i

    allocate (k(0), weight(0))
    to = start
    do while (to < last)
      from = to
      associate (widest => maxval(x, sharpest > from))
        to = min(last, merge(ratio*from, first, from > 0), from + swing/widest)
        turned = (to - from)*widest/swing
      end associate
      n = ceiling(nodes(1) + turned*(nodes(2) - nodes(1)))
      node = [(0.0_wp, i=1, n)]
      part = node
      call gauss_legendre(node, part)
      k = [k, from + (to - from)*node]
      weight = [weight, (to - from)*part]
    end do
  end subroutine wave_rule

end module quadrature
