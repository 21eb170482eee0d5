!> Gaps that bodies were seen to have on one mesh, to lay out another by. About the contact edge, or
!> the front of a step, bodies look much the same while it grows: moved to other radii, the gaps of
!> a state tell about states that were not seen.
module seen_gaps
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  implicit none
  private
  public :: seen_gaps_t

  type :: seen_gaps_t
    !> Where they were seen, how many states there are, what their gaps are beside the shape,
    !> (nodes, states), and their scales.
    type(discretisation_t), pointer, private :: grid => null()
    integer, private :: held = 0
    real(wp), allocatable, private :: beside(:, :), scale(:), on(:)
    !> The part of the load that panels for these gaps may leave out (`law_panels`).
    real(wp) :: most = 0
    !> What is tried: a state, the radius at which it has what the mesh to be laid out is locked to,
    !> and the radius at which that is taken to be (lateral units).
    integer, allocatable, private :: state(:)
    real(wp), allocatable, private :: from(:)
    real(wp), allocatable :: radius(:)
  contains
    procedure :: begin_on
    procedure :: add
    procedure :: try
    procedure :: try_between
    procedure :: gap
    procedure :: load
  end type seen_gaps_t

  !> Ratio of the radii tried: a step of the pressure moves by less than its width from one to the
  !> next.
  real(wp), parameter :: ratio = 1.02_wp

contains

  !> Begins with none of so many states on a mesh, which must outlive this. most: see the type.
  subroutine begin_on(self, grid, states, most)
    class(seen_gaps_t), intent(out) :: self
    type(discretisation_t), intent(in), target :: grid
    integer, intent(in) :: states
    real(wp), intent(in) :: most

    self%grid => grid
    self%most = most
    allocate (self%beside(grid%nodes, states), self%scale(states), self%on(states))
    allocate (self%state(0), self%from(0), self%radius(0))
  end subroutine begin_on

  !> Adds a state: gaps, scale, and the load of which its errors are parts.
  pure subroutine add(self, shape, gap, scale, load)
    class(seen_gaps_t), intent(inout) :: self
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: gap(:), scale, load

    self%held = self%held + 1
    self%beside(:, self%held) = gap - shape%height(scale*self%grid%x)
    self%scale(self%held) = scale
    self%on(self%held) = load
  end subroutine add

  !> Adds the newest state once more, moved outwards or inwards: the gap that it has at the radius
  !> `from` is placed at `radius`.
  pure subroutine try(self, from, radius)
    class(seen_gaps_t), intent(inout) :: self
    real(wp), intent(in) :: from, radius

    self%state = [self%state, self%held]
    self%from = [self%from, from]
    self%radius = [self%radius, radius]
  end subroutine try

  !> The same at radii between two.
  pure subroutine try_between(self, from, least, most)
    class(seen_gaps_t), intent(inout) :: self
    real(wp), intent(in) :: from, least, most
    integer :: steps, k

    if (.not. most > least) return
    steps = ceiling(log(most/least)/log(ratio))
    do k = 0, steps
      call self%try(from, least*(most/least)**(real(k, wp)/steps))
    end do
  end subroutine try_between

  !> The gap of a try at offsets from the centre of a mesh at its radius, or from the axis.
  pure function gap(self, shape, j, offset)
    class(seen_gaps_t), intent(in) :: self
    class(shape_t), intent(in) :: shape
    integer, intent(in) :: j
    real(wp), intent(in) :: offset(:)
    real(wp) :: gap(size(offset))
    integer :: i

    associate (r => abs(self%from(j) + self%radius(j)*offset), k => self%state(j))
      gap = shape%height(r) + [(self%grid%interpolate(self%beside(:, k), r(i)/self%scale(k)), &
        i=1, size(offset))]
    end associate
  end function gap

  !> The load of a try's state.
  pure real(wp) function load(self, j)
    class(seen_gaps_t), intent(in) :: self
    integer, intent(in) :: j

    load = self%on(self%state(j))
  end function load

end module seen_gaps
