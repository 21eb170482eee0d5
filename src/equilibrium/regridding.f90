!> The passage of a state from one mesh to another.
module regridding
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t, above_parabola
  implicit none
  private
  public :: regrid

contains

  !> The state on another mesh, at the scale given: what bodies and forces add to the parabola is
  !> interpolated, and beyond the old mesh it decays to H0 as 1/r.
  pure function regrid(state, from, to, scale) result(new)
    type(state_t), intent(in) :: state
    type(discretisation_t), intent(in) :: from, to
    real(wp), intent(in) :: scale
    type(state_t) :: new
    real(wp) :: r, at_end, raised(from%nodes)
    integer :: j

    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(to%nodes), new%pressure(to%nodes))
    new%pressure = 0
    new%scale = scale
    raised = above_parabola(from, state)
    at_end = 0
    if (from%is_bounded()) at_end = from%interpolate(raised, from%end) - state%h0
    do j = 1, to%nodes
      r = scale*to%x(j)
      if (r/state%scale <= from%end) then
        new%gap(j) = from%interpolate(raised, r/state%scale) + 0.5_wp*r**2
      else
        new%gap(j) = state%h0 + at_end*state%scale*from%end/r + 0.5_wp*r**2
      end if
    end do
  end function regrid

end module regridding
