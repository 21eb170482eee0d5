!> Hydration repulsion: p = (W/l) exp(-h/l); each value of the keys is one term.
module hydration
  use kinds, only: wp
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, group, list_key
  use exponential, only: read_exponentials
  use force_law, only: force_law_t
  implicit none
  private
  public :: keys, read_law

contains

  !> The rows of &hydration.
  pure function keys() result(rows)
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      group('hydration', 'Hydration repulsion. Give energy or pressure; each value of a list ' // &
            'is one term.'), &
      list_key('hydration', 'energy', 'J/m^2', 'Energy W at h = 0.', most=8, above=0.0_wp), &
      list_key('hydration', 'pressure', 'Pa', 'Pressure at h = 0, W over the decay length.', &
               most=8, above=0.0_wp), &
      list_key('hydration', 'decay_length', 'm', 'Decay length l.', most=8, above=0.0_wp, &
               required=.true.)]
  end function keys

  !> The law, if the deck has its group.
  subroutine read_law(deck, law, error)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error

    call read_exponentials(deck, 'hydration', 1.0_wp, law, error)
  end subroutine read_law

end module hydration
