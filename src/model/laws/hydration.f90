!> Hydration repulsion: p = (W/l) exp(-h/l); each value of the keys is one term.
module hydration
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_list
  use exponential, only: read_exponentials
  use force_law, only: force_law_t
  implicit none
  private
  public :: keys, read_law

  !> The rows of &hydration.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('hydration', meaning='Hydration repulsion. Give energy or pressure; each value ' // &
      'of a list is one term.', &
      choices='&hydration energy = 5e-3, decay_length = 0.3e-9 /'), &
    key_spec('hydration', 'energy', real_list, 'Energy W at h = 0.', 'J/m^2', most=8, &
      above=0.0_wp), &
    key_spec('hydration', 'pressure', real_list, 'Pressure at h = 0, W over the decay length.', &
      'Pa', most=8, above=0.0_wp), &
    key_spec('hydration', 'decay_length', real_list, 'Decay length l.', 'm', most=8, above=0.0_wp, &
      required=.true.)]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law

    call read_exponentials(deck, 'hydration', 1.0_wp, law)
  end subroutine read_law

end module hydration
