!> Depletion force between walls in a solution of hard spheres (Asakura and Oosawa). At separations
!> smaller than the diameter of the spheres, their osmotic pressure acts only from outside. The step
!> is smoothed (`step_attraction`).
module depletion
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use force_law, only: force_law_t
  use step_attraction, only: read_step
  implicit none
  private
  public :: keys, read_law

  !> The rows of &depletion.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('depletion', meaning='Depletion attraction in a solution of particles.', &
      choices='&depletion osmotic_pressure = 5e4, diameter = 10e-9 /'), &
    key_spec('depletion', 'osmotic_pressure', real_value, 'Osmotic pressure of the particles.', &
      'Pa', above=0.0_wp, required=.true.), &
    key_spec('depletion', 'diameter', real_value, 'Diameter of the particles.', 'm', above=0.0_wp, &
      required=.true.), &
    key_spec('depletion', 'smoothing', real_value, 'Width of the smoothed step.', 'm', &
      above=0.0_wp, otherwise='0.02 of its range')]

contains

  !> Reads the law from its group.
  subroutine read_law(deck, law)
    type(deck_t), intent(inout) :: deck
    class(force_law_t), allocatable, intent(out) :: law

    call read_step(deck, 'depletion', 'osmotic_pressure', 'diameter', law)
  end subroutine read_law

end module depletion
