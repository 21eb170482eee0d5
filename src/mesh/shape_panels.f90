!> Panels for shapes whose derivatives jump, as at the rim of a flat face. On meshes about the axis
!> panels end there. A contact on a flat face stays on such meshes while its edge passes the rim.
module shape_panels
  use kinds, only: wp
  use shape, only: shape_t
  use dimensionless_problem, only: problem_t
  use contact_scales, only: cohesive_width, smallest_feature
  use mapped_shape, only: mapped_shape_t
  implicit none
  private
  public :: panels_for, kinks_at_ends, has_flat_face, rim_passed_at

  !> Largest length in z of panels over which kinks lie, and of panels between kinks, which
  !> `law_panels` halves where the pressure needs it.
  real(wp), parameter :: short = 0.7_wp, between_kinks = 2
  !> Largest number of kinks of a shape at which panels end; a table has more kinks, which are
  !> everywhere.
  integer, parameter :: few = 4
  !> Largest radius, in widths of the cohesive zone, up to which the edge may move on meshes about
  !> the axis. Radius, in the same unit, up to which the edge stays on these meshes if the face is
  !> wider than that. If it is not, the edge stays on them up to this multiple of the rim's radius,
  !> but at most one unit beyond the rim.
  real(wp), parameter :: widths_to_pass = 100, widths_before = 5, beyond_rim = 1.3_wp
  !> Width of the cohesive zone, lateral units, above which adhesion is weak.
  real(wp), parameter :: wide = 10

contains

  !> The radius up to which the edge of a contact on a flat face stays on meshes about the axis.
  !> There the rim is a panel's end, so that the pressure is smooth on all panels. If the edge
  !> passes over few panels, the result is the radius of the widest contact. Otherwise it is a
  !> radius somewhat beyond the rim or, on a face that would need very many panels, well inside the
  !> rim. Under weak adhesion the cohesive zone is wide, and the number of panels follows from the
  !> narrower layer at the edge of a pressed contact. Inside a contact on layers, meshes about the
  !> axis lack short waves (`mesh_waves`). 0: the shape has no flat face.
  pure real(wp) function rim_passed_at(problem, widest) result(radius)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: widest

    radius = 0
    associate (rim => problem%shape%smooth_from(), width => cohesive_width(problem))
      if (.not. has_flat_face(problem%shape)) return
      radius = min(beyond_rim*rim, rim + 1)
      if (rim > widths_to_pass*width) radius = widths_before*width
      if (.not. problem%body%is_homogeneous()) return
      if (widest < widths_to_pass*width .and. (width < wide .or. &
        widest - rim < widths_to_pass*smallest_feature(problem, widest))) radius = widest
    end associate
  end function rim_passed_at

  !> The kinks of a shape at which panels of meshes about the axis end: all, if they are few.
  pure function kinks_at_ends(shape) result(kinks)
    class(shape_t), intent(in) :: shape
    real(wp), allocatable :: kinks(:)

    allocate (kinks(0))
    if (.not. allocated(shape%breaks)) return
    if (size(shape%breaks) <= few) kinks = shape%breaks
  end function kinks_at_ends

  !> Whether a shape is flat up to its outermost kink.
  pure logical function has_flat_face(shape)
    class(shape_t), intent(in) :: shape

    associate (rim => shape%smooth_from())
      has_flat_face = rim > 0 .and. .not. shape%height(rim) > 0
    end associate
  end function has_flat_face

  !> Lengths in z of panels over z_length, at offsets focus + side*d sinh(z) with the focus and d of
  !> `mapped`, for a shape with kinks. On a mesh about the axis they end at the kinks, if these are
  !> few; otherwise they are short.
  pure function panels_for(shape, mapped, about_axis, side, z_length) result(lengths)
    class(shape_t), intent(in) :: shape
    type(mapped_shape_t), intent(in) :: mapped
    logical, intent(in) :: about_axis
    integer, intent(in) :: side
    real(wp), intent(in) :: z_length
    real(wp), allocatable :: lengths(:), kinks(:), ends(:), rims(:)
    integer :: i

    allocate (kinks(0), lengths(0))
    if (about_axis) kinks = kinks_at_ends(shape)
    rims = side*(pack(kinks, .not. shape%height(kinks) > 0) - mapped%focus)
    ends = asinh(side*(kinks - mapped%focus)/mapped%d)
    if (side < 0) ends = ends(size(ends):1:-1)
    ends = [0.0_wp, pack(ends, ends > 0 .and. ends < z_length), z_length]
    do i = 1, size(ends) - 1
      lengths = [lengths, graded_panels(rims, mapped%d, ends(i), ends(i + 1), &
        merge(between_kinks, short, size(kinks) > 0))]
    end do
  end function panels_for

  !> Lengths in z of panels between two places, at most `longest`. They are also short compared with
  !> the distance from the rim of a flat face. Near the rim they are short compared with the length
  !> over which the undeformed bodies separate there. Gaps computed before the edge reaches the rim
  !> do not show how the pressure changes there.
  pure function graded_panels(rims, d, from, to, longest) result(lengths)
    real(wp), intent(in) :: rims(:), d, from, to, longest
    real(wp), allocatable :: lengths(:)
    !> Number of places at which the length is evaluated.
    integer, parameter :: places = 200
    real(wp) :: step, z, away, panels(0:places)
    integer :: i, n

    step = (to - from)/places
    panels(0) = 0
    do i = 1, places
      z = from + (i - 0.5_wp)*step
      away = max(1.0_wp, minval(abs(rims - d*sinh(z))))
      panels(i) = panels(i - 1) + step*d*cosh(z)/(longest*min(d*cosh(z), away))
    end do
    n = ceiling(panels(places))
    lengths = [(place_of(i*panels(places)/n) - place_of((i - 1)*panels(places)/n), i=1, n)]

  contains

    !> The length from the first place that contains a given number of panels.
    pure real(wp) function place_of(number)
      real(wp), intent(in) :: number
      integer :: k

      k = count(panels(1:places - 1) < number)
      place_of = step*(k + (number - panels(k))/(panels(k + 1) - panels(k)))
    end function place_of

  end function graded_panels

end module shape_panels
