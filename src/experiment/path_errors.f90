!> Errors of what is reported of the equilibrium path: each reported state (a fold, an extremum of
!> the load, the landing after a jump, a state at a given h0) is found again on a finer mesh.
!>
!> There the path near the state is a parabola in its coordinate, whose slopes are exact
!> (`path_slopes`): from it the same state follows, at the h0 or at the extremum that defines it.
!> That holds beside folds too, where an h0 that is off by little moves the load by much.
module path_errors
  use kinds, only: wp
  use regridding, only: regrid
  use equilibrium, only: state_t, equations_t
  use continuation, only: path_control, coordinate_of
  use path_slopes, only: slopes_along_path
  use potential_energy, only: energy_of
  use traced_path, only: path_point_t
  use known_path, only: known_path_t, landing_t, landing_over
  use reported, only: reported_t, error_t, measure_t
  use error_estimate, only: finer_t, unknown_error, profile_error, rounding, worst_residual, &
    what_is_left
  implicit none
  private
  public :: judge_on_path

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

  !> The mesh of a state, what defines it, at `h0` if that is it; what the iteration has left, as a
  !> change of h0; and whether the profile is to be judged too.
  type :: sought_t
    integer :: mesh = 1, kind = at_h0
    real(wp) :: h0 = 0, left = 0
    logical :: with_profile = .false.
  end type sought_t

  !> Distance of the second state of an expansion; how far an expansion is believed; its longest
  !> move, and how often it may.
  real(wp), parameter :: apart = 1.0e-4_wp, believed = 1.0e-3_wp, farthest = 0.1_wp
  integer, parameter :: most_moves = 8
  !> Tolerance of states that are looked for along the path (law's lengths).
  real(wp), parameter :: tight = 1.0e-12_wp

contains

  !> Errors of a reported state. with_profile: of the profile too.
  subroutine judge_on_path(own, fine, with_profile, known, reported)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    logical, intent(in) :: with_profile
    type(known_path_t), intent(inout) :: known
    type(reported_t), intent(inout) :: reported
    type(measure_t) :: on_fine
    integer :: k
    logical :: inside

    if (reported%landing) then
      call landing_over(known, reported%point, k, inside)
      if (inside) then
        call judge_landing(own, fine, known, known%inward(k))
        reported%error = known%inward(k)%error
      else
        call judge_landing(own, fine, known, known%outward(k))
        reported%error = known%outward(k)%error
      end if
    else if (reported%point > 0 .and. with_profile) then
      ! The point's own errors leave the profile out.
      associate (point => known%path%point(reported%point))
        call judge(own, fine, sought_at(point, .true.), point%state, on_fine, reported%error)
      end associate
    else if (reported%point > 0) then
      call judge_point(own, fine, known, reported%point)
      reported%error = known%path%point(reported%point)%error
    else
      associate (witness => reported%witness)
        call judge(own, fine, sought_t(witness%mesh, at_h0, reported%h0, &
          what_is_left(witness%state), with_profile), witness%state, on_fine, reported%error)
      end associate
    end if
  end subroutine judge_on_path

  !> What defines a point of the path that is reported.
  pure type(sought_t) function sought_at(point, with_profile) result(sought)
    type(path_point_t), intent(in) :: point
    logical, intent(in) :: with_profile

    sought = sought_t(point%mesh, merge(extremum_of_h0, extremum_of_load, point%fold), &
      point%state%h0, tight, with_profile)
  end function sought_at

  !> Errors of a fold or an extremum of the load, kept in the path.
  subroutine judge_point(own, fine, known, i)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(known_path_t), intent(inout) :: known
    integer, intent(in) :: i
    type(measure_t) :: on_fine

    associate (point => known%path%point(i))
      if (allocated(point%error)) return
      call judge(own, fine, sought_at(point, .false.), point%state, on_fine, point%error)
      point%fine = on_fine
    end associate
  end subroutine judge_point

  !> Errors of a landing, whose h0 is that of the fold on the same mesh; kept with it.
  subroutine judge_landing(own, fine, known, landing)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(known_path_t), intent(inout) :: known
    type(landing_t), intent(inout) :: landing
    type(measure_t) :: on_fine

    if (allocated(landing%error)) return
    call judge_point(own, fine, known, landing%fold)
    associate (fold => known%path%point(landing%fold))
      if (.not. landing%converged) then
        landing%error = unknown_error(reported_t(h0=fold%state%h0))
        return
      end if
      call judge(own, fine, sought_t(landing%mesh, at_h0, fold%fine%h0, tight, .false.), &
        landing%state, on_fine, landing%error)
      landing%fine = on_fine
      landing%error%h0 = fold%error%h0
    end associate
  end subroutine judge_landing

  !> Errors of a state, and what it is on the finer mesh.
  subroutine judge(own, fine, sought, state, on_fine, error)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(sought_t), intent(in) :: sought
    type(state_t), intent(in) :: state
    type(measure_t), intent(out) :: on_fine
    type(error_t), allocatable, intent(out) :: error
    type(expansion_t) :: near
    type(measure_t) :: measure
    type(state_t) :: right
    real(wp) :: distance, uncertainty
    logical :: found

    measure = measure_t(state%h0, state%axis_gap - state%h0, state%load)
    error = unknown_error(reported_t(measure%h0, measure%displacement, measure%load))
    on_fine = measure
    call energy_of(own, sought%mesh, state, on_fine%energy, uncertainty)
    near%s = coordinate_of(own%problem, sought%mesh, state)
    near%state = regrid(state, own%pair%grid(sought%mesh), fine%pair%grid(sought%mesh), &
      state%scale)
    call approach(fine, sought, near, distance, found)
    if (.not. found) return
    on_fine = measure_at(near, distance)
    error = error_between(measure, near, on_fine, sought, fine%margin)
    if (.not. sought%with_profile) return
    right = near%state
    call solve_fine(fine, sought%mesh, near%s + distance, right, found)
    error%profile = 1
    if (found) error%profile = fine%margin*profile_error(own, fine, sought%mesh, state, right)
  end subroutine judge

  !> Moves an expansion along the path until the state that is sought is near, and says how far it
  !> is. found = .false.: the finer mesh has no such state.
  subroutine approach(fine, sought, near, distance, found)
    type(finer_t), intent(inout) :: fine
    type(sought_t), intent(in) :: sought
    type(expansion_t), intent(inout) :: near
    real(wp), intent(out) :: distance
    logical, intent(out) :: found
    integer :: move

    do move = 1, most_moves
      call expand(fine, sought%mesh, near, found)
      if (.not. found) return
      distance = distance_to(near, sought%kind, sought%h0)
      found = abs(distance) <= believed
      if (found) return
      near%s = near%s + sign(min(abs(distance), farthest), distance)
    end do
  end subroutine approach

  !> The difference between a state and the same on the finer mesh as an error, with what the
  !> iteration and rounding leave.
  pure type(error_t) function error_between(own, near, on_fine, sought, margin) result(error)
    type(measure_t), intent(in) :: own, on_fine
    type(expansion_t), intent(in) :: near
    type(sought_t), intent(in) :: sought
    real(wp), intent(in) :: margin
    type(measure_t) :: moved

    error = error_t(h0=margin*abs(on_fine%h0 - own%h0), load=margin*abs(on_fine%load - own%load), &
      displacement=margin*abs(on_fine%displacement - own%displacement))
    if (sought%kind == at_h0) then
      ! What the iteration leaves moves a state at a given h0 as if that were off.
      moved = measure_at(near, distance_to(near, at_h0, on_fine%h0 + sought%left))
      error%h0 = 0
      error%load = error%load + abs(moved%load - on_fine%load)
      error%displacement = error%displacement + abs(moved%displacement - on_fine%displacement)
    else
      error%h0 = error%h0 + sought%left
    end if
    error%load = error%load + (rounding + worst_residual*tight)*abs(own%load)
    error%displacement = error%displacement + sought%left + rounding*abs(own%displacement)
  end function error_between

  !> Expands the path at near%s, from the guess near%state; found = .false. where the finer mesh has
  !> no such state.
  subroutine expand(fine, mesh, near, found)
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    type(expansion_t), intent(inout) :: near
    logical, intent(out) :: found
    type(state_t) :: second
    real(wp) :: slopes(2), slopes_there(2), uncertainty

    call solve_fine(fine, mesh, near%s, near%state, found, slopes)
    if (.not. found) return
    second = near%state
    call solve_fine(fine, mesh, near%s + apart, second, found, slopes_there)
    if (.not. found) return
    near%h0 = parabola_t(near%state%h0, slopes(1), (slopes_there(1) - slopes(1))/apart)
    near%load = parabola_t(near%state%load, slopes(2), (slopes_there(2) - slopes(2))/apart)
    near%axis_gap = parabola_t(near%state%axis_gap, &
      (second%axis_gap - near%state%axis_gap)/apart, 0.0_wp)
    call energy_of(fine%equations_t, mesh, near%state, near%energy, uncertainty)
  end subroutine expand

  !> Solves for the state at the coordinate s on the finer mesh; slopes: of h0 and load by s.
  subroutine solve_fine(fine, mesh, s, state, found, slopes)
    type(finer_t), intent(inout) :: fine
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state
    logical, intent(out) :: found
    real(wp), intent(out), optional :: slopes(2)

    fine%frozen%factors%valid = .false.
    associate (control => path_control(fine%problem, mesh, s))
      call fine%find(control, state, found)
      if (.not. (found .and. present(slopes))) return
      call slopes_along_path(fine%equations_t, control, state, fine%frozen, slopes(1), slopes(2), &
        found)
      ! On both meshes the control's value is exp(s) and a constant.
      slopes = slopes*exp(s)
    end associate
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

end module path_errors
