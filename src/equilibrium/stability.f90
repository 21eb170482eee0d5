!> Stability of an equilibrium at fixed h0: the smallest eigenvalue of the operator.
module stability
  use kinds, only: wp, nan
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t, first_node
  use contact_state, only: state_t
  use represented_pressure, only: pressure_slope_t, slope_on
  use controls, only: control_t
  use equilibrium, only: cost_t
  use jacobian, only: factorise_on
  use elastic_operator, only: elastic_operator_t
  use linear_algebra, only: factorisation_t, solve, determinant_sign, eigenvalues
  implicit none
  private
  public :: smallest_eigenvalue, unknown

  !> A bound of the error of an eigenvalue lambda. It has a part relative to |1 - lambda|, and a
  !> part for unavoidable rounding, relative to 1 or to the largest |1 - lambda| of the operator,
  !> whichever is larger.
  type :: margin_t
    real(wp) :: relative, rounding
  end type margin_t

  !> Distance of the inverse iteration's shift below the computed eigenvalue, and largest distance
  !> between the result and that eigenvalue.
  type(margin_t), parameter :: close = margin_t(1.0e-6_wp, 1.0e-12_wp)
  !> The change that ends the inverse iteration, and the largest residual of the eigenpair.
  type(margin_t), parameter :: settled = margin_t(1.0e-12_wp, 1.0e-14_wp), &
    exact = margin_t(1.0e-9_wp, 1.0e-12_wp)
  !> Bound of the errors of all computed eigenvalues.
  type(margin_t), parameter :: lower = margin_t(1.0e-2_wp, 1.0e-12_wp)
  integer, parameter :: most_iterations = 50
  !> The effect of a node is below rounding if it is below this fraction of the largest effect.
  real(wp), parameter :: negligible = 0.01_wp*epsilon(1.0_wp)

contains

  !> The smallest eigenvalue of I - A(c) diag(P'), which is positive if the state is stable at fixed
  !> h0. The spectrum is real because A is symmetric under the weights, except for discretisation
  !> errors. LAPACK computes all eigenvalues. The smallest is then refined to the accuracy of the
  !> operator's factors. Three independent conditions are checked. The refined pair satisfies the
  !> eigenvalue equation of the operator. The sign of the determinant belongs to an even number of
  !> smaller eigenvalues. The error bounds of all computed eigenvalues (Bauer and Fike) exclude a
  !> much smaller one. If a condition fails, the eigenvalue is NaN and `certain` is .false.
  subroutine smallest_eigenvalue(problem, grid, state, eigenvalue, certain, cost)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: eigenvalue
    logical, intent(out) :: certain
    type(cost_t), intent(inout) :: cost
    type(pressure_slope_t) :: slope
    real(wp), dimension(size(state%gap)) :: factor, root, effect
    real(wp), allocatable :: matrix(:, :), part(:)
    logical :: matters(size(state%gap))
    integer, allocatable :: node(:)
    type(elastic_operator_t) :: operator
    real(wp) :: error, widest
    integer :: j

    eigenvalue = 1
    certain = .true.
    slope = slope_on(problem%law, grid, state%gap)
    ! Rigid bodies, or bodies that do not attract each other: repulsion increases the eigenvalues,
    ! and these accumulate at 1.
    if (.not. (problem%coupling > 0 .and. maxval(slope%at_node) > 0)) return
    factor = slope%factor()
    ! Nodes at which the pressure hardly changes have eigenvalues close to 1, whose vectors are
    ! nearly parallel.
    effect = abs(factor)*grid%largest
    matters = effect > negligible*maxval(effect)
    do j = 1, size(slope%mixed)
      matters(slope%mixed(j)%first:slope%mixed(j)%last) = .true.
    end do
    node = pack([(j, j=1, size(matters))], matters)
    ! If rows and columns share the slope equally, the eigenvectors are far from parallel.
    root = sqrt(abs(factor))
    allocate (matrix(size(node), size(node)), part(size(node)))
    call operator%matrix(problem, grid, state%scale, sign(root(node), factor(node)), &
      first_node - 1 + node, node, matrix)
    call slope%mix(node, matrix)
    do j = 1, size(node)
      matrix(:, j) = root(node)*matrix(:, j)
    end do
    call eigenvalues(matrix, part, error, certain)
    if (certain) then
      eigenvalue = 1 - maxval(part)
      widest = maxval(abs(part))
      call refine(problem, grid, operator, state, slope, widest, eigenvalue, certain, cost)
    end if
    if (certain) certain = error <= room(lower, eigenvalue, widest)
    if (.not. certain) eigenvalue = unknown()
  end subroutine smallest_eigenvalue

  !> Inverse iteration on the operator itself, with a shift just below the eigenvalue. certain: it
  !> converged to an eigenpair near its start, and by the determinant an even number of eigenvalues
  !> is below the shift.
  subroutine refine(problem, grid, operator, state, slope, widest, eigenvalue, certain, cost)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: grid
    type(elastic_operator_t), intent(inout) :: operator
    type(state_t), intent(in) :: state
    type(pressure_slope_t), intent(in) :: slope
    real(wp), intent(in) :: widest
    real(wp), intent(inout) :: eigenvalue
    logical, intent(out) :: certain
    type(cost_t), intent(inout) :: cost
    type(control_t) :: control
    type(factorisation_t) :: factors
    real(wp), dimension(size(state%gap)) :: vector, image
    real(wp) :: rise(first_node - 1 + size(state%gap)), first, before, growth, shift
    integer :: step

    certain = .false.
    first = eigenvalue
    shift = first - room(close, first, widest)
    control%scale = state%scale
    call factorise_on(problem, grid, operator, problem%law%edge_gap, control, state, factors, &
      cost, -shift)
    if (.not. factors%valid) return
    if (determinant_sign(factors) < 0) return
    associate (weight => grid%weight(:size(state%gap)))
      vector = exp(-grid%x(:size(state%gap)))
      do step = 1, most_iterations
        before = eigenvalue
        vector = vector/sqrt(sum(weight*vector**2))
        image = vector
        call solve(factors, image)
        growth = sum(weight*vector*image)
        if (.not. abs(growth) > tiny(growth)) return
        eigenvalue = shift + 1/growth
        vector = image
        if (abs(eigenvalue - before) <= room(settled, first, widest)) exit
      end do
      vector = vector/sqrt(sum(weight*vector**2))
      call operator%deform(problem, grid, state%scale, size(state%gap), slope%times(vector), rise)
      image = (1 - eigenvalue)*vector - rise(first_node:)
      certain = abs(eigenvalue - first) <= room(close, first, widest) .and. &
        sqrt(sum(weight*image**2)) <= room(exact, first, widest)
    end associate
  end subroutine refine

  !> The margin at an eigenvalue of an operator with the given largest |1 - lambda|.
  pure real(wp) function room(margin, eigenvalue, widest)
    type(margin_t), intent(in) :: margin
    real(wp), intent(in) :: eigenvalue, widest

    room = margin%relative*abs(1 - eigenvalue) + margin%rounding*max(1.0_wp, widest)
  end function room

  !> NaN for a value that does not exist.
  pure real(wp) function unknown()
    unknown = nan
  end function unknown

end module stability
