!> Experiments with rigid bodies: at every h0 there is one state, with the gap of the shape and a
!> load that is an integral over the gap (`undeformed`). There are no equations and no meshes.
module rigid_bodies
  use kinds, only: wp, long
  use root_finding, only: root_search_t, new_root_search
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t, calm_gap, contact_level_of
  use undeformed, only: measured_t, measured_load, measured_slope, load_undeformed, &
    load_slope_undeformed
  use discretisation, only: discretisation_t
  use contact_state, only: state_t, undeformed_state
  use ending, only: touching
  use reported_place, only: place_t, of_h0, of_load, of_radius, rounding
  use places, only: places_t
  use reported_numbers, only: run_numbers_t, largest_error, chance
  use records, only: observer_t, record_t, branch_t, stable_yes, stable_unasked
  use experiment_request, only: request_t
  use experiment_result, only: experiment_result_t
  use largest_tension, only: lower
  use stepped_branch, only: enter_ends
  use h0_schedule, only: h0_schedule_t, path_plan
  use loading_cycle, only: branches_t, run_cycle
  use clock, only: seconds
  implicit none
  private
  public :: run_rigid

  !> The branches of rigid bodies, and the number of their states.
  type, extends(branches_t) :: rigid_branches_t
    type(problem_t), pointer :: problem => null()
    class(observer_t), pointer :: observer => null()
    integer(long) :: states = 0
  contains
    procedure :: run_branch
  end type rigid_branches_t

  !> Distance of successive sampled gaps, as a fraction of the distance from the law's pole or of
  !> `least`, whichever is larger. Without a pole (smallest gap below `no_pole`) it is a fraction of
  !> the gap or of the law's length. Least number of sampled gaps in a period.
  real(wp), parameter :: part = 0.02_wp, least = 1.0e-3_wp, of_period = 12, no_pole = -60
  !> Extent of a profile, in units of the larger one of its h0 and the law's length.
  real(wp), parameter :: far_out = 1000
  !> Step for the curvature of a load, as a fraction of a bracket.
  real(wp), parameter :: apart = 1.0e-3_wp

contains

  !> Runs the path and the cycle of a scene.
  subroutine run_rigid(request, problem, observer, outcome)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in), target :: problem
    class(observer_t), intent(inout), target :: observer
    type(experiment_result_t), intent(inout) :: outcome
    type(rigid_branches_t) :: branches
    type(run_numbers_t) :: none(0)
    real(wp) :: began
    logical :: reached

    began = seconds()
    branches%problem => problem
    branches%observer => observer
    if (allocated(request%path)) then
      allocate (outcome%stepped_path)
      call branches%run_branch(path_plan(request, problem%law, calm_gap(problem)), 0, &
        outcome%stepped_path, outcome%places, reached)
    end if
    if (allocated(request%loading)) call run_cycle(branches, request, problem%law, .true., &
      outcome%loading, outcome%unloading, outcome%places)
    ! The load is an integral with a known error.
    call outcome%places%judge_by(none, chance)
    outcome%error_estimate = largest_error(outcome%places%number)
    outcome%cost%states = outcome%cost%states + branches%states
    outcome%cost%solve_seconds = seconds() - began
  end subroutine run_rigid

  !> Runs a branch, as far as the law has a pressure: see `loading_cycle`.
  subroutine run_branch(self, plan, k, branch, places, reached)
    class(rigid_branches_t), intent(inout) :: self
    type(h0_schedule_t), intent(in) :: plan
    integer, intent(in) :: k
    type(branch_t), intent(out) :: branch
    type(places_t), intent(inout) :: places
    logical, intent(out) :: reached
    type(problem_t), pointer :: problem
    real(wp), allocatable :: load(:)
    integer :: i

    problem => self%problem
    reached = k == 0
    if (k > 0) reached = self%from(k) >= problem%law%smallest_gap
    if (.not. reached) return
    allocate (load(size(plan%h0)))
    do i = 1, size(plan%h0)
      if (plan%h0(i) < problem%law%smallest_gap) then
        branch%ending%cause = touching
        exit
      end if
      load(i) = load_undeformed(problem, plan%h0(i))
      call show(plan, i, load(i))
      if (plan%profile(i)) call places%add('profiles', place_at(plan%h0(i)))
      branch%states = i
    end do
    self%states = self%states + branch%states
    if (branch%states == 0) return
    branch%finish = place_at(plan%h0(branch%states))
    call find_largest_tension(plan%h0(:branch%states), load(:branch%states), branch)
    call judge_ends(plan%h0(1), plan%h0(branch%states), branch)
    call enter_ends(branch, k == 0, places)

  contains

    !> Records whether the tension is largest in the first or the last row, and may grow beyond it.
    !> It cannot grow if dF/dh0 = 0 there, or if the bodies touch there under a law without
    !> repulsion.
    pure subroutine judge_ends(first, last, branch)
      real(wp), intent(in) :: first, last
      type(branch_t), intent(inout) :: branch
      type(measured_t) :: slope
      logical :: touches

      if (.not. allocated(branch%lowest)) return
      slope = measured_slope(problem, branch%lowest%at(of_h0))
      touches = .not. problem%law%rest_gap > 0 .and. (branch%ending%early() .or. &
        branch%lowest%at(of_h0) <= max(problem%law%gap_of(0.0_wp), problem%law%smallest_gap))
      if (abs(slope%value) > slope%error .and. .not. touches) call branch%compare_ends(first, last)
    end subroutine judge_ends

    !> Gives step i of a branch to the observer, with positions if its profile is requested.
    subroutine show(plan, i, load)
      type(h0_schedule_t), intent(in) :: plan
      integer, intent(in) :: i
      real(wp), intent(in) :: load
      type(discretisation_t) :: grid
      type(state_t) :: state
      type(record_t) :: record

      record%branch = plan%name
      associate (h0 => plan%h0(i))
        record%h0 = problem%law%separation_of(h0)
        record%contact_radius = problem%lateral*contact_radius(h0)
        grid%x = positions(h0, plan%profile(i))
        grid%nodes = size(grid%x)
        state = undeformed_state(problem%shape, grid, h0, 1.0_wp)
        state%pressure = problem%law%pressure(state%gap)
      end associate
      record%h_centre = record%h0
      record%load = load*problem%load
      record%stable = merge(stable_yes, stable_unasked, plan%unique)
      state%load = load
      state%residual = 0
      call self%observer%take(record, problem, grid, state, plan%profile(i))
    end subroutine show

    !> Positions of a profile, lateral units: those of the sampled gaps, up to the end of the body.
    !> Empty unless `wanted`.
    pure function positions(h0, wanted) result(r)
      real(wp), intent(in) :: h0
      logical, intent(in) :: wanted
      real(wp), allocatable :: r(:), gap(:)

      allocate (r(0))
      if (.not. wanted) return
      gap = gaps_between(problem%law, h0, h0 + far_out*max(1.0_wp, abs(h0)))
      r = problem%shape%position_of(gap(2:) - h0)
      r = pack(r, r <= problem%shape%ends)
    end function positions

    !> Finds the largest tension over the range of h0; load: at the h0 of the branch. Not allocated
    !> if there is no attraction.
    pure subroutine find_largest_tension(h0, load, branch)
      real(wp), intent(in) :: h0(:), load(:)
      type(branch_t), intent(inout) :: branch
      type(place_t) :: found
      real(wp), allocatable :: gap(:)
      integer :: k, i

      gap = gaps_between(problem%law, minval(h0), maxval(h0))
      k = minloc([(load_undeformed(problem, gap(i)), i=1, size(gap))], 1)
      found = lowest_about(gap(k), gap(max(1, k - 1)), gap(min(size(gap), k + 1)))
      call lower(branch%lowest, found)
      k = minloc(load, 1)
      if (load(k) < found%at(of_load) - found%left(of_load)) then
        call lower(branch%lowest, lowest_about(h0(k), h0(max(1, k - 1)), h0(min(size(h0), k + 1))))
      end if
    end subroutine find_largest_tension

    !> The lowest load near the state at h0, between two values of h0 with higher loads, one of
    !> which may be h0 itself. It is at a root of dF/dh0; without a root it is taken at h0.
    pure type(place_t) function lowest_about(h0, before, after) result(found)
      real(wp), intent(in) :: h0, before, after
      type(root_search_t) :: search
      type(measured_t) :: slope
      real(wp) :: low, high, slopes(2), place, shift, curvature

      low = min(before, after)
      high = max(before, after)
      slopes = [load_slope_undeformed(problem, low), load_slope_undeformed(problem, high)]
      found = place_at(h0)
      if (.not. (slopes(1) < 0 .and. slopes(2) > 0)) then
        ! The minimum between these neighbours was not resolved.
        if (low < h0 .and. h0 < high) then
          found%left(of_h0) = high - low
          found%left(of_radius) = radius_error(h0, high - low)
        end if
        return
      end if
      search = new_root_search(low, slopes(1), high, slopes(2))
      do while (search%is_open())
        place = search%place()
        call search%note(place, load_slope_undeformed(problem, place))
      end do
      found = place_at(search%root)
      slope = measured_slope(problem, search%root)
      shift = apart*(high - low)
      curvature = (load_slope_undeformed(problem, search%root + shift) - &
        load_slope_undeformed(problem, search%root - shift))/(2*shift)
      found%left(of_h0) = min(high - low, given_error(search%root) + &
        (slope%error + abs(slope%value))/max(curvature, tiny(1.0_wp)))
      found%left(of_radius) = radius_error(search%root, found%left(of_h0))
    end function lowest_about

    !> The place of a state, with the errors due to the integral and to the rounding of h0.
    pure type(place_t) function place_at(h0) result(reported)
      real(wp), intent(in) :: h0
      type(measured_t) :: load

      load = measured_load(problem, h0)
      reported%at(of_h0) = h0
      reported%at(of_load) = load%value
      reported%at(of_radius) = contact_radius(h0)
      reported%left(of_load) = load%error + rounding*abs(load%value) + &
        given_error(h0)*abs(load_slope_undeformed(problem, h0))
      reported%left(of_radius) = radius_error(h0, given_error(h0))
    end function place_at

    !> Contact radius, lateral units; 0 without contact.
    pure real(wp) function contact_radius(h0) result(radius)
      real(wp), intent(in) :: h0

      radius = 0
      associate (level => contact_level_of(problem))
        if (h0 < level) radius = problem%shape%position_of(level - h0)
      end associate
    end function contact_radius

    !> Error of the contact radius due to an error of h0, and to rounding.
    pure real(wp) function radius_error(h0, off)
      real(wp), intent(in) :: h0, off

      radius_error = contact_radius(h0 - off) - contact_radius(h0 + off) + &
        rounding*contact_radius(h0)
    end function radius_error

    !> Rounding error of an h0 that is given in metres.
    pure real(wp) function given_error(h0)
      real(wp), intent(in) :: h0

      given_error = rounding*max(1.0_wp, abs(h0), abs(problem%law%origin/problem%length))
    end function given_error

  end subroutine run_branch

  !> Gaps between two gaps, with both ends, so close that a law is unlikely to have two extrema
  !> between neighbours.
  pure function gaps_between(law, low, high) result(gap)
    class(force_law_t), intent(in) :: law
    real(wp), intent(in) :: low, high
    real(wp), allocatable :: gap(:)
    real(wp) :: place
    integer :: count, i

    place = low
    count = 1
    do while (place < high)
      place = next(place)
      count = count + 1
    end do
    allocate (gap(count))
    gap(1) = low
    do i = 2, count
      gap(i) = min(next(gap(i - 1)), high)
    end do

  contains

    pure real(wp) function next(gap)
      real(wp), intent(in) :: gap
      real(wp) :: step

      if (law%smallest_gap < no_pole) then
        step = part*max(abs(gap), 1.0_wp)
      else
        step = part*max(gap - law%smallest_gap, least)
      end if
      if (law%period > 0 .and. gap < law%range) step = min(step, law%period/of_period)
      next = gap + step
      if (allocated(law%breaks)) next = minval([next, pack(law%breaks, law%breaks > gap)])
    end function next

  end function gaps_between

end module rigid_bodies
