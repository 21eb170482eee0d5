!> linear_limits [PIECE ...] NODES [NODES ...]: times the library's pieces, or the given ones, and
!> the linear algebra that bounds them from below, on a uniform grid of each number of nodes.
!> Output: one line of comma-separated processor seconds for each; every time is the least of
!> several rounds, and each round has all pieces, so that ratios are meaningful on a busy machine.
program linear_limits
  use, intrinsic :: iso_fortran_env, only: output_unit
  use kinds, only: wp
  use failure, only: failure_t
  use scene, only: read_scene, scene_t
  use scene_problem, only: problem_of
  use discretisation, only: discretisation_t, first_node
  use linear_mesh, only: new_uniform_grid
  use contact_state, only: undeformed_state, state_t
  use controls, only: control_t
  use equilibrium, only: equations_t, residual
  use frozen_jacobian, only: frozen_jacobian_t, freeze
  use linear_algebra, only: factorisation_t, factorise, solve
  use matrix_products, only: multiply
  use mixing, only: solve_mixing
  use anderson, only: solve_anderson
  use solver_options, only: solver_options_t
  use machine, only: use_threads_for
  implicit none

  !> assembly: the kernel. residual: one evaluation of the equations, dgemv in it. mixing, anderson,
  !> newton: one iteration; Anderson keeps its factors and solves with them (dgetrs). dgesv is the
  !> linear algebra of a Newton step.
  character(len=8), parameter :: pieces(*) = [character(len=8) :: 'assembly', 'dgemv', 'residual', &
    'mixing', 'dgetrs', 'anderson', 'dgesv', 'newton']
  !> Lennard-Jones bodies at sigma 0.87.
  character(len=*), parameter :: deck = '&bodies radius = 1.5e-2, stiffness = 1e10 / ' // &
    '&force law = ''lennard_jones'', hamaker = 1e-20, z0 = 0.5e-9 / ' // &
    '&equilibrium_path h0_end = 0 /'
  integer, parameter :: rounds = 7, most_repeats = 200, iterations = 5
  !> Largest number of seconds of a piece in one round, and seconds above which three rounds are
  !> enough.
  real(wp), parameter :: slice = 0.02_wp, long = 1
  !> Before contact every node has a pressure.
  real(wp), parameter :: h0 = 4, extent = 12

  type(equations_t) :: equations
  type(control_t) :: control
  type(solver_options_t) :: plain, newton
  type(frozen_jacobian_t) :: kept, fresh
  type(factorisation_t) :: matrix
  type(state_t) :: start, state
  real(wp), allocatable :: g(:), y(:)
  real(wp) :: least(size(pieces)), once
  logical :: wanted(size(pieces))
  character(len=16) :: argument
  integer :: k, piece, round, status

  call pose()
  control%value = h0
  ! No iteration ends early.
  plain%tolerance = 0
  plain%most_iterations = iterations
  plain%patience = 100
  newton = plain
  newton%most_iterations = 1
  newton%patience = 1
  newton%depth = 0

  wanted = .false.
  do k = 1, command_argument_count()
    call get_command_argument(k, argument)
    where (pieces == argument) wanted = .true.
  end do
  if (.not. any(wanted)) wanted = .true.
  write (output_unit, '(a)', advance='no') 'nodes'
  do piece = 1, size(pieces)
    if (wanted(piece)) write (output_unit, '(2a)', advance='no') ',', trim(pieces(piece))
  end do
  write (output_unit, '(a)') ''
  do k = 1, command_argument_count()
    call get_command_argument(k, argument)
    read (argument, *, iostat=status) round
    if (status /= 0) cycle
    call prepare(round)
    least = huge(1.0_wp)
    do round = 1, rounds
      do piece = 1, size(pieces)
        if (.not. wanted(piece) .or. round > 3 .and. least(piece) > long) cycle
        once = duration(pieces(piece), 1)
        least(piece) = min(least(piece), &
          duration(pieces(piece), max(1, min(most_repeats, int(slice/max(once, 1.0e-7_wp))))))
      end do
    end do
    write (output_unit, '(i0, *(:, ",", es11.4))') size(start%gap), pack(least, wanted)
    flush (output_unit)
  end do

contains

  subroutine pose()
    type(scene_t) :: scene
    type(failure_t), allocatable :: error

    call read_scene('deck', scene, error, deck)
    if (allocated(error)) error stop 'the deck of linear_limits is wrong'
    equations%problem = problem_of(scene)
    allocate (equations%meshes%grid(1))
  end subroutine pose

  !> Grid, guess and matrices.
  subroutine prepare(nodes)
    integer, intent(in) :: nodes

    call use_threads_for(nodes)
    equations%meshes%grid(1) = new_uniform_grid(nodes, extent, .true.)
    start = undeformed_state(equations%problem%shape, equations%meshes%grid(1), h0, 1.0_wp)
    g = start%gap
    call residual(equations, control, start%gap, g, start)
    ! Inaccurate factors, so that the iteration continues.
    state = start
    state%gap = 0.5_wp*state%gap
    call freeze(equations, control, state, kept)
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
        another = new_uniform_grid(size(start%gap), extent, .true.)
      case ('dgemv')
        call multiply(equations%meshes%grid(1)%kernel, size(start%gap), start%pressure, y)
      case ('residual')
        call residual(equations, control, start%gap, g, state)
      case ('mixing')
        state = start
        call solve_mixing(equations, plain, control, state, converged)
        steps = steps + state%iterations - 1
      case ('dgetrs')
        g = 1
        call solve(kept%factors, g)
      case ('anderson')
        state = start
        kept%excess = 0
        call solve_anderson(equations, plain, kept, control, state, converged)
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
        call solve_anderson(equations, newton, fresh, control, state, converged)
      end select
    end do
    duration = (seconds() - began - rest)/steps
  end function duration

  !> Processor time [s], which other work on the machine does not change.
  real(wp) function seconds()
    call cpu_time(seconds)
  end function seconds

  !> A matrix similar to the Jacobian.
  subroutine some_matrix(matrix)
    type(factorisation_t), intent(inout) :: matrix
    integer :: i

    matrix%lu = -0.1_wp*equations%meshes%grid(1)%kernel(first_node:, :)
    do i = 1, size(start%gap)
      matrix%lu(i, i) = matrix%lu(i, i) + 1
    end do
  end subroutine some_matrix

end program linear_limits
