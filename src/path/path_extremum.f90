!> Extrema of h0 or of the load along the equilibrium path, to the solver's tolerance.
module path_extremum
  use kinds, only: wp
  use equilibrium, only: state_t, equations_t
  use solver_options, only: solver_options_t
  use frozen_jacobian, only: frozen_jacobian_t
  use path_slopes, only: slopes_along_path
  use interpolation, only: interpolated_maximum
  use root_finding, only: bracket_t, secant_root
  use continuation, only: arc_t, state_at, path_control
  implicit none
  private
  public :: extremum_t, polish_extremum, of_h0, of_load

  !> The quantities that have extrema.
  integer, parameter :: of_h0 = 1, of_load = 2
  !> Secants for an extremum, and the change of the path's coordinate below which it is found; below
  !> which rounding may keep the derivative from falling.
  integer, parameter :: most_rounds = 60
  real(wp), parameter :: root_tolerance = 1.0e-10_wp, rounding_rules = 1.0e-6_wp

  !> An extremum on one of the meshes: its place on the path and its state; 1 for a maximum, -1 for
  !> a minimum; the derivative of the load by the path's coordinate there, up to a positive factor.
  type :: extremum_t
    real(wp) :: coordinate = 0
    type(state_t) :: state
    integer :: sense = 1
    real(wp) :: load_slope = 0
  end type extremum_t

contains

  !> The extremum of h0 or load that the last three states of an arc surround: a root of its exact
  !> derivative along the path, begun at the extremum of the polynomial through the states and found
  !> by secants, and by bisection where these do not come nearer, as under a force that changes by
  !> orders of magnitude. lost: a solve failed.
  subroutine polish_extremum(equations, options, arc, quantity, found, lost)
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: quantity
    type(extremum_t), intent(out) :: found
    logical, intent(out) :: lost
    type(state_t) :: trial
    type(frozen_jacobian_t) :: frozen
    type(bracket_t) :: bracket
    real(wp) :: slopes(2), slope, slope_size, slope_before, s, s_before, s_next
    integer :: round
    logical :: solved, fell

    associate (n => arc%held)
      associate (value => merge(arc%state(:n)%h0, arc%state(:n)%load, quantity == of_h0))
        found%sense = merge(1, -1, value(n - 1) > value(n))
        bracket = bracket_t(minval(arc%coordinate(n - 2:n)), maxval(arc%coordinate(n - 2:n)))
        s = interpolated_maximum(arc%coordinate(:n), found%sense*value, bracket%low, bracket%high)
      end associate
    end associate
    slope_size = huge(1.0_wp)
    do round = 1, most_rounds
      call state_at(equations, options, frozen, arc, s, trial, solved)
      if (solved) call slopes_along_path(equations, path_control(equations%problem, arc%mesh, s), &
        trial, frozen, slopes(1), slopes(2), solved)
      lost = .not. solved
      if (lost) return
      slope = slopes(quantity)
      fell = abs(slope) < slope_size
      if (fell) then
        slope_size = abs(slope)
        found%state = trial
        found%coordinate = s
        found%load_slope = slopes(2)
      end if
      ! A maximum has its rising side before it.
      call bracket%narrow((slope > 0) .eqv. (found%sense > 0), s)
      if (.not. fell .and. round > 2) then
        if (abs(s - s_before) < rounding_rules) exit
        s_next = bracket%middle()
      else if (round == 1) then
        s_next = s + sign(1.0e-4_wp*(bracket%high - bracket%low) + 1.0e-7_wp, found%sense*slope)
      else if (abs(slope - slope_before) > tiny(slope)) then
        s_next = secant_root(s, slope, s_before, slope_before)
      else
        exit
      end if
      s_next = bracket%within(s_next)
      if (abs(s_next - s) < root_tolerance) exit
      s_before = s
      slope_before = slope
      s = s_next
    end do
  end subroutine polish_extremum

end module path_extremum
