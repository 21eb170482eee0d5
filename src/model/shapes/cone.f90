!> A cone, the gap r tan(beta): a power with n = 1.
module cone
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use shape, only: shape_t
  use group_reading, only: require, refuse_radius
  use power, only: take_power
  implicit none
  private
  public :: keys, read_shape

  !> The row of a cone in &shape.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('shape', 'half_angle', real_value, 'Angle of a cone between axis and surface; ' // &
      'the gap is r/tan(half_angle).', 'rad', above=0.0_wp, below=0.5_wp*pi)]

contains

  !> Reads kind = 'cone'. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    real(wp) :: half_angle

    call require(deck, 'shape', 'kind', 'cone', 'half_angle')
    call refuse_radius(deck, 'a cone has none')
    if (allocated(deck%error)) return
    call deck%get('shape', 'half_angle', half_angle)
    call take_power(deck, 'half_angle', 1.0_wp, -log(tan(half_angle)), length, shape)
  end subroutine read_shape

end module cone
