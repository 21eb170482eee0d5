!> A flat punch with a rounded rim: f = 0 up to the radius b and (r - b)^2/(2R) beyond.
module rounded_punch
  use kinds, only: wp
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use shape, only: shape_t
  use group_reading, only: require, read_radius
  implicit none
  private
  public :: keys, read_shape

  type, extends(shape_t) :: rounded_punch_t
    !> The radius b in lateral units, which are those of the parabola with the rim's radius R.
    real(wp), private :: flat = 0
  contains
    procedure :: height
    procedure :: slope
    procedure :: bend
    procedure :: position_of
    procedure :: indentation
  end type rounded_punch_t

  !> The row of a rounded punch in &shape.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('shape', 'flat_radius', real_value, 'Radius b of the flat face of a punch, whose ' // &
      'rim has the radius R.', 'm', above=0.0_wp)]

contains

  !> Reads kind = 'rounded_punch'. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    type(rounded_punch_t) :: this
    real(wp) :: flat_radius

    call require(deck, 'shape', 'kind', 'rounded_punch', 'flat_radius')
    call read_radius(deck, this%radius)
    if (allocated(deck%error)) return
    call deck%get('shape', 'flat_radius', flat_radius)
    this%flat = flat_radius/sqrt(this%radius*length)
    this%exponent = 0
    this%breaks = [this%flat]
    allocate (shape, source=this)
  end subroutine read_shape

  elemental real(wp) function height(self, r) result(value)
    class(rounded_punch_t), intent(in) :: self
    real(wp), intent(in) :: r

    value = 0.5_wp*self%slope(r)**2
  end function height

  elemental real(wp) function slope(self, r) result(value)
    class(rounded_punch_t), intent(in) :: self
    real(wp), intent(in) :: r

    value = max(r - self%flat, 0.0_wp)
  end function slope

  elemental real(wp) function bend(self, r, dr)
    class(rounded_punch_t), intent(in) :: self
    real(wp), intent(in) :: r, dr

    bend = 0.5_wp*(self%slope(r + dr) - self%slope(r))**2 + &
      self%slope(r)*(self%slope(r + dr) - self%slope(r) - dr)
  end function bend

  elemental real(wp) function position_of(self, height) result(r)
    class(rounded_punch_t), intent(in) :: self
    real(wp), intent(in) :: height

    r = self%flat + sqrt(2*height)
  end function position_of

  elemental real(wp) function indentation(self, a)
    class(rounded_punch_t), intent(in) :: self
    real(wp), intent(in) :: a

    indentation = 0
    if (a > self%flat) &
      indentation = a*(sqrt((a - self%flat)*(a + self%flat)) - self%flat*acos(self%flat/a))
  end function indentation

end module rounded_punch
