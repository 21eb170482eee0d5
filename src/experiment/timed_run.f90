!> A drive that moves in time, and its results. The motion is run in several passes, each with all
!> steps halved and more nodes for the internal variables, until the numbers of two passes agree.
module timed_run
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use clock, only: seconds
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use equilibrium, only: cost_t
  use edge_locked, only: new_mesh_family, shape_for
  use mesh_digits, only: most_digits
  use records, only: observer_t
  use path_stepper, only: path_stepper_t
  use stepper, only: branch_point_t, step_result_t
  use traced_path, only: tracing_t
  use tracing, only: trace
  use numerics_choice, only: choice_t, size_grid, fixed_mesh, panels
  use experiment_request, only: request_t, numerics_t
  use path_demand, only: h0_in_contact
  use motion, only: new_motion, names_of_ways
  use time_stepper, only: time_stepper_t
  use memory_mesh, only: new_memory_mesh
  use solver_options, only: tightened
  use drainage, only: farthest_pole
  use frozen_start, only: effect_of_start
  use timed_pass, only: go_through
  use timed_record, only: timed_result_t, pass_t, most_steps, enter_numbers
  use places, only: places_t
  use reported_place, only: of_suction
  use reported_numbers, only: run_numbers_t, largest_error, chance
  implicit none
  private
  public :: run_timed

  !> Largest number of passes, and the largest change of the path's coordinate in a step of the
  !> first pass: a larger change is a jump, or needs shorter steps.
  integer, parameter :: most_passes = 9
  !> Number of passes in which the bodies may be lost before two consecutive passes are complete.
  integer, parameter :: most_tries = 3
  real(wp), parameter :: farthest = 0.3_wp
  !> Length of panels of the mesh for internal variables over the width of the cohesive zone, and
  !> their additional nodes; largest number of nodes, beyond which a warning reports unresolved
  !> details.
  real(wp), parameter :: over_neck = 3
  integer, parameter :: over_order = 3, most_nodes = 5000
  !> Largest quadrature error of a pressure on long panels of this mesh, over the accuracy.
  real(wp), parameter :: left_out = 1.0e-3_wp
  !> Extent of the mesh for internal variables under the pressure of a fluid, over the width of the
  !> film.
  real(wp), parameter :: far_out = 50
  !> Additional digits of the meshes in each pass.
  real(wp), parameter :: more_digits = 0.7_wp

contains

  !> Simulates the motion of request%drive, and shows the rows of the last pass. places: the
  !> numbers, with their errors. passes: if present, the number of passes, and the numbers get no
  !> errors. error: the largest relative error, huge if the motion was lost.
  subroutine run_timed(request, problem, chosen, observer, result, places, error, cost, nodes, &
    passes)
    class(request_t), intent(in) :: request
    type(problem_t), intent(in) :: problem
    type(choice_t), intent(in) :: chosen
    class(observer_t), intent(inout) :: observer
    type(timed_result_t), intent(out) :: result
    type(places_t), intent(out) :: places
    real(wp), allocatable, intent(out) :: error
    type(cost_t), intent(inout) :: cost
    integer, intent(out) :: nodes
    integer, intent(in), optional :: passes
    type(time_stepper_t) :: steps
    type(places_t) :: nothing
    type(run_numbers_t) :: others(2)
    type(pass_t) :: now, before, blank
    real(wp) :: began, low
    integer :: pass, whole, i

    ! The error of a pass over its difference from the pass before and from the one before that:
    ! steps half as long have a quarter of the error.
    others%part = 1/([4, 16] - 1.0_wp)
    call prepare()
    if (allocated(request%drive%time_step)) blank%time_step = request%drive%time_step
    began = seconds()
    ! With a spring the lowest h0 is that of the contact with the spring's load.
    low = minval(blank%drive%position)
    if (allocated(request%drive%stiffness)) low = &
      h0_in_contact(relaxed_problem(), [1.0_wp, -steps%compliance], low)
    call run_passes()
    result = now%result
    if (result%lost) then
      places = nothing
      error = huge(1.0_wp)
      if (.not. result%begun) deallocate (error)
    end if
    nodes = sum(steps%meshes%grid%nodes)
    do i = 1, now%held
      now%row(i)%time = now%row(i)%time + &
        blank%drive%began(findloc(names_of_ways == now%row(i)%branch, .true., 1))
      call observer%take(now%row(i), steps%problem, steps%meshes%grid(1), steps%before%state, &
        .false.)
    end do
    steps%cost%states = now%held
    steps%cost%solve_seconds = steps%cost%solve_seconds + seconds() - began
    cost = steps%cost
    if (.not. result%lost .and. problem%law%adhesion > 0) &
      result%of_start = effect_of_start(steps, blank%drive%position(0), now%row(:now%held))

  contains

    !> Runs passes until their numbers agree, the motion is lost, or there would be too many steps.
    subroutine run_passes()
      whole = 0
      do pass = 1, most_passes
        before = blank
        if (whole > 0) before = now
        now = blank
        now%number = pass
        call lay_out()
        steps%farthest = farthest/2**(pass - 1)
        call go_through(before, steps, observer, now)
        if (now%result%lost) then
          ! Finer meshes may resolve the loss; otherwise the previous passes have their error
          ! estimates.
          if (whole > 1 .and. .not. present(passes)) now = before
          if (whole > 1 .or. pass == most_tries .or. .not. now%result%begun .or. &
            now%held > most_steps) exit
          whole = 0
          cycle
        end if
        whole = whole + 1
        if (whole > 1 .and. .not. present(passes)) call keep_passes()
        call enter_numbers(now%result, request%numerics%accuracy, problem%shape%parabolic, &
          allocated(request%fluid), places)
        if (present(passes)) then
          if (pass >= passes) exit
          cycle
        end if
        if (whole == 1) cycle
        call places%judge_by(others(:min(2, whole - 1)), chance)
        call ignore_unknown_suction()
        error = largest_error(places%number)
        ! The first two passes may agree by chance.
        if (error <= request%numerics%accuracy .and. whole > 2 .or. &
          allocated(request%drive%time_step) .or. 2*now%held > most_steps) exit
      end do
    end subroutine run_passes

    !> Keeps the numbers of this pass and of the one before, with which the next pass is compared.
    !> If this pass did not determine the suction, because of an unresolved jump in the one before,
    !> the next suction is not compared with that of the one before.
    subroutine keep_passes()
      integer :: i

      if (whole > 2) others(2)%number = others(1)%number
      others(1)%number = places%numbers()
      if (whole == 2) return
      do i = 1, size(places%number)
        if (places%number(i)%compared(of_suction)) cycle
        where (others(2)%number%name == places%number(i)%name) &
          others(2)%number%value(of_suction) = places%number(i)%value(of_suction)
      end do
    end subroutine keep_passes

    !> A suction whose error exceeds the suction itself is not determined, and does not count: more
    !> passes rarely help, and the summary has a warning.
    subroutine ignore_unknown_suction()
      integer :: i

      do i = 1, size(places%number)
        associate (number => places%number(i))
          if (ieee_is_nan(number%error(of_suction) - number%value(of_suction))) cycle
          if (number%error(of_suction) > number%value(of_suction)) &
            number%compared(of_suction) = .false.
        end associate
      end do
    end subroutine ignore_unknown_suction

    !> Prepares the stepper for the problem, and the motion of the drive.
    subroutine prepare()
      associate (asked => request%drive, law => problem%law)
        steps%problem = problem
        steps%cost = cost
        steps%instant = problem%coupling
        if (allocated(request%creep)) then
          steps%creep = request%creep
        else
          allocate (steps%creep%share(0), steps%creep%time(0))
        end if
        steps%options = chosen%options
        steps%options%mixing = .false.
        if (allocated(asked%stiffness)) &
          steps%compliance = problem%load/(asked%stiffness*problem%length)
        blank%drive = new_motion(asked%velocity/problem%length, law%gap_of(asked%z_start), &
          law%gap_of(asked%z_turn), asked%dwell, law%gap_of(asked%z_end))
      end associate
      if (allocated(request%fluid)) then
        ! Rates are differences of gaps over short steps, so that the gaps must be exact to
        ! rounding.
        steps%options = tightened(steps%options)
        allocate (steps%drainage)
        steps%drainage%strength = 12*request%fluid%viscosity*problem%lateral**2/ &
          (problem%length**2*problem%pressure)
        steps%drainage%slip = request%fluid%slip/problem%length
      end if
    end subroutine prepare

    type(problem_t) function relaxed_problem() result(relaxed)
      relaxed = steps%problem
      relaxed%coupling = steps%instant*steps%creep%relaxed()
    end function relaxed_problem

    !> Lays out meshes for relaxed bodies, whose cohesive zone is the narrowest, with more digits in
    !> each pass; and panels fixed in space for the internal variables, with one more node each.
    subroutine lay_out()
      type(problem_t) :: relaxed
      type(numerics_t) :: numerics
      type(choice_t) :: of_memory
      type(discretisation_t) :: grid
      real(wp) :: digits, high

      relaxed = relaxed_problem()
      high = maxval(blank%drive%position)
      ! Internal variables follow the pressure at the nodes, which has half as many digits as its
      ! integrals.
      digits = chosen%digits
      if (allocated(request%creep) .or. allocated(request%fluid)) digits = 2*digits
      if (allocated(steps%drainage)) relaxed%film_gap = high + farthest_pole(steps%drainage%fluid_t)
      associate (meshes => steps%meshes)
        ! A drive inserts no meshes while the edge moves towards a rim.
        meshes = new_mesh_family(relaxed, high, low, &
          min(most_digits, digits + more_digits*(pass - 1)), further=.false.)
        if (any(meshes%waits) .or. may_pass_early(relaxed)) call fit_to_path(relaxed, high)
        if (allocated(steps%drainage)) call steps%drainage%lay_out(meshes%grid)
        call steps%frozen%forget()
        call steps%operator%forget()
        steps%cost%kernel_entries = steps%cost%kernel_entries + sum(meshes%grid%kernel_entries())
        if (.not. allocated(request%creep)) return
        numerics = request%numerics
        if (relaxed%film_gap > 0) numerics%r_max = far_out*relaxed%lateral* &
          relaxed%shape%position_of(relaxed%film_gap)
        of_memory%grid = panels
        of_memory%low = low
        call size_grid(of_memory, numerics, relaxed)
        of_memory%panel_over_feature = over_neck
        of_memory%panel_order = of_memory%panel_order + over_order + pass
        of_memory%nodes = most_nodes
        grid = fixed_mesh(of_memory, relaxed)
        steps%material = new_memory_mesh(grid, count(abs(grid%panel%right - grid%panel%left - &
          grid%panel(1)%right) <= sqrt(epsilon(1.0_wp))*grid%panel(1)%right), &
          left_out*request%numerics%accuracy)
        steps%cost%kernel_entries = steps%cost%kernel_entries + steps%material%kernel_entries()
      end associate
    end subroutine lay_out

    !> Whether the path may pass to the mesh of the contact edge before the planned radius
    !> (`mesh_passage`).
    pure logical function may_pass_early(problem)
      type(problem_t), intent(in) :: problem

      may_pass_early = .not. (problem%body%is_homogeneous() .or. problem%shape%parabolic)
    end function may_pass_early

    !> Lays out the meshes for the gaps of the path of relaxed bodies. This is needed for laws with
    !> a step or oscillations, and for bodies whose path passes early to the mesh of the contact
    !> edge. Meshes that the path does not reach are laid out without computed gaps.
    subroutine fit_to_path(relaxed, high)
      type(problem_t), intent(in) :: relaxed
      real(wp), intent(in) :: high
      type(path_stepper_t) :: at_rest
      type(branch_point_t) :: afar
      type(step_result_t) :: event
      type(tracing_t) :: traced
      integer :: k

      at_rest%problem = relaxed
      at_rest%options = steps%options
      at_rest%cost = steps%cost
      at_rest%meshes = steps%meshes
      at_rest%meshes%grows = .false.
      ! The pieces of the path and the jumps between them, which `find_path` solves too, are not
      ! needed.
      call at_rest%solve_afar(high, afar, event)
      if (.not. event%ending%early()) call trace(at_rest%solver_t, afar%state, low, .true., &
        request%numerics%accuracy, observer, traced)
      steps%meshes = at_rest%meshes
      steps%cost = at_rest%cost
      associate (meshes => steps%meshes)
        do k = 1, size(meshes%grid)
          if (meshes%waits(k)) call meshes%renew(k, shape_for(meshes, relaxed, k))
        end do
      end associate
    end subroutine fit_to_path

  end subroutine run_timed

end module timed_run
