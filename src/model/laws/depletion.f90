!> Depletion force between walls in a solution of hard spheres (Asakura and Oosawa): at separations
!> below their diameter the osmotic pressure acts only from outside. The step is smoothed
!> (`step_attraction`).
module depletion
  use kinds, only: wp
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, group, real_key
  use force_law, only: force_law_t
  use step_attraction, only: read_step, smoothing_key
  implicit none
  private
  public :: keys, read_law

contains

  !> The rows of &depletion.
  pure function keys() result(rows)
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      group('depletion', 'Depletion attraction in a solution of particles.'), &
      real_key('depletion', 'osmotic_pressure', 'Pa', 'Osmotic pressure of the particles.', &
               above=0.0_wp, required=.true.), &
      real_key('depletion', 'diameter', 'm', 'Diameter of the particles.', above=0.0_wp, &
               required=.true.), &
      smoothing_key('depletion')]
  end function keys

  !> The law, if the deck has its group.
  subroutine read_law(deck, law, error)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error

    call read_step(deck, 'depletion', 'osmotic_pressure', 'diameter', law, error)
  end subroutine read_law

end module depletion
