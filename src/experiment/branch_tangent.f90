!> The tangent of the curve of equilibria at a state on a mesh fixed in space, and whether this
!> curve connects two states.
!>
!> The coordinate of the curve is Q = h0 - sum(along*gap). A branch that is stable at prescribed h0
!> ends at a fold of h0, where gaps change infinitely fast with h0. If `along` is opposite to this
!> change, Q has no fold there. The curve can then be followed past the fold of h0, which is a zero
!> of dh0/dQ.
module branch_tangent
  use kinds, only: wp, pi, nan
  use far_field, only: load_slope_beyond
  use contact_state, only: state_t, gap_at_end, load_reach
  use controls, only: control_t
  use jacobian, only: control_derivative
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: solve, determinant_sign
  use represented_pressure, only: pressure_slope_t, slope_on
  use solver, only: solver_t
  implicit none
  private
  public :: branch_tangent_t, tangent_at, find_load_slope, has_factors_at, joins, passing

  !> Derivatives by Q of h0, of the displacement on the axis, of the load and of the gaps.
  type :: branch_tangent_t
    !> Whether the Jacobian is regular, and whether the state is stable at prescribed h0.
    logical :: regular = .false., stable = .false.
    !> The weights in Q; zeros if Q is h0.
    real(wp), allocatable :: along(:)
    real(wp) :: h0 = 1, axis = 0, load = 0
    real(wp), allocatable :: gap(:)
    !> The load of the absolute pressures, to which changes of the load are compared, and the
    !> derivatives of the load by the gaps.
    real(wp) :: scale = 1
    real(wp), allocatable :: load_by_gap(:)
  contains
    procedure :: turn
  end type branch_tangent_t

  !> The curve connects two states if the tangents at both of them predict the difference D of the
  !> states. The prediction is the tangent times the distance d in Q; its error is at most
  !> of_difference*|D| + of_distance*|d|. Near the cusp at which a pair of folds begins, h0 is a
  !> cubic of the coordinate, and the error of at least one tangent is two thirds of the difference,
  !> for any step.
  real(wp), parameter :: of_difference = 0.25_wp, of_distance = 0.05_wp
  !> Differences, in the law's lengths and of the relative load, that are too small for a jump.
  real(wp), parameter :: too_small = 1.0e-3_wp

contains

  !> The tangent at a state of the curve, in the coordinate of solver%along. The factors stay in
  !> solver%frozen, for the next state.
  subroutine tangent_at(solver, control, state, tangent)
    class(solver_t), intent(inout) :: solver
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(branch_tangent_t), intent(out) :: tangent
    type(pressure_slope_t) :: slope
    real(wp) :: weight(size(state%gap)), unit(size(state%gap)), of_end(2)

    if (allocated(solver%along) .or. .not. has_factors_at(solver%frozen, control, state)) &
      call freeze(solver%equations_t, control, state, solver%frozen)
    solver%frozen%excess = 0
    tangent%regular = solver%frozen%factors%valid
    if (.not. tangent%regular) return
    tangent%gap = -control_derivative(solver%equations_t, control, state)
    call solve(solver%frozen%factors, tangent%gap)
    associate (grid => solver%meshes%grid(1), n => size(state%gap))
      tangent%along = 0*grid%weight
      if (allocated(solver%along)) tangent%along = solver%along
      weight = 2*pi*state%scale**2*grid%weight
      slope = slope_on(solver%problem%law, grid, state%gap)
      unit = 1
      tangent%load_by_gap = weight*slope%times(unit)
      tangent%load = dot_product(weight, slope%times(tangent%gap))
      if (grid%is_bounded()) then
        ! The load beyond the mesh depends on the gap at its end, which follows the last node.
        of_end = 2*pi*load_slope_beyond(solver%problem, &
          gap_at_end(solver%problem%shape, grid, state), load_reach(grid, state))
        tangent%load_by_gap(n) = tangent%load_by_gap(n) + of_end(1)
        tangent%load = tangent%load + of_end(1)*tangent%gap(n)
      end if
      tangent%scale = dot_product(weight, abs(state%pressure))
      ! The ratio of the determinants at prescribed h0 and at prescribed Q.
      tangent%h0 = 1 + dot_product(tangent%along, tangent%gap)
      tangent%stable = (determinant_sign(solver%frozen%factors) > 0) .eqv. tangent%h0 > 0
      tangent%axis = dot_product(grid%at_axis, tangent%gap) - tangent%h0
    end associate
  end subroutine tangent_at

  !> The derivative of the load by h0 along the branch, at an equilibrium on a mesh fixed in space;
  !> NaN where the Jacobian is singular. The solver keeps its factors.
  subroutine find_load_slope(solver, state, slope)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: slope
    type(frozen_jacobian_t) :: own
    type(branch_tangent_t) :: tangent

    own = solver%frozen
    call solver%frozen%forget()
    call tangent_at(solver, control_t(value=state%h0), state, tangent)
    solver%frozen = own
    slope = nan
    if (tangent%regular) slope = tangent%load
  end subroutine find_load_slope

  !> Whether there are factors of the Jacobian at a state where h0 is prescribed.
  pure logical function has_factors_at(frozen, control, state) result(has)
    type(frozen_jacobian_t), intent(in) :: frozen
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state

    has = frozen%serves(control, size(state%gap))
    if (has) has = all(abs(frozen%state%gap - state%gap) <= 0)
  end function has_factors_at

  !> Weights for which Q increases along the curve, here and past the next fold. Near a fold the
  !> attraction changes fast with h0, so the weights are those of the attractive part of the load.
  !> If the load decreases with h0, no fold is near, and Q is h0. If the edge is pinned between
  !> nodes, a fold affects a few nodes and hardly the load, and the weights are the changes of the
  !> gaps.
  pure function passing(tangent, pinned) result(along)
    type(branch_tangent_t), intent(in) :: tangent
    logical, intent(in) :: pinned
    real(wp) :: along(size(tangent%gap))

    if (pinned) then
      along = -tangent%gap*maxval(abs(tangent%gap))/dot_product(tangent%gap, tangent%gap)
      along = sign(1.0_wp, tangent%h0)*along
    else
      along = 0
      if (tangent%load*tangent%h0 > 0) along = -max(tangent%load_by_gap, 0.0_wp)/tangent%scale
    end if
  end function passing

  !> Converts the tangent to the coordinate Q with other weights.
  pure subroutine turn(self, along)
    class(branch_tangent_t), intent(inout) :: self
    real(wp), intent(in) :: along(:)
    real(wp) :: length

    length = self%h0 - dot_product(along, self%gap)
    self%along = along
    self%h0 = self%h0/length
    self%axis = self%axis/length
    self%load = self%load/length
    self%gap = self%gap/length
  end subroutine turn

  !> Whether the curve connects two states: their tangents, in the same coordinate, agree with the
  !> change of load and displacement from one to the other.
  pure logical function joins(from, at_from, to, at_to)
    type(state_t), intent(in) :: from, to
    type(branch_tangent_t), intent(in) :: at_from, at_to
    real(wp) :: distance, change(2), off(2)

    distance = (to%h0 - from%h0) - dot_product(at_from%along, to%gap - from%gap)
    change = [(to%axis_gap - to%h0) - (from%axis_gap - from%h0), &
      (to%load - from%load)/at_from%scale]
    off = max(abs(distance*[at_from%axis, at_from%load/at_from%scale] - change), &
      abs(distance*[at_to%axis, at_to%load/at_from%scale] - change))
    joins = all(abs(change) <= too_small) .or. &
      all(off <= of_difference*abs(change) + of_distance*abs(distance))
  end function joins

end module branch_tangent
