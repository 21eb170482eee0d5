!> Panels and their maps from the local coordinate s in [0, 1], in which a panel's functions are
!> polynomials on Gauss-Legendre nodes, to offsets from the mesh's centre:
!>
!>     linear     offset = left + (right - left) s
!>     sinh       offset = focus + d sinh(z), z = z_left + z_length s
!>     power      position = end s**power, from the axis
!>     algebraic  position = begin/(1 - s), out to infinity
!>
!> The sinh map has equal numbers of nodes for each factor in the distance from its focus, from d to
!> the panel's length. On a power panel a function such as ln(position), times the speed, is as
!> smooth as s**(power - 1) ln(s). On an algebraic panel a pressure is (1 - s)**decay times a
!> polynomial: a power tail position**(-decay) times a polynomial in the inverse position.
module panel_map
  use kinds, only: wp
  implicit none
  private
  public :: panel_map_t, sinh_panel
  public :: linear_map, sinh_map, power_map, algebraic_map

  integer, parameter :: linear_map = 1, sinh_map = 2, power_map = 3, algebraic_map = 4

  type :: panel_map_t
    integer :: kind = linear_map
    !> Offsets of the panel's ends; the right one of an algebraic panel is huge.
    real(wp) :: left = 0, right = 0
    !> Parameters of a sinh panel: offset of its focus, d, z at the left end, and the length in z.
    real(wp) :: focus = 0, d = 0, z_left = 0, z_length = 0
    !> Exponent of a power panel.
    integer :: power = 1
    !> Parameters of an algebraic panel: position of its left end, and exponent of the tail.
    real(wp) :: begin = 0, decay = 0
  contains
    procedure :: offset
    procedure :: local
    procedure :: locals
    procedure :: speed
  end type panel_map_t

contains

  !> A sinh panel with a focus and a parameter d, from z_left over z_length.
  pure type(panel_map_t) function sinh_panel(focus, d, z_left, z_length) result(panel)
    real(wp), intent(in) :: focus, d, z_left, z_length

    panel%kind = sinh_map
    panel%focus = focus
    panel%d = d
    panel%z_left = z_left
    panel%z_length = z_length
    panel%left = focus + d*sinh(z_left)
    panel%right = focus + d*sinh(z_left + z_length)
  end function sinh_panel

  !> Offset at the local coordinate s.
  elemental real(wp) function offset(self, s)
    class(panel_map_t), intent(in) :: self
    real(wp), intent(in) :: s

    select case (self%kind)
    case (sinh_map)
      offset = self%focus + self%d*sinh(self%z_left + self%z_length*s)
    case (power_map)
      offset = self%left + (self%right - self%left)*s**self%power
    case (algebraic_map)
      offset = self%left + self%begin*s/(1 - s)
    case default
      offset = self%left + (self%right - self%left)*s
    end select
  end function offset

  !> Inverse of `offset`.
  elemental real(wp) function local(self, at) result(s)
    class(panel_map_t), intent(in) :: self
    real(wp), intent(in) :: at

    select case (self%kind)
    case (sinh_map)
      s = (asinh((at - self%focus)/self%d) - self%z_left)/self%z_length
    case (power_map)
      s = ((at - self%left)/(self%right - self%left))**(1.0_wp/self%power)
    case (algebraic_map)
      s = (at - self%left)/(at - self%left + self%begin)
    case default
      s = (at - self%left)/(self%right - self%left)
    end select
  end function local

  !> Local coordinates of many offsets, faster than `local`, since compilers vectorise a logarithm.
  pure function locals(self, at) result(s)
    class(panel_map_t), intent(in) :: self
    real(wp), intent(in) :: at(:)
    real(wp) :: s(size(at))

    if (self%kind == sinh_map) then
      s = abs(at - self%focus)/self%d
      s = (sign(log(s + sqrt(1 + s**2)), at - self%focus) - self%z_left)/self%z_length
    else
      s = self%local(at)
    end if
  end function locals

  !> Derivative of the offset by s.
  elemental real(wp) function speed(self, s)
    class(panel_map_t), intent(in) :: self
    real(wp), intent(in) :: s

    select case (self%kind)
    case (sinh_map)
      speed = self%z_length*self%d*cosh(self%z_left + self%z_length*s)
    case (power_map)
      speed = self%power*(self%right - self%left)*s**(self%power - 1)
    case (algebraic_map)
      speed = self%begin/(1 - s)**2
    case default
      speed = self%right - self%left
    end select
  end function speed

end module panel_map
