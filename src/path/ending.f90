!> The cause for which an experiment ends early, and the message for it.
module ending
  use kinds, only: wp
  implicit none
  private
  public :: ending_t
  public :: touching, beyond_rounding, no_equilibrium, path_lost, steps_lost, fallen_before, &
    beyond_path, nothing_afar, state_lost, turn_not_reached

  !> The causes, and their messages in the same order; blank if the end was planned.
  integer, parameter :: as_planned = 0, touching = 1, beyond_rounding = 2, no_equilibrium = 3, &
    path_lost = 4, steps_lost = 5, fallen_before = 6, beyond_path = 7, nothing_afar = 8, &
    state_lost = 9, turn_not_reached = 10
  character(len=*), parameter :: messages(0:turn_not_reached) = [character(len=100) :: '', &
    'rigid bodies would touch: the law has no pressure at gaps so small (h0 <= 0, or far ' // &
      'below it)', &
    'adhesion is so strong that rounding hides the force law once the bodies are in contact', &
    'no stable equilibrium exists beyond this h0', &
    'the equilibrium path was lost: no step, however small, converged', &
    'no step, however small, converged', &
    'the bodies have jumped into contact before the h0 at which this branch starts', &
    'this h0 is beyond the path that was traced', &
    'no equilibrium was found far from contact: after', &
    'a state at a given h0 did not converge', &
    'loading did not reach the turning point']

  type :: ending_t
    integer :: cause = as_planned
    !> For `nothing_afar`: number of iterations, and the last residual in the law's lengths.
    integer :: iterations = 0
    real(wp) :: residual = 0
  contains
    procedure :: early
    procedure :: message
  end type ending_t

contains

  !> Whether the experiment ended before its last step.
  elemental logical function early(self)
    class(ending_t), intent(in) :: self

    early = self%cause /= as_planned
  end function early

  !> The reason of the end. The length is not deferred: compiler note 4.
  pure function message(self) result(text)
    class(ending_t), intent(in) :: self
    character(len=160) :: text

    text = messages(self%cause)
    if (self%cause == nothing_afar) write (text, '(a, i0, a, es7.1)') trim(text) // ' ', &
      self%iterations, ' iterations the residual was ', self%residual
  end function message

end module ending
