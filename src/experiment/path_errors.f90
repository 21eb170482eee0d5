!> Errors of what is reported of the equilibrium path: each reported state (a fold, an extremum of
!> the load, the landing after a jump, a state at a given h0) is found again on a finer mesh.
!>
!> There the path near the state is a parabola in its coordinate, whose slopes are exact
!> (`path_slopes`): from it the same state follows, at the h0 or at the extremum that defines it.
!> That holds beside folds too, where an h0 that is off by little moves the load by much.
module path_errors
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use edge_locked, only: mesh_pair_t
  use regridding, only: regrid
  use equilibrium, only: state_t, cost_t, load_reach
  use anderson, only: frozen_jacobian_t, solve_anderson
  use continuation, only: path_control, coordinate_of
  use path_slopes, only: slopes_along_path
  use potential_energy, only: energy_of
  use traced_path, only: path_point_t
  use known_path, only: known_path_t, landing_t, landing_over
  use reported, only: reported_t, error_t, measure_t
  use error_estimate, only: to_rounding, unknown_error, profile_error, nearly_solved, rounding, &
    worst_residual, what_is_left
  implicit none
  private
  public :: judge_on_path, finer_nodes

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

  !> Distance of the second state of an expansion; how far an expansion is believed; its longest
  !> move, and how often it may.
  real(wp), parameter :: apart = 1.0e-4_wp, believed = 1.0e-3_wp, farthest = 0.1_wp
  integer, parameter :: most_moves = 8
  !> Reach of a state on the finer mesh over its own.
  real(wp), parameter :: farther = 1.6_wp
  !> Tolerance of states that are looked for along the path (law's lengths).
  real(wp), parameter :: tight = 1.0e-12_wp

contains

  !> Errors of a reported state. Differences count `margin` times. with_profile: of the profile too.
  subroutine judge_on_path(problem, pair, fine, margin, with_profile, known, reported, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: pair, fine
    real(wp), intent(in) :: margin
    logical, intent(in) :: with_profile
    type(known_path_t), intent(inout) :: known
    type(reported_t), intent(inout) :: reported
    type(cost_t), intent(inout) :: cost
    type(measure_t) :: on_fine
    integer :: k
    logical :: inside

    if (reported%landing) then
      call landing_over(known, reported%point, k, inside)
      if (inside) then
        call judge_landing(problem, pair, fine, margin, known, known%inward(k), cost)
        reported%error = known%inward(k)%error
      else
        call judge_landing(problem, pair, fine, margin, known, known%outward(k), cost)
        reported%error = known%outward(k)%error
      end if
    else if (reported%point > 0 .and. with_profile) then
      ! The point's own errors leave the profile out.
      associate (point => known%path%point(reported%point))
        call judge(problem, pair, fine, point%mesh, kind_of(point), point%state, &
          point%state%h0, margin, tight, .true., on_fine, reported%error, cost)
      end associate
    else if (reported%point > 0) then
      call judge_point(problem, pair, fine, margin, known, reported%point, cost)
      reported%error = known%path%point(reported%point)%error
    else
      associate (witness => reported%witness)
        call judge(problem, pair, fine, witness%mesh, at_h0, witness%state, reported%h0, margin, &
          what_is_left(witness%state), with_profile, on_fine, reported%error, cost)
      end associate
    end if
  end subroutine judge_on_path

  !> Nodes of the finer mesh for a state: they go beyond those that it has, for the error of the
  !> reach, which falls with its fifth power, must show.
  pure integer function finer_nodes(pair, fine, mesh, state)
    type(mesh_pair_t), intent(in) :: pair, fine
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state

    finer_nodes = fine%grid(mesh)%nodes_within( &
      farther*load_reach(pair%grid(mesh), state)/state%scale)
  end function finer_nodes

  !> What defines a point of the path that is reported.
  pure integer function kind_of(point)
    type(path_point_t), intent(in) :: point

    kind_of = merge(extremum_of_h0, extremum_of_load, point%fold)
  end function kind_of

  !> Errors of a fold or an extremum of the load, kept in the path.
  subroutine judge_point(problem, pair, fine, margin, known, i, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: pair, fine
    real(wp), intent(in) :: margin
    type(known_path_t), intent(inout) :: known
    integer, intent(in) :: i
    type(cost_t), intent(inout) :: cost
    type(measure_t) :: on_fine

    associate (point => known%path%point(i))
      if (allocated(point%error)) return
      call judge(problem, pair, fine, point%mesh, kind_of(point), point%state, point%state%h0, &
        margin, tight, .false., on_fine, point%error, cost)
      point%fine = on_fine
    end associate
  end subroutine judge_point

  !> Errors of a landing, whose h0 is that of the fold on the same mesh; kept with it.
  subroutine judge_landing(problem, pair, fine, margin, known, landing, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: pair, fine
    real(wp), intent(in) :: margin
    type(known_path_t), intent(inout) :: known
    type(landing_t), intent(inout) :: landing
    type(cost_t), intent(inout) :: cost
    type(measure_t) :: on_fine

    if (allocated(landing%error)) return
    call judge_point(problem, pair, fine, margin, known, landing%fold, cost)
    if (.not. landing%converged) then
      landing%error = unknown_error(reported_t(h0=known%path%point(landing%fold)%state%h0))
      return
    end if
    call judge(problem, pair, fine, landing%mesh, at_h0, landing%state, &
      known%path%point(landing%fold)%fine%h0, margin, tight, .false., on_fine, landing%error, cost)
    landing%fine = on_fine
    landing%error%h0 = known%path%point(landing%fold)%error%h0
  end subroutine judge_landing

  !> Errors of a state that is defined by `kind`, at `h0` if that is it, and what it is on the finer
  !> mesh. left: what the iteration has left, as a change of h0.
  subroutine judge(problem, pair, fine, mesh, kind, state, h0, margin, left, with_profile, &
    on_fine, error, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: pair, fine
    integer, intent(in) :: mesh, kind
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: h0, margin, left
    logical, intent(in) :: with_profile
    type(measure_t), intent(out) :: on_fine
    type(error_t), allocatable, intent(out) :: error
    type(cost_t), intent(inout) :: cost
    type(expansion_t) :: near
    type(measure_t) :: own, moved
    type(state_t) :: right
    real(wp) :: distance, uncertainty
    integer :: move
    logical :: found

    own = measure_t(state%h0, state%axis_gap - state%h0, state%load)
    error = unknown_error(reported_t(own%h0, own%displacement, own%load))
    on_fine = own
    call energy_of(problem, pair%grid(mesh), state, on_fine%energy, uncertainty)
    near%s = coordinate_of(problem, mesh, state)
    near%state = regrid(state, pair%grid(mesh), fine%grid(mesh), state%scale, &
      finer_nodes(pair, fine, mesh, state))
    do move = 1, most_moves
      call expand(problem, fine, mesh, near, found, cost)
      if (.not. found) return
      distance = distance_to(near, kind, h0)
      if (abs(distance) <= believed) exit
      near%s = near%s + sign(min(abs(distance), farthest), distance)
    end do
    if (.not. abs(distance) <= believed) return
    on_fine = measure_at(near, distance)
    error = error_t(h0=margin*abs(on_fine%h0 - own%h0), load=margin*abs(on_fine%load - own%load), &
      displacement=margin*abs(on_fine%displacement - own%displacement))
    ! What the iteration leaves moves a state at a given h0 as if that were off.
    moved = measure_at(near, distance_to(near, at_h0, &
      on_fine%h0 + left))
    if (kind == at_h0) then
      error%h0 = 0
      error%load = error%load + abs(moved%load - on_fine%load)
      error%displacement = error%displacement + abs(moved%displacement - on_fine%displacement)
    else
      error%h0 = error%h0 + left
    end if
    error%load = error%load + (rounding + worst_residual*tight)*abs(own%load)
    error%displacement = error%displacement + left + rounding*abs(own%displacement)
    if (.not. with_profile) return
    near%s = near%s + distance
    right = near%state
    call solve_fine(problem, fine, mesh, near%s, right, found, cost)
    error%profile = 1
    if (found) error%profile = margin*profile_error(problem, pair%grid(mesh), state, &
      fine%grid(mesh), right)
  end subroutine judge

  !> Expands the path at near%s, from the guess near%state; found = .false. where the finer mesh has
  !> no such state.
  subroutine expand(problem, fine, mesh, near, found, cost)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: fine
    integer, intent(in) :: mesh
    type(expansion_t), intent(inout) :: near
    logical, intent(out) :: found
    type(cost_t), intent(inout) :: cost
    type(state_t) :: second
    real(wp) :: slopes(2), slopes_there(2), uncertainty

    call solve_fine(problem, fine, mesh, near%s, near%state, found, cost, slopes)
    if (.not. found) return
    second = near%state
    call solve_fine(problem, fine, mesh, near%s + apart, second, found, cost, slopes_there)
    if (.not. found) return
    near%h0 = parabola_t(near%state%h0, slopes(1), (slopes_there(1) - slopes(1))/apart)
    near%load = parabola_t(near%state%load, slopes(2), (slopes_there(2) - slopes(2))/apart)
    near%axis_gap = parabola_t(near%state%axis_gap, &
      (second%axis_gap - near%state%axis_gap)/apart, 0.0_wp)
    call energy_of(problem, fine%grid(mesh), near%state, near%energy, uncertainty)
  end subroutine expand

  !> Solves for the state at the coordinate s on the finer mesh; slopes: of h0 and load by s.
  subroutine solve_fine(problem, fine, mesh, s, state, found, cost, slopes)
    type(problem_t), intent(in) :: problem
    type(mesh_pair_t), intent(in) :: fine
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(state_t), intent(inout) :: state
    logical, intent(out) :: found
    type(cost_t), intent(inout) :: cost
    real(wp), intent(out), optional :: slopes(2)
    type(frozen_jacobian_t) :: frozen

    associate (control => path_control(problem, mesh, s), grid => fine%grid(mesh))
      call solve_anderson(problem, grid, control, to_rounding(), frozen, state, found, cost)
      found = found .or. state%residual < nearly_solved
      if (.not. (found .and. present(slopes))) return
      call slopes_along_path(problem, grid, control, state, frozen, slopes(1), slopes(2), found, &
        cost)
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
