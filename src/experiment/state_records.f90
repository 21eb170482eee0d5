!> Packs states of an experiment into records of a journal, and unpacks identical states.
!>
!> A step makes one new state; the other states of its position are in earlier records, and only
!> their numbers are packed.
module state_records
  use kinds, only: long
  use contact_state, only: state_t
  use equilibrium, only: cost_t
  use stepper, only: branch_point_t, step_result_t, memory
  use frozen_jacobian, only: frozen_jacobian_t
  use byte_record, only: byte_record_t
  implicit none
  private
  public :: pass_cost, pass_state, pass_position, pass_event, pass_frozen

contains

  !> Packs the position after a step; before: the position at its start, of which only the state's
  !> number is used when the record is written.
  subroutine pass_position(record, before, position)
    type(byte_record_t), intent(inout) :: record
    type(branch_point_t), intent(in) :: before
    type(branch_point_t), intent(inout) :: position
    integer :: k, place

    call record%pass(position%mesh)
    call record%pass(position%piece)
    call record%pass(position%held)
    call record%pass(position%lost)
    call record%pass(position%lost_error)
    position%held = min(max(position%held, 0), memory)
    if (position%held > 0 .and. .not. allocated(position%past)) allocate (position%past(memory))
    do k = 1, position%held
      call record%pass(position%h0(k))
      call record%pass(position%past_number(k))
      call pass_unless_known(position%past_number(k), position%past(k))
    end do
    call record%pass(position%number)
    place = past_with(position, position%number)
    if (place == 0) then
      call pass_unless_known(position%number, position%state)
    else if (record%reading) then
      position%state = position%past(place)
    end if

  contains

    !> Packs a state, unless it is part of the earlier position.
    subroutine pass_unless_known(number, state)
      integer, intent(in) :: number
      type(state_t), intent(inout) :: state
      integer :: place

      if (number > before%number) then
        call pass_state(record, state)
      else if (record%reading) then
        place = past_with(before, number)
        if (place > 0) then
          state = before%past(place)
        else if (number == before%number) then
          state = before%state
        else
          record%exhausted = .true.
        end if
      end if
    end subroutine pass_unless_known

  end subroutine pass_position

  !> Index of a past state with the given number; 0: there is none.
  pure integer function past_with(position, number) result(place)
    type(branch_point_t), intent(in) :: position
    integer, intent(in) :: number

    place = findloc(position%past_number(:position%held), number, 1)
  end function past_with

  subroutine pass_state(record, state)
    type(byte_record_t), intent(inout) :: record
    type(state_t), intent(inout) :: state

    call record%pass(state%gap)
    call record%pass(state%pressure)
    call record%pass(state%h0)
    call record%pass(state%scale)
    call record%pass(state%axis_gap)
    call record%pass(state%load)
    call record%pass(state%residual)
    call record%pass(state%iterations)
  end subroutine pass_state

  !> Packs the result of a step.
  subroutine pass_event(record, event)
    type(byte_record_t), intent(inout) :: record
    type(step_result_t), intent(inout) :: event

    call record%pass(event%converged)
    call record%pass(event%jumped)
    call record%pass(event%jump_h0)
    call record%pass(event%jump_load)
    call record%pass(event%jump_uncertainty)
    call record%pass(event%slipped)
    call record%pass(event%jagged)
    call record%pass(event%before%h0)
    call record%pass(event%before%load)
    call record%pass(event%unsure)
    call record%pass(event%unsure_from)
    call record%pass(event%ending%cause)
    call record%pass(event%ending%iterations)
    call record%pass(event%ending%residual)
    call record%pass(event%fold)
  end subroutine pass_event

  !> Packs the place of a frozen Jacobian without the factors; frozen%factors%valid: there are
  !> factors. known: an earlier record has the place.
  subroutine pass_frozen(record, known, frozen)
    type(byte_record_t), intent(inout) :: record
    logical, intent(inout) :: known
    type(frozen_jacobian_t), intent(inout) :: frozen

    call record%pass(frozen%factors%valid)
    call record%pass(frozen%excess)
    call record%pass(frozen%control%kind)
    call record%pass(frozen%control%mesh)
    call record%pass(known)
    if (known) return
    call record%pass(frozen%control%value)
    call record%pass(frozen%control%scale)
    call record%pass(frozen%state%h0)
    call record%pass(frozen%state%scale)
    call record%pass(frozen%state%gap)
  end subroutine pass_frozen

  !> Packs the cost: all components are numbers of one word.
  subroutine pass_cost(record, cost)
    type(byte_record_t), intent(inout) :: record
    type(cost_t), intent(inout) :: cost
    integer(long) :: words(storage_size(cost)/storage_size(0_long))

    words = transfer(cost, words)
    call record%pass(words)
    cost = transfer(words, cost)
  end subroutine pass_cost

end module state_records
