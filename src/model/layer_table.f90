!> The pressure of the nonlinear double layer as a table, made once. With u = -ln tanh(h/2), which
!> is -ln(h/2) at small gaps h and 2 exp(-h) at large ones, q = p sinh h varies slowly over the
!> decades of u and is constant far away, but for terms like u ln u. On panels of u it is a
!> Chebyshev series. Since du = -dh/sinh h, the energy is the integral of q over u: that of the
!> series, exactly, as the slope is its derivative.
module layer_table
  use kinds, only: wp
  use chebyshev, only: chebyshev_points, chebyshev_series, series_slope, series_integral, &
    power_series, power_value
  use interpolation, only: polynomial_weights
  use poisson_boltzmann, only: surface_t, gap_state_t, far_amplitude, far_state, solve_gap
  implicit none
  private
  public :: layer_table_t, new_layer_table, nearest_gap, of_pressure, of_slope, of_energy

  !> What is read.
  integer, parameter :: of_pressure = 1, of_slope = 2, of_energy = 3

  !> Smallest gap of the table, in Debye lengths. Even the 1 um of pure water makes that smaller
  !> than an atom by a factor of a hundred.
  real(wp), parameter :: nearest_gap = 1.0e-6_wp
  !> Gap beyond which q is its limit to rounding: u ln u is 1e-16 there.
  real(wp), parameter :: farthest_gap = 40
  !> Degree of a series, and the most that its last two coefficients may be of the pressure; so much
  !> is left to the rounding of the quadratures.
  integer, parameter :: degree = 18
  real(wp), parameter :: resolved = 1.0e-13_wp, tolerated = 1.0e-11_wp
  !> The ratio of u over a panel, in logarithms: at first and at most, and at least.
  real(wp), parameter :: longest = 8, shortest = 0.02_wp

  !> Panels from the smallest u on, which begin at `first` and end at `last`; columns are series of
  !> powers in the panel's [-1, 1]. Energies are those from the panel's first u to infinity.
  type :: layer_table_t
    private
    real(wp), allocatable :: first(:), last(:)
    real(wp), allocatable :: q(:, :), slope(:, :), energy(:, :)
  contains
    procedure :: value
  end type layer_table_t

  !> The last gaps that were solved, from which the next is extrapolated; their number, and the
  !> largest pressure met, without its sign.
  integer, parameter :: most = 4
  type :: trail_t
    integer :: length = 0
    real(wp) :: largest = 0
    real(wp) :: u(most) = 0
    type(gap_state_t) :: state(most)
  end type trail_t

contains

  !> Tabulates the pressure between two surfaces, the first of which has the higher potential; it is
  !> positive. `solved` is false where an equation was not solved: then there is no table.
  pure subroutine new_layer_table(surface, table, solved)
    type(surface_t), intent(in) :: surface(2)
    type(layer_table_t), intent(out) :: table
    logical, intent(out) :: solved
    type(trail_t) :: trail, trial
    real(wp) :: first, last, span, series(0:degree), rest

    allocate (table%first(0), table%last(0))
    allocate (table%q(0:degree, 0), table%slope(0:degree, 0), table%energy(0:degree + 1, 0))
    first = u_at(farthest_gap)
    span = longest
    do while (first < u_at(nearest_gap))
      last = min(first*exp(span), u_at(nearest_gap))
      trial = trail
      call solve_panel(surface, first, last, trial, series, solved)
      rest = huge(rest)
      ! Where the pressure vanishes, so much of the largest counts.
      if (solved) rest = maxval(abs(series(degree - 1:)))/ &
        max(maxval(abs(series)), trial%largest*sinh(u_at(last)))
      if (.not. rest <= resolved .and. span > shortest) then
        span = span/2
        cycle
      end if
      solved = rest <= tolerated
      if (.not. solved) return
      trail = trial
      call append(table, first, last, series, far_amplitude(surface)/2)
      first = last
      span = min(1.5_wp*span, longest)
    end do
  end subroutine new_layer_table

  !> Solves at the points of one panel, from large gaps to small ones, and makes the series of q.
  pure subroutine solve_panel(surface, first, last, trail, series, solved)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: first, last
    type(trail_t), intent(inout) :: trail
    real(wp), intent(out) :: series(0:degree)
    logical, intent(out) :: solved
    type(gap_state_t) :: state
    real(wp) :: u(0:degree), q(0:degree)
    integer :: i

    u = first + (last - first)*(1 + chebyshev_points(degree))/2
    solved = .true.
    do i = 0, degree
      ! The point that a panel shares with the one before.
      if (i > 0 .or. trail%length == 0) then
        state = next_state(surface, u(i), trail)
        call solve_gap(surface, u_at(u(i)), state, solved)
        if (.not. solved) return
        trail = trail_t(min(trail%length + 1, most), max(trail%largest, abs(state%pressure)), &
          [u(i), trail%u(:most - 1)], [state, trail%state(:most - 1)])
      end if
      q(i) = trail%state(1)%pressure*sinh(u_at(u(i)))
    end do
    series = chebyshev_series(q)
  end subroutine solve_panel

  !> Where to begin at u: extrapolated from what was solved.
  pure type(gap_state_t) function next_state(surface, u, trail) result(state)
    type(surface_t), intent(in) :: surface(2)
    real(wp), intent(in) :: u
    type(trail_t), intent(in) :: trail

    select case (trail%length)
    case (0)
      state = far_state(surface, u_at(u))
    case (1)
      state%t = trail%state(1)%t*u/trail%u(1)
    case default
      associate (weight => polynomial_weights(trail%u(:trail%length), u))
        state%t = [sum(weight*trail%state(:trail%length)%t(1)), &
          sum(weight*trail%state(:trail%length)%t(2))]
      end associate
    end select
  end function next_state

  !> Adds a panel after those there are; before the first q is `limit`.
  pure subroutine append(table, first, last, series, limit)
    type(layer_table_t), intent(inout) :: table
    real(wp), intent(in) :: first, last, series(0:degree), limit
    real(wp) :: integral(0:degree + 1)
    integer :: n

    n = size(table%first)
    integral = series_integral(series)*(last - first)/2
    if (n == 0) integral(0) = integral(0) + limit*first
    if (n > 0) integral(0) = integral(0) + sum(table%energy(:, n))
    table%first = [table%first, first]
    table%last = [table%last, last]
    table%q = reshape([table%q, power_series(series)], [degree + 1, n + 1])
    table%slope = reshape([table%slope, power_series(series_slope(series)*2/(last - first))], &
      [degree + 1, n + 1])
    table%energy = reshape([table%energy, power_series(integral)], [degree + 2, n + 1])
  end subroutine append

  !> Pressure, slope or energy (`quantity`) at a gap in Debye lengths, from `nearest_gap` on.
  pure real(wp) function value(self, quantity, gap)
    class(layer_table_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap
    real(wp) :: u, x, e, inverse, cotangent
    integer :: i

    ! u, 1/sinh and coth of the gap, from one function and a logarithm.
    if (gap < 1) then
      e = tanh(gap/2)
      u = -log(e)
      inverse = 0.5_wp*(1 - e)*(1 + e)/e
      cotangent = 0.5_wp*(1 + e**2)/e
    else
      e = exp(-gap)
      u = 2*atanh(e)
      inverse = 2*e/((1 - e)*(1 + e))
      cotangent = (1 + e**2)/((1 - e)*(1 + e))
    end if
    i = max(count(self%first <= u), 1)
    ! Beyond the table q is its limit, that of the first point.
    x = max(-1.0_wp, 2*(u - self%first(i))/(self%last(i) - self%first(i)) - 1)
    value = power_value(self%q(:, i), x)
    select case (quantity)
    case (of_pressure)
      value = value*inverse
    case (of_slope)
      value = -value*cotangent*inverse
      if (u >= self%first(i)) value = value - power_value(self%slope(:, i), x)*inverse**2
    case default
      value = power_value(self%energy(:, i), x) - value*max(0.0_wp, self%first(i) - u)
    end select
  end function value

  !> u = -ln tanh(gap/2), to all digits near and far. The function is its own inverse.
  pure real(wp) function u_at(gap) result(u)
    real(wp), intent(in) :: gap

    if (gap < 1) then
      u = -log(tanh(gap/2))
    else
      u = 2*atanh(exp(-gap))
    end if
  end function u_at

end module layer_table
