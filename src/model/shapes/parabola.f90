!> The gap r^2/(2R) of spheres near their point of contact. It is the gap of the paper, and the
!> shape of decks without &shape.
module parabola
  use kinds, only: wp, pi
  use deck, only: deck_t
  use deck_keys, only: key_spec
  use shape, only: shape_t
  use group_reading, only: read_radius
  implicit none
  private
  public :: keys, read_shape, new_parabola

  type, extends(shape_t) :: parabola_t
  contains
    procedure :: height
    procedure :: slope
    procedure :: position_of
    procedure :: bend
    procedure :: unlike_scaling
    procedure :: indentation
    procedure :: indentation_load
    procedure :: contact_radius
    procedure :: opening
    procedure :: hertz_gap
  end type parabola_t

  !> A parabola has no rows of its own in &shape.
  type(key_spec), parameter :: keys(*) = [key_spec ::]

contains

  !> Reads kind = 'parabola', or a deck without &shape. length: the law's [m], which is not needed
  !> here.
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    real(wp) :: radius

    call read_radius(deck, radius)
    if (.not. allocated(deck%error)) allocate (shape, source=new_parabola(radius))
  end subroutine read_shape

  !> Makes the parabola. radius: R [m].
  pure type(parabola_t) function new_parabola(radius) result(shape)
    real(wp), intent(in) :: radius

    shape%radius = radius
    shape%parabolic = .true.
  end function new_parabola

  elemental real(wp) function height(self, r) result(value)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: r

    value = 0.5_wp*r**2
  end function height

  elemental real(wp) function slope(self, r) result(value)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: r

    value = r
  end function slope

  elemental real(wp) function position_of(self, height) result(r)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: height

    r = sqrt(2*height)
  end function position_of

  elemental real(wp) function bend(self, r, dr)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: r, dr

    bend = 0.5_wp*dr**2
  end function bend

  elemental real(wp) function unlike_scaling(self, c, x) result(change)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: c, x

    change = 0.5_wp*c*x**2
  end function unlike_scaling

  !> The indentation (4).
  elemental real(wp) function indentation(self, a)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: a

    indentation = a**2
  end function indentation

  !> The load integral (5).
  elemental real(wp) function indentation_load(self, a) result(load)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: a

    load = 2*a**3/3
  end function indentation_load

  elemental real(wp) function contact_radius(self, depth) result(a)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: depth

    a = sqrt(max(depth, 0.0_wp))
  end function contact_radius

  elemental real(wp) function opening(self, a)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: a

    opening = a
  end function opening

  pure function hertz_gap(self, a, beyond) result(gap)
    class(parabola_t), intent(in) :: self
    real(wp), intent(in) :: a, beyond(:)
    real(wp), dimension(size(beyond)) :: gap, tangent

    tangent = sqrt(beyond*(2 + beyond))
    gap = a**2/pi*(tangent + (tangent**2 - 1)*atan(tangent))
  end function hertz_gap

end module parabola
