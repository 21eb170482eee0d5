!> The records that an experiment gives to the observer of its results, one for each equilibrium, in
!> SI units; and the results of a branch of states.
module records
  use kinds, only: wp
  use progress_observer, only: progress_observer_t
  use dimensionless_problem, only: problem_t, spacing_over_neck
  use discretisation, only: discretisation_t
  use contact_state, only: state_t, contact_radius_of
  use ending, only: ending_t
  use reported_place, only: place_t, of_h0
  implicit none
  private
  public :: record_t, observer_t, record_of, quality_t, branch_t, stable_yes, stable_no, &
    stable_unasked

  !> Values of the column `stable`.
  integer, parameter :: stable_yes = 1, stable_no = 0, stable_unasked = -1

  type :: record_t
    character(len=:), allocatable :: branch
    !> Units: m, m, m, N, m; the residual is in units of the law's length.
    real(wp) :: h0 = 0, h_centre = 0, displacement = 0, load = 0, contact_radius = 0
    !> For a drive in time: the time [s], and the position [m] of a spring's base.
    real(wp), allocatable :: time, z
    integer :: stable = stable_unasked
    real(wp) :: residual = 0
    integer :: iterations = 0
    !> Whether the equations hold to the tolerance.
    logical :: converged = .true.
    !> Smallest eigenvalue and the left sides of (28) and (29); only with &stability.
    real(wp), allocatable :: eigenvalue, local_criterion, axis_criterion
  end type record_t

  !> The quality of some rows. For the numerics: largest residual, and widest spacing of nodes at
  !> the contact edge over the width of the cohesive zone. For the limits of the model: widest
  !> contact [m], largest magnitude of pressure (law's unit), deepest approach below h0 = 0 [m],
  !> largest magnitude of load [N], and smallest gap (law's unit).
  type :: quality_t
    real(wp) :: residual = 0, spacing = 0, contact_radius = 0, pressure = 0, depth = 0, load = 0
    real(wp) :: gap = huge(1.0_wp)
  contains
    procedure :: cover
    procedure :: cover_extent
    procedure :: join
  end type quality_t

  !> The results of a branch, in the units of `dimensionless_problem`. A component that is not
  !> allocated does not exist.
  type :: branch_t
    integer :: states = 0, unconverged = 0
    !> Largest tension (a negative load), and whether it is in the first or in the last row, so that
    !> the tension may grow beyond.
    type(place_t), allocatable :: lowest
    logical :: lowest_first = .false., lowest_last = .false.
    !> Whether the tension grows towards neighbouring states that did not converge.
    logical :: lowest_beside_lost = .false.
    !> The first jump: h0 and the load just before it, and the uncertainty of h0 if the path is not
    !> known.
    type(place_t), allocatable :: jump
    !> The last equilibrium, which is a converged state.
    type(place_t), allocatable :: finish
    !> The stable pieces of the path on which the branch begins and ends; 0 if they are not known,
    !> or the state is unstable.
    integer :: first_piece = 0, last_piece = 0
    type(quality_t) :: quality
    !> First h0 at which the iteration did not converge.
    real(wp) :: first_unconverged = 0
    !> The first part of the branch in which it is not known whether the bodies jumped.
    logical :: unsure = .false.
    real(wp) :: unsure_between(2) = 0
    type(ending_t) :: ending
  contains
    procedure :: compare_ends
  end type branch_t

  !> Receives records as they are computed. This one ignores them, for runs that need only the
  !> summary; extensions keep them.
  type, extends(progress_observer_t) :: observer_t
  contains
    procedure :: take
  end type observer_t

contains

  !> Includes one row; has_edge: whether the state has a contact edge.
  pure subroutine cover(self, record, problem, grid, state, has_edge)
    class(quality_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: has_edge

    self%residual = max(self%residual, state%residual)
    if (has_edge) self%spacing = max(self%spacing, &
      spacing_over_neck(problem, state%scale*grid%spacing))
    call self%cover_extent(record%contact_radius, record%h0, record%load, state)
  end subroutine cover

  !> Includes the measures of strain of a state. contact_radius and h0 [m], load [N].
  pure subroutine cover_extent(self, contact_radius, h0, load, state)
    class(quality_t), intent(inout) :: self
    real(wp), intent(in) :: contact_radius, h0, load
    type(state_t), intent(in) :: state

    self%contact_radius = max(self%contact_radius, contact_radius)
    self%depth = max(self%depth, -h0)
    self%load = max(self%load, abs(load))
    ! Undeformed bodies have no nodes.
    if (.not. allocated(state%pressure)) return
    self%pressure = max(self%pressure, maxval(abs(state%pressure)))
    self%gap = min(self%gap, minval(state%gap))
  end subroutine cover_extent

  !> Includes all rows of an experiment.
  pure subroutine join(self, other)
    class(quality_t), intent(inout) :: self
    class(quality_t), intent(in) :: other

    self%residual = max(self%residual, other%residual)
    self%spacing = max(self%spacing, other%spacing)
    self%contact_radius = max(self%contact_radius, other%contact_radius)
    self%pressure = max(self%pressure, other%pressure)
    self%gap = min(self%gap, other%gap)
    self%depth = max(self%depth, other%depth)
    self%load = max(self%load, other%load)
  end subroutine join

  !> Compares the place of the largest tension with the h0 of the first and of the last row. If the
  !> tension is largest at a point of the path, it is an extremum, a fold or the end of a jump,
  !> beyond which the tension does not grow.
  pure subroutine compare_ends(branch, first, last)
    class(branch_t), intent(inout) :: branch
    real(wp), intent(in) :: first, last

    if (.not. allocated(branch%lowest)) return
    if (branch%lowest%point > 0) return
    branch%lowest_last = abs(branch%lowest%at(of_h0) - last) <= 0
    branch%lowest_first = .not. branch%lowest_last .and. &
      abs(branch%lowest%at(of_h0) - first) <= 0
  end subroutine compare_ends

  !> Receives a record. state and grid: for the profile; profile: the scene requests the profile.
  subroutine take(self, record, problem, grid, state, profile)
    class(observer_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
  end subroutine take

  !> The record of a state on a branch; stable: `stable_yes`, `stable_no` or `stable_unasked`.
  pure function record_of(branch, problem, grid, state, stable, converged) result(record)
    character(len=*), intent(in) :: branch
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    integer, intent(in) :: stable
    logical, intent(in) :: converged
    type(record_t) :: record

    record%branch = branch
    record%h0 = problem%law%separation_of(state%h0)
    record%h_centre = problem%law%separation_of(state%axis_gap)
    ! Equation (19).
    record%displacement = (state%axis_gap - state%h0)*problem%length
    record%load = state%load*problem%load
    record%contact_radius = problem%lateral*contact_radius_of(problem, grid, state)
    record%stable = stable
    ! A state that is not an equilibrium is neither stable nor unstable.
    if (.not. converged) record%stable = stable_unasked
    record%residual = state%residual
    record%iterations = state%iterations
    record%converged = converged
  end function record_of

end module records
