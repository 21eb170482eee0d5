!> Quadrature for the elastic kernel on the part of a panel next to the axis, or on a tail.
!>
!> Points are graded towards a logarithmic singularity on the panel or near it: with distance =
!> length*v**power and Gauss points in v, a logarithm at distance 0 becomes as smooth as v**(power -
!> 1) ln(v), and a singularity at a small distance stays away from the points in proportion. Plain
!> Gauss points are enough for distant targets.
module graded_rule
  use kinds, only: wp, pi
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: graded_rule_t, new_graded_rule

  !> Exponent of the substitution, and number of points at which the error for v**(power - 1) ln(v)
  !> is a few parts of one: the error decreases with twice the exponent.
  integer, parameter :: power = 4
  real(wp), parameter :: least_graded = 1.75_wp
  !> Number of points for each degree of the nodes' polynomials, graded and plain; and additional
  !> plain points, since the last digits of the polynomials are of higher degrees.
  real(wp), parameter :: graded_share = 1.4_wp, plain_share = 0.5_wp
  integer, parameter :: least_plain = 3

  type :: graded_rule_t
    !> The end of the part of the panel, which begins at the panel's left end.
    real(wp) :: part = 1
    !> Points and weights of the substitution on [0, 1].
    real(wp), allocatable :: step(:), step_weight(:)
    !> Plain points on the part, and their weights; none on a tail.
    real(wp), allocatable :: plain(:), plain_weight(:)
  end type graded_rule_t

contains

  !> Rule for a part of a panel of `order` nodes, with an accuracy of `digits` digits. z_length:
  !> length of this part in z if it is mapped by sinh, otherwise zero.
  pure function new_graded_rule(order, part, z_length, digits) result(rule)
    integer, intent(in) :: order
    real(wp), intent(in) :: part, z_length, digits
    type(graded_rule_t) :: rule
    real(wp), allocatable :: v(:), v_weight(:)
    real(wp) :: degrees, clear
    integer :: points

    rule%part = part
    ! The part's share of the degrees: polynomials oscillate uniformly in this angle.
    degrees = order*acos(1 - 2*part)/pi
    ! The kernel is singular at t = r and at t = -r. The latter is as near to the axis as ln(2) in
    ! z, and near the axis the substitution has the fewest points.
    clear = log(2.0_wp)/max(z_length, 1.0_wp)
    points = ceiling(max(least_graded*10.0_wp**(digits/(2*power)), &
      graded_share*degrees + points_against(1 + sqrt(clear), digits)))
    allocate (v(points), v_weight(points))
    call gauss_legendre(v, v_weight)
    rule%step = v**power
    rule%step_weight = power*v**(power - 1)*v_weight

    clear = min(1.0_wp, clear)
    points = merge(least_plain + ceiling(plain_share*degrees + &
      points_against(1 + 2*clear + 2*sqrt(clear*(1 + clear)), digits)), 0, z_length > 0)
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

end module graded_rule
