!> The prediction of the next state on a mesh fixed in space.
module prediction
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use interpolation, only: polynomial_weights
  use contact_state, only: state_t, radius_of_gap
  use stepper, only: branch_point_t
  use arc, only: between
  implicit none
  private
  public :: extrapolated, moved_with_edge, towards_fold

contains

  !> The state at h0 extrapolated from a position's past, node by node.
  type(state_t) function extrapolated(position, h0) result(expected)
    type(branch_point_t), intent(in) :: position
    real(wp), intent(in) :: h0

    expected = between(position%h0(:position%held), position%past(:position%held), h0)
    if (position%held == 1) expected%gap = expected%gap + (h0 - position%state%h0)
    expected%h0 = h0
  end function extrapolated

  !> The extrapolated state, with the deformation extrapolated at fixed distances relative to the
  !> contact radius, which is extrapolated too: sharp features at the edge move with it. Without
  !> contact the extrapolation is node by node.
  type(state_t) function moved_with_edge(problem, mesh, position, h0) result(expected)
    type(problem_t), intent(in) :: problem
    type(discretisation_t), intent(in) :: mesh
    type(branch_point_t), intent(in) :: position
    real(wp), intent(in) :: h0
    real(wp) :: weight(position%held), radius(position%held), c
    real(wp), allocatable :: deformation(:), height(:)
    integer :: i, k

    expected = extrapolated(position, h0)
    do k = 1, position%held
      radius(k) = radius_of_gap(problem%shape, problem%law%edge_gap, mesh, position%past(k))
    end do
    if (position%held < 2 .or. .not. minval(radius) > 0) return
    weight = polynomial_weights(position%h0(:position%held), h0)
    c = dot_product(weight, radius)
    ! An edge that is extrapolated to half or twice its earlier radius is useless.
    if (.not. (c > 0.5_wp*minval(radius) .and. c < 2*maxval(radius))) return
    height = problem%shape%height(mesh%x(:mesh%nodes))
    expected%gap = h0 + height
    do k = 1, position%held
      deformation = position%past(k)%gap - position%h0(k) - height
      do i = 1, mesh%nodes
        expected%gap(i) = expected%gap(i) + weight(k)*mesh%interpolate(deformation, &
          min(mesh%x(i)*radius(k)/c, mesh%x(mesh%nodes)))
      end do
    end do
    if (minval(expected%gap) < 0.5_wp*minval(position%state%gap)) &
      expected = extrapolated(position, h0)
  end function moved_with_edge

  !> The predicted state at h0 on a branch that changes at the rate dH/dH0 and has a fold at a
  !> distance: the change is proportional to the square root of the distance from the fold.
  pure type(state_t) function towards_fold(state, rate, h0, distance) result(expected)
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: rate(:), h0, distance
    real(wp) :: way

    way = min(abs(h0 - state%h0)/distance, 1.0_wp)
    expected = state
    expected%h0 = h0
    expected%gap = state%gap + 2*sign(distance, h0 - state%h0)*(1 - sqrt(1 - way))*rate
    if (minval(expected%gap) < 0.5_wp*minval(state%gap) .and. minval(state%gap) > 0) &
      expected%gap = state%gap
  end function towards_fold

end module prediction
