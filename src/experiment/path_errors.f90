!> Errors of what is reported of the equilibrium path: each reported state (a fold, an extremum of
!> the load, the landing after a jump, a state at a given h0) is found again on a finer mesh.
module path_errors
  use kinds, only: wp
  use regridding, only: regrid
  use contact_state, only: state_t
  use equilibrium, only: equations_t, residual_floor
  use path_coordinate, only: coordinate_of
  use edge_locked, only: approach
  use potential_energy, only: energy_of
  use traced_path, only: path_point_t, traced_path_t
  use known_path, only: known_path_t, landing_t, landing_over
  use reported, only: reported_t, error_t, measure_t
  use path_expansion, only: expansion_t, expansion_about, move_to, solve_fine, distance_to, &
    measure_at, extremum_of_h0, extremum_of_load, at_h0
  use error_estimate, only: finer_t, unknown_error, profile_error, rounding, worst_residual, &
    what_is_left
  implicit none
  private
  public :: judge_on_path

  !> The mesh of a state, what defines it, at `h0` if that is it; what the search has left of its
  !> h0; and whether the profile is to be judged too.
  type :: sought_t
    integer :: mesh = 1, kind = at_h0
    real(wp) :: h0 = 0, left = 0
    logical :: with_profile = .false.
  end type sought_t

  !> What the search for a state along the path leaves of its h0 (law's lengths).
  real(wp), parameter :: tight = 3.0e-11_wp

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
        call judge(own, fine, known%path, sought_at(fine, point, .true.), point%state, &
          on_fine, reported%error)
      end associate
    else if (reported%point > 0) then
      call judge_point(own, fine, known, reported%point)
      reported%error = known%path%point(reported%point)%error
    else
      associate (witness => reported%witness)
        call judge(own, fine, known%path, sought_t(witness%mesh, at_h0, reported%h0, &
          with_profile=with_profile), witness%state, on_fine, reported%error)
      end associate
    end if
  end subroutine judge_on_path

  !> What defines a point of the path that is reported. Of its h0 rounding leaves more than the
  !> search where bodies yield much.
  pure type(sought_t) function sought_at(fine, point, with_profile) result(sought)
    type(finer_t), intent(in) :: fine
    type(path_point_t), intent(in) :: point
    logical, intent(in) :: with_profile

    sought = sought_t(point%mesh, merge(extremum_of_h0, extremum_of_load, point%fold), &
      point%state%h0, max(tight, residual_floor(fine%problem, point%state)), with_profile)
  end function sought_at

  !> Errors of a fold or an extremum of the load, kept in the path.
  subroutine judge_point(own, fine, known, i)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(known_path_t), intent(inout) :: known
    integer, intent(in) :: i
    type(measure_t) :: on_fine
    type(error_t), allocatable :: error

    associate (point => known%path%point(i))
      if (allocated(point%error)) return
      call judge(own, fine, known%path, sought_at(fine, point, .false.), point%state, &
        on_fine, error)
      point%fine = on_fine
      point%error = error
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
      if (.not. landing%landed) then
        landing%error = unknown_error(reported_t(h0=fold%state%h0))
        return
      end if
      call judge(own, fine, known%path, sought_t(landing%mesh, at_h0, fold%fine%h0, tight), &
        landing%state, on_fine, landing%error)
      landing%fine = on_fine
      landing%error%h0 = fold%error%h0
    end associate
  end subroutine judge_landing

  !> Errors of a state of a path, and what it is on the finer mesh.
  subroutine judge(own, fine, path, sought, state, on_fine, error)
    type(equations_t), intent(in) :: own
    type(finer_t), intent(inout) :: fine
    type(traced_path_t), intent(in) :: path
    type(sought_t), intent(in) :: sought
    type(state_t), intent(in) :: state
    type(measure_t), intent(out) :: on_fine
    type(error_t), allocatable, intent(out) :: error
    type(expansion_t) :: near
    type(measure_t) :: measure
    type(state_t) :: right
    real(wp) :: s, distance, uncertainty
    logical :: found

    measure = measure_t(state%h0, state%axis_gap - state%h0, state%load)
    error = unknown_error(reported_t(measure%h0, measure%displacement, measure%load))
    on_fine = measure
    call energy_of(own, sought%mesh, state, on_fine%energy, uncertainty)
    s = coordinate_of(own%problem, sought%mesh, state)
    call fine%prepare(sought%mesh)
    near = expansion_about(path%arc_about(sought%mesh, s), s, regrid(own%problem%shape, state, &
      own%meshes%grid(sought%mesh), fine%meshes%grid(sought%mesh), state%scale))
    call move_to(fine, sought%mesh, sought%kind, sought%h0, near, distance, found)
    if (.not. found) return
    on_fine = measure_at(near, distance)
    error = error_between(measure, near, on_fine, sought, fine%margin)
    if (sought%mesh > approach) &
      error%radius = fine%margin*abs(exp(near%s + distance) - state%scale)
    if (.not. sought%with_profile) return
    right = near%state
    call solve_fine(fine, sought%mesh, near%s + distance, right, found)
    error%profile = 1
    if (found) error%profile = fine%margin*profile_error(own, fine, sought%mesh, state, right)
  end subroutine judge

  !> The difference between a state and the same on the finer mesh as an error, with what search and
  !> rounding leave, and the iteration on the finer mesh: what it left on the own is in the
  !> difference.
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
      moved = measure_at(near, distance_to(near, at_h0, on_fine%h0 + max(sought%left, &
        what_is_left(near%state))))
      error%h0 = 0
      error%load = error%load + abs(moved%load - on_fine%load)
      error%displacement = error%displacement + abs(moved%displacement - on_fine%displacement)
    else
      error%h0 = error%h0 + sought%left
    end if
    error%load = error%load + (rounding + worst_residual*tight)*abs(own%load)
    error%displacement = error%displacement + sought%left + rounding*abs(own%displacement)
  end function error_between

end module path_errors
