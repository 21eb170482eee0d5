!> One state of two elastic bodies, solved by the library. With an installed library:
!>
!>     gfortran one_state.f90 $(pkg-config --cflags --libs snapin) -o one_state
program one_state
  use kinds, only: wp
  use failure, only: failure_t
  use scene, only: scene_t, read_scene
  use scene_problem, only: problem_of
  use linear_mesh, only: new_uniform_grid
  use contact_state, only: state_t, undeformed_state
  use controls, only: control_t
  use solver, only: solver_t
  implicit none
  character(len=*), parameter :: deck = '&bodies radius = 1.5e-2, stiffness = 1e10 / ' // &
    '&force law = "lennard_jones", hamaker = 1e-20, z0 = 0.5e-9 / &equilibrium_path h0_end = 0 /'
  type(scene_t) :: scene
  type(solver_t) :: bodies
  type(state_t) :: state
  type(failure_t), allocatable :: error
  real(wp) :: h0
  logical :: converged

  call read_scene('deck', scene, error, deck)
  if (allocated(error)) then
    print '(a)', error%message
    error stop 1
  end if
  bodies%problem = problem_of(scene)
  allocate (bodies%meshes%grid(1))
  bodies%meshes%grid(1) = new_uniform_grid(800, 30.0_wp, .true.)
  h0 = 2.0e-9_wp/bodies%problem%length
  state = undeformed_state(bodies%problem%shape, bodies%meshes%grid(1), h0, 1.0_wp)
  call bodies%solve(control_t(value=h0), state, converged)
  print '(a, l2, 2(a, es13.6), a)', 'converged:', converged, ', gap on the axis', &
    state%axis_gap*bodies%problem%length, ' m, load', state%load*bodies%problem%load, ' N'
end program one_state
