!> The cause for which an experiment ends early.
module ending
  use kinds, only: wp
  implicit none
  private
  public :: ending_t
  public :: as_planned, touching, beyond_rounding, no_equilibrium, path_lost, steps_lost, &
    fallen_before, beyond_path, nothing_afar, state_lost, turn_not_reached, not_kept

  !> In order: no early end; rigid bodies would touch, and their law has no pressure at such gaps;
  !> rounding hides the contact; there is no further stable equilibrium; no step along the path
  !> converged, however small; no step in h0 converged, however small; the bodies have fallen onto
  !> each other before the experiment begins; the path was not traced so far; no equilibrium was
  !> found at large separation; a state at a given h0 did not converge; loading did not reach the
  !> turning point; the results can no longer be kept.
  integer, parameter :: as_planned = 0, touching = 1, beyond_rounding = 2, no_equilibrium = 3, &
    path_lost = 4, steps_lost = 5, fallen_before = 6, beyond_path = 7, nothing_afar = 8, &
    state_lost = 9, turn_not_reached = 10, not_kept = 11

  type :: ending_t
    integer :: cause = as_planned
    !> For `nothing_afar`: number of iterations, and the last residual in the law's lengths.
    integer :: iterations = 0
    real(wp) :: residual = 0
  contains
    procedure :: early
  end type ending_t

contains

  elemental logical function early(self)
    class(ending_t), intent(in) :: self

    early = self%cause /= as_planned
  end function early

end module ending
