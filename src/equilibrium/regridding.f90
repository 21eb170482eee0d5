!> Transfers a state from one mesh to another.
module regridding
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t, gap_at
  implicit none
  private
  public :: regrid

contains

  !> The state on another mesh at a given scale. Gaps are interpolated; beyond the old mesh the
  !> deformation decays as 1/r.
  pure type(state_t) function regrid(shape, state, from, to, scale) result(new)
    class(shape_t), intent(in) :: shape
    type(state_t), intent(in) :: state
    type(discretisation_t), intent(in) :: from, to
    real(wp), intent(in) :: scale
    real(wp) :: r, raised
    integer :: j

    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(to%nodes), new%pressure(to%nodes))
    new%pressure = 0
    new%scale = scale
    raised = 0
    if (from%is_bounded()) raised = gap_at(shape, from, state, from%end) - state%h0 - &
      shape%height(state%scale*from%end)
    do j = 1, to%nodes
      r = scale*to%x(j)
      if (r/state%scale <= from%end) then
        new%gap(j) = gap_at(shape, from, state, r/state%scale)
      else
        new%gap(j) = state%h0 + raised*state%scale*from%end/r + shape%height(r)
      end if
    end do
  end function regrid

end module regridding
