!> The passage of a state from one mesh to another.
module regridding
  use kinds, only: wp
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t, gap_at
  implicit none
  private
  public :: regrid

contains

  !> The state on another mesh, at the scale given: gaps interpolated, and beyond the old mesh those
  !> of a deformation that decays as 1/r.
  pure function regrid(state, from, to, scale) result(new)
    type(state_t), intent(in) :: state
    type(discretisation_t), intent(in) :: from, to
    real(wp), intent(in) :: scale
    type(state_t) :: new
    real(wp) :: r, raised
    integer :: j

    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(to%nodes), new%pressure(to%nodes))
    new%pressure = 0
    new%scale = scale
    raised = 0
    if (from%is_bounded()) raised = gap_at(from, state, from%end) - state%h0 - &
      0.5_wp*(state%scale*from%end)**2
    do j = 1, to%nodes
      r = scale*to%x(j)
      if (r/state%scale <= from%end) then
        new%gap(j) = gap_at(from, state, r/state%scale)
      else
        new%gap(j) = state%h0 + raised*state%scale*from%end/r + 0.5_wp*r**2
      end if
    end do
  end function regrid

end module regridding
