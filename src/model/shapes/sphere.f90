!> An exact sphere on a plane: the spheroid whose axes are equal.
module sphere
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec
  use shape, only: shape_t
  use group_reading, only: read_radius
  use spheroid, only: take_spheroid
  implicit none
  private
  public :: keys, read_shape

  !> A sphere has no rows of its own in &shape.
  type(key_spec), parameter :: keys(*) = [key_spec ::]

contains

  !> Reads kind = 'sphere'. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    real(wp) :: radius

    call read_radius(deck, radius)
    if (.not. allocated(deck%error)) &
      call take_spheroid(deck, 'radius', radius, radius, length, shape)
  end subroutine read_shape

end module sphere
