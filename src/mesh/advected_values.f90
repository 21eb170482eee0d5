!> Interpolates values at fixed positions from one mesh to the next, while the mesh moves step by
!> step. The polynomial of one panel alone ignores the values that enter the panel from its
!> neighbour. If it is used repeatedly, this is an extrapolation whose errors grow without bound.
!> With the neighbour's value at the common end, the polynomial is a collocation of the flow through
!> the mesh, which is stable.
module advected_values
  use kinds, only: wp
  use discretisation, only: discretisation_t
  implicit none
  private
  public :: advected_t, new_advected

  type :: advected_t
    private
    real(wp), allocatable :: value(:)
    !> For each panel, the neighbour's value at the common end minus the panel's own; whether the
    !> common end is the outer one.
    real(wp), allocatable :: jump(:)
    logical :: outward = .true.
  contains
    procedure :: at
  end type advected_t

contains

  !> Values at the nodes of a mesh, for a mesh that has moved outward or inward.
  pure function new_advected(grid, value, outward) result(carried)
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: value(:)
    logical, intent(in) :: outward
    type(advected_t) :: carried
    integer :: k, next

    carried%value = value
    carried%outward = outward
    allocate (carried%jump(size(grid%panel)), source=0.0_wp)
    do k = 1, size(grid%panel)
      next = k + merge(1, -1, outward)
      if (next < 1 .or. next > size(grid%panel)) cycle
      carried%jump(k) = end_of(next, .not. outward) - end_of(k, outward)
    end do

  contains

    pure real(wp) function end_of(k, right)
      integer, intent(in) :: k
      logical, intent(in) :: right

      associate (local => grid%local(grid%which(k)), first => grid%first(k))
        end_of = local%value(value(first:first + size(local%node) - 1), &
          merge(1.0_wp, 0.0_wp, right))
      end associate
    end function end_of

  end function new_advected

  !> The value at a position: the panel's polynomial plus a multiple of P_n, which is zero at the
  !> nodes, so that the sum has the neighbour's value at the common end.
  pure real(wp) function at(self, grid, x)
    class(advected_t), intent(in) :: self
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: x
    real(wp) :: s
    integer :: k

    k = grid%panel_at(x)
    associate (local => grid%local(grid%which(k)), first => grid%first(k))
      s = grid%panel(k)%local(x - grid%centre)
      at = local%value(self%value(first:first + size(local%node) - 1), s)
      if (abs(self%jump(k)) > 0) at = at + self%jump(k)* &
        legendre(size(local%node), merge(2*s - 1, 1 - 2*s, self%outward))
    end associate
  end function at

  !> The Legendre polynomial P_n.
  pure real(wp) function legendre(n, x) result(value)
    integer, intent(in) :: n
    real(wp), intent(in) :: x
    real(wp) :: before, next
    integer :: m

    before = 1
    value = x
    do m = 2, n
      next = ((2*m - 1)*x*value - (m - 1)*before)/m
      before = value
      value = next
    end do
  end function legendre

end module advected_values
