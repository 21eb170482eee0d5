!> Stability of an equilibrium at fixed h0: the smallest eigenvalue of the operator, which decides,
!> and the paper's local criteria, which estimate.
module stability
  use kinds, only: wp
  use problem, only: problem_t
  use discretisation, only: discretisation_t, first_node
  use equilibrium, only: control_t, state_t, cost_t
  use jacobian, only: factorise_jacobian
  use linear_algebra, only: factorisation_t, solve
  implicit none
  private
  public :: smallest_eigenvalue, local_criterion, axis_criterion

  !> Inverse iterations with one shift, and the relative change that ends them.
  integer, parameter :: most_iterations = 200
  !> Pressures that are none, and by which nothing is divided.
  real(wp), parameter :: least_pressure = 1.0e-100_wp
  real(wp), parameter :: settled = 1.0e-10_wp, nearly_settled = 1.0e-3_wp

contains

  !> The smallest eigenvalue of I - 2 coupling c W diag(P'), whose spectrum is real because W is
  !> symmetric under the weights: above 0 the state is stable at fixed h0. Inverse iteration from a
  !> shift below the spectrum, then from one just below the eigenvalue.
  subroutine smallest_eigenvalue(this, grid, state, eigenvalue, cost)
    type(problem_t), intent(in) :: this
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state
    real(wp), intent(out) :: eigenvalue
    type(cost_t), intent(inout) :: cost
    type(control_t) :: control
    type(factorisation_t) :: factors
    real(wp) :: vector(size(state%gap)), shift, bound(size(state%gap))
    integer :: n

    eigenvalue = 1
    if (.not. this%coupling > 0) return
    n = size(state%gap)
    control%scale = state%scale
    associate (slope => max(this%law%slope(state%gap), 0.0_wp))
      bound = matmul(grid%kernel(first_node:first_node - 1 + n, :n), slope)
    end associate
    ! Attractive slopes alone lower eigenvalues, by no more than their largest row sum.
    shift = 1 - 2*this%coupling*state%scale*maxval(bound) - 0.01_wp
    vector = exp(-grid%x(:n))
    call iterate(nearly_settled)
    shift = eigenvalue - 0.01_wp*max(abs(eigenvalue), 0.1_wp)
    call iterate(settled)

  contains

    subroutine iterate(tolerance)
      real(wp), intent(in) :: tolerance
      real(wp) :: before, growth, image(n)
      integer :: step

      call factorise_jacobian(this, grid, control, state, factors, cost, -shift)
      eigenvalue = shift
      ! Singular: the shift is the eigenvalue.
      if (.not. factors%valid) return
      before = 0.1_wp*huge(1.0_wp)
      do step = 1, most_iterations
        vector = vector/norm2(vector)
        image = vector
        call solve(factors, image)
        growth = dot_product(vector, image)
        if (.not. abs(growth) > tiny(growth)) return
        eigenvalue = shift + 1/growth
        vector = image
        if (abs(eigenvalue - before) <= tolerance*max(1.0_wp, abs(eigenvalue))) exit
        before = eigenvalue
      end do
    end subroutine iterate

  end subroutine smallest_eigenvalue

  !> The left side of (28), the largest |2 u p'/p| over the surface; above 1 the criterion calls the
  !> state unstable. Where the pressure passes zero it has no bound, and contacts with adhesion
  !> always violate it just outside the contact zone.
  pure real(wp) function local_criterion(this, grid, state) result(value)
    type(problem_t), intent(in) :: this
    type(discretisation_t), intent(in) :: grid
    type(state_t), intent(in) :: state

    associate (two_u => state%h0 + 0.5_wp*(state%scale*grid%x(:size(state%gap)))**2 - state%gap, &
      slope => this%law%slope(state%gap))
      ! Slopes are below 1e121 and lengths below 1e80.
      value = max(0.0_wp, maxval(abs(two_u*slope)/max(abs(state%pressure), least_pressure), &
        abs(state%pressure) > least_pressure))
    end associate
  end function local_criterion

  !> The left side of (29), 2 p'(h(0)) u(0)/p(h(0)); below -1 the criterion calls the state
  !> unstable.
  pure real(wp) function axis_criterion(this, state) result(value)
    type(problem_t), intent(in) :: this
    type(state_t), intent(in) :: state
    real(wp) :: slope(1), pressure(1)

    value = 0
    ! Where the iteration has failed the axis may be anywhere.
    if (.not. state%axis_gap >= this%law%smallest_gap) return
    slope = this%law%slope([state%axis_gap])
    pressure = this%law%pressure([state%axis_gap])
    if (abs(pressure(1)) > least_pressure) value = (state%h0 - state%axis_gap)*slope(1)/pressure(1)
  end function axis_criterion

end module stability
