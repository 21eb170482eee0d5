!> The tangent of the curve of equilibria at a state on a mesh fixed in space, and whether this curve
!> joins two states.
!>
!> The coordinate of the curve is Q = h0 - compliance*load. A branch that is stable at prescribed h0
!> ends at a fold of h0, and there the load increases infinitely steeply with h0. Under a negative
!> compliance, as of a device that is stiffer than rigid, Q has no fold there: the curve can be
!> followed past the fold, which is a zero of dh0/dQ.
module branch_tangent
  use kinds, only: wp, pi
  use beyond_mesh, only: load_slope_beyond
  use contact_state, only: state_t, gap_at_end, load_reach
  use controls, only: control_t
  use control_derivatives, only: control_derivative
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: solve, determinant_sign
  use represented_pressure, only: pressure_slope_t, slope_on
  use solver, only: solver_t
  implicit none
  private
  public :: tangent_t, tangent_at, has_factors_at, joins

  !> Derivatives by Q of h0, of the displacement on the axis, of the load and of the gaps.
  type :: tangent_t
    !> Whether the Jacobian is regular, and whether the state is stable at prescribed h0.
    logical :: regular = .false., stable = .false.
    real(wp) :: compliance = 0
    real(wp) :: h0 = 1, axis = 0, load = 0
    real(wp), allocatable :: gap(:)
    !> The load of the absolute pressures, to which changes of the load are compared.
    real(wp) :: scale = 1
  contains
    procedure :: passing
    procedure :: under
  end type tangent_t

  !> Two states are joined by the curve if at both of them the tangent's change, over the whole
  !> distance in Q, differs from their difference by at most these parts of the difference and of
  !> the distance. About the cusp at which a pair of folds begins, where h0 is a cubic of the
  !> coordinate, at least one tangent is off by two thirds of the difference, whatever the step.
  real(wp), parameter :: of_difference = 0.25_wp, of_distance = 0.05_wp
  !> Differences, in the law's lengths and of the relative load, that are too small for a jump.
  real(wp), parameter :: too_small = 1.0e-3_wp

contains

  !> The tangent at a state. The factors stay in solver%frozen, for the next state.
  subroutine tangent_at(solver, state, compliance, tangent)
    class(solver_t), intent(inout) :: solver
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: compliance
    type(tangent_t), intent(out) :: tangent
    type(control_t) :: control
    type(pressure_slope_t) :: slope
    real(wp) :: at_nodes, beyond(2), length

    control%value = state%h0 - compliance*state%load
    control%compliance = compliance
    tangent%compliance = compliance
    if (.not. has_factors_at(solver%frozen, control, state)) &
      call freeze(solver%equations_t, control, state, solver%frozen)
    solver%frozen%excess = 0
    tangent%regular = solver%frozen%factors%valid
    if (.not. tangent%regular) return
    associate (grid => solver%meshes%grid(1), problem => solver%problem)
      tangent%gap = -control_derivative(solver%equations_t, control, state)
      call solve(solver%frozen%factors, tangent%gap)
      slope = slope_on(problem%law, grid, state%gap)
      at_nodes = 2*pi*state%scale**2*dot_product(grid%weight, slope%times(tangent%gap))
      tangent%scale = 2*pi*state%scale**2*dot_product(grid%weight, abs(state%pressure))
      ! The Jacobian does not have the load beyond the mesh: dh0/dQ is the ratio of the determinants
      ! at prescribed h0 and at prescribed Q.
      tangent%h0 = 1 + compliance*at_nodes
      tangent%stable = (determinant_sign(solver%frozen%factors) > 0) .eqv. tangent%h0 > 0
      tangent%load = at_nodes
      if (grid%is_bounded()) then
        beyond = load_slope_beyond(problem, gap_at_end(problem%shape, grid, state), &
          load_reach(grid, state))
        tangent%load = at_nodes + 2*pi*beyond(1)*tangent%gap(size(tangent%gap))
      end if
      tangent%axis = dot_product(grid%at_axis, tangent%gap) - tangent%h0
    end associate
    length = tangent%h0 - compliance*tangent%load
    tangent%regular = abs(length) > 0
    if (tangent%regular) call rescale(tangent, length)

  end subroutine tangent_at

  !> Whether there are factors of the Jacobian at a state under a control.
  pure logical function has_factors_at(frozen, control, state) result(has)
    type(frozen_jacobian_t), intent(in) :: frozen
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state

    has = frozen%serves(control, size(state%gap))
    if (has) has = abs(frozen%control%compliance - control%compliance) <= 0 .and. &
      all(abs(frozen%state%gap - state%gap) <= 0)
  end function has_factors_at

  !> The compliance under which the curve passes the fold that is ahead; 0 if the load does not
  !> increase with h0, since then there is none.
  pure real(wp) function passing(self) result(compliance)
    class(tangent_t), intent(in) :: self

    compliance = 0
    if (self%load*self%h0 > 0) compliance = -1/self%scale
  end function passing

  !> The tangent under another compliance.
  pure type(tangent_t) function under(self, compliance) result(tangent)
    class(tangent_t), intent(in) :: self
    real(wp), intent(in) :: compliance

    tangent = self
    tangent%compliance = compliance
    call rescale(tangent, self%h0 - compliance*self%load)
  end function under

  !> Divides the derivatives by the derivative of the new coordinate.
  pure subroutine rescale(tangent, length)
    type(tangent_t), intent(inout) :: tangent
    real(wp), intent(in) :: length

    tangent%h0 = tangent%h0/length
    tangent%axis = tangent%axis/length
    tangent%load = tangent%load/length
    tangent%gap = tangent%gap/length
  end subroutine rescale

  !> Whether the curve joins two states: their tangents, under the same compliance, agree with the
  !> change of load and displacement from one to the other.
  pure logical function joins(from, at_from, to, at_to)
    type(state_t), intent(in) :: from, to
    type(tangent_t), intent(in) :: at_from, at_to
    real(wp) :: distance, change(2), off(2)

    distance = (to%h0 - from%h0) - at_from%compliance*(to%load - from%load)
    change = [(to%axis_gap - to%h0) - (from%axis_gap - from%h0), (to%load - from%load)/at_from%scale]
    off = max(abs(distance*[at_from%axis, at_from%load/at_from%scale] - change), &
      abs(distance*[at_to%axis, at_to%load/at_from%scale] - change))
    joins = all(abs(change) <= too_small) .or. &
      all(off <= of_difference*abs(change) + of_distance*abs(distance))
  end function joins

end module branch_tangent
