!> Why an experiment ends before it should.
module ending
  use kinds, only: wp
  implicit none
  private
  public :: ending_t
  public :: as_planned, touching, beyond_rounding, no_equilibrium, path_lost, steps_lost, &
    fallen_before, beyond_path, nothing_afar, state_lost, turn_not_reached, not_kept

  !> It does not; rigid bodies would touch, and so near their law has no pressure; rounding hides
  !> the contact; there is no stable equilibrium any more; no step along the path, or in h0,
  !> converged, however small; the bodies have fallen onto each other before it begins; the path was
  !> not traced so far; no equilibrium was found far from contact; a state at a given h0 did not
  !> converge; loading did not reach the turning point; what was found can no longer be kept.
  integer, parameter :: as_planned = 0, touching = 1, beyond_rounding = 2, no_equilibrium = 3, &
    path_lost = 4, steps_lost = 5, fallen_before = 6, beyond_path = 7, nothing_afar = 8, &
    state_lost = 9, turn_not_reached = 10, not_kept = 11

  type :: ending_t
    integer :: cause = as_planned
    !> For `nothing_afar`: iterations, and the residual they left in the law's lengths.
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
