!> Derivatives of the equations of equilibrium: the Jacobian, factorised, and how the equations
!> depend on what a control prescribes.
module jacobian
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use linear_algebra, only: factorisation_t, factorise, multiply
  use contact_state, only: state_t
  use equilibrium, only: control_t, cost_t, equations_t, at_h0, at_axis_gap, at_edge_radius, &
    at_h0_with_edge
  implicit none
  private
  public :: factorise_jacobian, factorise_on, jacobian_times, control_derivative

contains

  !> Factors of the Jacobian of `residual` at a state, bordered where the control has an unknown of
  !> its own: I - 2 coupling c W diag(P'), and the derivatives by H0 or c. `shift` is added to the
  !> diagonal of the nodes' block.
  subroutine factorise_jacobian(equations, control, state, factors, shift)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(factorisation_t), intent(inout) :: factors
    real(wp), intent(in), optional :: shift

    associate (grid => equations%meshes%grid(control%mesh), problem => equations%problem)
      call factorise_on(problem, grid, equations%meshes%locked_gap(problem%law, control%mesh), &
        control, state, factors, equations%cost, shift)
    end associate
  end subroutine factorise_jacobian

  !> The same for a state on a mesh that is given, locked to a given gap.
  subroutine factorise_on(problem, grid, locked_gap, control, state, factors, cost, shift)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: locked_gap
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(factorisation_t), intent(inout) :: factors
    type(cost_t), intent(inout) :: cost
    real(wp), intent(in), optional :: shift
    real(wp) :: factor(size(state%gap)), diagonal
    integer :: n, m, j, row

    n = size(state%gap)
    m = n
    if (control%kind /= at_h0) m = n + 1
    if (allocated(factors%lu)) then
      if (size(factors%lu, 1) /= m) deallocate (factors%lu)
    end if
    if (.not. allocated(factors%lu)) allocate (factors%lu(m, m))
    factor = -2*problem%coupling*state%scale*problem%law%slope(state%gap)
    cost%pressure_evaluations = cost%pressure_evaluations + n*problem%law%terms
    diagonal = 1
    if (present(shift)) diagonal = 1 + shift
    row = bordered_row(control)
    do j = 1, n
      if (problem%coupling > 0) then
        factors%lu(:n, j) = factor(j)*grid%kernel(first_node:first_node - 1 + n, j)
        if (m > n) factors%lu(m, j) = -factor(j)*grid%kernel(row, j)
      else
        factors%lu(:, j) = 0
      end if
      factors%lu(j, j) = factors%lu(j, j) + diagonal
    end do
    if (m > n) call border(problem, grid, locked_gap, control, state, factors%lu(:, m))
    call factorise(factors)
    cost%factorisations = cost%factorisations + 1
  end subroutine factorise_on

  !> The Jacobian of `residual` at a state times a change of the unknowns.
  function jacobian_times(equations, control, state, change) result(product)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: change(:)
    real(wp) :: product(size(change))
    real(wp) :: raised(first_node - 1 + size(state%gap)), column(size(change))

    associate (problem => equations%problem, grid => equations%meshes%grid(control%mesh), &
      n => size(state%gap), m => size(change), cost => equations%cost)
      raised = 0
      if (problem%coupling > 0) then
        call multiply(grid%kernel, n, problem%law%slope(state%gap)*change(:n), raised)
        raised = 2*problem%coupling*state%scale*raised
        cost%pressure_evaluations = cost%pressure_evaluations + n*problem%law%terms
        cost%operator_products = cost%operator_products + 1
        cost%operator_columns = cost%operator_columns + n
      end if
      product(:n) = change(:n) - raised(first_node:)
      if (m == n) return
      call border(problem, grid, equations%meshes%locked_gap(problem%law, control%mesh), control, &
        state, column)
      product(:n) = product(:n) + column(:n)*change(m)
      product(m) = raised(bordered_row(control)) + column(m)*change(m)
    end associate
  end function jacobian_times

  !> The row of the kernel in the control's own equation.
  pure integer function bordered_row(control)
    type(control_t), intent(in) :: control

    bordered_row = merge(axis_row, centre_row, control%kind == at_axis_gap)
  end function bordered_row

  !> The column of derivatives of `residual` by the control's unknown.
  pure subroutine border(problem, grid, locked_gap, control, state, column)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: locked_gap
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: column(:)

    if (control%kind == at_h0_with_edge) then
      column = scale_derivative(problem, grid, locked_gap, state)
    else
      column = -1
      column(size(column)) = 1
    end if
  end subroutine border

  !> Derivative of `residual` by the scale c: -x f'(c x) - 2 coupling W P at the nodes, the opposite
  !> sign, with x = 1, in the equation for the edge. The deformation is read off the gaps, which is
  !> exact where the residual vanishes and costs no operator product.
  pure function scale_derivative(problem, grid, locked_gap, state) result(column)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    real(wp), intent(in) :: locked_gap
    type(state_t), intent(in) :: state
    real(wp) :: column(size(state%gap) + 1)

    associate (c => state%scale, n => size(state%gap))
      column(:n) = -problem%shape%unlike_scaling(c, grid%x(:n)) - (state%gap - state%h0)/c
      column(n + 1) = problem%shape%unlike_scaling(c, 1.0_wp) + &
        (locked_gap - state%h0)/c
    end associate
  end function scale_derivative

  !> Derivative of `residual` by the control's value, at a state: with the factors of the same
  !> control the tangent of the path is minus their solution for it.
  pure function control_derivative(equations, control, state) result(derivative)
    type(equations_t), intent(in) :: equations
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
      associate (problem => equations%problem, meshes => equations%meshes)
        derivative = scale_derivative(problem, meshes%grid(control%mesh), &
          meshes%locked_gap(problem%law, control%mesh), state)
      end associate
    end select
  end function control_derivative

end module jacobian
