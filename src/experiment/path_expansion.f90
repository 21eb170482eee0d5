!> The path near a state on a finer mesh: a parabola in the path's coordinate with exact slopes
!> (`path_tangent`) and the second derivatives of the traced path. The parabola gives the place at
!> which D = weights(1) h0 + weights(2) load turns or has a value. It is accurate also near folds,
!> where a small error of h0 changes the load much.
module path_expansion
  use kinds, only: wp
  use contact_state, only: state_t, contact_radius_of
  use path_coordinate, only: path_control
  use path_tangent, only: tangent_t, tangent_along
  use potential_energy, only: energy_of
  use reported_place, only: read_of_states, of_h0, of_load, of_displacement, of_energy, &
    of_radius, of_edge
  use finer_solver, only: finer_t
  implicit none
  private
  public :: expansion_t

  !> The path near the coordinate s on a finer mesh, and the state there.
  type :: expansion_t
    real(wp) :: s = 0
    type(state_t) :: state
    !> h0, load and gap on the axis: values, slopes and second derivatives by the path's coordinate.
    real(wp), dimension(3) :: value = 0, slope = 0, curvature = 0
    !> Energy; contact radius and its slope.
    real(wp) :: energy = 0, radius = 0, widening = 0
  contains
    procedure :: move_to
    procedure :: distance_to
    procedure :: read_at
    procedure, private :: expand
  end type expansion_t

  !> Largest distance at which the expansion is accurate; largest move, and number of moves.
  real(wp), parameter :: believed = 1.0e-3_wp, farthest = 0.1_wp
  integer, parameter :: most_moves = 8
  !> Distance for the difference quotient of the contact radius.
  real(wp), parameter :: beside = 1.0e-5_wp

contains

  !> Moves an expansion along the path until the place at which D turns, or is `wanted`, is near,
  !> and returns the distance to this place. At first the expansion has a coordinate, a guess of the
  !> state and the second derivatives. found = .false.: the finer mesh has no such place.
  subroutine move_to(near, fine, mesh, weights, turns, wanted, distance, found)
    class(expansion_t), intent(inout) :: near
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    real(wp), intent(in) :: weights(2), wanted
    logical, intent(in) :: turns
    real(wp), intent(out) :: distance
    logical, intent(out) :: found
    integer :: move

    call fine%frozen%forget()
    do move = 1, most_moves
      call near%expand(fine, mesh, found)
      if (.not. found) return
      distance = near%distance_to(weights, turns, wanted)
      found = abs(distance) <= believed
      if (found) return
      near%s = near%s + sign(min(abs(distance), farthest), distance)
    end do
  end subroutine move_to

  !> Expands the path at near%s from the guess near%state; found = .false.: the finer mesh has no
  !> such state.
  subroutine expand(near, fine, mesh, found)
    class(expansion_t), intent(inout) :: near
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    logical, intent(out) :: found
    type(tangent_t) :: tangent
    type(state_t) :: next
    real(wp) :: uncertainty

    call fine%find(path_control(fine%problem, fine%meshes, mesh, near%s), near%state, found)
    if (found) call tangent_along(fine%solver_t, mesh, near%s, near%state, tangent, found)
    if (.not. found) return
    near%value = [near%state%h0, near%state%load, near%state%axis_gap]
    near%slope = [tangent%h0, tangent%load, tangent%axis_gap]
    call energy_of(fine%equations_t, mesh, near%state, near%energy, uncertainty)
    associate (grid => fine%meshes%grid(mesh))
      near%radius = contact_radius_of(fine%problem, grid, near%state)
      near%widening = 0
      if (.not. near%radius > 0) return
      next = near%state
      next%gap = next%gap + beside*tangent%gap
      next%axis_gap = next%axis_gap + beside*tangent%axis_gap
      next%scale = next%scale + beside*tangent%scale
      near%widening = (contact_radius_of(fine%problem, grid, next) - near%radius)/beside
    end associate
  end subroutine expand

  !> Distance from the centre of an expansion to the place at which D turns or is `wanted`. If D has
  !> no such value, the distance to the turn.
  pure real(wp) function distance_to(near, weights, turns, wanted) result(distance)
    class(expansion_t), intent(in) :: near
    real(wp), intent(in) :: weights(2), wanted
    logical, intent(in) :: turns
    real(wp) :: missing, slope, curvature, root

    slope = dot_product(weights, near%slope(:2))
    curvature = dot_product(weights, near%curvature(:2))
    missing = dot_product(weights, near%value(:2)) - wanted
    root = slope**2 - 2*curvature*missing
    if (root > 0 .and. .not. turns) then
      distance = -2*missing/(slope + sign(sqrt(root), slope))
    else
      distance = huge(1.0_wp)
      if (abs(curvature) > tiny(1.0_wp)) distance = -slope/curvature
    end if
  end function distance_to

  !> The quantities at a distance from the centre. The energy's derivative by h0 is minus the load.
  pure function read_at(near, distance) result(read)
    class(expansion_t), intent(in) :: near
    real(wp), intent(in) :: distance
    real(wp) :: read(read_of_states)

    read = 0
    associate (value => near%value, slope => near%slope, curvature => near%curvature)
      read(:3) = value + distance*(slope + 0.5_wp*distance*curvature)
      read(of_displacement) = read(3) - read(of_h0)
      read(of_energy) = near%energy - distance*value(of_load)*slope(of_h0) - 0.5_wp*distance**2* &
        (slope(of_load)*slope(of_h0) + value(of_load)*curvature(of_h0))
      read(of_radius) = max(0.0_wp, near%radius + distance*near%widening)
      read(of_edge) = exp(near%s + distance)
    end associate
  end function read_at

end module path_expansion
