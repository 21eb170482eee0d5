!> A force law from its name and numbers, for the flat modules. Beside them and not in one, since
!> f2py does not understand the type.
module law_by_name
  use failure, only: bad_input
  use force_law, only: force_law_t
  use kinds, only: wp
  use exponential, only: new_exponential
  use lennard_jones, only: new_lennard_jones
  implicit none
  private
  public :: make_law

contains

  !> The law of this name; stat and message where there is none.
  subroutine make_law(name, part, hamaker, z0, p0, decay_length, law, stat, message)
    character(len=*), intent(in) :: name, part
    real(wp), intent(in) :: hamaker, z0, p0, decay_length
    class(force_law_t), allocatable, intent(out) :: law
    integer, intent(out) :: stat
    character(len=*), intent(out) :: message

    stat = 0
    message = ''
    select case (name)
    case ('lennard_jones')
      allocate (law, source=new_lennard_jones(hamaker, z0, trim(part)))
    case ('exponential')
      allocate (law, source=new_exponential(p0, decay_length))
    case default
      stat = bad_input
      message = 'law: there is no "'//trim(name)//'"'
    end select
  end subroutine make_law

end module law_by_name
