!> The path near a state on a finer mesh: a parabola in its coordinate with exact slopes
!> (`path_tangent`); how these change, the path itself tells. From it the same state follows, at the
!> h0 or at the extremum that defines it. That holds beside folds too, where an h0 that is off by
!> little moves the load by much.
module path_expansion
  use kinds, only: wp
  use contact_state, only: state_t
  use path_coordinate, only: path_control
  use path_tangent, only: tangent_t, tangent_along, of_h0, of_load
  use arc, only: arc_t
  use potential_energy, only: energy_of
  use reported, only: measure_t
  use error_estimate, only: finer_t
  implicit none
  private
  public :: expansion_t, expansion_about, move_to, solve_fine, distance_to, measure_at
  public :: extremum_of_h0, extremum_of_load, at_h0

  !> Value, slope and second derivative by the path's coordinate.
  type :: parabola_t
    real(wp) :: value = 0, slope = 0, curvature = 0
  end type parabola_t

  !> The path near the coordinate s on a finer mesh, and the state there.
  type :: expansion_t
    real(wp) :: s = 0
    type(parabola_t) :: h0, load, axis_gap
    real(wp) :: energy = 0
    type(state_t) :: state
  end type expansion_t

  !> What defines a state: it is an extremum of h0 or of the load, or it is at a given h0.
  integer, parameter :: extremum_of_h0 = 1, extremum_of_load = 2, at_h0 = 3

  !> How far an expansion is believed; its longest move, and how often it may.
  real(wp), parameter :: believed = 1.0e-3_wp, farthest = 0.1_wp
  integer, parameter :: most_moves = 8

contains

  !> An expansion at the coordinate s, not yet solved: from the guess `state` on the finer mesh, and
  !> with the curvatures of the path about it.
  pure type(expansion_t) function expansion_about(about, s, state) result(near)
    type(arc_t), intent(in) :: about
    real(wp), intent(in) :: s
    type(state_t), intent(in) :: state

    near%s = s
    near%state = state
    near%h0%curvature = about%curvature(of_h0, s)
    near%load%curvature = about%curvature(of_load, s)
  end function expansion_about

  !> Moves an expansion along the path until the state that `kind` defines, at h0 if that is it, is
  !> near, and says how far it is. found = .false.: the finer mesh has no such state.
  subroutine move_to(fine, mesh, kind, h0, near, distance, found)
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh, kind
    real(wp), intent(in) :: h0
    type(expansion_t), intent(inout) :: near
    real(wp), intent(out) :: distance
    logical, intent(out) :: found
    integer :: move

    call fine%frozen%forget()
    do move = 1, most_moves
      call expand(fine, mesh, near, found)
      if (.not. found) return
      distance = distance_to(near, kind, h0)
      found = abs(distance) <= believed
      if (found) return
      near%s = near%s + sign(min(abs(distance), farthest), distance)
    end do
  end subroutine move_to

  !> Expands the path at near%s, from the guess near%state; found = .false. where the finer mesh has
  !> no such state.
  subroutine expand(fine, mesh, near, found)
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    type(expansion_t), intent(inout) :: near
    logical, intent(out) :: found
    type(tangent_t) :: tangent
    real(wp) :: uncertainty

    call solve_fine(fine, mesh, near%s, near%state, found)
    if (found) call tangent_along(fine%solver_t, mesh, near%s, near%state, tangent, found)
    if (.not. found) return
    near%h0 = parabola_t(near%state%h0, tangent%h0, near%h0%curvature)
    near%load = parabola_t(near%state%load, tangent%load, near%load%curvature)
    near%axis_gap = parabola_t(near%state%axis_gap, tangent%axis_gap, 0.0_wp)
    call energy_of(fine%equations_t, mesh, near%state, near%energy, uncertainty)
  end subroutine expand

  !> Solves for the state at the coordinate s on the finer mesh.
  subroutine solve_fine(fine, mesh, s, state, found)
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state
    logical, intent(out) :: found

    call fine%find(path_control(fine%problem, mesh, s), state, found)
  end subroutine solve_fine

  !> How far from the middle of an expansion the state is that `kind` defines. Beyond a fold, where
  !> there is no state at h0, the fold stands for it.
  pure real(wp) function distance_to(near, kind, h0) result(distance)
    type(expansion_t), intent(in) :: near
    integer, intent(in) :: kind
    real(wp), intent(in) :: h0
    real(wp) :: root

    select case (kind)
    case (extremum_of_h0)
      distance = to_extremum(near%h0)
    case (extremum_of_load)
      distance = to_extremum(near%load)
    case default
      associate (missing => near%h0%value - h0, slope => near%h0%slope)
        root = slope**2 - 2*near%h0%curvature*missing
        if (root > 0) then
          distance = -2*missing/(slope + sign(sqrt(root), slope))
        else
          distance = to_extremum(near%h0)
        end if
      end associate
    end select

  contains

    pure real(wp) function to_extremum(parabola)
      type(parabola_t), intent(in) :: parabola

      to_extremum = huge(1.0_wp)
      if (abs(parabola%curvature) > tiny(1.0_wp)) &
        to_extremum = -parabola%slope/parabola%curvature
    end function to_extremum

  end function distance_to

  !> What the state at a distance from the middle is reported by. The energy's derivative by h0 is
  !> minus the load.
  pure type(measure_t) function measure_at(near, distance) result(measure)
    type(expansion_t), intent(in) :: near
    real(wp), intent(in) :: distance

    associate (h0 => near%h0, load => near%load)
      measure%h0 = at(h0)
      measure%load = at(load)
      measure%displacement = at(near%axis_gap) - measure%h0
      measure%energy = near%energy - distance*load%value*h0%slope - &
        0.5_wp*distance**2*(load%slope*h0%slope + load%value*h0%curvature)
    end associate

  contains

    pure real(wp) function at(parabola)
      type(parabola_t), intent(in) :: parabola

      at = parabola%value + distance*(parabola%slope + 0.5_wp*distance*parabola%curvature)
    end function at

  end function measure_at

end module path_expansion
