!> The end of a spheroid, b - b sqrt(1 - r^2/a^2), whose radius of curvature on the axis is R =
!> a^2/b. In dimensionless form it is (1 - sqrt(1 - kappa r^2))/kappa, kappa = L/b; near the axis it
!> is the parabola. Beyond 0.98 a it continues as a straight line, on which no force may act.
module spheroid
  use kinds, only: wp
  use text, only: brief
  use deck, only: deck_t
  use deck_keys, only: key_spec, real_value
  use shape, only: shape_t
  use group_reading, only: require, read_radius
  implicit none
  private
  public :: keys, read_shape, take_spheroid

  type, extends(shape_t) :: spheroid_t
    real(wp), private :: kappa = 0
  contains
    procedure :: height
    procedure :: slope
    procedure :: position_of
    procedure :: indentation
  end type spheroid_t

  !> Radius at which the body ends, relative to the radius of the equator.
  real(wp), parameter :: reaching = 0.98_wp
  !> Smallest half-axis in lengths L of the law.
  real(wp), parameter :: smallest = 5

  !> The row of a spheroid in &shape.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('shape', 'semi_axis', real_value, 'Half the axis b of a spheroid along the line ' // &
      'through the bodies; across it is sqrt(R b).', 'm', above=0.0_wp)]

contains

  !> Reads kind = 'spheroid'. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    real(wp) :: radius, semi_axis

    call require(deck, 'shape', 'kind', 'spheroid', 'semi_axis')
    call read_radius(deck, radius)
    if (allocated(deck%error)) return
    call deck%get('shape', 'semi_axis', semi_axis)
    call take_spheroid(deck, 'semi_axis', radius, semi_axis, length, shape)
  end subroutine read_shape

  !> Makes the shape from R, b and the law's length, all in [m]. It fails, with the given key in the
  !> message, if the body is hardly larger than this length.
  subroutine take_spheroid(deck, key, radius, semi_axis, length, shape)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: key
    real(wp), intent(in) :: radius, semi_axis, length
    class(shape_t), allocatable, intent(out) :: shape
    type(spheroid_t) :: this

    if (.not. semi_axis > smallest*length) then
      call deck%mistake('shape', key, 'the body is not larger than '//brief(smallest)// &
        ' lengths of the force law, '//brief(length)//' m; it would end where forces act')
      return
    end if
    this%radius = radius
    this%kappa = length/semi_axis
    this%growth = 1
    this%ends = reaching/sqrt(this%kappa)
    this%breaks = [this%ends]
    allocate (shape, source=this)
  end subroutine take_spheroid

  elemental function height(self, r) result(value)
    class(spheroid_t), intent(in) :: self
    real(wp), intent(in) :: r
    real(wp) :: value, inside

    inside = min(r, self%ends)
    value = inside**2/(1 + sqrt(1 - self%kappa*inside**2))
    if (r > inside) value = value + (r - inside)*self%slope(r)
  end function height

  elemental function slope(self, r) result(value)
    class(spheroid_t), intent(in) :: self
    real(wp), intent(in) :: r
    real(wp) :: value, inside

    inside = min(r, self%ends)
    value = inside/sqrt(1 - self%kappa*inside**2)
  end function slope

  elemental real(wp) function position_of(self, height) result(r)
    class(spheroid_t), intent(in) :: self
    real(wp), intent(in) :: height
    real(wp) :: inside

    inside = min(height, self%height(self%ends))
    r = sqrt(inside*(2 - self%kappa*inside)) + (height - inside)/self%slope(self%ends)
  end function position_of

  !> The closed form, the sum of the part inside the end of the body, up to e a, and of the straight
  !> line beyond.
  elemental real(wp) function indentation(self, a)
    class(spheroid_t), intent(in) :: self
    real(wp), intent(in) :: a
    real(wp) :: e, k

    k = sqrt(self%kappa)*a
    if (a <= self%ends) then
      indentation = a/sqrt(self%kappa)*atanh(k)
    else
      e = self%ends/a
      indentation = a/sqrt(self%kappa)* &
        log((1 + k)/(k*sqrt(1 - e**2) + sqrt(1 - (k*e)**2))) + a*self%slope(a)*acos(e)
    end if
  end function indentation

end module spheroid
