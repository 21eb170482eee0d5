!> A quasi-static experiment whose steps are kept in a journal. The
!> steps of an interrupted run are read from the journal instead of being solved, with the same
!> results. After them the solver continues as if there had been no interruption.
module resumable_stepper
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use frozen_jacobian, only: freeze
  use contact_state, only: state_t
  use controls, only: control_t
  use equilibrium, only: cost_t
  use ending, only: ending_t, not_kept
  use stepper, only: keeping_stepper_t, branch_point_t, step_result_t
  use journal, only: of_step
  use byte_record, only: byte_record_t
  use state_records, only: pass_cost, pass_position, pass_event, pass_frozen
  use clock, only: seconds
  implicit none
  private
  public :: resumable_stepper_t

  type, extends(keeping_stepper_t) :: resumable_stepper_t
    !> Time [s] of the steps solved in this run.
    real(wp) :: own_seconds = 0
    !> Whether the solver still lacks the factors of the last record.
    logical, private :: behind = .false.
    !> Count of the factorisation that the journal has.
    integer, private :: known = -1
    !> The record being packed, whose memory is used again for each step.
    type(byte_record_t), private :: record
  contains
    procedure :: approach_to
    procedure :: step_to
    procedure :: find_load_slope
    procedure :: grid
    procedure, private :: recall
    procedure, private :: catch_up
    procedure, private :: keep
  end type resumable_stepper_t

contains

  subroutine approach_to(self, h0, position, event)
    class(resumable_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(out) :: position
    type(step_result_t), intent(out) :: event
    type(branch_point_t) :: before
    real(wp) :: began

    if (self%recall(h0, position, event)) return
    began = seconds()
    call self%catch_up()
    call self%steps%approach_to(h0, position, event)
    call self%keep(h0, before, position, event, began)
  end subroutine approach_to

  subroutine step_to(self, h0, position, event)
    class(resumable_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(out) :: event
    type(branch_point_t) :: before
    real(wp) :: began

    if (self%recall(h0, position, event)) return
    began = seconds()
    before%number = position%number
    call self%catch_up()
    call self%steps%step_to(h0, position, event)
    call self%keep(h0, before, position, event, began)
  end subroutine step_to

  !> Takes the step from the position to h0 from the journal. .false. if it has no more steps; the
  !> step is then to be solved. A journal that cannot be continued ends the experiment.
  logical function recall(self, h0, position, event) result(known)
    class(resumable_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(branch_point_t) :: before
    type(byte_record_t) :: record
    type(cost_t) :: cost
    real(wp) :: kept_h0
    logical :: fits, made_before

    call self%journal%next_of(of_step, record, known)
    if (known) then
      call record%pass(kept_h0)
      fits = abs(kept_h0 - h0) <= 0
      before = position
      call pass_position(record, before, position)
      call pass_event(record, event)
      call pass_frozen(record, made_before, self%steps%frozen)
      call pass_cost(record, cost)
      self%earlier_seconds = cost%solve_seconds
      ! Times are those of this run.
      cost%kernel_seconds = self%steps%cost%kernel_seconds
      cost%solve_seconds = self%steps%cost%solve_seconds
      cost%estimate_seconds = self%steps%cost%estimate_seconds
      self%steps%cost = cost
      self%behind = .true.
      if (record%exhausted .or. .not. fits) call self%journal%reject()
    end if
    if (.not. allocated(self%journal%trouble)) return
    known = .true.
    event = step_result_t(ending=ending_t(not_kept))
  end function recall

  !> Gives the solver the factorisation that it had at the end of the last record.
  subroutine catch_up(self)
    class(resumable_stepper_t), intent(inout) :: self
    type(control_t) :: control
    type(state_t) :: state
    type(cost_t) :: spent

    if (.not. self%behind) return
    self%behind = .false.
    if (self%steps%frozen%factors%valid) then
      ! Copies, since `freeze` changes its arguments; the cost is in the record already.
      control = self%steps%frozen%control
      state = self%steps%frozen%state
      spent = self%steps%cost
      call freeze(self%steps%equations_t, control, state, self%steps%frozen)
      self%steps%cost = spent
    end if
    self%known = self%steps%frozen%renewals
  end subroutine catch_up

  !> Appends a step to the journal. The step began at the time `began`, at the position `before`, of
  !> which only the number is used.
  subroutine keep(self, h0, before, position, event, began)
    class(resumable_stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0, began
    type(branch_point_t), intent(in) :: before
    type(branch_point_t), intent(inout) :: position
    type(step_result_t), intent(inout) :: event
    type(cost_t) :: cost
    logical :: made_before

    call self%record%clear()
    call self%record%pass(of_step)
    call self%record%pass(h0)
    call pass_position(self%record, before, position)
    call pass_event(self%record, event)
    associate (frozen => self%steps%frozen)
      made_before = frozen%renewals == 0 .or. frozen%renewals == self%known
      self%known = frozen%renewals
      call pass_frozen(self%record, made_before, frozen)
    end associate
    self%own_seconds = self%own_seconds + seconds() - began
    cost = self%steps%cost
    cost%solve_seconds = self%earlier_seconds + self%own_seconds
    call pass_cost(self%record, cost)
    call self%journal%append(self%record)
  end subroutine keep

  subroutine find_load_slope(self, state, slope)
    class(resumable_stepper_t), intent(inout) :: self
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: slope

    call self%steps%find_load_slope(state, slope)
  end subroutine find_load_slope

  function grid(self, position)
    class(resumable_stepper_t), intent(in), target :: self
    type(branch_point_t), intent(in) :: position
    type(discretisation_t), pointer :: grid

    grid => self%steps%grid(position)
  end function grid

end module resumable_stepper
