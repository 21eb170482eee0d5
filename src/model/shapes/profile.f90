!> A shape from a file of positions and heights. It is a cubic spline of continuous curvature that
!> is flat on the axis, and continues beyond the last point as a parabola. If the spline through a
!> convex body is not convex, as beside a straight flank, it is replaced by convex pieces of
!> continuous slope.
module profile
  use kinds, only: wp, pi
  use failure, only: failure_t
  use deck, only: deck_t
  use deck_keys, only: key_spec, text_value
  use data_table, only: data_table_t, read_columns
  use interpolation, only: spline, interval_of
  use quadrature, only: gauss_legendre
  use group_reading, only: require, check_decades, refuse_radius
  use shape, only: shape_t
  implicit none
  private
  public :: keys, read_shape

  type, extends(shape_t) :: profile_t
    !> at: the beginnings of the pieces, and the end of the last one. taylor: for each piece the
    !> height and its first three derivatives at its beginning, divided by 0!, 1!, 2! and 3!; the
    !> last column has those at the end.
    real(wp), allocatable :: at(:), taylor(:, :)
  contains
    procedure :: height
    procedure :: slope
    procedure :: rough_indentation
  end type profile_t

  !> Smallest number of points of a profile; number of points of a rough quadrature.
  integer, parameter :: fewest = 5, points = 12
  !> Largest curvature of the wrong sign, relative to the largest curvature, that is tolerated. It
  !> may be due to the rounding of a table, or to a spline through a body that is flat at its tip.
  real(wp), parameter :: straight = 0.02_wp
  !> Relative difference of the slopes between points below which a flank counts as straight.
  real(wp), parameter :: same_slope = 1.0e-9_wp
  !> Smallest difference between a slope and those of the adjacent chords, relative to the
  !> difference of these.
  real(wp), parameter :: least_bend = 0.1_wp

  !> The row of a profile in &shape.
  type(key_spec), parameter :: keys(*) = [ &
    key_spec('shape', 'file', text_value, 'File of two columns, r from 0 on and height f in ' // &
      'm, # before comments; a relative path begins at the deck''s folder.', most=1000, &
      otherwise='none')]

contains

  !> Reads kind = 'profile'. length: the law's [m].
  subroutine read_shape(deck, length, shape)
    type(deck_t), intent(inout) :: deck
    real(wp), intent(in) :: length
    class(shape_t), allocatable, intent(out) :: shape
    type(failure_t), allocatable :: trouble
    type(profile_t) :: this
    type(data_table_t) :: table

    call require(deck, 'shape', 'kind', 'profile', 'file')
    call refuse_radius(deck, 'the profile has its own')
    if (allocated(deck%error)) return
    call read_columns(deck, 'shape', 'file', fewest, table, trouble)
    if (.not. allocated(trouble)) call check_points(table, trouble)
    if (.not. allocated(trouble)) call take_points(table, length, this, trouble)
    if (allocated(trouble)) then
      call deck%mistake('shape', 'file', 'the profile cannot be used: ' // trouble%message)
      return
    end if
    call check_decades(deck, 'shape', 'file', log10(this%radius), 'a radius', ' m')
    if (.not. allocated(deck%error)) allocate (shape, source=this)
  end subroutine read_shape

  !> Fails if positions do not begin at 0 and increase, or if heights do not increase with them.
  subroutine check_points(table, error)
    type(data_table_t), intent(inout) :: table
    type(failure_t), allocatable, intent(inout) :: error
    integer :: i

    associate (r => table%value(:, 1), f => table%value(:, 2), n => size(table%place))
      if (abs(r(1)) > 0) then
        call table%source%complain(table%place(1), 'the first position is not 0, the axis', error)
        return
      end if
      do i = 2, n
        if (r(i) > r(i - 1) .and. f(i) > f(i - 1)) cycle
        call table%source%complain(table%place(i), &
          'position and height do not both grow from the line before', error)
        return
      end do
    end associate
  end subroutine check_points

  !> Makes the shape through the points, in its own units; fails if it is not convex.
  subroutine take_points(table, length, this, error)
    type(data_table_t), intent(inout) :: table
    real(wp), intent(in) :: length
    type(profile_t), intent(inout) :: this
    type(failure_t), allocatable, intent(inout) :: error
    real(wp) :: mirrored(0:3, size(table%place) - 1), unit, last
    integer :: n, i

    n = size(table%place)
    last = table%value(n, 1)
    this%at = table%value(:, 1)/last
    ! The spline procedure makes splines that are flat at their right end; therefore the profile is
    ! mirrored.
    mirrored = spline(-this%at(n:1:-1), (table%value(n:1:-1, 2) - table%value(1, 2))/length)
    allocate (this%taylor(0:3, n))
    do i = 1, n - 1
      this%taylor(:, n - i) = expanded_at_end(mirrored(:, i), this%at(n + 1 - i) - this%at(n - i))
    end do
    this%taylor(:, n) = [(table%value(n, 2) - table%value(1, 2))/length, &
      -mirrored(1, 1), mirrored(2, 1), 0.0_wp]
    i = first_hollow(this)
    if (i > 0) then
      if (.not. are_convex(this%at, this%taylor(0, :))) then
        call table%source%complain(table%place(i), 'the profile is not convex ' // &
          'here; contacts with several edges are not computed', error)
        return
      end if
      call make_convex(this)
    end if
    n = size(this%at)
    this%taylor(2, n) = max(this%taylor(2, n), 0.0_wp)
    unit = this%position_of(0.5_wp)
    this%at = this%at/unit
    do i = 1, 3
      this%taylor(i, :) = this%taylor(i, :)*unit**i
    end do
    this%radius = (unit*last)*(unit*last/length)
    this%exponent = 0
    this%breaks = this%at(2:)
    this%known_to = this%at(n)
  end subroutine take_points

  !> The first piece that begins with a curvature of the wrong sign, or in which the height falls; 0
  !> if there is none.
  pure integer function first_hollow(this) result(i)
    type(profile_t), intent(in) :: this

    associate (curvature => this%taylor(2, :))
      do i = 1, size(curvature)
        if (curvature(i) < -straight*maxval(curvature) .or. i > 1 .and. &
          .not. this%taylor(1, i) > 0) return
      end do
    end associate
    i = 0
  end function first_hollow

  !> Whether the slopes between points never decrease, and increase near the axis, where the body is
  !> flat.
  pure logical function are_convex(r, f)
    real(wp), intent(in) :: r(:), f(:)
    real(wp) :: slope(size(r) - 1)
    integer :: n

    n = size(r)
    slope = (f(2:) - f(:n - 1))/(r(2:) - r(:n - 1))
    are_convex = slope(2) > (1 + same_slope)*slope(1) .and. &
      all(slope(2:) > (1 - same_slope)*slope(:n - 2))
  end function are_convex

  !> Replaces the pieces between the points of a convex profile by convex ones. A piece becomes the
  !> cubic with the given slopes at its ends if this cubic is convex, otherwise two parabolas
  !> (Schumaker, SIAM J. Numer. Anal. 20, 853 (1983)). The slopes are those of the spline, limited
  !> to values between those of the adjacent chords.
  subroutine make_convex(this)
    type(profile_t), intent(inout) :: this
    real(wp), allocatable :: at(:), taylor(:, :)
    real(wp) :: chord(size(this%at) - 1), slope(size(this%at)), below, above, width, &
      part, apart
    integer :: n, i

    n = size(this%at)
    chord = (this%taylor(0, 2:) - this%taylor(0, :n - 1))/(this%at(2:) - this%at(:n - 1))
    slope = this%taylor(1, :)
    do i = 2, n - 1
      apart = least_bend*(chord(i) - chord(i - 1))
      slope(i) = min(max(slope(i), chord(i - 1) + apart), chord(i) - apart)
    end do
    slope(n) = max(slope(n), 2*chord(n - 1) - slope(n - 1))
    ! Two adjacent chords of equal slope are a straight flank; its ends have this slope too.
    do i = 2, n - 2
      if (chord(i + 1) - chord(i) < same_slope*chord(i)) slope(i:i + 2) = chord(i)
    end do
    slope(1) = 0
    allocate (at(0), taylor(0:3, 0))
    do i = 1, n - 1
      width = this%at(i + 1) - this%at(i)
      below = chord(i) - slope(i)
      above = slope(i + 1) - chord(i)
      if (below <= same_slope*chord(i) .or. above <= same_slope*chord(i)) then
        call add(this%at(i), [this%taylor(0, i), chord(i), 0.0_wp, 0.0_wp])
      else if (below <= 2*above .and. above <= 2*below) then
        call add(this%at(i), [this%taylor(0, i), slope(i), (2*below - above)/width, &
          (above - below)/width**2])
      else
        ! Where the parabolas meet, the slope is that of the chord.
        part = width*above/(below + above)
        call add(this%at(i), [this%taylor(0, i), slope(i), 0.5_wp*below/part, 0.0_wp])
        call add(this%at(i) + part, [this%taylor(0, i) + part*(slope(i) + 0.5_wp*below), &
          chord(i), 0.5_wp*above/(width - part), 0.0_wp])
      end if
    end do
    call add(this%at(n), [this%taylor(0, n), slope(n), this%taylor(2, n), 0.0_wp])
    this%at = at
    this%taylor = taylor

  contains

    subroutine add(position, coefficients)
      real(wp), intent(in) :: position, coefficients(4)
      real(wp) :: longer(0:3, size(at) + 1)

      longer(:, :size(at)) = taylor
      longer(:, size(at) + 1) = coefficients
      at = [at, position]
      taylor = longer
    end subroutine add

  end subroutine make_convex

  !> Expands a cubic, given as a polynomial of the distance from its left end, in powers of the
  !> distance to the left of its right end. width: the distance of the ends.
  pure function expanded_at_end(cubic, width) result(taylor)
    real(wp), intent(in) :: cubic(0:3), width
    real(wp) :: taylor(0:3)

    taylor(0) = cubic(0) + width*(cubic(1) + width*(cubic(2) + width*cubic(3)))
    taylor(1) = -(cubic(1) + width*(2*cubic(2) + 3*width*cubic(3)))
    taylor(2) = cubic(2) + 3*width*cubic(3)
    taylor(3) = -cubic(3)
  end function expanded_at_end

  elemental real(wp) function height(self, r) result(value)
    class(profile_t), intent(in) :: self
    real(wp), intent(in) :: r
    integer :: i

    i = interval_of(self%at, r)
    associate (c => self%taylor(:, i), t => r - self%at(i))
      value = c(1) + t*(c(2) + t*(c(3) + t*c(4)))
    end associate
  end function height

  elemental real(wp) function slope(self, r) result(value)
    class(profile_t), intent(in) :: self
    real(wp), intent(in) :: r
    integer :: i

    i = interval_of(self%at, r)
    associate (c => self%taylor(:, i), t => r - self%at(i))
      value = c(2) + t*(2*c(3) + 3*t*c(4))
    end associate
  end function slope

  !> The indentation with the fewest points that suffice, without splitting at the ends of the
  !> pieces.
  pure function rough_indentation(self, a) result(indentation)
    class(profile_t), intent(in) :: self
    real(wp), intent(in) :: a(:)
    real(wp) :: indentation(size(a)), node(points), weight(points)
    integer :: k

    call gauss_legendre(node, weight)
    node = sin(0.5_wp*pi*node)
    indentation = [(0.5_wp*pi*a(k)*sum(weight*self%slope(a(k)*node)), k=1, size(a))]
  end function rough_indentation

end module profile
