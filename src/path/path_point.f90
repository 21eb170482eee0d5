!> An equilibrium of the path, with its tangent and its place on the path.
module path_point
  use kinds, only: wp
  use contact_state, only: state_t
  implicit none
  private
  public :: path_point_t, tangent_t, part_of, no_mesh, h0_alone, load_alone

  !> Weights of h0 and load in a combination Q = weights(1) h0 + weights(2) load: h0 itself, the
  !> load, or the position of a spring's base (`driven_pieces`).
  real(wp), parameter :: h0_alone(2) = [1, 0], load_alone(2) = [0, 1]

  !> The mesh number of undeformed bodies; their coordinate on the path is -log(h0).
  integer, parameter :: no_mesh = 0

  !> Derivatives of a state: of its gaps (at the nodes), H0, scale, gap on the axis, and load.
  type :: tangent_t
    real(wp), allocatable :: gap(:)
    real(wp) :: h0 = 0, scale = 0, axis_gap = 0, load = 0
  contains
    procedure :: of
    procedure :: goes_with
    procedure :: is_alike
    procedure, private :: become => become_tangent
  end type tangent_t

  !> One equilibrium: a point of the path, or a state between two of its points.
  type :: path_point_t
    !> The state, whose arrays are not allocated for undeformed bodies; its derivatives by the
    !> path's coordinate; the mesh, and the coordinate on this mesh (`path_coordinate`).
    type(state_t) :: state
    type(tangent_t) :: tangent
    integer :: mesh = no_mesh
    real(wp) :: coordinate = 0
    !> The number of the point on the path, or of the point before it; 0: it is not known.
    integer :: interval = 0
    !> The number of unstable modes at fixed h0 between this point and the next one, and whether the
    !> path continues to that one. (Where the path passes to another mesh, its last two points exist
    !> on both meshes. The path does not continue between the two on the old mesh.)
    integer :: modes = 0
    logical :: leads_on = .false.
    !> Whether a point of the path is an extremum of h0, and whether one of the load.
    logical :: fold = .false., load_extremum = .false.
    !> Whether the state was solved.
    logical :: converged = .true.
    !> Quantities that `curve_states` computes: the contact radius in lateral units; the energy in
    !> the units of `dimensionless_problem`, and its error due to rounding and the residual.
    real(wp) :: radius = 0, energy = 0, uncertainty = 0
  contains
    procedure :: become
  end type path_point_t

contains

  !> Copies another tangent into the allocated array, without a new allocation.
  pure subroutine become_tangent(self, other)
    class(tangent_t), intent(inout) :: self
    type(tangent_t), intent(in) :: other

    self%gap = other%gap
    self%h0 = other%h0
    self%scale = other%scale
    self%axis_gap = other%axis_gap
    self%load = other%load
  end subroutine become_tangent

  !> The derivative of weights(1) h0 + weights(2) load.
  pure real(wp) function of(self, weights)
    class(tangent_t), intent(in) :: self
    real(wp), intent(in) :: weights(2)

    of = dot_product(weights, [self%h0, self%load])
  end function of

  !> Whether h0 and load change in the same sense along two tangents. Otherwise an extremum would be
  !> found twice or not at all where the path passes to another mesh.
  pure logical function goes_with(self, other)
    class(tangent_t), intent(in) :: self
    type(tangent_t), intent(in) :: other

    goes_with = self%h0*other%h0 > 0 .and. self%load*other%load > 0
  end function goes_with

  !> Whether dF/dh0 is nearly the same along two tangents. The tangents may be derivatives by
  !> different coordinates.
  pure logical function is_alike(self, other)
    class(tangent_t), intent(in) :: self
    type(tangent_t), intent(in) :: other
    real(wp), parameter :: nearly = 1.5_wp

    associate (one => self%load*other%h0, another => other%load*self%h0)
      is_alike = max(abs(one), abs(another)) <= nearly*min(abs(one), abs(another))
    end associate
  end function is_alike

  !> Takes state, tangent, mesh and coordinate of another point into the allocated arrays, without a
  !> new allocation.
  pure subroutine become(self, other)
    class(path_point_t), intent(inout) :: self
    type(path_point_t), intent(in) :: other

    call self%state%become(other%state)
    call self%tangent%become(other%tangent)
    self%mesh = other%mesh
    self%coordinate = other%coordinate
  end subroutine become

  !> The ends of the part of interval i that is between two points; ends: those of the whole
  !> interval.
  pure function part_of(ends, i, from, to) result(part)
    real(wp), intent(in) :: ends(2)
    integer, intent(in) :: i
    type(path_point_t), intent(in) :: from, to
    real(wp) :: part(2)

    part = ends
    if (i == from%interval) part(1) = from%coordinate
    if (i == to%interval) part(2) = to%coordinate
  end function part_of

end module path_point
