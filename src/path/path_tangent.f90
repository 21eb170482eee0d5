!> The tangent of the equilibrium path: derivatives of a state by the value of its control, to a
!> given relative error. The equations of the tangent are solved with the factors that corrected the
!> state. These belong to a Jacobian nearby, so the solution is improved by iterative refinement.
module path_tangent
  use kinds, only: wp, pi
  use far_field, only: load_slope_beyond
  use represented_pressure, only: pressure_slope_t, slope_on
  use contact_state, only: state_t, load_reach, gap_at_end
  use path_point, only: path_point_t, tangent_t
  use controls, only: control_t, at_axis_gap, at_edge_radius
  use equilibrium, only: equations_t
  use solver, only: solver_t
  use path_coordinate, only: path_control, axis_gap_rate
  use jacobian, only: jacobian_times, control_derivative
  use linear_algebra, only: solve
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  implicit none
  private
  public :: tangent_along

  !> Refinement ends with a correction below this multiple of the permitted error, since the next
  !> correction would be smaller by a larger factor. Factors are kept up to a ratio `shrinking` of
  !> successive corrections, and up to `most_corrections` corrections.
  real(wp), parameter :: last_over_error = 100, shrinking = 0.3_wp
  integer, parameter :: most_corrections = 12

contains

  !> Sets the derivatives of an equilibrium by the path's coordinate. error: permitted relative
  !> error, if larger than that of the options. found = .false.: the Jacobian is singular.
  subroutine tangent_along(solver, point, found, error)
    class(solver_t), intent(inout) :: solver
    type(path_point_t), intent(inout) :: point
    logical, intent(out) :: found
    real(wp), intent(in), optional :: error
    real(wp) :: allowed

    allowed = solver%options%slope_error
    if (present(error)) allowed = max(allowed, error)
    call tangent_at(solver%equations_t, path_control(solver%problem, solver%meshes, point%mesh, &
      point%coordinate), point%state, allowed, solver%frozen, point%tangent, found)
    if (.not. found) return
    if (solver%meshes%is_about_axis(point%mesh)) then
      call scale(point%tangent, axis_gap_rate(solver%problem%law, point%coordinate))
    else
      call scale(point%tangent, exp(point%coordinate))
    end if
  end subroutine tangent_along

  !> The derivatives by the value of the control. Factors of a state too far from this one are
  !> renewed.
  subroutine tangent_at(equations, control, state, error, frozen, tangent, found)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: error
    type(frozen_jacobian_t), intent(inout) :: frozen
    type(tangent_t), intent(out) :: tangent
    logical, intent(out) :: found
    real(wp), allocatable :: right(:), dz(:)
    type(pressure_slope_t) :: law_slope
    integer :: n

    n = size(state%gap)
    law_slope = slope_on(equations%problem%law, equations%meshes%grid(control%mesh), state%gap)
    equations%cost%pressure_evaluations = equations%cost%pressure_evaluations + &
      n*equations%problem%law%terms
    right = -control_derivative(equations, control, state)
    found = frozen%serves(control, size(right))
    if (found) call refine(equations, error, control, state, law_slope, right, frozen, dz, found)
    if (.not. found) then
      call freeze(equations, control, state, frozen, exact=.true.)
      found = frozen%factors%valid
      if (.not. found) return
      dz = right
      call solve(frozen%factors, dz)
    end if
    tangent%gap = dz(:n)
    tangent%h0 = dz(n + 1)
    if (control%kind == at_edge_radius) tangent%scale = 1
    associate (grid => equations%meshes%grid(control%mesh))
      if (control%kind == at_axis_gap) then
        tangent%axis_gap = 1
      else
        tangent%axis_gap = dot_product(grid%at_axis, tangent%gap)
      end if
    end associate
    tangent%load = load_slope(equations, control, state, law_slope, tangent)
  end subroutine tangent_at

  !> Solves J dz = right to a relative error, with factors of a neighbouring J; done = .false.: the
  !> refinement does not converge fast. law_slope: slopes of the law.
  subroutine refine(equations, error, control, state, law_slope, right, frozen, dz, done)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: error
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(pressure_slope_t), intent(in) :: law_slope
    real(wp), intent(in) :: right(:)
    type(frozen_jacobian_t), intent(in) :: frozen
    real(wp), allocatable, intent(out) :: dz(:)
    logical, intent(out) :: done
    real(wp) :: correction(size(right)), size_now, size_before
    integer :: step

    dz = right
    call solve(frozen%factors, dz)
    size_before = relative(dz)
    do step = 1, most_corrections
      correction = right - jacobian_times(equations, control, state, law_slope, dz)
      call solve(frozen%factors, correction)
      dz = dz + correction
      size_now = relative(correction)
      done = size_now <= last_over_error*error*relative(dz) .or. &
        size_now**2 <= error*relative(dz)*max(size_now, size_before)
      if (done .or. .not. size_now <= shrinking*size_before) return
      size_before = size_now
    end do

  contains

    !> The largest change relative to the gaps; at large separations both are large.
    pure real(wp) function relative(change)
      real(wp), intent(in) :: change(:)

      relative = max(maxval(abs(change(:size(state%gap)))/(1 + abs(state%gap))), &
        abs(change(size(change)))/(1 + abs(state%h0)))
    end function relative

  end subroutine refine

  !> The derivative of the load, from the derivatives of gaps and scale.
  function load_slope(equations, control, state, law_slope, tangent) result(slope)
    type(equations_t), intent(in) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(pressure_slope_t), intent(in) :: law_slope
    type(tangent_t), intent(in) :: tangent
    real(wp) :: slope, reach, last, of_end(2)

    associate (grid => equations%meshes%grid(control%mesh), n => size(state%gap), &
      shape => equations%problem%shape)
      slope = 2*pi*(2*state%scale*tangent%scale*dot_product(grid%weight, state%pressure) + &
        state%scale**2*dot_product(grid%weight, law_slope%times(tangent%gap)))
      if (.not. grid%is_bounded()) return
      ! The load beyond a bounded mesh depends on the position of the mesh's end and on the gap
      ! there. This gap changes with the gap at the last node and with that position.
      reach = load_reach(grid, state)
      last = state%scale*grid%x(n)
      of_end = load_slope_beyond(equations%problem, gap_at_end(shape, grid, state), reach)
      slope = slope + 2*pi*(of_end(1)*(tangent%gap(n) + tangent%scale/state%scale* &
        (reach*shape%slope(reach) - last*shape%slope(last))) + &
        of_end(2)*reach*tangent%scale/state%scale)
    end associate
  end function load_slope

  !> Converts a tangent to derivatives by another variable; rate: the derivative of the control's
  !> value by this variable.
  pure subroutine scale(tangent, rate)
    type(tangent_t), intent(inout) :: tangent
    real(wp), intent(in) :: rate

    tangent%gap = rate*tangent%gap
    tangent%h0 = rate*tangent%h0
    tangent%scale = rate*tangent%scale
    tangent%axis_gap = rate*tangent%axis_gap
    tangent%load = rate*tangent%load
  end subroutine scale

end module path_tangent
