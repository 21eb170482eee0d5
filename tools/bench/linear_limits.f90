!> linear_limits NODES [NODES ...]: times the library's pieces beside the linear algebra that bounds
!> them from below, on a uniform grid of each number of nodes. One line of comma-separated seconds
!> each; every time is the least of several rounds, and each round has all pieces, so that ratios
!> mean something on a busy machine.
program linear_limits
  use, intrinsic :: iso_fortran_env, only: output_unit
  use kinds, only: wp
  use clock, only: seconds
  use laws, only: law_parameters_t, new_law
  use force_law, only: force_law_t
  use dimensionless_problem, only: problem_t, new_problem
  use discretisation, only: discretisation_t, first_node
  use uniform_grid, only: new_uniform_grid
  use equilibrium, only: control_t, state_t, cost_t, state_from, residual
  use jacobian, only: factorise_jacobian
  use linear_algebra, only: multiply, factorisation_t, factorise, solve
  use mixing, only: solve_mixing
  use anderson, only: frozen_jacobian_t, solve_anderson
  use solver_options, only: solver_options_t
  use blas_threads, only: use_threads_for
  implicit none

  !> assembly: the kernel. residual: one evaluation of the equations, dgemv in it. mixing, anderson,
  !> newton: one iteration; Anderson keeps its factors and solves with them (dgetrs). dgesv is the
  !> linear algebra of a Newton step.
  character(len=8), parameter :: pieces(*) = [character(len=8) :: 'assembly', 'dgemv', 'residual', &
    'mixing', 'dgetrs', 'anderson', 'dgesv', 'newton']
  integer, parameter :: rounds = 7, most_repeats = 200, iterations = 5
  !> Seconds that a piece may take in one round, and those above which three rounds must do.
  real(wp), parameter :: slice = 0.02_wp, long = 1
  !> Before contact every node acts.
  real(wp), parameter :: h0 = 4, extent = 12

  type(problem_t) :: this
  type(discretisation_t) :: grid
  type(control_t) :: control
  type(solver_options_t) :: plain, newton
  type(frozen_jacobian_t) :: kept, fresh
  type(factorisation_t) :: matrix
  type(state_t) :: start, state
  type(cost_t) :: cost
  real(wp), allocatable :: g(:), y(:)
  real(wp) :: least(size(pieces)), once
  character(len=16) :: argument
  integer :: k, piece, round

  this = some_problem()
  control%value = h0
  ! No iteration ends early.
  plain%tolerance = 0
  plain%most_iterations = iterations
  plain%patience = 100
  newton = plain
  newton%most_iterations = 1
  newton%patience = 1
  newton%depth = 0

  write (output_unit, '(*(a, :, ","))') 'nodes', (trim(pieces(piece)), piece=1, size(pieces))
  do k = 1, command_argument_count()
    call get_command_argument(k, argument)
    read (argument, *) round
    call prepare(round)
    least = huge(1.0_wp)
    do round = 1, rounds
      do piece = 1, size(pieces)
        if (round > 3 .and. least(piece) > long) cycle
        once = duration(pieces(piece), 1)
        least(piece) = min(least(piece), &
          duration(pieces(piece), max(1, min(most_repeats, int(slice/max(once, 1.0e-7_wp))))))
      end do
    end do
    write (output_unit, '(i0, *(:, ",", es11.4))') grid%nodes, least
    flush (output_unit)
  end do

contains

  !> Lennard-Jones bodies at sigma 0.87.
  function some_problem() result(this)
    type(problem_t) :: this
    class(force_law_t), allocatable :: law
    type(law_parameters_t) :: parameters

    parameters%law = 'lennard_jones'
    parameters%part = 'full'
    parameters%hamaker = 1.0e-20_wp
    parameters%z0 = 0.5e-9_wp
    call new_law(parameters, law)
    this = new_problem(law, 1.5e-2_wp, 1.0e10_wp, .false.)
  end function some_problem

  !> Grid, guess and matrices.
  subroutine prepare(nodes)
    integer, intent(in) :: nodes

    call use_threads_for(nodes)
    grid = new_uniform_grid(nodes, extent, .true.)
    start = state_from(nodes)
    start%h0 = h0
    start%gap = h0 + 0.5_wp*grid%x**2
    g = start%gap
    call residual(this, grid, control, start%gap, g, start, cost)
    ! Factors that do not fit: the iteration then goes on.
    state = start
    state%gap = 0.5_wp*state%gap
    call factorise_jacobian(this, grid, control, state, kept%factors, cost)
    kept%control_kind = control%kind
    y = [0.0_wp, 0.0_wp, g]
  end subroutine prepare

  !> Mean seconds of a piece over a number of repeats.
  real(wp) function duration(piece, repeats)
    character(len=*), intent(in) :: piece
    integer, intent(in) :: repeats
    type(discretisation_t) :: another
    real(wp) :: began, rest
    integer :: i, steps
    logical :: converged

    steps = 0
    rest = 0
    began = seconds()
    do i = 1, repeats
      steps = steps + 1
      select case (piece)
      case ('assembly')
        another = new_uniform_grid(grid%nodes, extent, .true.)
      case ('dgemv')
        call multiply(grid%kernel, grid%nodes, start%pressure, y)
      case ('residual')
        call residual(this, grid, control, start%gap, g, state, cost)
      case ('mixing')
        state = start
        call solve_mixing(this, grid, control, plain, state, converged, cost)
        steps = steps + state%iterations - 1
      case ('dgetrs')
        g = 1
        call solve(kept%factors, g)
      case ('anderson')
        state = start
        call solve_anderson(this, grid, control, plain, kept, state, converged, cost)
        steps = steps + state%iterations - 1
      case ('dgesv')
        rest = rest - seconds()
        call some_matrix(matrix)
        g = 1
        rest = rest + seconds()
        call factorise(matrix)
        call solve(matrix, g)
      case ('newton')
        state = start
        fresh%factors%valid = .false.
        call solve_anderson(this, grid, control, newton, fresh, state, converged, cost)
      end select
    end do
    duration = (seconds() - began - rest)/steps
  end function duration

  !> A matrix like the Jacobian.
  subroutine some_matrix(matrix)
    type(factorisation_t), intent(inout) :: matrix
    integer :: i

    matrix%lu = -0.1_wp*grid%kernel(first_node:, :)
    do i = 1, grid%nodes
      matrix%lu(i, i) = matrix%lu(i, i) + 1
    end do
  end subroutine some_matrix

end program linear_limits
