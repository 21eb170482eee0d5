!> The next state of a branch of equilibria on a mesh fixed in space.
module fixed_branch
  use kinds, only: wp
  use dimensionless_problem, only: over_neck => spacing_over_neck
  use contact_state, only: state_t
  use prediction, only: extrapolated, moved_with_edge
  use stepper, only: stepper_t, branch_point_t
  implicit none
  private
  public :: expected_at, is_expected, is_pinned, change, same_state

  !> Two states are the same if their deformations differ by less than this, in the law's lengths:
  !> far more than the error of an iteration, and less than a jump.
  real(wp), parameter :: same_state = 1.0e-3_wp
  !> If the mesh pins the edge, a state continues the branch if it differs from the expected state
  !> by at most half the expected change plus this many of the law's lengths.
  real(wp), parameter :: slip = 0.05_wp
  !> The edge is not pinned between nodes if their spacing is below this fraction of the width of
  !> the cohesive zone. Change of the gaps, in the law's lengths, after which the factorisation is
  !> renewed.
  real(wp), parameter :: resolved = 0.25_wp, large_change = 0.2_wp

contains

  !> Whether nodes are so far apart that the edge is pinned between them.
  logical function is_pinned(self)
    class(stepper_t), intent(in) :: self

    is_pinned = .not. over_neck(self%problem, self%meshes%grid(1)%spacing) <= resolved
  end function is_pinned

  !> The predicted state of a step to h0.
  type(state_t) function expected_at(self, h0, position) result(expected)
    class(stepper_t), intent(inout) :: self
    real(wp), intent(in) :: h0
    type(branch_point_t), intent(in) :: position

    if (position%held == 0) then
      expected = position%state
    else if (self%options%is_plain_mixing() .or. is_pinned(self)) then
      expected = extrapolated(position, h0)
    else
      expected = moved_with_edge(self%problem, self%meshes%grid(1), position, h0)
      ! The factorisation is no longer useful after the edge has moved by a large part of the
      ! cohesive zone.
      if (change(position%state, expected) > large_change) call self%frozen%forget()
    end if
  end function expected_at

  !> Whether a state is close enough to the expected one; `before`: the state before it.
  pure logical function is_expected(before, expected, state)
    type(state_t), intent(in) :: before, expected, state

    is_expected = change(expected, state) <= 0.5_wp*change(before, expected) + slip
  end function is_expected

  !> Largest difference between the deformations of two states.
  pure real(wp) function change(a, b)
    type(state_t), intent(in) :: a, b

    change = maxval(abs((b%gap - b%h0) - (a%gap - a%h0)))
  end function change

end module fixed_branch
