!> Makes a force law from its name in the deck. A new law is one new file under laws/ and one case
!> here.
module laws
  use kinds, only: wp
  use force_law, only: force_law_t
  use exponential, only: new_exponential
  use lennard_jones, only: new_lennard_jones
  implicit none
  private
  public :: law_parameters_t, new_law

  !> The parameters of all laws, SI; each law reads its own.
  type :: law_parameters_t
    character(len=:), allocatable :: law, part
    real(wp) :: hamaker = 0, z0 = 0, p0 = 0, decay_length = 0
  end type law_parameters_t

contains

  !> Unallocated result: no law has this name (a deck with such a name is refused earlier).
  subroutine new_law(parameters, law)
    type(law_parameters_t), intent(in) :: parameters
    class(force_law_t), allocatable, intent(out) :: law

    select case (parameters%law)
    case ('lennard_jones')
      allocate (law, source=new_lennard_jones(parameters%hamaker, parameters%z0, parameters%part))
    case ('exponential')
      allocate (law, source=new_exponential(parameters%p0, parameters%decay_length))
    end select
  end subroutine new_law

end module laws
