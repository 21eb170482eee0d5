!> An observer that adds the stability of each state to its record and passes the record on, for
!> scenes with &stability. If a record already has a stability, it is kept: the path counts unstable
!> modes, and the sign of the eigenvalue has to agree with this count.
module stability_records
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t
  use equilibrium, only: cost_t
  use records, only: observer_t, record_t, stable_yes, stable_no, stable_unasked
  use reported_numbers, only: safety_factor
  use text, only: counted
  use summary, only: summary_t
  use stability, only: smallest_eigenvalue, unknown
  use local_criteria, only: local_criterion, axis_criterion
  implicit none
  private
  public :: stability_recorder_t

  type, extends(observer_t) :: stability_recorder_t
    !> The observer that gets the completed records.
    class(observer_t), pointer :: next => null()
    !> Cost of computing the eigenvalues.
    type(cost_t) :: cost
    !> Number of states with an uncertain eigenvalue; number of states with an eigenvalue that
    !> contradicts the record.
    integer :: uncertain = 0, contradicted = 0
    !> The largest interpolation error of the criterion (28); negative if there is none. The largest
    !> derivatives of the criterion by the gap, and by h0.
    real(wp) :: criterion_error = -1, by_gap = 0, by_h0 = 0
    !> Relative accuracy that the deck asks for.
    real(wp) :: accuracy = 0
  contains
    procedure :: take
    procedure :: hear
    procedure :: warn
  end type stability_recorder_t

  !> An eigenvalue whose magnitude is smaller than this number times the accuracy does not
  !> contradict the count. At a fold the eigenvalue is zero except for the error of the mesh, which
  !> is at most 7e-6 for an accuracy of 1e-4.
  real(wp), parameter :: zero = 100
  !> Eigenvalue below which a state counts as a fold.
  real(wp), parameter :: least = 1.0e-12_wp

contains

  subroutine hear(self, what)
    class(stability_recorder_t), intent(inout) :: self
    character(len=*), intent(in) :: what

    call self%next%hear(what)
  end subroutine hear

  subroutine take(self, record, problem, grid, state, profile)
    class(stability_recorder_t), intent(inout) :: self
    type(record_t), intent(in) :: record
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    logical, intent(in) :: profile
    type(record_t) :: completed
    logical :: certain, known
    real(wp) :: error, by_gap

    completed = record
    completed%eigenvalue = unknown()
    completed%local_criterion = unknown()
    completed%axis_criterion = unknown()
    known = .false.
    ! A state that is not an equilibrium is neither stable nor unstable.
    if (record%converged) then
      call smallest_eigenvalue(problem, grid, state, completed%eigenvalue, certain, self%cost)
      call local_criterion(problem, grid, state, completed%local_criterion, error, by_gap)
      if (.not. ieee_is_nan(completed%local_criterion)) known = completed%local_criterion > 0
      if (known) then
        self%criterion_error = max(self%criterion_error, error)
        self%by_gap = max(self%by_gap, by_gap)
        if (certain) then
          self%by_h0 = max(self%by_h0, by_gap/max(least, min(1.0_wp, abs(completed%eigenvalue))))
        else
          self%by_h0 = huge(self%by_h0)
        end if
      end if
      completed%axis_criterion = axis_criterion(problem, state)
      if (.not. certain) then
        self%uncertain = self%uncertain + 1
      else if (record%stable == stable_unasked) then
        completed%stable = merge(stable_yes, stable_no, completed%eigenvalue > 0)
      else if (abs(completed%eigenvalue) > zero*self%accuracy) then
        if ((record%stable == stable_yes) .neqv. (completed%eigenvalue > 0)) &
          self%contradicted = self%contradicted + 1
      end if
    end if
    call self%next%take(completed, problem, grid, state, profile)
  end subroutine take

  !> Adds the error of the criterion (28), and warnings about states with doubtful eigenvalues. An
  !> error of h0 changes gaps in proportion to the inverse eigenvalue, but near a fold at most by
  !> the square root of the error. off: the error of h0 in lengths L of the law; absent for rigid
  !> bodies.
  subroutine warn(self, summary, off)
    class(stability_recorder_t), intent(in) :: self
    type(summary_t), intent(inout) :: summary
    real(wp), intent(in), optional :: off
    real(wp) :: of_states

    of_states = 0
    if (present(off)) of_states = min(off*self%by_h0, sqrt(off)*self%by_gap)
    if (self%criterion_error >= 0) &
      call summary%set('criterion_28_error', safety_factor*self%criterion_error + of_states)
    if (self%uncertain > 0) call summary%warn('the smallest eigenvalue of '// &
      counted(self%uncertain, 'state')//' could not be verified and is NaN')
    if (self%contradicted > 0) call summary%warn('the eigenvalue of '// &
      counted(self%contradicted, 'state')//' contradicts the column stable')
  end subroutine warn

end module stability_records
