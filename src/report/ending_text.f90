!> The messages for experiments that end early.
module ending_text
  use ending, only: ending_t, touching, beyond_rounding, no_equilibrium, path_lost, steps_lost, &
    fallen_before, beyond_path, nothing_afar, state_lost, turn_not_reached, not_kept
  implicit none
  private
  public :: text_of

contains

  !> The reason of the end, blank if it was planned. The length is not deferred: compiler note 4.
  pure function text_of(ending) result(text)
    type(ending_t), intent(in) :: ending
    character(len=160) :: text

    select case (ending%cause)
    case (touching)
      text = 'rigid bodies would touch: the law has no pressure at gaps so small (h0 <= 0, or ' // &
        'far below it)'
    case (beyond_rounding)
      text = 'adhesion is so strong that rounding hides the force law once the bodies are in ' // &
        'contact'
    case (no_equilibrium)
      text = 'no stable equilibrium exists beyond this h0'
    case (path_lost)
      text = 'the equilibrium path was lost: no step, however small, converged'
    case (steps_lost)
      text = 'no step, however small, converged'
    case (fallen_before)
      text = 'the bodies have jumped into contact before the h0 at which this branch starts'
    case (beyond_path)
      text = 'this h0 is beyond the path that was traced'
    case (nothing_afar)
      write (text, '(a, i0, a, es7.1)') 'no equilibrium was found far from contact: after ', &
        ending%iterations, ' iterations the residual was ', ending%residual
    case (state_lost)
      text = 'a state at a given h0 did not converge'
    case (turn_not_reached)
      text = 'loading did not reach the turning point'
    case (not_kept)
      text = 'the results can no longer be written'
    case default
      text = ''
    end select
  end function text_of

end module ending_text
