!> A force law from its name and numbers, for the flat modules. Beside them and not in one, since
!> f2py does not understand the type.
module law_by_name
  use failure, only: bad_input
  use force_law, only: force_law_t
  use kinds, only: wp
  use laws, only: law_parameters_t, new_law
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
    call new_law(law_parameters_t(law=trim(name), part=trim(part), hamaker=hamaker, z0=z0, p0=p0, &
      decay_length=decay_length), law)
    if (allocated(law)) return
    stat = bad_input
    message = 'law: there is no "'//trim(name)//'"'
  end subroutine make_law

end module law_by_name
