!> The Jacobian of the equations of equilibrium: its factors, its products with changes of the
!> unknowns, and the derivatives by what a control prescribes or leaves unknown: H0, the scale, the
!> gap on the axis.
module jacobian
  use kinds, only: wp, pi
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, axis_row, centre_row, first_node
  use linear_algebra, only: factorisation_t, factorise
  use elastic_operator, only: elastic_operator_t
  use earlier_deformation, only: earlier_deformation_t
  use contact_state, only: state_t
  use represented_pressure, only: pressure_slope_t, slope_on
  use controls, only: control_t, at_h0, at_axis_gap, at_edge_radius, at_h0_with_edge, &
    h0_is_prescribed
  use equilibrium, only: cost_t, equations_t
  implicit none
  private
  public :: factorise_jacobian, factorise_on, jacobian_times, control_derivative

contains

  !> Factors of the Jacobian of `residual` at a state: I - A(c) diag(P'), bordered by the
  !> derivatives by H0 or c if the control has one of these as an unknown. `shift` is added to the
  !> diagonal of the nodes' block. rough: see `factorise`.
  subroutine factorise_jacobian(equations, control, state, factors, shift, rough)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(factorisation_t), intent(inout) :: factors
    real(wp), intent(in), optional :: shift
    logical, intent(in), optional :: rough

    associate (grid => equations%meshes%grid(control%mesh), problem => equations%problem)
      call fill(problem, grid, equations%operator, equations%meshes%locked_gap( &
        control%mesh), control, state, factors, equations%cost, shift)
      if (allocated(equations%earlier)) call add_earlier(equations%earlier, control, state, &
        factors%lu)
      if (h0_is_prescribed(control) .and. control%compliance > 0) &
        call add_spring(equations, control, state, factors%lu)
      if (allocated(equations%along)) factors%lu = factors%lu - &
        spread(equations%along, 1, size(equations%along))
    end associate
    if (allocated(equations%drainage)) call add_drainage(equations, control, state, factors%lu)
    call factorise(factors, rough)
    equations%cost%factorisations = equations%cost%factorisations + 1
  end subroutine factorise_jacobian

  !> Corrects the derivative by the scale for viscoelastic bodies: the rise due to earlier pressures
  !> is part of the gaps in `scale_derivative`, but is not proportional to the scale.
  subroutine add_earlier(earlier, control, state, lu)
    type(earlier_deformation_t), intent(in) :: earlier
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(inout) :: lu(:, :)
    real(wp) :: change(size(earlier%value))
    integer :: n

    if (control%kind /= at_h0_with_edge) return
    n = size(state%gap)
    change = (earlier%growth - earlier%at_scale(state%scale))/state%scale
    lu(:n, n + 1) = lu(:n, n + 1) - change(first_node:)
    lu(n + 1, n + 1) = lu(n + 1, n + 1) + change(centre_row)
  end subroutine add_earlier

  !> Adds the spring's part: H0 depends on the load, and therefore on gaps and scale.
  subroutine add_spring(equations, control, state, lu)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(inout) :: lu(:, :)
    type(pressure_slope_t) :: slope
    real(wp) :: softer(1, size(lu, 2))
    integer :: n, i

    n = size(state%gap)
    associate (grid => equations%meshes%grid(control%mesh), c => state%scale)
      slope = slope_on(equations%problem%law, grid, state%gap)
      softer(1, :n) = 2*pi*control%compliance*c**2*grid%weight(:n)*slope%factor()
      call slope%mix([(i, i=1, n)], softer(:, :n))
      if (size(lu, 2) > n) softer(1, n + 1) = 2*control%compliance*state%load/c
      do i = 1, n
        lu(i, :) = lu(i, :) - softer(1, :)
      end do
      if (size(lu, 1) > n) lu(n + 1, :) = lu(n + 1, :) + softer(1, :)
    end associate
  end subroutine add_spring

  !> Adds the part of the fluid, whose pressure is multiplied by the same elastic operator and adds
  !> to the load on a spring.
  subroutine add_drainage(equations, control, state, lu)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    real(wp), intent(inout) :: lu(:, :)
    real(wp), allocatable :: yields(:, :), by_gap(:, :), by_scale(:)
    integer :: n, rows, i

    n = size(state%gap)
    rows = first_node - 1 + n
    allocate (yields(rows, n), by_gap(rows, n), by_scale(rows))
    associate (grid => equations%meshes%grid(control%mesh), problem => equations%problem, &
      c => state%scale)
      call equations%operator%matrix(problem, grid, c, spread(1.0_wp, 1, n), &
        [(i, i=axis_row, rows)], [(i, i=1, n)], yields)
      if (h0_is_prescribed(control) .and. control%compliance > 0) yields = yields + &
        spread(2*pi*control%compliance*c**2*grid%weight(:n), 1, rows)
      call equations%drainage%changes(control%mesh, c, state%gap, &
        equations%raised(control%mesh, state), grid%x(:n)*problem%shape%slope(c*grid%x(:n)), &
        yields, by_gap, by_scale)
    end associate
    lu(:n, :n) = lu(:n, :n) - by_gap(first_node:, :)
    if (size(lu, 1) == n) return
    lu(n + 1, :n) = lu(n + 1, :n) + by_gap(bordered_row(control), :)
    if (control%kind /= at_h0_with_edge) return
    lu(:n, n + 1) = lu(:n, n + 1) - by_scale(first_node:)
    lu(n + 1, n + 1) = lu(n + 1, n + 1) + by_scale(bordered_row(control))
  end subroutine add_drainage

  !> Factorises the Jacobian of bodies in static equilibrium on any mesh. locked_gap: the gap at the
  !> radius to which the mesh is locked; shift: is added to the diagonal of the nodes' block.
  subroutine factorise_on(problem, grid, operator, locked_gap, control, state, factors, cost, shift)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(elastic_operator_t), intent(inout) :: operator
    real(wp), intent(in) :: locked_gap
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(factorisation_t), intent(inout) :: factors
    type(cost_t), intent(inout) :: cost
    real(wp), intent(in), optional :: shift

    call fill(problem, grid, operator, locked_gap, control, state, factors, cost, shift)
    call factorise(factors)
    cost%factorisations = cost%factorisations + 1
  end subroutine factorise_on

  !> Assembles the matrix to be factorised.
  subroutine fill(problem, grid, operator, locked_gap, control, state, factors, cost, shift)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(elastic_operator_t), intent(inout) :: operator
    real(wp), intent(in) :: locked_gap
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(factorisation_t), intent(inout) :: factors
    type(cost_t), intent(inout) :: cost
    real(wp), intent(in), optional :: shift
    type(pressure_slope_t) :: slope
    real(wp) :: factor(size(state%gap)), column(size(state%gap) + 1), diagonal
    integer :: node(size(state%gap)), n, m, j

    n = size(state%gap)
    node = [(j, j=1, n)]
    slope = slope_on(problem%law, grid, state%gap)
    factor = -slope%factor()
    cost%pressure_evaluations = cost%pressure_evaluations + n*problem%law%terms
    m = n
    if (control%kind /= at_h0) m = n + 1
    if (allocated(factors%lu)) then
      if (size(factors%lu, 1) /= m) deallocate (factors%lu)
    end if
    if (.not. allocated(factors%lu)) allocate (factors%lu(m, m))
    diagonal = 1
    if (present(shift)) diagonal = 1 + shift
    associate (lu => factors%lu)
      call operator%matrix(problem, grid, state%scale, factor, first_node - 1 + node, node, &
        lu(:n, :n))
      if (m > n) call operator%matrix(problem, grid, state%scale, -factor, &
        [bordered_row(control)], node, lu(m:, :n))
      call slope%mix(node, lu(:, :n))
      do j = 1, n
        lu(j, j) = lu(j, j) + diagonal
      end do
      if (m == n) return
      call border(problem, grid, operator, locked_gap, control, state, column)
      lu(:, m) = column
    end associate
  end subroutine fill

  !> The Jacobian of `residual` at a state times a change of the unknowns. slope: that of the law at
  !> the state's gaps.
  function jacobian_times(equations, control, state, slope, change) result(product)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    type(state_t), intent(in) :: state
    type(pressure_slope_t), intent(in) :: slope
    real(wp), intent(in) :: change(:)
    real(wp) :: product(size(change)), rise(first_node - 1 + size(state%gap)), column(size(change))

    associate (problem => equations%problem, grid => equations%meshes%grid(control%mesh), &
      n => size(state%gap), m => size(change), cost => equations%cost)
      call equations%operator%deform(problem, grid, state%scale, n, &
        slope%times(change(:n)), rise)
      cost%operator_products = cost%operator_products + 1
      cost%operator_columns = cost%operator_columns + n
      product(:n) = change(:n) - rise(first_node:)
      if (m == n) return
      call border(problem, grid, equations%operator, equations%meshes%locked_gap( &
        control%mesh), control, state, column)
      product(:n) = product(:n) + column(:n)*change(m)
      product(m) = rise(bordered_row(control)) + column(m)*change(m)
    end associate
  end function jacobian_times

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

  !> Derivative of `residual` by the control's value at a state. With this right-hand side and the
  !> Jacobian for the same control, the solution of the linear system is minus the tangent of the
  !> path.
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

end module jacobian
