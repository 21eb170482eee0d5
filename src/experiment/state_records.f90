!> States of an experiment as records of a journal, and back, bit by bit the same.
!>
!> A step leaves one new state; the others that a position holds it had before, and only their
!> numbers are packed.
module state_records
  use kinds, only: wp, long
  use contact_state, only: state_t
  use equilibrium, only: cost_t
  use stepper, only: branch_point_t, step_result_t, memory
  use frozen_jacobian, only: frozen_jacobian_t
  use byte_record, only: byte_record_t
  implicit none
  private
  public :: put_cost, take_cost, put_state, take_state, put_position, take_position, put_event, &
    take_event, put_frozen, take_frozen

contains

  !> Packs the position that a step has led to; known: the number of the state that it began in.
  subroutine put_position(record, known, position)
    type(byte_record_t), intent(inout) :: record
    integer, intent(in) :: known
    type(branch_point_t), intent(in) :: position
    integer :: k

    call record%put(position%mesh)
    call record%put(position%piece)
    call record%put(position%held)
    do k = 1, position%held
      call record%put(position%h0(k))
      call record%put(position%past_number(k))
      if (position%past_number(k) > known) call put_state(record, position%past(k))
    end do
    call record%put(position%number)
    if (position%number > known .and. past_with(position, position%number) == 0) &
      call put_state(record, position%state)
  end subroutine put_position

  !> Unpacks what `put_position` packed; before: the position that the step began in.
  subroutine take_position(record, before, position)
    type(byte_record_t), intent(inout) :: record
    type(branch_point_t), intent(in) :: before
    type(branch_point_t), intent(out) :: position
    integer :: k, place

    call record%take(position%mesh)
    call record%take(position%piece)
    call record%take(position%held)
    position%held = min(max(position%held, 0), memory)
    allocate (position%past(memory))
    do k = 1, position%held
      call record%take(position%h0(k))
      call record%take(position%past_number(k))
      call take_known(position%past_number(k), position%past(k))
    end do
    call record%take(position%number)
    place = past_with(position, position%number)
    if (place > 0) then
      position%state = position%past(place)
    else
      call take_known(position%number, position%state)
    end if

  contains

    !> Takes a state from where it was before, or from the record.
    subroutine take_known(number, state)
      integer, intent(in) :: number
      type(state_t), intent(out) :: state
      integer :: place

      place = past_with(before, number)
      if (number > before%number) then
        call take_state(record, state)
      else if (place > 0) then
        state = before%past(place)
      else if (number == before%number) then
        state = before%state
      else
        record%exhausted = .true.
      end if
    end subroutine take_known

  end subroutine take_position

  !> Which state of a position's past has a number; 0: none.
  pure integer function past_with(position, number) result(place)
    type(branch_point_t), intent(in) :: position
    integer, intent(in) :: number

    place = findloc(position%past_number(:position%held), number, 1)
  end function past_with

  !> Packs a state.
  subroutine put_state(record, state)
    type(byte_record_t), intent(inout) :: record
    type(state_t), intent(in) :: state

    call record%put(state%gap)
    call record%put(state%pressure)
    call record%put(state%h0)
    call record%put(state%scale)
    call record%put(state%axis_gap)
    call record%put(state%load)
    call record%put(state%residual)
    call record%put(state%iterations)
  end subroutine put_state

  !> Unpacks what `put_state` packed.
  subroutine take_state(record, state)
    type(byte_record_t), intent(inout) :: record
    type(state_t), intent(out) :: state

    call record%take(state%gap)
    call record%take(state%pressure)
    call record%take(state%h0)
    call record%take(state%scale)
    call record%take(state%axis_gap)
    call record%take(state%load)
    call record%take(state%residual)
    call record%take(state%iterations)
  end subroutine take_state

  !> Packs what happened in a step.
  subroutine put_event(record, event)
    type(byte_record_t), intent(inout) :: record
    type(step_result_t), intent(in) :: event

    call record%put(event%converged)
    call record%put(event%jumped)
    call record%put(event%jump_h0)
    call record%put(event%jump_load)
    call record%put(event%jump_uncertainty)
    call record%put(event%ending%cause)
    call record%put(event%ending%iterations)
    call record%put(event%ending%residual)
    call record%put(event%fold)
    call record%put(allocated(event%lowest))
    if (.not. allocated(event%lowest)) return
    call record%put(event%lowest%load)
    call record%put(event%lowest%h0)
    call record%put(event%lowest%point)
    call record%put(event%lowest%landing)
  end subroutine put_event

  !> Unpacks what `put_event` packed.
  subroutine take_event(record, event)
    type(byte_record_t), intent(inout) :: record
    type(step_result_t), intent(out) :: event
    logical :: known

    call record%take(event%converged)
    call record%take(event%jumped)
    call record%take(event%jump_h0)
    call record%take(event%jump_load)
    call record%take(event%jump_uncertainty)
    call record%take(event%ending%cause)
    call record%take(event%ending%iterations)
    call record%take(event%ending%residual)
    call record%take(event%fold)
    call record%take(known)
    if (.not. known) return
    allocate (event%lowest)
    call record%take(event%lowest%load)
    call record%take(event%lowest%h0)
    call record%take(event%lowest%point)
    call record%take(event%lowest%landing)
  end subroutine take_event

  !> Packs a frozen Jacobian as where it was made; known: the records before have that.
  subroutine put_frozen(record, frozen, known)
    type(byte_record_t), intent(inout) :: record
    type(frozen_jacobian_t), intent(in) :: frozen
    logical, intent(in) :: known

    call record%put(frozen%factors%valid)
    call record%put(frozen%excess)
    call record%put(frozen%control%kind)
    call record%put(frozen%control%mesh)
    call record%put(known .or. frozen%renewals == 0)
    if (known .or. frozen%renewals == 0) return
    call record%put([frozen%control%value, frozen%control%scale, frozen%state%h0, &
      frozen%state%scale, frozen%state%gap])
  end subroutine put_frozen

  !> Unpacks what `put_frozen` packed, all but the factors: frozen%factors%valid says whether there
  !> were any.
  subroutine take_frozen(record, frozen)
    type(byte_record_t), intent(inout) :: record
    type(frozen_jacobian_t), intent(inout) :: frozen
    real(wp), allocatable :: made_at(:)
    logical :: known

    call record%take(frozen%factors%valid)
    call record%take(frozen%excess)
    call record%take(frozen%control%kind)
    call record%take(frozen%control%mesh)
    call record%take(known)
    if (known) return
    call record%take(made_at)
    ! A record that is too short is refused by whoever reads it.
    if (size(made_at) < 4) return
    frozen%control%value = made_at(1)
    frozen%control%scale = made_at(2)
    frozen%state%h0 = made_at(3)
    frozen%state%scale = made_at(4)
    frozen%state%gap = made_at(5:)
  end subroutine take_frozen

  !> Packs what was spent: all its components are numbers of one word.
  subroutine put_cost(record, cost)
    type(byte_record_t), intent(inout) :: record
    type(cost_t), intent(in) :: cost

    call record%put_words(transfer(cost, [0_long], storage_size(cost)/storage_size(0_long)))
  end subroutine put_cost

  !> Unpacks what `put_cost` packed.
  subroutine take_cost(record, cost)
    type(byte_record_t), intent(inout) :: record
    type(cost_t), intent(out) :: cost
    integer(long) :: words(storage_size(cost)/storage_size(0_long))

    call record%take_words(words)
    cost = transfer(words, cost)
  end subroutine take_cost

end module state_records
