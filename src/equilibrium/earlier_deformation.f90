!> The rise of the gap due to earlier pressures in viscoelastic bodies. It is fixed in the bodies'
!> material, and known on a mesh fixed in space.
module earlier_deformation
  use kinds, only: wp
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  implicit none
  private
  public :: earlier_deformation_t, rise_at

  !> The rise of the gap at the rows of the kernel (axis, centre, nodes) of the present mesh: at the
  !> expected scale, and its derivatives by the logarithm of the scale. For a slightly different
  !> scale, the nodes move little and the rise is linear in the logarithm.
  type :: earlier_deformation_t
    real(wp) :: scale = 1
    real(wp), allocatable :: value(:), growth(:)
  contains
    procedure :: at_scale
  end type earlier_deformation_t

  !> Relative difference of positions for the difference quotient. Its relative error is about as
  !> large, which is sufficient for small changes of the scale.
  real(wp), parameter :: apart = 1.0e-6_wp

contains

  !> The rise at the rows of the mesh for a scale.
  pure function at_scale(self, scale) result(rise)
    class(earlier_deformation_t), intent(in) :: self
    real(wp), intent(in) :: scale
    real(wp) :: rise(size(self%value))

    rise = self%value
    if (abs(scale - self%scale) > 0) rise = rise + log(scale/self%scale)*self%growth
  end function at_scale

  !> The rise at the rows of another mesh at an expected scale, from the rise at the rows of a mesh
  !> fixed in space (scale 1). Beyond that mesh the rise decreases as 1/r, like that of a point
  !> load.
  pure type(earlier_deformation_t) function rise_at(material, risen, grid, scale) result(earlier)
    type(discretisation_t), intent(in) :: material, grid
    real(wp), intent(in) :: risen(:), scale
    real(wp) :: r
    integer :: i, rows

    rows = first_node - 1 + grid%nodes
    allocate (earlier%value(rows), earlier%growth(rows))
    earlier%scale = scale
    do i = 1, rows
      select case (i)
      case (axis_row)
        r = 0
      case (centre_row)
        r = scale*grid%centre
      case default
        r = scale*grid%x(i - first_node + 1)
      end select
      earlier%value(i) = value(r)
      earlier%growth(i) = (value((1 + apart)*r) - earlier%value(i))/apart
    end do

  contains

    pure real(wp) function value(r)
      real(wp), intent(in) :: r

      associate (last => material%x(material%nodes))
        if (.not. r > 0) then
          value = risen(axis_row)
        else if (r < last) then
          value = material%interpolate(risen(first_node:), r)
        else
          value = risen(size(risen))*last/r
        end if
      end associate
    end function value

  end function rise_at

end module earlier_deformation
