!> Bodies of bonded layers. For the wave number k the compliance of their surfaces is L(k) times
!> that of half-spaces of the top layers (`layered_surface`). L - 1 falls as exp(-2 k t), where t is
!> the thickness of the top layer. It is tabulated as power series on panels of k.
module layered_body
  use kinds, only: wp, nan
  use matrix_products, only: multiply_transposed
  use chebyshev, only: chebyshev_points, chebyshev_series, series_slope, series_integral, &
    power_series, power_value
  use quadrature, only: wave_rule
  use elastic_body, only: elastic_body_t
  use layered_surface, only: layered_surface_t
  implicit none
  private
  public :: layered_body_t, new_layered_body

  !> Largest k times twice the top layer's thickness. There L - 1 is exp(-28) (28)^2 = 5e-10, and
  !> the component of a pressure with so large a k is even smaller. For fewer digits, the largest
  !> product is a constant plus a number for each digit. Components beyond 20 change loads by 1e-8
  !> or less, beyond 24 by 1e-10.
  real(wp), parameter :: last_wave = 28, last_at_none = 8.8_wp, last_a_digit = 1.6_wp
  !> Degree of the series of L - 1 on a panel of k; largest number of halvings of a panel.
  integer, parameter :: degree = 16, halvings = 60
  !> Largest change of the phase k r over a panel of k; numbers of nodes of a panel (`wave_rule`).
  real(wp), parameter :: swing = 16
  real(wp), parameter :: nodes(2) = 20
  !> An upper limit of the number of panels, larger than layers within the limits of `scene_layers`
  !> need.
  integer, parameter :: most_panels = 1000
  !> Largest size of the last coefficients of a series that counts as resolved.
  real(wp), parameter :: resolved = 1.0e-13_wp

  !> L - 1 of both bodies together, in lateral units.
  type, extends(elastic_body_t) :: layered_body_t
    private
    !> Ends of the panels of k; series on the panels for L - 1, for dL/dk, and for the integral of L
    !> - 1 from 0.
    real(wp), allocatable :: ends(:), series(:, :), slope(:, :), whole(:, :)
    !> Whether L is 1 for all k because layers and base have the same material.
    logical :: plain = .false.
    !> L(0), for infinite wavelength, which depends on the base only.
    real(wp), public :: bottom = 1
    !> Thickness of the thinnest top layer.
    real(wp), public :: thinnest = 1
    !> The surfaces of the bodies; and the share of each body in the compliance of the half-spaces
    !> of the top layers.
    type(layered_surface_t), public :: surface(2)
    real(wp), public :: part(2) = 0.5_wp
  contains
    procedure :: is_homogeneous
    procedure :: beside_half_space
    procedure :: growth
    procedure :: mean_beside
    procedure :: wave_range
    procedure :: is_alike
    procedure :: take_one
    procedure :: cosine_sums
    procedure :: compliance
  end type layered_body_t

contains

  !> Bodies of these surfaces, with thicknesses in lateral units.
  type(layered_body_t) function new_layered_body(surface, part) result(body)
    type(layered_surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: part(2)
    real(wp) :: last, first, before, largest, series(0:degree), whole(0:degree + 1)
    integer :: i, halved

    body%surface = surface
    body%part = part
    allocate (body%ends(1), body%series(0:degree, 0), body%slope(0:degree, 0), &
      body%whole(0:degree + 1, 0))
    before = 0
    largest = 0
    body%ends = 0
    body%thinnest = huge(last)
    do i = 1, 2
      if (size(surface(i)%thickness) > 0) &
        body%thinnest = min(body%thinnest, surface(i)%thickness(1))
    end do
    last = last_wave/(2*body%thinnest)
    do while (body%ends(size(body%ends)) < last .and. size(body%ends) < most_panels)
      first = body%ends(size(body%ends))
      do halved = 0, halvings
        series = series_on(first, first + (last - first)/2**halved)
        if (maxval(abs(series(degree - 1:))) <= resolved*max(1.0_wp, maxval(abs(series)))) exit
      end do
      body%ends = [body%ends, merge(last, first + (last - first)/2**halved, halved == 0)]
      largest = max(largest, maxval(abs(series)))
      body%series = reshape([body%series, power_series(series)], [degree + 1, size(body%ends) - 1])
      body%slope = reshape([body%slope, power_series(series_slope(series)*2/ &
        (body%ends(size(body%ends)) - first))], [degree + 1, size(body%ends) - 1])
      whole = series_integral(series)*(body%ends(size(body%ends)) - first)/2
      whole(0) = whole(0) + before
      before = sum(whole)
      body%whole = reshape([body%whole, power_series(whole)], [degree + 2, size(body%ends) - 1])
    end do
    body%plain = largest <= resolved
    ! The series is NaN if the panels do not reach the largest k, so that no state converges.
    if (body%ends(size(body%ends)) < last) body%series = nan
    body%bottom = body%compliance(tiny(last))
    ! On a rigid base L(0) is zero except for rounding errors.
    if (body%bottom < resolved) body%bottom = 0

  contains

    !> The series of L - 1 on a panel.
    function series_on(from, to) result(coefficient)
      real(wp), intent(in) :: from, to
      real(wp) :: coefficient(0:degree), k(0:degree)
      integer :: j

      k = from + (to - from)*(1 + chebyshev_points(degree))/2
      coefficient = chebyshev_series([(body%compliance(max(k(j), tiny(last))) - 1, j=0, degree)])
    end function series_on

  end function new_layered_body

  !> L at a wave number.
  pure real(wp) function compliance(self, k)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: k
    integer :: i

    compliance = 0
    do i = 1, 2
      if (self%part(i) > 0) compliance = compliance + self%part(i)*self%surface(i)%compliance(k)
    end do
  end function compliance

  pure logical function is_homogeneous(self)
    class(layered_body_t), intent(in) :: self

    is_homogeneous = self%plain
  end function is_homogeneous

  !> Whether both bodies have the same number of layers on the same base.
  pure logical function is_alike(self)
    class(layered_body_t), intent(in) :: self

    associate (a => self%surface(1), b => self%surface(2))
      is_alike = size(a%thickness) == size(b%thickness) .and. (a%on_rigid .eqv. b%on_rigid)
      if (.not. is_alike) return
      is_alike = a%on_rigid .or. .not. (abs(a%base_shear - b%base_shear) > 0 .or. &
        abs(a%base_poisson - b%base_poisson) > 0)
    end associate
  end function is_alike

  subroutine take_one(self, which, one)
    class(layered_body_t), intent(in) :: self
    integer, intent(in) :: which
    class(elastic_body_t), allocatable, intent(out) :: one

    if (size(self%surface(which)%thickness) == 0) then
      allocate (elastic_body_t :: one)
    else
      allocate (one, source=new_layered_body(spread(self%surface(which), 1, 2), [1.0_wp, 0.0_wp]))
    end if
  end subroutine take_one

  pure function beside_half_space(self, k) result(value)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: k(:)
    real(wp) :: value(size(k))

    value = on_panels(self%ends, self%series, k)
  end function beside_half_space

  pure function growth(self, k) result(value)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: k(:)
    real(wp) :: value(size(k))

    value = k*on_panels(self%ends, self%slope, k)
  end function growth

  elemental real(wp) function mean_beside(self, k)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: k
    real(wp) :: whole(1)

    whole = on_panels(self%ends, self%whole, [min(k, self%ends(size(self%ends)))])
    mean_beside = whole(1)/k
  end function mean_beside

  !> The values of the series at wave numbers, each from the panel that contains it; 0 beyond the
  !> panels.
  pure function on_panels(ends, series, k) result(value)
    real(wp), intent(in) :: ends(:), series(:, :), k(:)
    real(wp) :: value(size(k))
    integer :: panel, i

    panel = 1
    do i = 1, size(k)
      value(i) = 0
      if (k(i) > ends(size(ends))) cycle
      ! Wave numbers usually are in ascending order.
      if (k(i) < ends(panel)) panel = 1
      do while (k(i) > ends(panel + 1))
        panel = panel + 1
      end do
      value(i) = power_value(series(:, panel), &
        2*(k(i) - ends(panel))/(ends(panel + 1) - ends(panel)) - 1)
    end do
  end function on_panels

  pure function wave_range(self, digits) result(k)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: digits
    real(wp) :: k(2)

    k = 0
    if (.not. self%plain) k = [self%ends(2), &
      min(last_wave, last_at_none + last_a_digit*digits)/(2*self%thinnest)]
  end function wave_range

  !> sums(i, j) = 2 Int (L - 1) cos(k x(i)) cos(k y(j)) dk.
  subroutine cosine_sums(self, x, y, sums)
    class(layered_body_t), intent(in) :: self
    real(wp), intent(in) :: x(:), y(:)
    real(wp), intent(out) :: sums(:, :)
    real(wp), allocatable :: k(:), weight(:), left(:, :), right(:, :)
    real(wp) :: range(2)
    integer :: j

    sums = 0
    if (self%plain) return
    range = self%wave_range(real(precision(x), wp))
    call wave_rule([max(maxval(x), maxval(y))], [huge(1.0_wp)], swing, nodes, 0.0_wp, range(1), &
      range(2), k, weight)
    weight = 2*weight*self%beside_half_space(k)
    allocate (left(size(k), size(x)), right(size(k), size(y)))
    do j = 1, size(x)
      left(:, j) = cos(k*x(j))
    end do
    do j = 1, size(y)
      right(:, j) = weight*cos(k*y(j))
    end do
    call multiply_transposed(left, right, sums)
  end subroutine cosine_sums

end module layered_body
