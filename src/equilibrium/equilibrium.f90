!> The equations of equilibrium on a discretisation, in the units of `dimensionless_problem`:
!>
!>     G_i = H_i - H0 - f(c x_i) - (A(c) P(H))_i = 0 ,
!>
!> which are equations (14), (16), (17) and (18) of the paper in one, for the gaps H at the nodes
!> rho = c x of bodies of the shape f with the `elastic_operator` A. A control says which quantity
!> is prescribed. If it is not H0 at a fixed scale, there is one more unknown (H0 or c) and one more
!> equation (for the gap on the axis or at the contact edge). Behind a spring H0 follows from the
!> position of its base and the load. In viscoelastic bodies the deformation due to earlier
!> pressures (`earlier_deformation`) adds to the gap, and the pressure of a fluid between the bodies
!> (`drainage`) adds to P(H).
module equilibrium
  use kinds, only: wp, pi, long
  use dimensionless_problem, only: problem_t, coupling_over
  use far_field, only: load_beyond
  use discretisation, only: axis_row, centre_row, first_node
  use contact_scales, only: largest_floor
  use contact_state, only: state_t, load_reach, gap_at_end, far_gap
  use mesh_family, only: mesh_family_t
  use controls, only: control_t, at_h0, at_axis_gap, at_edge_radius, at_h0_with_edge, &
    h0_is_prescribed, node_count, unpack
  use elastic_operator, only: elastic_operator_t
  use represented_pressure, only: pressure_on
  use earlier_deformation, only: earlier_deformation_t
  use drainage, only: drainage_t
  implicit none
  private
  public :: cost_t, equations_t, residual, largest_step, holds, residual_floor

  !> Upper limit of all lengths of an equilibrium, in the law's or in lateral units; its cube does
  !> not overflow.
  real(wp), parameter :: largest_unknown = 1.0e80_wp
  !> Largest relative change of the contact radius in an iteration.
  real(wp), parameter :: largest_change = 0.3_wp
  !> Pressures below this fraction of the rounding error of the largest pressure have no effect.
  real(wp), parameter :: unfelt = 1.0e-3_wp

  !> The fraction of a gap's excess over `far_gap` by which the gap may decrease in one step.
  real(wp), parameter :: harmless = 0.3_wp

  !> Counts of work.
  type :: cost_t
    integer(long) :: operator_products = 0, operator_columns = 0, pressure_evaluations = 0
    integer(long) :: factorisations = 0, iterations = 0, kernel_entries = 0, states = 0
    integer(long) :: rejected_steps = 0
    real(wp) :: kernel_seconds = 0, solve_seconds = 0, estimate_seconds = 0
  end type cost_t

  !> The equations of a problem on its meshes, and the cost of solving them. A mesh fixed in space
  !> is the only mesh of its family.
  type :: equations_t
    type(problem_t) :: problem
    type(mesh_family_t) :: meshes
    type(cost_t) :: cost
    type(elastic_operator_t) :: operator
    type(earlier_deformation_t), allocatable :: earlier
    type(drainage_t), allocatable :: drainage
    !> If allocated, (nodes): a control at_h0 prescribes H0 - sum(along*gap), the coordinate of a
    !> curve of equilibria that has folds of H0.
    real(wp), allocatable :: along(:)
    !> Work array of `residual` for the rise of the gap, kept to avoid frequent allocations.
    real(wp), allocatable, private :: rise(:)
  contains
    procedure :: become_those_of
    procedure :: raised
    procedure :: fluid_pressure
  end type equations_t

contains

  !> The gaps at the nodes minus the shape.
  pure function raised(self, mesh, state)
    class(equations_t), intent(in) :: self
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp) :: raised(size(state%gap))

    raised = state%gap - self%problem%shape%height( &
      state%scale*self%meshes%grid(mesh)%x(:size(state%gap)))
  end function raised

  !> The pressure of the fluid in a state. rate: the rate of the gaps [1/s].
  function fluid_pressure(self, mesh, state, rate) result(pressure)
    class(equations_t), intent(in) :: self
    integer, intent(in) :: mesh
    type(state_t), intent(in) :: state
    real(wp), intent(out), optional :: rate(:)
    real(wp), dimension(size(state%gap)) :: pressure, change

    change = self%drainage%rate(state%scale, self%raised(mesh, state))
    pressure = self%drainage%pressure(mesh, state%scale, state%gap, change)
    if (present(rate)) rate = change
  end function fluid_pressure

  !> Replaces the problem; the meshes stay. (It leaks with flang: compiler note 13.)
  subroutine become_those_of(self, problem)
    class(equations_t), intent(inout) :: self
    type(problem_t), intent(in) :: problem

    self%problem = problem
    call self%operator%forget()
  end subroutine become_those_of

  !> The residuals for the unknowns z = (gaps [, H0 or c]): g(:nodes) = G and, if the control has
  !> its own equation, g(nodes + 1). On return `state` holds z, its pressures, load and residual.
  !> Outside the law's domain pressures and load are zero, and the residual is huge.
  subroutine residual(equations, control, z, g, state)
    type(equations_t), intent(inout) :: equations
    type(control_t), intent(in) :: control
    real(wp), intent(in) :: z(:)
    real(wp), intent(out) :: g(:)
    type(state_t), intent(inout) :: state
    real(wp) :: edge_gap
    integer :: i, n, rows, columns

    n = node_count(control, size(z))
    rows = first_node - 1 + n
    if (.not. allocated(equations%rise)) allocate (equations%rise(rows))
    if (size(equations%rise) < rows) then
      deallocate (equations%rise)
      allocate (equations%rise(rows))
    end if
    associate (problem => equations%problem, cost => equations%cost, &
      grid => equations%meshes%grid(control%mesh), rise => equations%rise(:rows))
      call unpack(control, z, state%h0, state%scale)
      state%gap = z(:n)
      if (allocated(equations%along)) state%h0 = state%h0 + dot_product(equations%along, state%gap)
      if (.not. defined(problem, state)) then
        g = 0
        state%pressure = 0*g(:n)
        state%load = 0
        state%axis_gap = state%h0
        state%residual = huge(1.0_wp)
        return
      end if
      ! The pressure, equation (16).
      state%pressure = pressure_on(problem%law, grid, state%gap)
      cost%pressure_evaluations = cost%pressure_evaluations + n*problem%law%terms
      if (allocated(equations%drainage)) state%pressure = state%pressure + &
        equations%fluid_pressure(control%mesh, state)
      ! The load, equation (20).
      state%load = 2*pi*state%scale**2*dot_product(grid%weight, state%pressure)
      if (grid%is_bounded()) state%load = state%load + 2*pi*load_beyond(problem, &
        gap_at_end(problem%shape, grid, state), load_reach(grid, state))
      if (h0_is_prescribed(control) .and. control%compliance > 0) &
        state%h0 = control%value + control%compliance*state%load
      ! The deformation, equation (14): the rise of the gap is -2 u.
      columns = acting_columns(state%pressure)
      call equations%operator%deform(problem, grid, state%scale, columns, state%pressure, rise)
      if (allocated(equations%earlier)) rise = rise + equations%earlier%at_scale(state%scale)
      cost%operator_products = cost%operator_products + 1
      cost%operator_columns = cost%operator_columns + columns
      ! The given gap less the separation of equation (17).
      do i = 1, n
        g(i) = state%gap(i) - state%h0 - problem%shape%height(state%scale*grid%x(i)) - &
          rise(first_node - 1 + i)
      end do
      ! The axis need not be a node. In a stiff contact the equation for the axis magnifies the
      ! error of interpolated pressures; extrapolation of the gaps at the nodes is more accurate. On
      ! a mesh fixed in space a state may be far from equilibrium, and its gap on the axis must also
      ! follow from the gaps at the nodes.
      state%axis_gap = state%h0 + rise(axis_row)
      if (grid%centre > 0 .or. (equations%meshes%is_fixed() .and. control%kind == at_h0)) &
        state%axis_gap = dot_product(grid%at_axis, state%gap)
      select case (control%kind)
      case (at_axis_gap)
        g(n + 1) = state%axis_gap - control%value
      case (at_edge_radius, at_h0_with_edge)
        edge_gap = state%h0 + problem%shape%height(state%scale) + rise(centre_row)
        g(n + 1) = edge_gap - equations%meshes%locked_gap(control%mesh)
      end select
      state%residual = largest_error(g, state%gap)
    end associate
  end subroutine residual

  !> The largest |G|, relative to the gap for gaps above `far_gap`. NaN and infinity become huge, so
  !> that they never count as converged.
  pure real(wp) function largest_error(g, gap) result(largest)
    real(wp), intent(in) :: g(:), gap(:)
    real(wp) :: error
    integer :: i

    largest = 0
    do i = 1, size(g)
      error = abs(g(i))
      if (.not. error <= huge(error)) then
        largest = huge(error)
        return
      end if
      if (i <= size(gap)) then
        if (gap(i) > far_gap) error = error*(far_gap/gap(i))
      end if
      largest = max(largest, error)
    end do
  end function largest_error

  !> Whether a state is within the range in which pressures and all derived quantities are finite.
  pure logical function defined(problem, state)
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state
    real(wp) :: least
    integer :: i

    defined = abs(state%h0) <= largest_unknown .and. state%scale > 0 .and. &
      state%scale <= largest_unknown
    least = max(problem%law%smallest_gap, -largest_unknown)
    do i = 1, size(state%gap)
      if (.not. defined) return
      defined = state%gap(i) >= least .and. state%gap(i) <= largest_unknown
    end do
  end function defined

  !> The fraction (at most 1) of a step dz from z for which every gap stays within the law's closure
  !> limit and the contact radius changes by at most the fraction 0.3.
  pure real(wp) function largest_step(problem, control, z, dz) result(fraction)
    type(problem_t), intent(in) :: problem
    type(control_t), intent(in) :: control
    real(wp), intent(in) :: z(:), dz(:)
    integer :: n

    n = size(z)
    if (control%kind == at_h0) then
      fraction = limit(z, dz)
    else
      fraction = limit(z(:n - 1), dz(:n - 1))
    end if
    if (control%kind == at_h0_with_edge) &
      fraction = min(fraction, largest_change*z(n)/max(abs(dz(n)), tiny(1.0_wp)))

  contains

    pure real(wp) function limit(gap, step)
      real(wp), intent(in) :: gap(:), step(:)
      real(wp) :: room(size(gap))

      ! A large gap may decrease by many of the law's lengths without any effect.
      room = max(problem%law%closure(gap), harmless*(gap - far_gap))
      ! The quotient could overflow for a step that increases a gap.
      limit = min(1.0_wp, minval(room/max(-step, room, tiny(1.0_wp))))
    end function limit

  end function largest_step

  !> Whether a state is an equilibrium: to the tolerance, or to rounding.
  pure logical function holds(problem, tolerance, state)
    type(problem_t), intent(in) :: problem
    real(wp), intent(in) :: tolerance
    type(state_t), intent(in) :: state

    holds = state%residual <= tolerance
    if (.not. holds) holds = state%residual <= residual_floor(problem, state)
  end function holds

  !> The residual due to rounding alone. It is a few units in the last place of the gaps, plus the
  !> rounding of the sums for the deformation, which grows as the square root of the number of
  !> nodes. The terms of these sums have opposite signs in an adhesive contact (for a uniform
  !> pressure the operator gives at most 2). The result is limited to the residual up to which a
  !> state counts as an equilibrium of the law.
  pure real(wp) function residual_floor(problem, state)
    type(problem_t), intent(in) :: problem
    type(state_t), intent(in) :: state
    real(wp) :: part

    part = 2*max(problem%coupling, coupling_over(problem, state%scale))*state%scale* &
      maxval(abs(state%pressure))
    residual_floor = epsilon(1.0_wp)*(3*(abs(state%h0) + min(maxval(abs(state%gap)), far_gap)) + &
      sqrt(real(size(state%pressure), wp))*part)
    residual_floor = min(residual_floor, largest_floor)
  end function residual_floor

  !> Number of leading columns of the operator that matter: the pressures at later nodes are below
  !> the rounding of the largest pressure.
  pure integer function acting_columns(pressure) result(columns)
    real(wp), intent(in) :: pressure(:)
    real(wp) :: least

    least = 0
    do columns = 1, size(pressure)
      least = max(least, abs(pressure(columns)))
      ! An infinite pressure or NaN must reach the residual.
      if (.not. abs(pressure(columns)) <= huge(1.0_wp)) exit
    end do
    if (columns <= size(pressure)) then
      columns = size(pressure)
      return
    end if
    least = unfelt*epsilon(1.0_wp)*least
    do columns = size(pressure), 1, -1
      if (abs(pressure(columns)) > least) exit
    end do
  end function acting_columns

end module equilibrium
