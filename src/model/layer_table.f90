!> The pressure of the nonlinear double layer as a table. Let u = -ln tanh(h/2), which is -ln(h/2)
!> at small gaps h and 2 exp(-h) at large gaps. The function q = p sinh h varies slowly over the
!> decades of u. At large gaps it is constant, except for terms like u ln u. On panels of u, q is a
!> Chebyshev series. Since du = -dh/sinh h, the energy is the exact integral of the series over u,
!> and the slope is the derivative of the series.
!>
!> The panels need few solutions of the equation, but u takes long to evaluate. Therefore the table
!> consists of polynomials of the gap. On an eighth of a factor of two, pressure, slope and energy
!> times exp(h) are as smooth as powers.
module layer_table
  use kinds, only: wp
  use chebyshev, only: chebyshev_points, chebyshev_series, series_value, series_slope, &
    series_integral, power_series
  use interpolation, only: polynomial_weights
  use force_law, only: of_pressure, of_slope, of_energy
  use poisson_boltzmann, only: surface_t, gap_state_t, far_state, solve_gap
  implicit none
  private
  public :: layer_table_t, new_layer_table, nearest_gap

  !> Binary exponents of the first and the last factor of two in the gap that the table covers.
  integer, parameter :: first_octave = -19, last_octave = 6
  !> Smallest gap of the table in Debye lengths, 1e-6. Even in pure water, whose Debye length is 1
  !> um, this is a hundredth of the size of an atom.
  real(wp), parameter :: nearest_gap = 2.0_wp**(first_octave - 1)
  !> Gap beyond which q equals its limit except for rounding errors: u ln u is smaller than 1e-16.
  real(wp), parameter :: farthest_gap = 40
  !> The largest gap within the last piece.
  real(wp), parameter :: last_gap = 2.0_wp**last_octave*(1 - epsilon(1.0_wp))
  !> Degree of the polynomial on a piece; smallest and largest number of pieces for a factor of two.
  !> On a piece whose centre is 17 half-widths from 0, powers of the gap have errors of 34**-10.
  !> Largest ratio of the last coefficient to the pressure; the next coefficient would be 30 times
  !> smaller.
  integer, parameter :: piece_degree = 9, fewest = 8, finest = 64
  real(wp), parameter :: last_part = 1.0e-12_wp
  !> Degree of a series; ratio of its last two coefficients to the pressure at which it counts as
  !> resolved, and the ratio that is tolerated because of rounding in the quadratures.
  integer, parameter :: degree = 18
  real(wp), parameter :: resolved = 1.0e-13_wp, tolerated = 1.0e-11_wp
  !> Logarithm of the ratio of u over a panel: the first and largest value, and the smallest value.
  real(wp), parameter :: longest = 8, shortest = 0.02_wp
  !> Ratio of the next panel, or of a repeated panel, relative to the one that would just be
  !> resolved.
  real(wp), parameter :: careful = 0.9_wp

  !> power(:, piece, quantity): coefficients of the powers of a coordinate that runs from -1 to 1 on
  !> a piece. parts: number of pieces for a factor of two.
  type :: layer_table_t
    private
    integer :: parts = fewest
    real(wp), allocatable :: power(:, :, :)
  contains
    procedure :: value
  end type layer_table_t

  !> Panels, ordered from the smallest u, each from `first` to `last`. Columns are series in a
  !> coordinate that runs from -1 to 1 on the panel. Energies are integrals from the gap to
  !> infinity.
  type :: panels_t
    real(wp), allocatable :: first(:), last(:)
    real(wp), allocatable :: q(:, :), slope(:, :), energy(:, :)
  end type panels_t

  !> The states that were solved last, from which the next one is extrapolated; their number; and
  !> the largest magnitude of the pressure so far.
  integer, parameter :: most = 4
  type :: trail_t
    integer :: length = 0
    real(wp) :: largest = 0
    real(wp) :: u(most) = 0
    type(gap_state_t) :: state(most)
  end type trail_t

contains

  !> Tabulates the pressure between two surfaces, the first of which has the higher potential, which
  !> is positive. solved = .false.: an equation was not solved, and there is no table.
  pure subroutine new_layer_table(surface, table, solved)
    type(surface_t), intent(in) :: surface(2)
    type(layer_table_t), intent(out) :: table
    logical, intent(out) :: solved
    type(panels_t) :: panels
    type(trail_t) :: trail, trial
    real(wp) :: first, last, span, series(0:degree), rest, better

    allocate (panels%first(0), panels%last(0))
    allocate (panels%q(0:degree, 0), panels%slope(0:degree, 0), panels%energy(0:degree + 1, 0))
    first = u_at(farthest_gap)
    span = longest
    do while (first < u_at(nearest_gap))
      last = min(first*exp(span), u_at(nearest_gap))
      trial = trail
      call solve_panel(surface, first, last, trial, series, solved)
      rest = huge(rest)
      ! Where the pressure vanishes, errors are relative to a fraction of the largest pressure.
      if (solved) rest = maxval(abs(series(degree - 1:)))/ &
        max(maxval(abs(series)), trial%largest*sinh(u_at(last)))
      better = careful*(resolved/max(rest, tiny(rest)))**(1.0_wp/degree)
      if (.not. rest <= resolved .and. span > shortest) then
        span = span*max(better, 0.5_wp)
        cycle
      end if
      solved = rest <= tolerated
      if (.not. solved) return
      trail = trial
      call append(panels, first, last, series)
      first = last
      span = min(span*max(0.5_wp, min(better, 2.0_wp)), longest)
    end do
    do
      call tabulate(panels, table)
      associate (power => abs(table%power(:, :, of_pressure)))
        if (all(power(piece_degree + 1, :) <= last_part*2**(piece_degree - 1)*maxval(power, 1)) &
          .or. table%parts == finest) exit
      end associate
      table%parts = 2*table%parts
    end do
  end subroutine new_layer_table

  !> Solves the equation at the points of one panel, from large gaps to small ones, and makes the
  !> series of q.
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
      ! The first point of a panel coincides with the last point of the panel before.
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

  !> The first estimate of the state at u, extrapolated from the states solved before.
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

  !> Appends a panel. At gaps larger than those of the first panel q is constant.
  pure subroutine append(panels, first, last, series)
    type(panels_t), intent(inout) :: panels
    real(wp), intent(in) :: first, last, series(0:degree)
    real(wp) :: integral(0:degree + 1)
    integer :: n

    n = size(panels%first)
    integral = series_integral(series)*(last - first)/2
    if (n == 0) integral(0) = integral(0) + first*series_value(series, -1.0_wp)
    if (n > 0) integral(0) = integral(0) + series_value(panels%energy(:, n), 1.0_wp)
    panels%first = [panels%first, first]
    panels%last = [panels%last, last]
    panels%q = reshape([panels%q, series], [degree + 1, n + 1])
    panels%slope = reshape([panels%slope, series_slope(series)*2/(last - first)], &
      [degree + 1, n + 1])
    panels%energy = reshape([panels%energy, integral], [degree + 2, n + 1])
  end subroutine append

  !> Pressure, slope and energy at a gap, from the panels.
  pure function solved_at(panels, gap) result(value)
    type(panels_t), intent(in) :: panels
    real(wp), intent(in) :: gap
    real(wp) :: value(3)
    real(wp) :: u, x, q
    integer :: i

    u = u_at(gap)
    i = max(count(panels%first <= u), 1)
    ! At larger gaps q has its limit, the value at the first point.
    x = max(-1.0_wp, 2*(u - panels%first(i))/(panels%last(i) - panels%first(i)) - 1)
    q = series_value(panels%q(:, i), x)
    value(of_pressure) = q/sinh(gap)
    value(of_slope) = -q*cosh(gap)
    if (u >= panels%first(i)) value(of_slope) = value(of_slope) - &
      series_value(panels%slope(:, i), x)
    value(of_slope) = value(of_slope)/sinh(gap)**2
    value(of_energy) = q*u
    if (u >= panels%first(i)) value(of_energy) = series_value(panels%energy(:, i), x)
  end function solved_at

  !> Makes the polynomials of the table from the panels.
  pure subroutine tabulate(panels, table)
    type(panels_t), intent(in) :: panels
    type(layer_table_t), intent(inout) :: table
    real(wp), dimension(0:piece_degree, 0:piece_degree) :: one, series, powers
    real(wp) :: point(0:piece_degree), sample(0:piece_degree, 3), gap
    integer :: octave, part, piece, k

    one = 0
    do k = 0, piece_degree
      one(k, k) = 1
      series(:, k) = chebyshev_series(one(:, k))
      powers(:, k) = power_series(one(:, k))
    end do
    point = chebyshev_points(piece_degree)
    if (allocated(table%power)) deallocate (table%power)
    allocate (table%power(0:piece_degree, table%parts*(last_octave - first_octave + 1), 3))
    piece = 0
    do octave = first_octave, last_octave
      do part = 0, table%parts - 1
        piece = piece + 1
        do k = 0, piece_degree
          gap = 2.0_wp**(octave - 1)*(1 + (part + (1 + point(k))/2)/table%parts)
          sample(k, :) = exp(gap)*solved_at(panels, gap)
        end do
        ! The matrices are multiplied one after the other. Since the coefficients of a series
        ! decrease, those of the powers then have small rounding errors.
        table%power(:, piece, :) = matmul(powers, matmul(series, sample))
      end do
    end do
  end subroutine tabulate

  !> Pressure, slope or energy (`quantity`) at gaps in Debye lengths, from `nearest_gap` on.
  pure function value(self, quantity, gap)
    class(layer_table_t), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: gap(:)
    real(wp) :: value(size(gap))
    real(wp) :: near, x
    integer :: i, k, piece

    do i = 1, size(gap)
      ! Beyond the last piece the value at its end is used. A NaN is also assigned a piece; the
      ! exponential then makes the result NaN.
      near = last_gap
      if (gap(i) < last_gap) near = gap(i)
      x = self%parts*(2*fraction(near) - 1)
      piece = self%parts*(exponent(near) - first_octave) + int(x) + 1
      x = 2*(x - int(x)) - 1
      value(i) = self%power(piece_degree, piece, quantity)
      do k = piece_degree - 1, 0, -1
        value(i) = value(i)*x + self%power(k, piece, quantity)
      end do
    end do
    value = value*exp(-gap)
  end function value

  !> u = -ln tanh(gap/2), without loss of digits at small and large gaps. The function is its own
  !> inverse.
  pure real(wp) function u_at(gap) result(u)
    real(wp), intent(in) :: gap

    if (gap < 1) then
      u = -log(tanh(gap/2))
    else
      u = 2*atanh(exp(-gap))
    end if
  end function u_at

end module layer_table
