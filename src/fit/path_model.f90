!> The model whose loads are those of the equilibrium path, computed for each trial of the unknowns.
!> Branches are the stable ones of the path with the spring, segments those of `device`.
module path_model
  use kinds, only: wp
  use failure, only: failure_t
  use progress_observer, only: progress_observer_t
  use dimensionless_problem, only: problem_t
  use variation, only: problem_family_t, variation_t, vary, to_search
  use edge_locked, only: new_mesh_family
  use mesh_store, only: mesh_store_t
  use traced_path, only: traced_path_t
  use path_sensitivity, only: rate_t, rates_along
  use driven_pieces, only: driven_piece_t, through_spring
  use piece_search, only: find_pieces
  use device, only: driven_t, drive_bodies
  use experiment_request, only: request_t, numerics_t
  use numerics_choice, only: choice_t, choose
  use path_end, only: demand_t
  use path_demand, only: demand_of
  use path_stepper, only: path_stepper_t
  use contact_edges, only: edge_t, find_edges, set_rates
  use force_branch, only: force_branch_t
  use force_model, only: force_model_t, response_t, way_t, inward, outward
  implicit none
  private
  public :: path_model_t

  !> The points of a path are densest for the accuracy `closest_for`; for a larger one they are
  !> farther apart (`demand_t`). enough: the relative residual at which the equations for the
  !> derivatives of a curve count as solved.
  real(wp), parameter :: closest_for = 1.0e-6_wp, enough = 1.0e-5_wp

  !> A trial: its values of the unknowns and its path. solved: the path exists.
  type :: trial_t
    real(wp), allocatable :: value(:)
    type(path_stepper_t) :: steps
    type(driven_t) :: driven
    real(wp) :: stiffness = 0, farthest = 0, largest = 0
    logical :: solved = .false.
    !> Derivatives of the curve, once they were requested.
    type(rate_t), allocatable :: rate(:, :)
    !> The edges of the contact at the points of the path, if the contact radius is wanted.
    type(edge_t), allocatable :: edge(:)
  contains
    procedure :: serves
  end type trial_t

  type, extends(force_model_t) :: path_model_t
    !> The problems; the unknowns are its parameters.
    class(problem_family_t), allocatable :: family
    type(numerics_t) :: numerics
    !> All trials share their meshes.
    type(mesh_store_t), private :: store
    !> Two trials; `last` is the index of the one requested last. A fit requests its best values
    !> again after trials elsewhere that need no derivatives. Therefore a trial with derivatives is
    !> kept until another one has derivatives.
    type(trial_t), private :: trial(2)
    integer, private :: last = 1
    !> The fraction of the load that is missing on the meshes of the trial solved last
    !> (`mesh_refinement`).
    real(wp) :: left_out = 0
  contains
    procedure :: respond
    procedure :: widen_to
    procedure, private :: solve_trial
  end type path_model_t

contains

  subroutine respond(self, value, stiffness, farthest, largest, with_rates, response, found)
    class(path_model_t), intent(inout) :: self
    real(wp), intent(in) :: value(:), stiffness, farthest, largest
    logical, intent(in) :: with_rates
    type(response_t), intent(out) :: response
    logical, intent(out) :: found
    type(rate_t), allocatable :: rate(:, :)
    integer :: i

    if (.not. self%trial(self%last)%serves(value, stiffness, farthest, largest)) then
      i = 3 - self%last
      if (self%trial(i)%serves(value, stiffness, farthest, largest)) then
        self%last = i
      else
        if (allocated(self%trial(self%last)%rate)) self%last = i
        call self%solve_trial(value, stiffness, farthest, largest, self%trial(self%last))
      end if
    end if
    associate (trial => self%trial(self%last))
      found = trial%solved
      if (.not. found) return
      if (with_rates .and. .not. allocated(trial%rate)) then
        call find_rates(self%family, trial, found)
        if (.not. found) return
      end if
      allocate (rate(merge(size(value), 0, with_rates), trial%steps%known%path%last))
      if (with_rates) rate = trial%rate
      allocate (response%branch(size(trial%driven%piece)))
      do i = 1, size(response%branch)
        call make_branch(trial%steps%problem, trial%steps%known%path, trial%driven%piece(i), rate, &
          trial%edge, response%branch(i))
        call response%branch(i)%close(stiffness)
      end do
      if (stiffness > 0) then
        call find_ways(trial%steps%problem, trial%driven, response)
      else
        ! Under dead loads the last branch is the one in contact.
        response%way(inward) = way_t([i - 1], [-huge(1.0_wp)])
        response%way(outward) = way_t([i - 1], [huge(1.0_wp)])
      end if
    end associate
  end subroutine respond

  !> Whether a trial has these values of the unknowns, and a path that is long enough.
  pure logical function serves(self, value, stiffness, farthest, largest)
    class(trial_t), intent(in) :: self
    real(wp), intent(in) :: value(:), stiffness, farthest, largest

    serves = allocated(self%value) .and. largest <= self%largest .and. farthest <= self%farthest
    if (serves) serves = all(abs(value - self%value) <= 0) .and. &
      abs(stiffness - self%stiffness) <= 0
  end function serves

  !> Takes another family. Its first parameters are those of the present family; with its further
  !> parameters at their own values it describes the same problems. The trials need not be solved
  !> again.
  subroutine widen_to(self, family)
    class(path_model_t), intent(inout) :: self
    class(problem_family_t), intent(in) :: family
    integer :: i

    do i = 1, size(self%trial)
      associate (trial => self%trial(i))
        if (.not. allocated(trial%value)) cycle
        trial%value = [trial%value, family%parameter(size(trial%value) + 1:)%value]
        if (allocated(trial%rate)) deallocate (trial%rate)
      end associate
    end do
    deallocate (self%family)
    allocate (self%family, source=family)
  end subroutine widen_to

  !> Computes the path of a trial and the cycle of the spring along this path.
  subroutine solve_trial(self, value, stiffness, farthest, largest, trial)
    class(path_model_t), intent(inout) :: self
    real(wp), intent(in) :: value(:), stiffness, farthest, largest
    type(trial_t), intent(inout) :: trial
    type(trial_t) :: fresh
    type(request_t) :: request
    type(demand_t) :: demand
    type(problem_t) :: problem
    type(choice_t) :: chosen
    type(progress_observer_t) :: silent
    type(failure_t), allocatable :: error
    real(wp), allocatable :: anywhere

    trial = fresh
    trial%value = value
    trial%stiffness = stiffness
    trial%largest = largest
    trial%farthest = farthest
    call self%family%pose(value, problem, error)
    if (allocated(error)) return
    if (.not. problem%law%adhesion > 0) return
    request%numerics = self%numerics
    allocate (request%path, request%device)
    request%path%h0_end = problem%law%separation_of(problem%law%rest_gap)
    request%device%stiffness = [stiffness]
    request%device%z_start = farthest
    request%fixed_loads = [largest]
    chosen = choose(request, problem)
    demand = demand_of(request, problem)
    demand%looser = max(1.0_wp, self%numerics%accuracy/closest_for)
    associate (steps => trial%steps, driven => trial%driven)
      call steps%set_up(problem, chosen%options)
      steps%options%mixing = .false.
      steps%meshes = new_mesh_family(problem, chosen%high, chosen%low, chosen%digits, &
        store=self%store)
      call steps%find_path(chosen%high, chosen%low, chosen%ends_at, .true., &
        self%numerics%accuracy, silent, demand)
      self%left_out = steps%known%left_out
      if (.not. steps%known%path%held > 1) return
      if (self%with_radius) &
        call find_edges(steps%problem, steps%meshes, steps%known%path, trial%edge)
      if (.not. stiffness > 0) then
        call find_pieces(steps%solver_t, steps%known%path, through_spring(0.0_wp), driven)
        trial%solved = driven%whole .and. size(driven%piece) > 0
        return
      end if
      call drive_bodies(steps%solver_t, steps%known%path, &
        through_spring(stiffness*problem%length/problem%load), chosen%low, anywhere, anywhere, &
        driven)
      trial%solved = driven%solved .and. driven%caught .and. size(driven%leg) > 1
    end associate
  end subroutine solve_trial

  !> Finds the derivatives of a trial's curve by its unknowns.
  subroutine find_rates(family, trial, found)
    class(problem_family_t), intent(inout) :: family
    type(trial_t), intent(inout) :: trial
    logical, intent(out) :: found
    type(variation_t) :: varied(size(trial%value))
    type(rate_t), allocatable :: rate(:, :)
    type(failure_t), allocatable :: error
    real(wp), allocatable :: place(:)
    integer :: i

    family%parameter%value = trial%value
    where (abs(trial%value) > 0) family%parameter%scale = abs(trial%value)
    found = .true.
    do i = 1, size(varied)
      call vary(family, i, to_search, varied(i), error)
      found = found .and. .not. allocated(error)
    end do
    if (.not. found) return
    if (allocated(trial%edge)) place = trial%edge%place
    call rates_along(trial%steps%equations_t, trial%steps%known%path, varied, enough, rate, found, &
      place)
    if (.not. found) return
    call move_alloc(rate, trial%rate)
    if (allocated(trial%edge)) call set_rates(trial%edge, varied, trial%rate)
  end subroutine find_rates

  !> A stable branch of the path as panels, in SI units. rate(unknown, point): derivatives at its
  !> points.
  subroutine make_branch(problem, path, piece, rate, edge, branch)
    type(problem_t), intent(in) :: problem
    type(traced_path_t), intent(in) :: path
    type(driven_piece_t), intent(in) :: piece
    type(rate_t), intent(in) :: rate(:, :)
    type(edge_t), allocatable, intent(in) :: edge(:)
    type(force_branch_t), intent(out) :: branch
    integer, allocatable :: near(:)
    integer :: i, k, n

    allocate (branch%panel(piece%last%interval - piece%first%interval + 1))
    n = 0
    do i = piece%first%interval, piece%last%interval
      if (.not. path%point(i)%leads_on) cycle
      associate (panel => branch%panel(n + 1), point => path%point)
        near = path%fitted_between(i)
        panel%x = path%point(near)%coordinate
        panel%ends = path%point(i:i + 1)%coordinate
        if (i == piece%first%interval) panel%ends(1) = piece%first%coordinate
        if (i == piece%last%interval) panel%ends(2) = piece%last%coordinate
        if (.not. panel%ends(2) > panel%ends(1)) cycle
        panel%h0 = reshape([problem%law%separation_of(point(near)%state%h0), &
          problem%length*point(near)%tangent%h0], [2, size(near)], order=[2, 1])
        panel%load = problem%load*reshape([point(near)%state%load, point(near)%tangent%load], &
          [2, size(near)], order=[2, 1])
        panel%h0_rate = rate(:, near)%h0
        panel%load_rate = rate(:, near)%load
        if (allocated(edge)) then
          allocate (panel%square(2, size(near)))
          panel%square_rate = 0*panel%load_rate
          do k = 1, size(near)
            panel%square(:, k) = edge(near(k))%square
            if (size(rate, 1) > 0) panel%square_rate(:, k) = edge(near(k))%rate
          end do
        end if
      end associate
      n = n + 1
    end do
    branch%panel = branch%panel(:n)
    branch%turns_first = piece%first_turns
    branch%turns_last = piece%last_turns
  end subroutine make_branch

  !> Finds the branches of approach and retract, and the main jump of each.
  subroutine find_ways(problem, driven, response)
    type(problem_t), intent(in) :: problem
    type(driven_t), intent(in) :: driven
    type(response_t), intent(inout) :: response
    real(wp) :: largest(2), change_of_load
    integer :: i, k

    response%way = way_t([integer ::], [real(wp) ::])
    do i = 1, size(driven%leg)
      k = merge(inward, outward, driven%leg(i)%inward)
      associate (way => response%way(k))
        way%branch = [way%branch, driven%leg(i)%piece]
        way%leaves_at = [way%leaves_at, &
          problem%law%separation_of(driven%drive%position(driven%leg(i)%to))]
      end associate
    end do
    ! The jumps of a segment start from the ends of its legs, in order, except from the last leg.
    largest = 0
    do i = 1, size(driven%jumped)
      k = merge(inward, outward, driven%jumped(i)%inward)
      associate (jump => driven%jumped(i))
        change_of_load = abs(jump%after%state%load - jump%before%state%load)
        if (.not. change_of_load > largest(k)) cycle
        largest(k) = change_of_load
        response%way(k)%main = count(driven%jumped(:i)%inward .eqv. jump%inward)
      end associate
    end do
  end subroutine find_ways

end module path_model
