!> Transfers a state from one mesh to another.
module regridding
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use contact_state, only: state_t, gap_at, gaps_at
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
    real(wp) :: raised
    integer :: within

    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(to%nodes), new%pressure(to%nodes))
    new%pressure = 0
    new%scale = scale
    associate (x => to%x*(scale/state%scale), gap => new%gap)
      within = count(x <= from%end)
      gap(:within) = gaps_at(shape, from, state, x(:within))
      if (within == to%nodes) return
      raised = gap_at(shape, from, state, from%end) - state%h0 - &
        shape%height(state%scale*from%end)
      gap(within + 1:) = state%h0 + raised*from%end/x(within + 1:) + &
        shape%height(state%scale*x(within + 1:))
    end associate
  end function regrid

end module regridding
