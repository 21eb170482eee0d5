!> Derivatives of the results of a drive in time by numbers of its deck, from whole runs with each
!> number slightly smaller and slightly larger, since no path gives these derivatives. A number at
!> the end of its range is varied to one side.
module drive_rates
  use kinds, only: wp
  use failure, only: failure_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use scene, only: swept_scene
  use scene_problem, only: problem_of
  use experiment, only: run_experiment
  use experiment_result, only: experiment_result_t
  use listener, only: listener_t
  use records, only: observer_t
  use timed_record, only: timed_result_t, numbers
  use rate_entries, only: si_numbers
  implicit none
  private
  public :: rate_drive

  !> The largest relative change of a number. The error of a difference is about the square of the
  !> change, plus the errors of the runs over the change; both agree if its cube is the accuracy.
  real(wp), parameter :: largest = 0.05_wp

contains

  !> Sets the derivatives of the numbers of a drive by each parameter of &sensitivity.
  subroutine rate_drive(scene, listener, timed)
    type(scene_t), intent(in) :: scene
    class(listener_t), intent(inout) :: listener
    type(timed_result_t), intent(inout) :: timed
    real(wp) :: change, place(2), side(numbers, 2)
    real(wp), allocatable :: rate(:, :)
    logical :: found
    integer :: i, j

    associate (varied => scene%varied)
      allocate (rate(size(varied), numbers))
      change = min(largest, scene%numerics%accuracy**(1.0_wp/3))
      do j = 1, size(varied)
        associate (name => varied(j)%parameter%name, value => varied(j)%parameter%value)
          call listener%hear('differentiating by '//name)
          place = [-change, change]
          if (.not. allowed(scene, name, value*(1 + change))) then
            place = [-change, -2*change]
          else if (.not. allowed(scene, name, value*(1 - change))) then
            place = [change, 2*change]
          end if
          do i = 1, 2
            call run_with(scene, name, value*(1 + place(i)), side(:, i), found)
            if (.not. found) then
              timed%not_rated = name
              return
            end if
          end do
          if (place(1)*place(2) < 0) then
            rate(j, :) = (side(:, 2) - side(:, 1))/(2*change*value)
          else
            rate(j, :) = (4*side(:, 1) - side(:, 2) - 3*si_numbers(problem_of(scene), timed))/ &
              (2*place(1)*value)
          end if
        end associate
      end do
    end associate
    timed%rate = rate
  end subroutine rate_drive

  !> Whether the number `name` may have this value.
  logical function allowed(scene, name, value)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value
    type(scene_t) :: variant
    type(failure_t), allocatable :: error

    call swept_scene(scene, name, [value], variant, error)
    allowed = .not. allocated(error)
  end function allowed

  !> The numbers that a run with another value of the number `name` finds.
  subroutine run_with(scene, name, value, side, found)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value
    real(wp), intent(out) :: side(:)
    logical, intent(out) :: found
    type(scene_t) :: variant
    type(problem_t) :: problem
    type(experiment_result_t) :: outcome
    type(observer_t) :: observer
    type(failure_t), allocatable :: error

    side = 0
    call swept_scene(scene, name, [value], variant, error)
    found = .not. allocated(error)
    if (.not. found) return
    problem = problem_of(variant)
    call run_experiment(variant, problem, observer, outcome)
    found = outcome%timed%begun .and. .not. outcome%timed%lost
    if (found) side = si_numbers(problem, outcome%timed)
  end subroutine run_with

end module drive_rates
