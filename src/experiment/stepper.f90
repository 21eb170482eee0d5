!> What a quasi-static experiment at controlled h0 asks of whoever solves it: start as the bodies
!> approach from afar, then go from one h0 to the next, and say when they jumped.
module stepper
  use kinds, only: wp
  use dimensionless_problem, only: over_neck => spacing_over_neck
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use solver, only: solver_t
  use ending, only: ending_t
  use journal, only: journal_t
  implicit none
  private
  public :: stepper_t, keeping_stepper_t, branch_point_t, step_result_t, extreme_t, memory, &
    remember, move_to

  !> States kept for extrapolation in h0.
  integer, parameter :: memory = 4

  !> Where an experiment is: the present state and as much of its past as the next step can use.
  !> Copied to come back to it (turning points, refinements), and packed whole by `state_records`.
  type :: branch_point_t
    type(state_t) :: state
    !> Which of the solver's meshes the state lives on, and which stable piece of the path, where
    !> that is known.
    integer :: mesh = 1, piece = 0
    integer :: held = 0
    real(wp) :: h0(memory) = 0
    !> Room for as many states, once there is one: compiler note 11.
    type(state_t), allocatable :: past(:)
    !> The states that an experiment comes to have numbers, in order: those of `state` and `past`.
    integer :: number = 0, past_number(memory) = 0
  end type branch_point_t

  !> The largest tension of a step: the load, where, and the point of the path that it belongs to,
  !> or whose landing it belongs to; 0 for the state that the step ends in.
  type :: extreme_t
    real(wp) :: load = 0, h0 = 0
    integer :: point = 0
    logical :: landing = .false.
  end type extreme_t

  !> What happened in a step; packed whole by `state_records`.
  type :: step_result_t
    logical :: converged = .false.
    !> The state jumped; from where (h0, and the load just before), and how well that is known.
    logical :: jumped = .false.
    real(wp) :: jump_h0 = 0, jump_load = 0, jump_uncertainty = 0
    !> The fold that the first jump starts from, as a point of the path; 0 where that is not known.
    integer :: fold = 0
    !> The largest tension on the way, where the path that the step follows is known.
    type(extreme_t), allocatable :: lowest
    !> Early where there is no state.
    type(ending_t) :: ending
  end type step_result_t

  type, abstract, extends(solver_t) :: stepper_t
    !> How closely jumps are to be located, in the law's lengths.
    real(wp) :: jump_tolerance = 1.0e-6_wp
  contains
    procedure(begin_at), deferred :: approach_to
    procedure(go_to), deferred :: step_to
    procedure :: grid
    procedure :: spacing_over_neck
  end type stepper_t

  !> A stepper between an experiment and whoever solves, which keeps the steps.
  type, abstract, extends(stepper_t) :: keeping_stepper_t
    class(stepper_t), pointer :: steps => null()
    !> Where the steps are kept.
    type(journal_t), pointer :: journal => null()
    !> Time [s] that the steps of an earlier run once took.
    real(wp) :: earlier_seconds = 0
  contains
    procedure :: keep_steps_of
  end type keeping_stepper_t

  abstract interface
    !> The state at h0 that an approach from afar arrives at.
    subroutine begin_at(self, h0, position, event)
      import :: stepper_t, branch_point_t, step_result_t, wp
      class(stepper_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(branch_point_t), intent(out) :: position
      type(step_result_t), intent(out) :: event
    end subroutine begin_at

    !> From the position to h0. Not converged: position%state is the best that was found and its
    !> residual says how good that is.
    subroutine go_to(self, h0, position, event)
      import :: stepper_t, branch_point_t, step_result_t, wp
      class(stepper_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(branch_point_t), intent(inout) :: position
      type(step_result_t), intent(out) :: event
    end subroutine go_to
  end interface

contains

  !> Makes `steps` those that are kept.
  subroutine keep_steps_of(self, steps)
    class(keeping_stepper_t), intent(inout) :: self
    class(stepper_t), intent(in), target :: steps

    self%steps => steps
    self%problem = steps%problem
    self%options = steps%options
    self%jump_tolerance = steps%jump_tolerance
  end subroutine keep_steps_of

  !> The discretisation on which a position's state lives.
  function grid(self, position)
    class(stepper_t), intent(in), target :: self
    type(branch_point_t), intent(in) :: position
    type(discretisation_t), pointer :: grid

    grid => self%meshes%grid(position%mesh)
  end function grid

  !> Distance between nodes at the edge over the width of the neck, for a state; 0 without a neck.
  pure real(wp) function spacing_over_neck(self, position)
    class(stepper_t), intent(in) :: self
    type(branch_point_t), intent(in) :: position

    spacing_over_neck = over_neck(self%problem, &
      position%state%scale*self%meshes%grid(position%mesh)%spacing)
  end function spacing_over_neck

  !> Makes `state` the position's present one; on another mesh, or after a jump, the past is
  !> forgotten. foretold: the state was predicted from the past and needed no correction. Such a
  !> state is not added to the past.
  subroutine remember(position, state, mesh, jumped, foretold)
    type(branch_point_t), intent(inout) :: position
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    logical, intent(in) :: jumped
    logical, intent(in), optional :: foretold
    integer :: j

    if (mesh /= position%mesh .or. jumped) position%held = 0
    position%mesh = mesh
    call move_to(position, state)
    if (present(foretold)) then
      if (foretold) return
    end if
    ! A turn of the experiment comes back over the same values.
    do j = 1, position%held
      if (abs(position%h0(j) - state%h0) <= 1.0e-12_wp*max(1.0_wp, abs(state%h0))) then
        call forget(position, j)
        exit
      end if
    end do
    if (.not. allocated(position%past)) allocate (position%past(memory))
    if (position%held == memory) call forget(position, 1)
    position%held = position%held + 1
    position%h0(position%held) = state%h0
    call position%past(position%held)%become(state)
    position%past_number(position%held) = position%number
  end subroutine remember

  !> Makes `state` the position's present one, and no part of its past.
  subroutine move_to(position, state)
    type(branch_point_t), intent(inout) :: position
    type(state_t), intent(in) :: state

    call position%state%become(state)
    position%number = position%number + 1
  end subroutine move_to

  !> Drops a state of the past.
  pure subroutine forget(position, which)
    type(branch_point_t), intent(inout) :: position
    integer, intent(in) :: which
    integer :: k

    do k = which, position%held - 1
      position%h0(k) = position%h0(k + 1)
      call position%past(k)%become(position%past(k + 1))
      position%past_number(k) = position%past_number(k + 1)
    end do
    position%held = position%held - 1
  end subroutine forget

end module stepper
