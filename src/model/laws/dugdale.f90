!> Dugdale's law: a constant attraction up to a separation, with a smoothed step
!> (`step_attraction`).
module dugdale
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t
  use step_attraction, only: read_step
  implicit none
  private
  public :: keys, read_law

  !> The rows of &dugdale.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('dugdale', meaning='Constant attraction up to a separation; needs a repulsion ' // &
      'beside it.', &
      choices='&dugdale stress = 2e7, range = 1.5e-9 /'), &
    key_spec('dugdale', 'stress', real_value, 'Attraction.', 'Pa', above=0.0_wp, required=.true.), &
    key_spec('dugdale', 'range', real_value, 'Separation at which the attraction ends.', 'm', &
      above=0.0_wp, required=.true.), &
    key_spec('dugdale', 'smoothing', real_value, 'Width of the smoothed step.', 'm', &
      above=0.0_wp, otherwise='0.02 of its range')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law

    call read_step(deck, 'dugdale', 'stress', 'range', law)
  end subroutine read_law

end module dugdale
