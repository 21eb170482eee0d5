!> The energy lost in a cycle of approach and separation at controlled h0: the work between the two
!> stable branches from the jump into contact to the jump out of it.
module hysteresis
  use kinds, only: wp
  use quadrature, only: gauss_legendre
  use interpolation, only: polynomial_value, polynomial_slope
  use trail, only: trail_t
  implicit none
  private
  public :: energy_lost

  !> States in the polynomial that stands for the curve near a piece, and points of the rule on it.
  integer, parameter :: stencil = 6, points = 5
  !> States in the polynomial that it is compared with.
  integer, parameter :: lower = 5

contains

  !> Integral of (load of the approach - load of the contact) dh0 between the first and the last
  !> fold of a trail that runs from afar into contact, in units of load times length; positive. 0
  !> without folds. uncertainty: what a lower order of the interpolation between states changes;
  !> turned_over: the work done on both ways together, to which errors of the load are relative.
  subroutine energy_lost(trail, energy, uncertainty, turned_over)
    type(trail_t), intent(in) :: trail
    real(wp), intent(out) :: energy, uncertainty, turned_over
    real(wp) :: inward, outward
    integer :: first, last

    energy = 0
    uncertainty = 0
    turned_over = 0
    first = findloc(trail%fold(:trail%held), .true., 1)
    last = findloc(trail%fold(:trail%held), .true., 1, back=.true.)
    if (first == 0 .or. last == first) return
    ! Both parts are run through inward, with falling h0.
    associate (jump_in => trail%state(first)%h0, jump_out => trail%state(last)%h0)
      inward = work(trail, 1, first, jump_in, jump_out, lower)
      outward = work(trail, last, trail%held, jump_in, jump_out, lower)
      uncertainty = abs(inward - outward)
      inward = work(trail, 1, first, jump_in, jump_out, stencil)
      outward = work(trail, last, trail%held, jump_in, jump_out, stencil)
      energy = abs(inward - outward)
      uncertainty = abs(uncertainty - energy)
      turned_over = abs(inward) + abs(outward)
    end associate
  end subroutine energy_lost

  !> Integral of load dh0 along the trail, on which h0 falls, from the state `begin` to the state
  !> `finish`, as far as h0 is between low and high.
  function work(trail, begin, finish, low, high, stencil)
    type(trail_t), intent(in) :: trail
    integer, intent(in) :: begin, finish, stencil
    real(wp), intent(in) :: low, high
    real(wp) :: work
    real(wp) :: from, to
    integer :: i

    work = 0
    do i = begin, finish - 1
      from = min(trail%state(i)%h0, high)
      to = max(trail%state(i + 1)%h0, low)
      if (from > to) work = work + piece(trail, i, from, to, stencil)
    end do
  end function work

  !> Integral of load dh0 over the part of the piece from state i to state i + 1 between two values
  !> of h0, both functions of the path's coordinate being the polynomials through the nearest
  !> states.
  function piece(trail, i, h0_from, h0_to, stencil) result(work)
    type(trail_t), intent(in) :: trail
    integer, intent(in) :: i, stencil
    real(wp), intent(in) :: h0_from, h0_to
    real(wp) :: work
    real(wp) :: node(points), weight(points), a, b, s
    integer :: first, last, k

    first = i
    last = i + 1
    if (trail%mesh(first) /= trail%mesh(last)) then
      ! Coordinates do not go on across a change of mesh.
      work = 0.5_wp*(trail%state(i)%load + trail%state(i + 1)%load)*(h0_to - h0_from)
      return
    end if
    do while (last - first + 1 < stencil)
      k = last - first
      if (extends(first - 1)) first = first - 1
      if (last - first + 1 < stencil .and. extends(last + 1)) last = last + 1
      if (last - first == k) exit
    end do
    associate (at => trail%coordinate(first:last), states => trail%state(first:last))
      a = place(at, states%h0, trail%coordinate(i), trail%coordinate(i + 1), h0_from)
      b = place(at, states%h0, trail%coordinate(i), trail%coordinate(i + 1), h0_to)
      call gauss_legendre(node, weight)
      work = 0
      do k = 1, points
        s = a + (b - a)*node(k)
        work = work + (b - a)*weight(k)*polynomial_value(at, states%load, s)* &
          polynomial_slope(at, states%h0, s)
      end do
    end associate

  contains

    logical function extends(j)
      integer, intent(in) :: j

      extends = .false.
      if (j >= 1 .and. j <= trail%held) extends = trail%mesh(j) == trail%mesh(i)
    end function extends

  end function piece

  !> Where in [a, b] the polynomial through (at, f) has the value wanted, f being monotone there.
  pure real(wp) function place(at, f, a, b, wanted)
    real(wp), intent(in) :: at(:), f(:), a, b, wanted
    real(wp) :: low, high
    integer :: step

    low = a
    high = b
    do step = 1, 60
      place = 0.5_wp*(low + high)
      if ((polynomial_value(at, f, place) - wanted)*(polynomial_value(at, f, b) - wanted) > 0) then
        high = place
      else
        low = place
      end if
    end do
  end function place

end module hysteresis
