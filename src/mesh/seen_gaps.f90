!> Gaps of computed states on one mesh, used to lay out another mesh. About the contact edge, or the
!> front of a step, the gap changes little in shape while the contact grows: the gaps of a state,
!> moved to other radii, approximate those of other states.
module seen_gaps
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  implicit none
  private
  public :: seen_gaps_t

  type :: seen_gaps_t
    !> The mesh of the states, the number of states, their gaps minus the heights of the shape,
    !> (nodes, states), their scales, and their loads.
    type(discretisation_t), pointer, private :: grid => null()
    integer, private :: held = 0
    real(wp), allocatable, private :: beside(:, :), scale(:), on(:)
    !> The part of the load that panels for these gaps may miss (`law_panels`).
    real(wp) :: most = 0
    !> For each tried gap: a state, the radius at which this state has the gap to which the new mesh
    !> is locked, and the radius to which this gap is moved (lateral units).
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

  !> Ratio of successive tried radii: a step of the pressure moves by less than its width between
  !> them.
  real(wp), parameter :: ratio = 1.02_wp

contains

  !> Makes room for states on a mesh; the mesh must exist as long as this object. most: see the
  !> type.
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

  !> Adds a state: its gaps, scale, and the load to which its errors are relative.
  pure subroutine add(self, shape, gap, scale, load)
    class(seen_gaps_t), intent(inout) :: self
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: gap(:), scale, load

    self%held = self%held + 1
    self%beside(:, self%held) = gap - shape%height(scale*self%grid%x)
    self%scale(self%held) = scale
    self%on(self%held) = load
  end subroutine add

  !> Adds a tried gap: the newest state, moved so that its gap at the radius `from` is at `radius`.
  pure subroutine try(self, from, radius)
    class(seen_gaps_t), intent(inout) :: self
    real(wp), intent(in) :: from, radius

    self%state = [self%state, self%held]
    self%from = [self%from, from]
    self%radius = [self%radius, radius]
  end subroutine try

  !> Adds tried gaps at radii between two radii.
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

  !> The tried gap number j at offsets from the centre of a mesh at its radius, or from the axis.
  pure function gap(self, shape, j, offset)
    class(seen_gaps_t), intent(in) :: self
    class(shape_t), intent(in) :: shape
    integer, intent(in) :: j
    real(wp), intent(in) :: offset(:)
    real(wp) :: gap(size(offset))

    associate (r => abs(self%from(j) + self%radius(j)*offset), k => self%state(j))
      gap = shape%height(r) + self%grid%interpolate_all(self%beside(:, k), r/self%scale(k))
    end associate
  end function gap

  !> The load of the state of a tried gap.
  pure real(wp) function load(self, j)
    class(seen_gaps_t), intent(in) :: self
    integer, intent(in) :: j

    load = self%on(self%state(j))
  end function load

end module seen_gaps
