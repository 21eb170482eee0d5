!> The cases of a sweep, spread over the cores: one value of a key a case, one row of its summary.
module sweeps
  use kinds, only: wp
  use failure, only: failure_t
  use problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use experiment, only: outcome_t, run_experiment, problem_of
  use equilibrium, only: cost_t
  use records, only: silent_observer_t
  use summarise, only: summary_of
  use summary, only: summary_t
  use case_columns, only: columns_of, numbers_of
  use results, only: results_t
  implicit none
  private
  public :: run_sweep

contains

  !> Computes every case of scene%sweep and hands its row to `results`, in the order of the values.
  !> A case that fails is a row that says so. failed: how many; cost: of all together.
  subroutine run_sweep(scene, results, failed, cost)
    type(scene_t), intent(in) :: scene
    type(results_t), intent(inout) :: results
    integer, intent(out) :: failed
    type(cost_t), intent(out) :: cost
    type(summary_t), allocatable :: summaries(:)
    logical, allocatable :: done(:)
    type(cost_t) :: of_case
    integer :: i, written

    associate (values => scene%sweep%values)
      allocate (summaries(size(values)), done(size(values)))
      done = .false.
      written = 0
      failed = 0
      ! Each case has a thread of its own: its kernels and its linear algebra use no more.
      !$omp parallel do schedule(dynamic, 1) private(of_case)
      do i = 1, size(values)
        call run_case(scene, values(i), summaries(i), of_case)
        !$omp critical (sweep_rows)
        done(i) = .true.
        cost = sum_of(cost, of_case)
        if (.not. summaries(i)%converged) failed = failed + 1
        call results%progress%step('case')
        do while (written < size(values))
          if (.not. done(written + 1)) exit
          written = written + 1
          call results%take_case(scene%sweep%key, values(written), &
            columns_of(scene), numbers_of(summaries(written), scene))
        end do
        !$omp end critical (sweep_rows)
      end do
      !$omp end parallel do
    end associate
  end subroutine run_sweep

  !> The summary of the scene with the swept key at a value.
  subroutine run_case(scene, value, summary, cost)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: value
    type(summary_t), intent(out) :: summary
    type(cost_t), intent(out) :: cost
    type(scene_t) :: variant
    type(problem_t) :: problem
    type(outcome_t) :: outcome
    type(silent_observer_t) :: observer
    type(failure_t), allocatable :: error

    call swept_scene(scene, value, variant, error)
    if (allocated(error)) then
      summary%converged = .false.
      call summary%warn(error%message)
      return
    end if
    problem = problem_of(variant)
    call run_experiment(variant, problem, observer, outcome)
    summary = summary_of(variant, problem, outcome)
    cost = outcome%cost
  end subroutine run_case

  pure function sum_of(a, b) result(total)
    type(cost_t), intent(in) :: a, b
    type(cost_t) :: total

    total%operator_products = a%operator_products + b%operator_products
    total%operator_columns = a%operator_columns + b%operator_columns
    total%pressure_evaluations = a%pressure_evaluations + b%pressure_evaluations
    total%factorisations = a%factorisations + b%factorisations
    total%iterations = a%iterations + b%iterations
    total%kernel_entries = a%kernel_entries + b%kernel_entries
    total%states = a%states + b%states
    total%rejected_steps = a%rejected_steps + b%rejected_steps
    total%kernel_seconds = a%kernel_seconds + b%kernel_seconds
    total%solve_seconds = a%solve_seconds + b%solve_seconds
    total%estimate_seconds = a%estimate_seconds + b%estimate_seconds
  end function sum_of

end module sweeps
