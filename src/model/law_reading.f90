!> Common parts of the readers of force laws.
module law_reading
  use kinds, only: wp
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use failure, only: failure_t
  use text, only: brief, quoted
  use deck, only: deck_t
  use deck_keys, only: key_spec, word_value
  use force_law, only: force_law_t
  implicit none
  private
  public :: keys_of_force, is_law, check_parameter, check_decades, accept_law

  !> Largest decimal order, positive or negative, of units and derived quantities.
  integer, parameter :: most_decades = 100

  !> The row of &force, the group of the paper's two laws, and the row of its key `law`; the laws
  !> add their own rows.
  type(key_spec), parameter :: keys_of_force(*) = [ &
    key_spec('force', meaning='Force per area between the surfaces, against their separation.'), &
    key_spec('force', 'law', word_value, 'Name of the force law.', &
      choices='lennard_jones exponential', required=.true.)]

contains

  !> Whether the deck has &force with this law.
  pure logical function is_law(deck, law)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: law
    character(len=:), allocatable :: name

    is_law = .false.
    if (.not. deck%has_group('force')) return
    call deck%get('force', 'law', name)
    is_law = name == law
  end function is_law

  !> Requires a parameter of &force for its law, if it is `needed`, and refuses it for another law.
  pure subroutine check_parameter(deck, law, key, needed, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: law, key
    logical, intent(in) :: needed
    type(failure_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: name

    if (.not. deck%has_group('force')) return
    call deck%get('force', 'law', name)
    if (name == law .and. needed .and. .not. deck%is_set('force', key)) then
      call deck%mistake('force', key, 'missing; law '//quoted(law)//' needs it', error)
    else if (name /= law .and. deck%is_set('force', key)) then
      call deck%mistake('force', key, 'belongs to law '//quoted(law)//', not to '//quoted(name), &
        error)
    end if
  end subroutine check_parameter

  !> Refuses `what`, a quantity of 10^decades `unit` that follows from values of &bodies and of the
  !> group, if it is out of range.
  pure subroutine check_decades(deck, group, key, decades, what, unit, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: group, key, what, unit
    real(wp), intent(in) :: decades
    type(failure_t), allocatable, intent(inout) :: error

    if (ieee_is_nan(decades)) then
      call deck%mistake(group, key, 'these values make no finite '//what(index(what, ' ') + 1:)// &
        '; do forces cancel each other?', error)
    else if (.not. abs(decades) <= most_decades) then
      call deck%mistake(group, key, 'these values of &bodies and &'//group//' make '//what// &
        ' of 1e'//brief(nint(decades))//unit//'; allowed: from 1e-100 to 1e100', error)
    end if
  end subroutine check_decades

  !> Hands out a law that was read from a group, with the names of the group and of its keys for the
  !> magnitudes of pressure and gap; refuses it if its pressure is out of range.
  subroutine accept_law(deck, group, strength_key, length_key, this, law, error)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: group, strength_key, length_key
    class(force_law_t), intent(inout) :: this
    class(force_law_t), allocatable, intent(out) :: law
    type(failure_t), allocatable, intent(inout) :: error

    call check_decades(deck, group, strength_key, log10(this%pressure_unit), 'a pressure', ' Pa', &
      error)
    if (allocated(error)) return
    this%group = group
    this%strength_key = strength_key
    this%length_key = length_key
    allocate (law, source=this)
  end subroutine accept_law

end module law_reading
