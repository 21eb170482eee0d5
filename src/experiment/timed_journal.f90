!> A drive in a journal: at intervals, and at the end of a pass, everything that determines the rest
!> of the pass is stored, with the new rows. A resumed run gives the same bytes, since factors and
!> waves are made anew after each record in both cases.
module timed_journal
  use kinds, only: long
  use byte_record, only: byte_record_t
  use journal, only: journal_t, of_drive
  use elastic_operator, only: elastic_operator_t
  use motion, only: names_of_ways
  use time_instant, only: instant_t
  use records, only: record_t
  use state_records, only: pass_state, pass_cost
  use time_stepper, only: time_stepper_t
  use timed_record, only: pass_t, tally_t, make_room, lose
  implicit none
  private
  public :: keep, recall

  !> Number of rows after which they are stored.
  integer, parameter :: every = 200

contains

  !> Stores a pass if it has ended, or has `every` new rows.
  subroutine keep(journal, steps, now)
    type(journal_t), pointer, intent(in) :: journal
    type(time_stepper_t), intent(inout) :: steps
    type(pass_t), intent(inout) :: now
    type(byte_record_t) :: record

    if (now%held < now%kept + every .and. .not. now%ended) return
    call steps%frozen%forget()
    steps%frozen%excess = 0
    steps%operator = elastic_operator_t()
    if (associated(journal)) then
      call record%pass(of_drive)
      call pass_drive(record, steps, now)
      call journal%append(record)
      if (allocated(journal%trouble)) call lose(now)
    end if
    now%kept = now%held
  end subroutine keep

  !> Restores a pass from an earlier run; `now` has no rows if the run stored none.
  subroutine recall(journal, steps, now)
    type(journal_t), pointer, intent(in) :: journal
    type(time_stepper_t), intent(inout) :: steps
    type(pass_t), intent(inout) :: now
    type(byte_record_t) :: record
    logical :: found

    do while (associated(journal) .and. .not. now%ended)
      call journal%next_of(of_drive, record, found)
      if (.not. found .or. allocated(journal%trouble)) exit
      call pass_drive(record, steps, now)
      now%kept = now%held
      if (record%exhausted) call journal%reject()
    end do
  end subroutine recall

  !> Packs everything that determines the rest of a pass, and its rows since the last record.
  subroutine pass_drive(record, steps, now)
    type(byte_record_t), intent(inout) :: record
    type(time_stepper_t), intent(inout) :: steps
    type(pass_t), intent(inout) :: now
    type(tally_t) :: tally
    integer(long) :: words(storage_size(tally)/storage_size(0_long))
    integer :: k

    words = transfer(now%tally_t, words)
    call record%pass(words)
    tally = transfer(words, tally)
    call make_room(now, tally%held - now%held)
    do k = now%kept + 1, tally%held
      call pass_row(record, now%row(k))
    end do
    now%tally_t = tally
    call pass_instant(record, now%at)
    call pass_instant(record, steps%before)
    call record%pass(steps%made_for)
    call pass_cost(record, steps%cost)
  end subroutine pass_drive

  subroutine pass_row(record, row)
    type(byte_record_t), intent(inout) :: record
    type(record_t), intent(inout) :: row
    logical :: with_spring
    integer :: way

    if (.not. record%reading) way = findloc(names_of_ways == row%branch, .true., 1)
    call record%pass(way)
    row%branch = trim(names_of_ways(way))
    with_spring = allocated(row%z)
    call record%pass(with_spring)
    if (record%reading) then
      allocate (row%time)
      if (with_spring) allocate (row%z)
    end if
    call record%pass(row%time)
    if (with_spring) call record%pass(row%z)
    call record%pass(row%h0)
    call record%pass(row%h_centre)
    call record%pass(row%displacement)
    call record%pass(row%load)
    call record%pass(row%contact_radius)
    call record%pass(row%residual)
    call record%pass(row%iterations)
    call record%pass(row%converged)
  end subroutine pass_row

  subroutine pass_instant(record, at)
    type(byte_record_t), intent(inout) :: record
    type(instant_t), intent(inout) :: at

    call record%pass(at%time)
    call record%pass(at%position)
    call record%pass(at%mesh)
    call pass_state(record, at%state)
    call record%pass(at%memory)
    call record%pass(at%pressure)
    call record%pass(at%memory_rise)
    call record%pass(at%pressure_rise)
    call record%pass(at%dissipated)
    call record%pass(at%power)
    call record%pass(at%suction)
    call record%pass(at%suction_at)
    call record%pass(at%since_turn)
  end subroutine pass_instant

end module timed_journal
