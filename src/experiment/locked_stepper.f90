!> The common parts of quasi-static experiments in edge-locked coordinates: nothing is pinned
!> between nodes, and the equations are not stiff at any adhesion strength. `path_stepper` follows
!> the traced path of a law that attracts; `unique_stepper_t` is for other laws, under which there
!> is one state for every h0.
module locked_stepper
  use kinds, only: wp
  use progress_observer, only: progress_observer_t
  use contact_state, only: state_t
  use arc, only: between
  use path_coordinate, only: h0_control, begin_afar
  use ending, only: ending_t, nothing_afar, steps_lost
  use path_end, only: demand_t
  use stepper, only: stepper_t, branch_point_t, step_result_t, remember, move_to
  implicit none
  private
  public :: locked_stepper_t, unique_stepper_t

  type, abstract, extends(stepper_t) :: locked_stepper_t
  contains
    procedure(find_the_path), deferred :: find_path
    procedure :: solve_afar
    procedure :: attempt
  end type locked_stepper_t

  type, extends(locked_stepper_t) :: unique_stepper_t
  contains
    procedure :: find_path
    procedure :: approach_to
    procedure :: step_to
    procedure, private :: step_in_pieces
  end type unique_stepper_t

  abstract interface
    !> Traces the path from h0_high, or from where the bodies hardly deform, until it is stable at
    !> h0_low. into_contact: until the bodies are also in contact, at ends_at. accuracy, demand: see
    !> `trace`. With `demand` the points define a smooth curve. To be called before the first step.
    !> The observer receives messages about the progress.
    subroutine find_the_path(self, h0_high, h0_low, ends_at, into_contact, accuracy, observer, &
      demand)
      import :: locked_stepper_t, progress_observer_t, demand_t, wp
      class(locked_stepper_t), intent(inout) :: self
      real(wp), intent(in) :: h0_high, h0_low, ends_at, accuracy
      logical, intent(in) :: into_contact
      class(progress_observer_t), intent(inout) :: observer
      type(demand_t), intent(in), optional :: demand
    end subroutine find_the_path
  end interface

  !> Smallest step in h0, in the law's lengths and relative to h0: deep in contact the state is
  !> nearly constant over smaller steps, and rounding makes some of them fail.
  real(wp), parameter :: smallest_creep = 1.0e-6_wp, smallest_part = 1.0e-4_wp
  !> Ratio of a step to the one before, with and without a solution.
  real(wp), parameter :: longer = 2, shorter = 0.3_wp

contains

  !> A state at h0 or, if the bodies would be close to each other there, at a separation so large
  !> that they hardly deform.
  subroutine solve_afar(self, h0, position, event)
    class(locked_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state
    integer :: mesh

    call begin_afar(self%problem, self%meshes, h0, mesh, state)
    call self%attempt(state%h0, state, mesh, event)
    if (.not. event%converged) &
      event%ending = ending_t(nothing_afar, state%iterations, state%residual)
    call remember(position, state, mesh, .false.)
  end subroutine solve_afar

  !> Solves at h0 from the guess `state`.
  subroutine attempt(self, h0, state, mesh, event)
    class(locked_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(state_t), intent(inout) :: state
    integer, intent(in) :: mesh
    type(step_result_t), intent(inout) :: event

    call self%solve(h0_control(self%problem%shape, self%meshes, mesh, h0), state, event%converged)
  end subroutine attempt

  !> There is no path with unstable states, and h0 determines each state.
  subroutine find_path(self, h0_high, h0_low, ends_at, into_contact, accuracy, observer, demand)
    class(unique_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0_high, h0_low, ends_at, accuracy
    logical, intent(in) :: into_contact
    class(progress_observer_t), intent(inout) :: observer
    type(demand_t), intent(in), optional :: demand
  end subroutine find_path

  subroutine approach_to(self, h0, position, event)
    class(unique_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event

    call self%solve_afar(h0, position, event)
    if (event%ending%early()) return
    if (position%state%h0 > h0) call self%step_to(h0, position, event)
  end subroutine approach_to

  subroutine step_to(self, h0, position, event)
    class(unique_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(state_t) :: state

    state = between(position%h0(:position%held), position%past(:position%held), h0)
    call self%attempt(h0, state, position%mesh, event)
    if (event%converged) then
      call remember(position, state, position%mesh, .false.)
    else
      call self%step_in_pieces(h0, position, event)
    end if
  end subroutine step_to

  !> Reaches h0 in shorter steps: a step fails only if it is too long.
  subroutine step_in_pieces(self, h0, position, event)
    class(unique_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(state_t) :: state
    real(wp) :: next, step

    step = 0.25_wp*(h0 - position%state%h0)
    do
      next = position%state%h0 + step
      if (abs(h0 - position%state%h0) <= 1.5_wp*abs(step)) next = h0
      state = between(position%h0(:position%held), position%past(:position%held), next)
      call self%frozen%forget()
      call self%attempt(next, state, position%mesh, event)
      if (event%converged) then
        call remember(position, state, position%mesh, .false.)
        if (abs(next - h0) <= 0.0_wp) return
        step = longer*step
      else
        step = shorter*step
        if (abs(step) < max(smallest_creep, smallest_part*abs(position%state%h0))) then
          event%ending%cause = steps_lost
          call move_to(position, state)
          return
        end if
      end if
    end do
  end subroutine step_in_pieces

end module locked_stepper
