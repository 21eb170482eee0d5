!> What a quasi-static experiment at controlled h0 asks of whoever solves it: start as the bodies
!> approach from afar, then go from one h0 to the next, and say when they jumped.
module quasi_static
  use kinds, only: wp
  use problem, only: problem_t
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t, cost_t
  use reported, only: witness_t
  use anderson, only: frozen_t
  use solver_options, only: solver_options_t
  implicit none
  private
  public :: quasi_static_t, position_t, event_t, extreme_t, memory, remember, touching

  !> Why rigid bodies have no state below the smallest gap of their law.
  character(len=*), parameter :: touching = &
    'rigid bodies would touch: so near (h0 <= 0, or far below it) this law has no pressure'

  !> States kept for extrapolation in h0.
  integer, parameter :: memory = 4

  !> Where an experiment is: the present state and as much of its past as the next step can use.
  !> Copied to come back to it (turning points, refinements), and packed whole by `packed_states`.
  type :: position_t
    type(state_t) :: state
    !> Which of the solver's meshes the state lives on, and which stable piece of the path, where
    !> that is known.
    integer :: mesh = 1, piece = 0
    integer :: held = 0
    real(wp) :: h0(memory) = 0
    type(state_t) :: past(memory)
  end type position_t

  !> The largest tension of a step: the load, where, and the point of the path that it belongs to, or
  !> whose landing it belongs to; 0 for the state that the step ends in.
  type :: extreme_t
    real(wp) :: load = 0, h0 = 0
    integer :: point = 0
    logical :: landing = .false.
  end type extreme_t

  !> What happened in a step; packed whole by `packed_states`.
  type :: event_t
    logical :: converged = .false.
    !> The state jumped; from where (h0, and the load just before), and how well that is known.
    logical :: jumped = .false.
    real(wp) :: jump_h0 = 0, jump_load = 0, jump_uncertainty = 0
    !> The fold that the first jump starts from, as a point of the path; 0 where that is not known.
    integer :: fold = 0
    !> The largest tension on the way, where the path that the step follows is known.
    type(extreme_t), allocatable :: lowest
    !> Why there is no state, for the user; empty otherwise.
    character(len=160) :: reason = ''
  end type event_t

  type, abstract :: quasi_static_t
    type(problem_t) :: problem
    type(solver_options_t) :: options
    type(frozen_t) :: frozen
    type(cost_t) :: cost
    !> How closely jumps are to be located, in the law's lengths.
    real(wp) :: jump_tolerance = 1.0e-6_wp
  contains
    procedure(begin_at), deferred :: begin
    procedure(go_to), deferred :: go
    !> The discretisation on which a position's state lives.
    procedure(grid_of), deferred :: grid
    !> Distance between nodes at the edge over the width of the neck, for a state; 0 without a neck.
    procedure(spacing_of), deferred :: spacing_over_neck
    !> The witness of a position's state: what its h0 was prescribed as.
    procedure(witness_of), deferred :: witness
    !> Which of the meshes the Jacobian for a kind of control lives on.
    procedure :: mesh_of
  end type quasi_static_t

  abstract interface
    !> The state at h0 that an approach from afar arrives at.
    subroutine begin_at(self, h0, position, event)
      import :: quasi_static_t, position_t, event_t, wp
      class(quasi_static_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(position_t), intent(out) :: position
      type(event_t), intent(out) :: event
    end subroutine begin_at

    !> From the position to h0. Not converged: position%state is the best that was found and its
    !> residual says how good that is.
    subroutine go_to(self, h0, position, event)
      import :: quasi_static_t, position_t, event_t, wp
      class(quasi_static_t), intent(inout) :: self
      real(wp), intent(in) :: h0
      type(position_t), intent(inout) :: position
      type(event_t), intent(out) :: event
    end subroutine go_to

    function grid_of(self, position) result(grid)
      import :: quasi_static_t, position_t, discretisation_t
      class(quasi_static_t), intent(in), target :: self
      type(position_t), intent(in) :: position
      type(discretisation_t), pointer :: grid
    end function grid_of

    pure real(wp) function spacing_of(self, position)
      import :: quasi_static_t, position_t, wp
      class(quasi_static_t), intent(in) :: self
      type(position_t), intent(in) :: position
    end function spacing_of

    pure function witness_of(self, position) result(witness)
      import :: quasi_static_t, position_t, witness_t
      class(quasi_static_t), intent(in) :: self
      type(position_t), intent(in) :: position
      type(witness_t) :: witness
    end function witness_of
  end interface

contains

  !> With one mesh there is no choice.
  pure integer function mesh_of(self, kind)
    class(quasi_static_t), intent(in) :: self
    integer, intent(in) :: kind

    mesh_of = 1
  end function mesh_of

  !> Makes `state` the position's present one; on another mesh, or after a jump, the past is
  !> forgotten.
  subroutine remember(position, state, mesh, jumped)
    type(position_t), intent(inout) :: position
    type(state_t), intent(in) :: state
    integer, intent(in) :: mesh
    logical, intent(in) :: jumped
    integer :: j

    if (mesh /= position%mesh .or. jumped) position%held = 0
    ! A turn of the experiment comes back over the same values.
    do j = 1, position%held
      if (abs(position%h0(j) - state%h0) <= 1.0e-12_wp*max(1.0_wp, abs(state%h0))) then
        position%h0(j:position%held - 1) = position%h0(j + 1:position%held)
        position%past(j:position%held - 1) = position%past(j + 1:position%held)
        position%held = position%held - 1
        exit
      end if
    end do
    if (position%held == memory) then
      position%h0(:memory - 1) = position%h0(2:)
      position%past(:memory - 1) = position%past(2:)
      position%held = memory - 1
    end if
    position%held = position%held + 1
    position%h0(position%held) = state%h0
    position%past(position%held) = state
    position%state = state
    position%mesh = mesh
  end subroutine remember

end module quasi_static
