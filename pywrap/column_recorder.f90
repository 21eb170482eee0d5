!> Records kept as rows of numbers, for callers that take arrays. Beside the flat modules and not in
!> one, since f2py does not understand the type.
module column_recorder
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t
  use dimensionless_problem, only: problem_t
  use records, only: observer_t, record_t
  implicit none
  private
  public :: column_recorder_t

  integer, parameter :: columns = 8

  !> Keeps h0, h_centre, displacement, load, contact radius, stable (1, 0, -1), residual and
  !> converged (1, 0) of every record that it is given.
  type, extends(observer_t) :: column_recorder_t
    integer :: held = 0
    real(wp), allocatable, private :: column(:, :)
  contains
    procedure :: take
    procedure :: give
  end type column_recorder_t

contains

  subroutine take(self, record, problem, grid, state, profile)
    class(column_recorder_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
    real(wp), allocatable :: longer(:, :)

    if (.not. allocated(self%column)) allocate (self%column(columns, 100))
    if (self%held == size(self%column, 2)) then
      allocate (longer(columns, 2*self%held))
      longer(:, :self%held) = self%column
      call move_alloc(longer, self%column)
    end if
    self%held = self%held + 1
    self%column(:, self%held) = [record%h0, record%h_centre, record%displacement, record%load, &
      record%contact_radius, real(record%stable, wp), record%residual, &
      merge(1.0_wp, 0.0_wp, record%converged)]
  end subroutine take

  !> Copies what is held to the rows of `states`, as many as there are; the others become NaN.
  pure subroutine give(self, states, reached)
    class(column_recorder_t), intent(in) :: self
    real(wp), intent(out) :: states(:, :)
    integer, intent(out) :: reached

    states = ieee_value(states, ieee_quiet_nan)
    reached = min(self%held, size(states, 1))
    if (reached > 0) states(:reached, :) = transpose(self%column(:, :reached))
  end subroutine give

end module column_recorder
