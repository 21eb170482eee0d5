!> Derivatives of H0 and load along the equilibrium path, exact to the solver's tolerance.
module path_slopes
  use kinds, only: wp, pi
  use beyond_mesh, only: load_slope_beyond
  use equilibrium, only: control_t, state_t, equations_t, at_edge_radius, load_reach, &
    gap_at_end
  use jacobian, only: control_derivative
  use linear_algebra, only: solve
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  implicit none
  private
  public :: slopes_along_path

contains

  !> h0_slope and load_slope: derivatives of H0 and load by the value of the control at an
  !> equilibrium under it; found = .false. where the Jacobian is singular. Renews the factorisation,
  !> which then fits the state exactly.
  subroutine slopes_along_path(equations, control, state, frozen, h0_slope, load_slope, found)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(frozen_jacobian_t), intent(inout) :: frozen
    real(wp), intent(out) :: h0_slope, load_slope
    logical, intent(out) :: found
    real(wp), allocatable :: dz(:)
    real(wp) :: c_slope, reach, last, of_end(2)
    integer :: n

    n = size(state%gap)
    call freeze(equations, control, state, frozen)
    h0_slope = 0
    load_slope = 0
    found = frozen%factors%valid
    if (.not. found) return
    dz = -control_derivative(equations, control, state)
    call solve(frozen%factors, dz)
    h0_slope = dz(n + 1)
    c_slope = merge(1.0_wp, 0.0_wp, control%kind == at_edge_radius)
    associate (grid => equations%meshes%grid(control%mesh), &
      law => equations%problem%law, shape => equations%problem%shape)
      load_slope = 2*pi*(2*state%scale*c_slope*dot_product(grid%weight, state%pressure) + &
        state%scale**2*sum(grid%weight*law%slope(state%gap)*dz(:n)))
      if (.not. grid%is_bounded()) return
      ! What is beyond a bounded mesh depends on the position of its end and on the gap there; this
      ! moves with the last node's and with the end itself.
      reach = load_reach(grid, state)
      last = state%scale*grid%x(n)
      of_end = load_slope_beyond(equations%problem, gap_at_end(shape, grid, state), reach)
      load_slope = load_slope + 2*pi*(of_end(1)*(dz(n) + c_slope/state%scale* &
        (reach*shape%slope(reach) - last*shape%slope(last))) + &
        of_end(2)*reach*c_slope/state%scale)
    end associate
  end subroutine slopes_along_path

end module path_slopes
