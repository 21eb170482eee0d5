!> The parameters of a mesh mapped to a place, such as the contact edge or the axis (`mapped_mesh`).
module mapped_shape
  use kinds, only: wp
  implicit none
  private
  public :: mapped_shape_t, same_shape

  !> Number of nodes above which a panel counts as long.
  integer, parameter :: long = 16
  !> Least number of nodes of each half of a long panel, over the number of nodes of the panel.
  real(wp), parameter :: nodes_of_half = 0.7_wp

  !> The parameters of a mapped mesh.
  type :: mapped_shape_t
    !> Position of the centre (0: the axis, 1: the contact edge), and d.
    real(wp) :: centre = 0, d = 1
    !> Nodes of the sinh panels and their lengths in z, from the innermost outward; the first
    !> `inner` panels lie inside the focus and extend to the axis.
    integer :: inner = 0
    integer, allocatable :: order(:)
    real(wp), allocatable :: z_length(:)
    !> Nodes of the algebraic panel (0: the mesh has a finite end) and the exponent of the
    !> pressure's tail on it.
    integer :: tail_order = 0
    real(wp) :: decay = 0
    !> Digits of the kernel matrix.
    real(wp) :: digits = 14
    !> Whether functions are even in the distance from the axis.
    logical :: even = .true.
    !> Exponent of the power panel that replaces the innermost panel; 1: none.
    integer :: axis_power = 1
    !> Offset of the place to which the mesh is mapped.
    real(wp) :: focus = 0
  contains
    procedure :: halved
    procedure :: enriched
    procedure :: node_count
  end type mapped_shape_t

contains

  !> The shape with some of its sinh panels halved. Half of a long panel has fewer nodes than the
  !> whole, but more per length.
  pure type(mapped_shape_t) function halved(self, which) result(shape)
    class(mapped_shape_t), intent(in) :: self
    logical, intent(in) :: which(:)
    integer :: k

    shape = self
    deallocate (shape%order, shape%z_length)
    allocate (shape%order(0), shape%z_length(0))
    do k = 1, size(self%order)
      associate (parts => merge(2, 1, which(k)), order => self%order(k))
        shape%order = [shape%order, spread(merge(max(min(order, long), ceiling( &
          nodes_of_half*order)), order, which(k)), 1, parts)]
        shape%z_length = [shape%z_length, spread(self%z_length(k)/parts, 1, parts)]
      end associate
    end do
    shape%inner = self%inner + count(which(:self%inner))
  end function halved

  !> Number of nodes.
  pure integer function node_count(self)
    class(mapped_shape_t), intent(in) :: self

    node_count = sum(self%order) + self%tail_order
  end function node_count

  !> The shape with the number of nodes of each panel multiplied by `times`, and with additional
  !> digits of the kernel.
  pure type(mapped_shape_t) function enriched(self, times, digits) result(shape)
    class(mapped_shape_t), intent(in) :: self
    real(wp), intent(in) :: times, digits

    shape = self
    shape%order = ceiling(times*self%order)
    shape%tail_order = ceiling(times*self%tail_order)
    shape%digits = self%digits + digits
  end function enriched

  !> Whether two shapes are equal to the last digit.
  pure logical function same_shape(a, b) result(same)
    type(mapped_shape_t), intent(in) :: a, b

    same = size(a%order) == size(b%order) .and. a%inner == b%inner .and. &
      a%tail_order == b%tail_order .and. a%axis_power == b%axis_power .and. (a%even .eqv. b%even)
    if (same) same = all(a%order == b%order) .and. all(abs(a%z_length - b%z_length) <= 0) .and. &
      all(abs([a%centre, a%focus, a%d, a%decay, a%digits] - &
      [b%centre, b%focus, b%d, b%decay, b%digits]) <= 0)
  end function same_shape

end module mapped_shape
