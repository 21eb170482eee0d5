!> Hydrophobic attraction: p = -(W/l) exp(-h/l); each value of the keys is one term.
module hydrophobic
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_list
  use exponential, only: read_exponentials
  use force_law, only: force_law_t
  implicit none
  private
  public :: keys, read_law

  !> The rows of &hydrophobic.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('hydrophobic', meaning='Hydrophobic attraction; each value of a list is one ' // &
      'term. Needs a repulsion beside it.', &
      choices='&hydrophobic energy = 0.02, decay_length = 1e-9 /'), &
    key_spec('hydrophobic', 'energy', real_list, 'Energy W at h = 0, twice the interfacial ' // &
      'energy times the hydrophobic fraction.', 'J/m^2', most=8, above=0.0_wp, required=.true.), &
    key_spec('hydrophobic', 'decay_length', real_list, 'Decay length l.', 'm', most=8, &
      above=0.0_wp, required=.true.)]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law

    call read_exponentials(deck, 'hydrophobic', -1.0_wp, law)
  end subroutine read_law

end module hydrophobic
