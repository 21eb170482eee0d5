!> States of an experiment as records of a journal, and back, bit by bit the same.
module packed_states
  use equilibrium, only: cost_t
  use packing, only: packed_t
  implicit none
  private
  public :: put_cost, take_cost

contains

  !> Packs what was spent.
  subroutine put_cost(record, cost)
    type(packed_t), intent(inout) :: record
    type(cost_t), intent(in) :: cost

    call record%put(cost%operator_products)
    call record%put(cost%operator_columns)
    call record%put(cost%pressure_evaluations)
    call record%put(cost%factorisations)
    call record%put(cost%iterations)
    call record%put(cost%kernel_entries)
    call record%put(cost%states)
    call record%put(cost%rejected_steps)
    call record%put(cost%kernel_seconds)
    call record%put(cost%solve_seconds)
    call record%put(cost%estimate_seconds)
  end subroutine put_cost

  !> Unpacks what `put_cost` packed.
  subroutine take_cost(record, cost)
    type(packed_t), intent(inout) :: record
    type(cost_t), intent(out) :: cost

    call record%take(cost%operator_products)
    call record%take(cost%operator_columns)
    call record%take(cost%pressure_evaluations)
    call record%take(cost%factorisations)
    call record%take(cost%iterations)
    call record%take(cost%kernel_entries)
    call record%take(cost%states)
    call record%take(cost%rejected_steps)
    call record%take(cost%kernel_seconds)
    call record%take(cost%solve_seconds)
    call record%take(cost%estimate_seconds)
  end subroutine take_cost

end module packed_states
