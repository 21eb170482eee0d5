!> Rules for integrals over wave numbers k of a smooth function times products of waves, cos(k x) or
!> J0(k x), at several places x, each of which matters up to a wave number of its own.
module wave_quadrature
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  implicit none
  private
  public :: wave_rule

  !> Ratio of the ends of panels where waves are longer than that.
  real(wp), parameter :: ratio = 3

contains

  !> Nodes in order from `start` to `last`, and weights. sharpest: up to where each x matters. The
  !> function is a polynomial of low degree up to `first` and between k and 3 k. Over a panel of
  !> `nodes` no x turns its wave by more than `swing`: a product of two waves that both turn by 16
  !> has an error of 1e-12 with 20 nodes, by 60 with 48; where x matters less and less as k grows,
  !> fewer do.
  pure subroutine wave_rule(x, sharpest, swing, nodes, start, first, last, k, weight)
    real(wp), intent(in) :: x(:), sharpest(:), swing, start, first, last
    integer, intent(in) :: nodes
    real(wp), allocatable, intent(out) :: k(:), weight(:)
    real(wp), allocatable :: ends(:)
    real(wp) :: node(nodes), part(nodes), from, to
    integer :: i

    allocate (ends(1))
    ends = start
    do while (ends(size(ends)) < last)
      from = ends(size(ends))
      to = min(last, merge(ratio*from, first, from > 0), from + swing/maxval(x, sharpest > from))
      ends = [ends, to]
    end do
    call gauss_legendre(node, part)
    allocate (k(nodes*(size(ends) - 1)), weight(nodes*(size(ends) - 1)))
    do i = 1, size(ends) - 1
      associate (length => ends(i + 1) - ends(i), all => nodes*(i - 1))
        k(all + 1:all + nodes) = ends(i) + length*node
        weight(all + 1:all + nodes) = length*part
      end associate
    end do
  end subroutine wave_rule

end module wave_quadrature
