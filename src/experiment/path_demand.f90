!> The range of h0 of an experiment, and of the path that it needs. A soft spring needs a wide
!> range: snap-in ends deep in contact, and snap-off far apart.
module path_demand
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t, coupling_over, yielding_gap
  use barriers, only: pass_barrier, trial_ratio
  use contact_scales, only: beyond_contact
  use convex_contact, only: jkr_like_pull_off
  use undeformed, only: load_undeformed
  use path_point, only: load_alone
  use path_end, only: demand_t
  use experiment_request, only: request_t
  implicit none
  private
  public :: path_start, range_of, demand_of, h0_in_contact

  !> Where the deformation of the bodies is below this fraction of that at the jump, it no longer
  !> affects the load, and closed forms replace the path.
  real(wp), parameter :: no_yielding = 1.0e-9_wp
  !> Smallest trial radius of the contact, in lateral units; and margin for the error of an h0 of
  !> JKR theory.
  real(wp), parameter :: smallest = 0.1_wp, margin = 0.1_wp
  !> Number of h0 at which the tension of rigid bodies is evaluated.
  integer, parameter :: tried = 100

contains

  !> The h0 [m] at which the shown path starts: beyond any contact and any largest tension, or the
  !> deck's value.
  real(wp) function path_start(request, problem) result(start)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem

    start = problem%law%separation_of(beyond_pull(problem, beyond_contact(problem)))
    if (.not. allocated(request%path)) return
    if (allocated(request%path%h0_start)) then
      start = request%path%h0_start
    else if (allocated(request%profile_h0)) then
      start = max(start, maxval(request%profile_h0))
    end if
  end function path_start

  !> An h0 larger than `from`, and larger than the h0 of the largest tension of undeformed bodies
  !> beyond `from`. Outside a barrier the tension may be largest far from contact.
  pure real(wp) function beyond_pull(problem, from) result(h0)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: from
    real(wp) :: most, load
    integer :: k

    h0 = from
    if (.not. problem%law%adhesion > 0) return
    most = load_undeformed(problem, from)
    do k = 1, tried
      load = load_undeformed(problem, from*trial_ratio**k)
      if (.not. load < min(most, 0.0_wp)) cycle
      most = load
      h0 = from*trial_ratio**(k + 1)
    end do
  end function beyond_pull

  !> The range of H0 of a scene that must be traced, in the law's lengths.
  subroutine range_of(request, problem, low, high)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp), intent(out) :: low, high
    type(demand_t) :: demand
    integer :: i

    low = huge(1.0_wp)
    high = -huge(1.0_wp)
    if (allocated(request%loading)) then
      low = request%loading%h0_end
      high = request%loading%h0_start
    end if
    if (allocated(request%unloading)) high = max(high, request%unloading%h0_end)
    if (allocated(request%drive)) then
      low = min(low, request%drive%z_turn)
      high = max(high, request%drive%z_start, request%drive%z_end)
    end if
    if (allocated(request%path)) then
      low = min(low, request%path%h0_end)
      high = max(high, request%path%h0_end)
      ! The state after the last jump out of contact also belongs to the path.
      high = max(high, path_start(request, problem), &
        problem%law%separation_of(beyond_contact(problem)))
    end if
    low = problem%law%gap_of(low)
    high = problem%law%gap_of(high)
    if (.not. request%reads_path() .or. .not. problem%law%adhesion > 0) return
    demand = demand_of(request, problem)
    high = max(high, min(demand%farthest, yielding_gap(problem, no_yielding)))
    do i = 1, size(demand%until)
      low = min(low, h0_in_contact(problem, demand%weights(:, i), demand%until(i)))
    end do
  end subroutine range_of

  !> What the request reads from the path: states at the position of a drive, and at fixed loads.
  type(demand_t) function demand_of(request, problem) result(demand)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp) :: h0_behind, load_before
    logical :: closes
    integer :: i

    demand%farthest = farthest_wanted(request, problem)
    allocate (demand%weights(2, 0))
    demand%until = [real(wp) ::]
    demand%closes = [logical ::]
    if (allocated(request%fixed_loads)) then
      do i = 1, size(request%fixed_loads)
        call add(-load_alone, -max(request%fixed_loads(i)/problem%load, 0.0_wp), .false.)
      end do
    end if
    if (.not. allocated(request%device)) return
    call pass_barrier(problem, h0_behind, load_before, closes)
    associate (device => request%device)
      if (size(device%stiffness) == 0) call add_spring(0.0_wp)
      do i = 1, size(device%stiffness)
        if (device%stiffness(i) > 0) then
          call add_spring(problem%load/(device%stiffness(i)*problem%length))
        else if (closes) then
          call add(-load_alone, -load_before, .true.)
        end if
      end do
    end associate

  contains

    !> Adds a spring with the compliance `softness`. Its base moves to z_end or, if there is none,
    !> beyond the position at which the highest barrier is overcome.
    subroutine add_spring(softness)
      real(wp), intent(in) :: softness

      if (allocated(request%device%z_end)) then
        call add([1.0_wp, -softness], problem%law%gap_of(request%device%z_end), .false.)
      else if (closes) then
        call add([1.0_wp, -softness], h0_behind - softness*load_before, .true.)
      end if
    end subroutine add_spring

    subroutine add(weights, until, closes)
      real(wp), intent(in) :: weights(2), until
      logical, intent(in) :: closes

      demand%weights = reshape([demand%weights, weights], [2, size(demand%until) + 1])
      demand%until = [demand%until, until]
      demand%closes = [demand%closes, closes]
    end subroutine add

  end function demand_of

  !> The largest h0 at which a state is needed (law's lengths); 0: there is no such need.
  pure real(wp) function farthest_wanted(request, problem) result(farthest)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    real(wp) :: load
    integer :: i

    farthest = 0
    if (allocated(request%device)) then
      if (allocated(request%device%z_start)) farthest = problem%law%gap_of(request%device%z_start)
      do i = 1, size(request%device%stiffness)
        associate (k => request%device%stiffness(i))
          if (k > 0) farthest = max(farthest, beyond_contact(problem) + &
            trial_ratio*largest_pull(problem)*problem%load/(k*problem%length))
        end associate
      end do
    end if
    if (.not. allocated(request%fixed_loads)) return
    do i = 1, size(request%fixed_loads)
      load = request%fixed_loads(i)/problem%load
      if (abs(load) > 0) farthest = max(farthest, gap_of_load(problem, load))
    end do
  end function farthest_wanted

  !> A gap beyond which the load between undeformed bodies is smaller than `load`.
  pure real(wp) function gap_of_load(problem, load) result(gap)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: load
    integer :: step

    gap = 1
    do step = 1, 400
      if (max(abs(load_undeformed(problem, gap)), abs(load_undeformed(problem, trial_ratio*gap)), &
        abs(load_undeformed(problem, trial_ratio**2*gap))) < abs(load)) exit
      gap = trial_ratio*gap
    end do
  end function gap_of_load

  !> A tension that no pull-off exceeds: for parabolas that of rigid bodies; for other shapes the
  !> larger one of rigid bodies and JKR theory, doubled because of thin films.
  pure real(wp) function largest_pull(problem) result(tension)
    type(problem_t), intent(in) :: problem
    real(wp) :: well
    integer :: step

    if (problem%shape%parabolic) then
      tension = merge(2, 4, problem%body%is_homogeneous())*pi*problem%law%adhesion
      return
    end if
    tension = 0
    if (problem%law%work > 0) tension = -jkr_like_pull_off(problem)
    associate (law => problem%law)
      well = law%length
      if (law%rest_gap > 0) well = law%separation_of(law%rest_gap)
      ! If the law attracts in contact, the tension has no limit at small gaps, which are omitted.
      do step = merge(0, -tried/2, law%falls_below > 0), tried/2
        tension = max(tension, -load_undeformed(problem, law%gap_of(well*trial_ratio**step)))
      end do
    end associate
  end function largest_pull

  !> An h0 below that at which Q = weights(1) h0 + weights(2) load has the value `wanted` in
  !> contact, by JKR theory (10), (11).
  pure real(wp) function h0_in_contact(problem, weights, wanted) result(h0)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: weights(2), wanted
    real(wp) :: c

    c = 1
    do while (position(c) > wanted)
      c = 2*c
    end do
    do while (c > smallest .and. position(c/trial_ratio) < wanted)
      c = c/trial_ratio
    end do
    h0 = h0_at(c)
    h0 = h0 - margin*(1 + abs(h0))

  contains

    pure real(wp) function h0_at(radius)
      real(wp), intent(in) :: radius

      h0_at = 1 - problem%shape%indentation(radius) + &
        sqrt(4*pi*coupling_over(problem, radius)*problem%law%adhesion*radius)
    end function h0_at

    pure real(wp) function position(radius)
      real(wp), intent(in) :: radius

      associate (coupling => coupling_over(problem, radius))
        position = weights(1)*h0_at(radius) + weights(2)*( &
          problem%shape%indentation_load(radius)/coupling - &
          sqrt(4*pi*problem%law%adhesion*radius**3/coupling))
      end associate
    end function position

  end function h0_in_contact

end module path_demand
