!> Panels for shapes whose derivatives jump, as at the rim of a flat face. On meshes about the axis
!> panels end there. A contact on a flat face stays on such meshes while its edge passes the rim.
module shape_panels
  use kinds, only: wp
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t
  use contact_scales, only: cohesive_width, smallest_feature
  implicit none
  private
  public :: panels_for, rim_passed_at

  !> Largest length in z of panels over which kinks lie, and of panels between kinks, which
  !> `law_panels` halves where the pressure needs it.
  real(wp), parameter :: short = 0.7_wp, between_kinks = 2
  !> Largest number of kinks of a shape at which panels end; a table has more kinks, which are
  !> everywhere.
  integer, parameter :: few = 4
  !> Widths of the cohesive zone: the largest radius over which the edge passes on meshes about the
  !> axis; on a wider face, the radius up to which it stays on them. The radius up to which it stays
  !> on them after a rim within that radius, over that of the rim, but at most one unit more.
  real(wp), parameter :: widths_to_pass = 40, widths_before = 5, beyond_rim = 1.3_wp
  !> Width of the cohesive zone, lateral units, above which adhesion is weak.
  real(wp), parameter :: wide = 10

contains

  !> The radius up to which the edge of a contact on a flat face stays on meshes about the axis, on
  !> which the rim is a panel's end, so that the pressure is smooth on all panels: up to the widest
  !> contact, if the edge passes over few panels; otherwise up to somewhat beyond the rim or, on a
  !> face so wide that there would be very many panels, while the rim is far outside. Of weak
  !> adhesion the cohesive zone is no measure of these panels, but the edge of the pressed contact.
  !> Inside a contact on layers, meshes about the axis lack short waves (`mesh_waves`). 0: the shape
  !> has no flat face.
  pure real(wp) function rim_passed_at(problem, widest) result(radius)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: widest

    radius = 0
    associate (rim => problem%shape%smooth_from(), width => cohesive_width(problem))
      if (.not. rim > 0 .or. problem%shape%height(rim) > 0) return
      radius = min(beyond_rim*rim, rim + 1)
      if (rim > widths_to_pass*width) radius = widths_before*width
      if (.not. problem%body%is_homogeneous()) return
      if (widest < widths_to_pass*width .and. (width < wide .or. &
        widest - rim < widths_to_pass*smallest_feature(problem, widest))) radius = widest
    end associate
  end function rim_passed_at

  !> Lengths in z of panels over z_length, at positions d sinh(z), for a shape with kinks. On a mesh
  !> about the axis they end at the kinks, if these are few; otherwise they are short.
  pure function panels_for(shape, about_axis, d, z_length) result(lengths)
    class(shape_t), intent(in) :: shape
    logical, intent(in) :: about_axis
    real(wp), intent(in) :: d, z_length
    real(wp), allocatable :: lengths(:), kinks(:), ends(:)
    integer :: i, n

    allocate (kinks(0), lengths(0))
    if (about_axis .and. allocated(shape%breaks)) kinks = shape%breaks
    if (size(kinks) > few) kinks = kinks(:0)
    ends = asinh(kinks/d)
    ends = [0.0_wp, pack(ends, ends < z_length), z_length]
    do i = 1, size(ends) - 1
      n = ceiling((ends(i + 1) - ends(i))/merge(between_kinks, short, size(kinks) > 0))
      lengths = [lengths, spread((ends(i + 1) - ends(i))/n, 1, n)]
    end do
  end function panels_for

end module shape_panels
