!> Dugdale's law: a constant attraction up to a separation, with a smoothed step
!> (`step_attraction`).
module dugdale
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

  !> The rows of &dugdale.
  pure function keys() result(rows)
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      group('dugdale', 'Constant attraction up to a separation; needs a repulsion beside it.'), &
      real_key('dugdale', 'stress', 'Pa', 'Attraction.', above=0.0_wp, required=.true.), &
      real_key('dugdale', 'range', 'm', 'Separation at which the attraction ends.', above=0.0_wp, &
               required=.true.), &
      smoothing_key('dugdale')]
  end function keys

  !> The law, if the deck has its group.
  subroutine read_law(deck, law, error)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error

    call read_step(deck, 'dugdale', 'stress', 'range', law, error)
  end subroutine read_law

end module dugdale
