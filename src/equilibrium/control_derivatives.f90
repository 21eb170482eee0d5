!> Derivatives of the equations of equilibrium by what a control prescribes or leaves unknown: H0,
!> the scale, the gap on the axis.
module control_derivatives
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use elastic_operator, only: elastic_operator_t
  use contact_state, only: state_t
  use controls, only: control_t, at_h0, at_axis_gap, at_edge_radius, at_h0_with_edge
  use equilibrium, only: equations_t
  implicit none
  private
  public :: bordered_row, border, control_derivative

contains

  !> The row of the kernel for the control's own equation.
  pure integer function bordered_row(control)
    type(control_t), intent(in) :: control

    bordered_row = merge(axis_row, centre_row, control%kind == at_axis_gap)
  end function bordered_row

  !> The column of derivatives of `residual` by the control's unknown.
  subroutine border(problem, grid, operator, locked_gap, control, state, column)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(elastic_operator_t), intent(inout) :: operator
    real(wp), intent(in) :: locked_gap
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: column(:)

    if (control%kind == at_h0_with_edge) then
      call scale_derivative(problem, grid, operator, locked_gap, state, column)
    else
      column = -1
      column(size(column)) = 1
    end if
  end subroutine border

  !> Derivative of `residual` by the scale c: -x f'(c x) - dA/dc P at the nodes; the negative of
  !> this, with x = 1, in the equation of the edge. For homogeneous bodies dA/dc P = A P/c is taken
  !> from the gaps, which is exact if the residual is zero and needs no operator product.
  subroutine scale_derivative(problem, grid, operator, locked_gap, state, column)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(elastic_operator_t), intent(inout) :: operator
    real(wp), intent(in) :: locked_gap
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: column(:)
    real(wp) :: more(centre_row - 1 + size(column))

    associate (c => state%scale, n => size(state%gap))
      call operator%unlike_scaling(problem, grid, c, state%pressure, centre_row, more(centre_row:))
      column(:n) = -problem%shape%unlike_scaling(c, grid%x(:n)) - (state%gap - state%h0)/c - &
        more(first_node:)
      column(n + 1) = problem%shape%unlike_scaling(c, 1.0_wp) + (locked_gap - state%h0)/c + &
        more(centre_row)
    end associate
  end subroutine scale_derivative

  !> Derivative of `residual` by the control's value at a state. The tangent of the path is minus
  !> the solution of the linear system of the same control's Jacobian with this right-hand side.
  function control_derivative(equations, control, state) result(derivative)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), allocatable :: derivative(:)
    integer :: n

    n = size(state%gap)
    select case (control%kind)
    case (at_h0)
      allocate (derivative(n), source=-1.0_wp)
    case (at_h0_with_edge)
      allocate (derivative(n + 1), source=-1.0_wp)
      derivative(n + 1) = 1
    case (at_axis_gap)
      allocate (derivative(n + 1), source=0.0_wp)
      derivative(n + 1) = -1
    case (at_edge_radius)
      allocate (derivative(n + 1))
      associate (problem => equations%problem, meshes => equations%meshes)
        call scale_derivative(problem, meshes%grid(control%mesh), equations%operator, &
          meshes%locked_gap(control%mesh), state, derivative)
      end associate
    end select
  end function control_derivative

end module control_derivatives
