!> Common parts of the readers of shapes.
module shape_reading
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value, word_value
  implicit none
  private
  public :: keys_of_shape, read_radius, refuse_radius

contains

  !> The rows that belong to no single kind; `kinds` has the names of all kinds. The rows of the
  !> shapes follow them.
  pure function keys_of_shape(kinds) result(rows)
    character(len=*), intent(in) :: kinds
    type(key_spec), allocatable :: rows(:)

    rows = [ &
      key_spec('shape', meaning='Shape of the undeformed gap f(r): bodies at h0 are h0 + f(r) ' // &
        'apart. Without this group it is r^2/(2R).'), &
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

  !> Fails for the given reason if the deck gives a radius.
  pure subroutine refuse_radius(deck, reason)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: reason

    if (deck%is_set('shape', 'radius')) &
      call deck%mistake('shape', 'radius', 'has no meaning here: '//reason)
    if (deck%is_set('bodies', 'radius')) &
      call deck%mistake('bodies', 'radius', 'has no meaning here: '//reason)
  end subroutine refuse_radius

end module shape_reading
