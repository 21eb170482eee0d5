!> Procedures that the readers of force laws and shapes have in common.
module group_reading
  use kinds, only: wp
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use text, only: brief, quoted
  use deck, only: deck_t
  use deck_keys, only: key_spec, word_value, real_value
  use force_law, only: force_law_t
  implicit none
  private
  public :: keys_of_force, is_law, require, refuse_foreign, check_decades, accept_law, &
    keys_of_shape, read_radius, refuse_radius

  !> Largest decimal order, positive or negative, of units and of derived quantities.
  integer, parameter :: most_decades = 100

  !> The row of &force, the group of the paper's two laws, and the row of its key `law`. The modules
  !> of the laws add their own rows.
  type(key_spec), parameter :: keys_of_force(*) = [ &
    key_spec('force', meaning='Force per area between the surfaces, against their separation.', &
      choices='&force law = ''lennard_jones'', work_of_adhesion = 0.05, z0 = 0.3e-9 /'), &
    key_spec('force', 'law', word_value, 'Name of the force law.', &
      choices='lennard_jones exponential', required=.true.)]

contains

  !> Whether the deck has &force with this law.
  pure logical function is_law(deck, law)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: law
    character(len=:), allocatable :: name

    call deck%get('force', 'law', name)
    is_law = name == law
  end function is_law

  !> Fails if the deck does not give a key of a group that is needed for a `choice`, which is the
  !> value of the group's key `by`.
  pure subroutine require(deck, group, by, choice, key)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, by, choice, key

    if (.not. deck%is_set(group, key)) call deck%mistake(group, key, 'missing; '//by//' '// &
      quoted(choice)//' needs it')
  end subroutine require

  !> Fails if the deck gives one of the keys `rows` although its `choice` is not the one to which
  !> they belong.
  pure subroutine refuse_foreign(deck, group, by, choice, rows)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, by, choice
    type(key_spec), intent(in) :: rows(:)
    character(len=:), allocatable :: other
    integer :: i

    call deck%get(group, by, other)
    if (other == choice) return
    do i = 1, size(rows)
      if (deck%is_set(group, trim(rows(i)%key))) call deck%mistake(group, trim(rows(i)%key), &
        'belongs to '//by//' '//quoted(choice)//', not to '//quoted(other))
    end do
  end subroutine refuse_foreign

  !> Refuses a quantity that is out of range. what: the quantity, equal to 10^decades `unit`, which
  !> follows from values of &bodies and of the group. most: the largest decimal order;
  !> `most_decades` if absent.
  pure subroutine check_decades(deck, group, key, decades, what, unit, most)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, key, what, unit
    real(wp), intent(in) :: decades
    integer, intent(in), optional :: most
    integer :: largest

    largest = most_decades
    if (present(most)) largest = most

    if (ieee_is_nan(decades)) then
      call deck%mistake(group, key, 'these values make no finite '//what(index(what, ' ') + 1:)// &
        '; do forces cancel each other?')
    else if (.not. (decades >= -most_decades .and. decades <= largest)) then
      call deck%mistake(group, key, 'these values of &bodies and &'//group//' make '//what// &
        ' of about 1e'//brief(merge(ceiling(decades), floor(decades), decades > 0))//unit// &
        '; allowed: from 1e-100 to 1e'//brief(largest))
    end if
  end subroutine check_decades

  !> Hands over a law that was read from a group, with the names of the group and of its keys for
  !> the magnitudes of pressure and gap. The law is refused if its pressure is out of range.
  subroutine accept_law(deck, group, strength_key, length_key, this, law)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: group, strength_key, length_key
    class(force_law_t), intent(inout) :: this
    class(force_law_t), allocatable, intent(out) :: law

    call check_decades(deck, group, strength_key, log10(this%pressure_unit), 'a pressure', ' Pa')
    if (allocated(deck%error)) return
    this%group = group
    this%strength_key = strength_key
    this%length_key = length_key
    allocate (law, source=this)
  end subroutine accept_law

  !> The rows of &shape that belong to no single kind of shape. kinds: the names of all kinds. The
  !> rows of the kinds follow.
  pure function keys_of_shape(kinds) result(rows)
    character(len=*), intent(in) :: kinds
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      key_spec('shape', meaning='Shape of the undeformed gap f(r): bodies at h0 are h0 + f(r) ' // &
        'apart. Without this group it is r^2/(2R).', &
        choices='&shape kind = ''sphere'' /'), &
      key_spec('shape', 'kind', word_value, 'Kind of shape.', choices=kinds, required=.true.), &
      key_spec('shape', 'radius', real_value, 'Radius R of a parabola or sphere, of the end ' // &
        'of a spheroid, of the rim of a punch; for a power B = 1/(2 R^(n-1)).', 'm', above=0.0_wp, &
        otherwise='that of &bodies')]
  end function keys_of_shape

  !> Reads R [m] from &shape or &bodies.
  subroutine read_radius(deck, radius)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(out) :: radius

    radius = 1
    if (deck%is_set('shape', 'radius') .and. deck%is_set('bodies', 'radius')) then
      call deck%mistake('shape', 'radius', 'given in &bodies too; give it once')
    else if (deck%is_set('shape', 'radius')) then
      call deck%get('shape', 'radius', radius)
    else if (deck%is_set('bodies', 'radius')) then
      call deck%get('bodies', 'radius', radius)
    else
      call deck%mistake('bodies', 'radius', 'missing; give it a number > 0 m')
    end if
  end subroutine read_radius

  !> Fails with the given reason if the deck gives a radius.
  pure subroutine refuse_radius(deck, reason)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: reason

    if (deck%is_set('shape', 'radius')) &
      call deck%mistake('shape', 'radius', 'has no meaning here: '//reason)
    if (deck%is_set('bodies', 'radius')) &
      call deck%mistake('bodies', 'radius', 'has no meaning here: '//reason)
  end subroutine refuse_radius

end module group_reading
