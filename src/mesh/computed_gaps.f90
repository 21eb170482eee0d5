!> Gaps of computed states on one mesh, used to lay out another mesh. About the contact edge, or the
!> front of a step, the gap changes little in shape while the contact grows: the gaps of a state,
!> moved to other radii, approximate those of other states.
module computed_gaps
  use kinds, only: wp
  use interpolation, only: fading
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use shape_panels, only: kinks_at_ends
  implicit none
  private
  public :: computed_gaps_t

  type :: computed_gaps_t
    !> The mesh of the states, the number of states, their gaps minus the heights of the shape,
    !> (nodes, states), their scales, and their loads.
    type(discretisation_t), pointer, private :: grid => null()
    integer, private :: held = 0
    real(wp), allocatable, private :: beside(:, :), scale(:), on(:)
    !> The largest distance between the undeformed bodies of a state.
    real(wp) :: farthest = 0
    !> The last position on a bounded mesh.
    real(wp), private :: last = huge(1.0_wp)
    !> The part of the load that panels for these gaps may miss (`law_panels`).
    real(wp) :: most = 0
    type(moved_t), allocatable, private :: moved(:)
  contains
    procedure :: begin_on
    procedure :: add
    procedure :: try
    procedure :: try_about_axis
    procedure :: tried
    procedure :: radii
    procedure :: edges
    procedure :: gap
    procedure :: load
  end type computed_gaps_t

  !> A state whose gaps are moved to other radii (lateral units). state: its number. from: the
  !> radius of the gap to which the new mesh is locked or, if the new mesh is about the axis, of the
  !> edge. low, high: the least and the largest radius to which this gap is moved. step: the radius
  !> of a step of the pressure in the state, or 0. about_axis: whether the new mesh is about the
  !> axis and the state has an edge.
  type :: moved_t
    integer :: state = 0
    real(wp) :: from = 0, low = 0, high = 0, step = 0
    logical :: about_axis = .false.
  end type moved_t

  !> Ratio of successive tried radii, if the law has no step.
  real(wp), parameter :: ratio = 1.1_wp

contains

  !> Makes room for states on a mesh; the mesh must exist as long as this object. most: see the
  !> type.
  subroutine begin_on(self, grid, states, most)
    class(computed_gaps_t), intent(out) :: self
    type(discretisation_t), intent(in), target :: grid
    integer, intent(in) :: states
    real(wp), intent(in) :: most

    self%grid => grid
    if (grid%is_bounded()) self%last = grid%x(grid%nodes)
    self%most = most
    allocate (self%beside(grid%nodes, states), self%scale(states), self%on(states))
    allocate (self%moved(0))
  end subroutine begin_on

  !> Adds a state: its gaps, scale, H0, and the load to which its errors are relative.
  pure subroutine add(self, shape, gap, scale, h0, load)
    class(computed_gaps_t), intent(inout) :: self
    class(shape_t), intent(in) :: shape
    real(wp), intent(in) :: gap(:), scale, h0, load

    self%held = self%held + 1
    self%beside(:, self%held) = gap - shape%height(scale*self%grid%x)
    self%scale(self%held) = scale
    self%on(self%held) = load
    self%farthest = max(self%farthest, abs(h0))
  end subroutine add

  !> Notes that the newest state is to be tried, with its gaps moved: the gap at the radius `from`
  !> moves to radii from low to high. step: the radius of a step of the pressure in this state; 0:
  !> there is none.
  pure subroutine try(self, from, low, high, step)
    class(computed_gaps_t), intent(inout) :: self
    real(wp), intent(in) :: from, low, high, step

    self%moved = [self%moved, moved_t(self%held, from, min(low, high), high, step)]
  end subroutine try

  !> Notes that the newest state is to be tried on a mesh about the axis, with its gaps moved. The
  !> edge moves from its own radius `edge` (0: there is no edge) to radii up to `high`.
  pure subroutine try_about_axis(self, edge, high)
    class(computed_gaps_t), intent(inout) :: self
    real(wp), intent(in) :: edge, high

    if (edge > 0) then
      self%moved = [self%moved, moved_t(self%held, edge, edge, high, about_axis=.true.)]
    else
      self%moved = [self%moved, moved_t(self%held, low=1.0_wp, high=1.0_wp)]
    end if
  end subroutine try_about_axis

  !> Number of states to be tried, each at one or more radii.
  pure integer function tried(self)
    class(computed_gaps_t), intent(in) :: self

    tried = size(self%moved)
  end function tried

  !> The least and the largest tried radius of the edge on a mesh about the axis; 0 if any state has
  !> no edge: the mesh must then resolve the axis.
  pure function edges(self)
    class(computed_gaps_t), intent(in) :: self
    real(wp) :: edges(2)

    edges = 0
    if (all(self%moved%about_axis)) edges = [minval(self%moved%low), maxval(self%moved%high)]
  end function edges

  !> The radii at which the tried state number j is tried on a panel. They are the least and the
  !> largest one, and radii between them. If the pressure has a step, the latter put the step at the
  !> given offsets from the centre of the mesh; otherwise they are in equal ratios.
  pure function radii(self, j, offset)
    class(computed_gaps_t), intent(in) :: self
    integer, intent(in) :: j
    real(wp), intent(in) :: offset(:)
    real(wp), allocatable :: radii(:)
    integer :: steps, k

    associate (moved => self%moved(j))
      radii = [moved%low]
      if (.not. moved%high > moved%low) return
      if (moved%step > 0) then
        radii = (moved%step - moved%from)/pack(offset, abs(offset) > 0)
        radii = [moved%low, moved%high, &
          pack(radii, radii > moved%low .and. radii < moved%high)]
      else
        steps = ceiling(log(moved%high/moved%low)/log(ratio))
        radii = moved%low*(moved%high/moved%low)**[(real(k, wp)/steps, k=0, steps)]
      end if
    end associate
  end function radii

  !> The gap of the tried state number j, moved to a radius, at offsets from the centre of a mesh at
  !> this radius (over the radius), or from the axis. Outside a contact gaps move with the edge.
  !> Inside they do so approximately near the edge, while the gap on the axis stays there. On a mesh
  !> about the axis gaps at kinks of the shape, and beyond them as seen from the edge, stay in
  !> place, unless the edge is moved too near to the kink.
  pure function gap(self, shape, j, radius, offset)
    class(computed_gaps_t), intent(in) :: self
    class(shape_t), intent(in) :: shape
    integer, intent(in) :: j
    real(wp), intent(in) :: radius, offset(:)
    real(wp), dimension(size(offset)) :: gap, r, beyond

    beyond = offset
    if (self%moved(j)%about_axis) beyond = offset/radius - 1
    associate (from => self%moved(j)%from, k => self%moved(j)%state)
      r = from + radius*beyond
      where (beyond < 0) r = abs(from + radius*from*beyond/(from - beyond*(radius - from)))
      if (self%moved(j)%about_axis) call keep_kinks(kinks_at_ends(shape), from, radius, offset, r)
      gap = shape%height(r)
      ! Beyond the mesh of the state deformations decrease as 1/r.
      r = r/self%scale(k)
      gap = gap + self%grid%interpolate_all(self%beside(:, k), min(r, self%last))* &
        (self%last/max(r, self%last))
    end associate
  end function gap

  !> Sets the positions r whose gaps move to the positions `at`. Near the edge gaps move with the
  !> edge. On each side their motion decreases to zero at the nearest kink, if the edge moves by
  !> less than the fraction `nearest` of its distance to this kink.
  pure subroutine keep_kinks(kinks, from, radius, at, r)
    real(wp), intent(in) :: kinks(:), from, radius, at(:)
    real(wp), intent(inout) :: r(:)
    real(wp), parameter :: nearest = 0.5_wp
    real(wp) :: kink(2), way(size(r))
    integer :: side

    kink = [maxval(kinks, kinks < radius), minval(kinks, kinks > radius)]
    do side = 1, 2
      if (abs(kink(side)) >= huge(kink) .or. &
        abs(radius - from) > nearest*abs(radius - kink(side))) cycle
      way = (at - radius)/(kink(side) - radius)
      where (way > 0) r = at - (radius - from)*fading(way)
    end do
  end subroutine keep_kinks

  !> The load of the tried state number j.
  pure real(wp) function load(self, j)
    class(computed_gaps_t), intent(in) :: self
    integer, intent(in) :: j

    load = self%on(self%moved(j)%state)
  end function load

end module computed_gaps
