!> One state of two elastic bodies, solved by the library. With an installed library:
!>
!>     gfortran one_state.f90 $(pkg-config --cflags --libs snapin) -o one_state
program one_state
  use solved_deck, only: solved_deck_t, solve_deck
  use failure, only: failure_t
  implicit none
  type(solved_deck_t) :: solved
  type(failure_t), allocatable :: error
  integer :: i

  call solve_deck('&bodies radius = 1.5e-2, stiffness = 1e10 / ' // &
    '&force law = "lennard_jones", hamaker = 1e-20, z0 = 0.5e-9 / ' // &
    '&equilibrium_path h0_end = 0 / &profiles h0 = 2e-9 /', solved, error)
  if (allocated(error)) error stop error%message
  associate (state => solved%state(1))
    print '(3(a, es13.6))', 'load', state%load, ' N, gap on the axis', state%h_centre, &
      ' m, relative error of the profile', solved%summary%number('profiles_error')
    print '(2es14.6)', (state%profile%r(i), state%profile%pressure(i), i=1, size(state%profile%r))
  end associate
  print '(a)', (solved%summary%warnings(i)%text, i=1, size(solved%summary%warnings))
end program one_state
