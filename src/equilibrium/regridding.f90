!> The passage of a state from one mesh to another.
module regridding
  use kinds, only: wp
  use shape, only: shape_t
  use discretisation, only: discretisation_t
  use equilibrium, only: state_t
  implicit none
  private
  public :: regrid

contains

  !> The state on another mesh (or a shorter or longer part of the same), at the scale given: gaps
  !> interpolated, and beyond the old mesh those of a deformation that decays as 1/r.
  pure function regrid(shape, state, from, to, scale, nodes) result(new)
    class(shape_t), intent(in) :: shape
    type(state_t), intent(in) :: state
    type(discretisation_t), intent(in) :: from, to
    real(wp), intent(in) :: scale
    integer, intent(in) :: nodes
    type(state_t) :: new
    real(wp) :: r, last, raised
    integer :: j, n

    n = size(state%gap)
    last = state%scale*from%x(n)
    raised = state%gap(n) - state%h0 - shape%height(last)
    new = state
    deallocate (new%gap, new%pressure)
    allocate (new%gap(nodes), new%pressure(nodes))
    new%pressure = 0
    new%scale = scale
    do j = 1, nodes
      r = scale*to%x(j)
      if (r <= last) then
        new%gap(j) = from%interpolate(state%gap, r/state%scale)
      else
        new%gap(j) = state%h0 + shape%height(r) + raised*last/r
      end if
    end do
  end function regrid

end module regridding
