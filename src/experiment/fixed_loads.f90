!> All equilibria under given loads, stable or not, wherever they are on the path.
module fixed_loads
  use kinds, only: wp
  use solver, only: solver_t
  use path_tangent, only: of_load
  use traced_path, only: traced_path_t
  use curve_states, only: curve_state_t, state_where, find_turns
  implicit none
  private
  public :: loaded_state_t, find_loaded

  !> An equilibrium under a load (units of `dimensionless_problem`). It is stable at fixed load
  !> where no mode is unstable at fixed h0 and dF/dh0 < 0.
  type :: loaded_state_t
    real(wp) :: wanted = 0
    type(curve_state_t) :: state
    logical :: stable = .false.
  end type loaded_state_t

contains

  !> Adds the equilibria under a load in the order of the path, from afar inward. solved = .false.:
  !> one was not found.
  subroutine find_loaded(solver, path, load, list, solved)
    class(solver_t), intent(inout) :: solver
    type(traced_path_t), intent(in) :: path
    real(wp), intent(in) :: load
    type(loaded_state_t), allocatable, intent(inout) :: list(:)
    logical, intent(inout) :: solved
    type(loaded_state_t) :: found
    type(curve_state_t), allocatable :: turns(:)
    real(wp), allocatable :: edges(:), beyond(:)
    integer :: i, k
    logical :: all_turns

    found%wanted = load
    do i = 1, path%last - 1
      if (.not. path%point(i)%leads_on) cycle
      call find_turns(solver, path, i, of_load, turns, all_turns)
      solved = solved .and. all_turns
      associate (ends => path%point(i:i + 1))
        edges = [ends(1)%coordinate, turns%x, ends(2)%coordinate]
        beyond = [ends(1)%state%load, turns%load, ends(2)%state%load] - load
      end associate
      do k = 1, size(edges) - 1
        if ((beyond(k) < 0) .eqv. (beyond(k + 1) < 0)) cycle
        call state_where(solver, path, i, of_load, load, edges(k), edges(k + 1), found%state)
        solved = solved .and. found%state%converged
        if (.not. found%state%converged) cycle
        ! Inward h0 falls along what is stable at fixed h0.
        found%stable = found%state%modes == 0 .and. found%state%slopes(2) > 0
        list = [list, found]
      end do
    end do
  end subroutine find_loaded

end module fixed_loads
