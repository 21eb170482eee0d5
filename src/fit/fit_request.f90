!> The input of a fit: the measured curve and the unknowns.
!>
!> The search uses free numbers, which have no bounds. A positive unknown is represented by its
!> logarithm. Two bounds are enforced by the map of a sine, a single bound by that of a hyperbola.
module fit_request
  use kinds, only: wp
  use baseline, only: baseline_t
  implicit none
  private
  public :: measurement_t, fit_t, unknown_t, of_model, of_contact_point, of_sensitivity, &
    of_spring, free_of, value_of, fitted_of, value_by_free, value_by_fitted, farthest_off, &
    is_at_end, is_beyond, inside, settled_within, change, fine_change
  public :: of_position, of_separation, of_load, of_segment, of_radius

  !> The quantity of a column of the file. of_position: the position of the base of the spring.
  !> of_separation: the separation of the bodies (h0 plus a constant). of_load: the load, or the
  !> signal that measures the load. of_segment: the label of the segment. of_radius: the contact
  !> radius.
  integer, parameter :: of_position = 1, of_separation = 2, of_load = 3, of_segment = 4, &
    of_radius = 5

  !> The group &measurement in SI units. sensitivity: the sensitivity of a detector, for a signal in
  !> volts; if it is not allocated, the signal is the force, or the force over the radius.
  !> spring_constant: 0 without a spring.
  type :: measurement_t
    character(len=:), allocatable :: file, segment
    character(len=64), allocatable :: columns(:)
    !> The quantity of each column. Two columns of loads belong to approach and retract, side by
    !> side.
    integer, allocatable :: quantity(:)
    !> The column that numbers the curves of a file with several curves, and the number of the
    !> curve.
    character(len=:), allocatable :: curves
    integer, allocatable :: curve
    !> Labels of approach and retract in the column of segments, in lower case. If they are not
    !> allocated, known labels are used, or the motion of the position.
    character(len=64), allocatable :: approach(:), retreat(:)
    !> Number of lines at the beginning of the file to be ignored.
    integer :: skip_lines = 0
    real(wp) :: spring_constant = 0
    real(wp), allocatable :: sensitivity, contact_point
    !> Pairs of positions; samples between the positions of a pair are ignored.
    real(wp), allocatable :: skip(:)
    !> Units of the columns in the file; 0: the units in the names of the columns, or SI. signal_in:
    !> the unit of the signal, 'N', 'V', 'm', or 'R' for the force over the radius; blank if neither
    !> deck nor file gives the unit.
    real(wp), allocatable :: unit(:)
    character :: signal_in = ' '
    !> The radius given in the deck; 0 if it gives none.
    real(wp) :: radius = 0
    type(baseline_t) :: baseline
  contains
    procedure :: has
    procedure :: under_loads
    procedure :: load_of_unit
    procedure :: signal_unit
  end type measurement_t

  !> The role of an unknown: a number of the problem, contact point, detector, spring.
  integer, parameter :: of_model = 0, of_contact_point = 1, of_sensitivity = 2, of_spring = 3

  !> Largest logarithm of the ratio of a trial to the deck's value, or to a value that the data
  !> suggest. A limit is needed because the path of a very different problem may take too long.
  real(wp), parameter :: farthest_off = 5

  !> A number this near to a limit counts as being at the limit: a fitted number at that of the
  !> search, a start at a bound.
  real(wp), parameter :: at_limit = 1.0e-3_wp
  !> The relative distance by which values stay inside a limit that is excluded.
  real(wp), parameter :: inside = 1.0e-6_wp

  !> An iteration has settled when numbers change by less than this part of themselves.
  real(wp), parameter :: settled_within = 0.01_wp

  !> Changes of a fitted number, or of a positive one relative to itself, for finite differences:
  !> between solutions of the equations, and between values of closed forms.
  real(wp), parameter :: change = 1.0e-3_wp, fine_change = 1.0e-4_wp

  !> An unknown, in the unit of its key. in_log: the unknown is positive and its logarithm is
  !> fitted; otherwise the fitted number is (value - origin)/scale. prior: prior standard deviation
  !> about the deck's value; 0 without a prior. farthest: the largest logarithms of the ratio of a
  !> trial to the deck's value, downward and upward. shared: the unknown has one value for all
  !> curves that are fitted together.
  type :: unknown_t
    character(len=:), allocatable :: name, unit
    integer :: role = of_model
    logical :: in_log = .false., shared = .false.
    real(wp) :: value = 0, origin = 0, scale = 1, prior = 0
    real(wp) :: farthest(2) = farthest_off
    real(wp), allocatable :: lower, upper
  end type unknown_t

  !> The group &fit. noise: standard deviation of the signal; if it is not allocated, the baseline
  !> shows it. noise_radius: standard deviation of contact radii; if it is not allocated, the
  !> residuals of the radii show it. poisson: Poisson's ratios of the bodies, if the deck gives
  !> them.
  type :: fit_t
    type(unknown_t), allocatable :: unknown(:)
    real(wp), allocatable :: noise, noise_radius, poisson(:)
  contains
    procedure :: is_joint
  end type fit_t

contains

  !> Whether several curves are fitted together.
  pure logical function is_joint(self)
    class(fit_t), intent(in) :: self

    is_joint = any(self%unknown%shared)
  end function is_joint

  !> Whether one of the columns has this quantity.
  pure logical function has(self, quantity)
    class(measurement_t), intent(in) :: self
    integer, intent(in) :: quantity

    has = any(self%quantity == quantity)
  end function has

  !> Whether the load is the independent variable, since there is no position.
  pure logical function under_loads(self)
    class(measurement_t), intent(in) :: self

    under_loads = .not. (self%has(of_position) .or. self%has(of_separation))
  end function under_loads

  !> The load that one unit of the signal means, if the signal is the force [N] or the force over
  !> the radius [N/m].
  pure real(wp) function load_of_unit(self) result(load)
    class(measurement_t), intent(in) :: self

    load = merge(self%radius, 1.0_wp, self%signal_in == 'R')
  end function load_of_unit

  !> The name of the signal's unit; blank if it is not known.
  pure function signal_unit(self) result(unit)
    class(measurement_t), intent(in) :: self
    character(len=:), allocatable :: unit

    unit = trim(self%signal_in)
    if (unit == 'R') unit = 'N/m'
  end function signal_unit

  !> The fitted number of a value: ln(value/scale), or (value - origin)/scale.
  elemental real(wp) function fitted_of(unknown, value) result(u)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    u = (value - unknown%origin)/unknown%scale
    if (unknown%in_log) u = log(value/unknown%scale)
  end function fitted_of

  !> Whether a value is at the limit of the search, as far from the deck's value as allowed.
  elemental logical function is_at_end(unknown, value)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    is_at_end = is_beyond(unknown, value, -at_limit)
  end function is_at_end

  !> Whether the logarithm of a value is beyond the limits of the search by more than `excess`.
  elemental logical function is_beyond(unknown, value, excess)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value, excess
    real(wp) :: u

    is_beyond = .false.
    if (.not. unknown%in_log) return
    u = fitted_of(unknown, value)
    is_beyond = u < -unknown%farthest(1) - excess .or. u > unknown%farthest(2) + excess
  end function is_beyond

  !> The free number of a value. A value at or beyond its bound is moved slightly inside.
  elemental real(wp) function free_of(unknown, value) result(x)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value
    real(wp) :: u, low, high

    u = fitted_of(unknown, value)
    x = u
    if (allocated(unknown%lower)) low = fitted_of(unknown, unknown%lower)
    if (allocated(unknown%upper)) high = fitted_of(unknown, unknown%upper)
    if (allocated(unknown%lower) .and. allocated(unknown%upper)) then
      x = asin(max(-1 + at_limit, min(1 - at_limit, 2*(u - low)/(high - low) - 1)))
    else if (allocated(unknown%lower)) then
      x = sqrt((max(u - low, at_limit) + 1)**2 - 1)
    else if (allocated(unknown%upper)) then
      x = sqrt((max(high - u, at_limit) + 1)**2 - 1)
    end if
  end function free_of

  !> The value of a free number.
  elemental real(wp) function value_of(unknown, x) result(value)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: x
    real(wp) :: u, slope

    call bound(unknown, x, u, slope)
    value = unknown%origin + unknown%scale*u
    if (unknown%in_log) value = unknown%scale*exp(u)
  end function value_of

  !> Derivative of the value with respect to its free number.
  elemental real(wp) function value_by_free(unknown, x) result(by)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: x
    real(wp) :: u, slope

    call bound(unknown, x, u, slope)
    by = slope*value_by_fitted(unknown, value_of(unknown, x))
  end function value_by_free

  !> The fitted number u of a free number x, within the bounds, and the derivative du/dx.
  pure subroutine bound(unknown, x, u, slope)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: x
    real(wp), intent(out) :: u, slope
    real(wp) :: low, high, root

    u = x
    slope = 1
    root = sqrt(x**2 + 1)
    if (allocated(unknown%lower)) low = fitted_of(unknown, unknown%lower)
    if (allocated(unknown%upper)) high = fitted_of(unknown, unknown%upper)
    if (allocated(unknown%lower) .and. allocated(unknown%upper)) then
      u = low + 0.5_wp*(high - low)*(1 + sin(x))
      slope = 0.5_wp*(high - low)*cos(x)
    else if (allocated(unknown%lower)) then
      u = low - 1 + root
      slope = x/root
    else if (allocated(unknown%upper)) then
      u = high + 1 - root
      slope = -x/root
    end if
  end subroutine bound

  !> Derivative of a value with respect to its fitted number.
  elemental real(wp) function value_by_fitted(unknown, value) result(slope)
    type(unknown_t), intent(in) :: unknown
    real(wp), intent(in) :: value

    slope = unknown%scale
    if (unknown%in_log) slope = value
  end function value_by_fitted

end module fit_request
