!> A drive in a journal: now and then, and when a pass has come to its end, all that decides how it
!> goes on is kept there, with the rows since the last time. A run that goes on has the same bytes,
!> since factors and waves are made anew after each such record in any case.
module timed_journal
  use kinds, only: wp, long
  use byte_record, only: byte_record_t
  use journal, only: journal_t, of_drive
  use elastic_operator, only: elastic_operator_t
  use motion, only: names_of_ways
  use state_records, only: put_state, take_state, put_cost, take_cost
  use time_instant, only: instant_t
  use time_stepper, only: time_stepper_t
  use timed_record, only: pass_t, tally_t, make_room, lose
  implicit none
  private
  public :: keep, recall

  !> Rows after which they are kept.
  integer, parameter :: every = 200

contains

  !> Keeps a pass at an instant if it has ended, or gone on long enough.
  subroutine keep(journal, steps, at, now)
    type(journal_t), pointer, intent(in) :: journal
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(in) :: at
    type(pass_t), intent(inout) :: now
    type(byte_record_t) :: record
    integer :: k

    if (now%held < now%kept + every .and. .not. now%ended) return
    steps%frozen%factors%valid = .false.
    steps%frozen%excess = 0
    steps%operator = elastic_operator_t()
    if (associated(journal)) then
      call record%put(of_drive)
      call record%put_words(transfer(now%tally_t, [0_long], words()))
      do k = now%kept + 1, now%held
        associate (row => now%row(k))
          call record%put(findloc(names_of_ways == row%branch, .true., 1))
          call record%put([row%h0, row%h_centre, row%displacement, row%load, row%contact_radius, &
            row%residual, row%time])
          if (allocated(row%z)) call record%put(row%z)
          call record%put(row%iterations)
          call record%put(row%converged)
        end associate
      end do
      call put_instant(record, at)
      call put_instant(record, steps%before)
      call record%put(steps%made_for)
      call put_cost(record, steps%cost)
      call journal%append(record)
      if (allocated(journal%trouble)) call lose(at, now)
    end if
    now%kept = now%held
  end subroutine keep

  !> Takes a pass as far as an earlier run has kept it; `now` has no rows where that has none.
  subroutine recall(journal, steps, at, now)
    type(journal_t), pointer, intent(in) :: journal
    type(time_stepper_t), intent(inout) :: steps
    type(instant_t), intent(inout) :: at
    type(pass_t), intent(inout) :: now
    type(byte_record_t) :: record
    type(tally_t) :: tally
    integer(long) :: packed(words())
    real(wp), allocatable :: values(:)
    logical :: found
    integer :: k, way

    do while (associated(journal) .and. .not. now%ended)
      call journal%next_of(of_drive, record, found)
      if (.not. found .or. allocated(journal%trouble)) exit
      call record%take_words(packed)
      tally = transfer(packed, tally)
      call make_room(now, tally%held - now%held)
      do k = now%held + 1, tally%held
        associate (row => now%row(k))
          call record%take(way)
          row%branch = trim(names_of_ways(way))
          call record%take(values)
          row%h0 = values(1)
          row%h_centre = values(2)
          row%displacement = values(3)
          row%load = values(4)
          row%contact_radius = values(5)
          row%residual = values(6)
          row%time = values(7)
          if (steps%compliance > 0) then
            allocate (row%z)
            call record%take(row%z)
          end if
          call record%take(row%iterations)
          call record%take(row%converged)
        end associate
      end do
      now%tally_t = tally
      now%kept = now%held
      call take_instant(record, size(steps%creep%time), at)
      call take_instant(record, size(steps%creep%time), steps%before)
      call record%take(steps%made_for)
      call take_cost(record, steps%cost)
      if (record%exhausted) call journal%reject()
    end do
  end subroutine recall

  !> Words of a tally.
  pure integer function words()
    type(tally_t) :: tally

    words = storage_size(tally)/storage_size(0_long)
  end function words

  subroutine put_instant(record, at)
    type(byte_record_t), intent(inout) :: record
    type(instant_t), intent(in) :: at

    call record%put([at%time, at%position, at%dissipated, at%power, at%suction, at%suction_at])
    call record%put(at%mesh)
    call record%put(at%since_turn)
    call put_state(record, at%state)
    call record%put(at%pressure)
    call record%put(at%pressure_rise)
    call record%put(reshape(at%memory, [size(at%memory)]))
    call record%put(reshape(at%memory_rise, [size(at%memory_rise)]))
  end subroutine put_instant

  !> terms: of the creep.
  subroutine take_instant(record, terms, at)
    type(byte_record_t), intent(inout) :: record
    integer, intent(in) :: terms
    type(instant_t), intent(out) :: at
    real(wp), allocatable :: values(:)

    call record%take(values)
    at%time = values(1)
    at%position = values(2)
    at%dissipated = values(3)
    at%power = values(4)
    at%suction = values(5)
    at%suction_at = values(6)
    call record%take(at%mesh)
    call record%take(at%since_turn)
    call take_state(record, at%state)
    call record%take(at%pressure)
    call record%take(at%pressure_rise)
    call record%take(values)
    at%memory = reshape(values, [size(at%pressure), terms])
    call record%take(values)
    at%memory_rise = reshape(values, [size(at%pressure_rise), terms])
  end subroutine take_instant

end module timed_journal
