!> The fit of a scene to its measured curve, which has been read.
module measured_fit
  use kinds, only: wp
  use failure, only: failure_t
  use progress_observer, only: progress_observer_t
  use dimensionless_problem, only: problem_t
  use scene_groups, only: scene_t
  use deck_family, only: deck_family_t, widened
  use fit_group, only: family_of_fit
  use fit_run, only: run_fit, fit_outcome_t
  implicit none
  private
  public :: fit_measured

contains

  !> Makes the fit. like: values of the unknowns of another curve, from which the search starts;
  !> theories: whether the classical theories are fitted too.
  subroutine fit_measured(scene, problem, theories, observer, outcome, like)
    type(scene_t), intent(in) :: scene
    type(problem_t), intent(in) :: problem
    logical, intent(in) :: theories
    class(progress_observer_t), intent(inout) :: observer
    type(fit_outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: like(:)
    type(deck_family_t) :: family
    type(failure_t), allocatable :: error

    ! The deck has been read already, so that its family has no mistake.
    call family_of_fit(scene%deck, family, error)
    call run_fit(scene%measured, scene%fit, scene%numerics, family, widened(family), problem, &
      theories, observer, outcome, like)
  end subroutine fit_measured

end module measured_fit
