!> What the next state along the path is expected to be: what a span of it has there, and by how
!> much that missed the states before.
module path_prediction
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use interpolation, only: polynomial_weights
  use contact_state, only: state_t
  use path_coordinate, only: coordinate_of
  use path_span, only: path_span_t
  use stepper, only: branch_point_t
  implicit none
  private
  public :: expect

  !> The largest sum of the weights of states that tell by how much a span misses the next: an
  !> extrapolation far beyond them tells nothing.
  real(wp), parameter :: most_weight = 100

contains

  !> The state that is expected at h0, where the span has the coordinate s: that of the span, and by
  !> how much it missed the last states, extrapolated.
  subroutine expect(problem, span, h0, s, position, state)
    type(problem_t), intent(in) :: problem
    type(path_span_t), intent(inout) :: span
    real(wp), intent(in) :: h0, s
    type(branch_point_t), intent(in) :: position
    type(state_t), intent(out) :: state
    real(wp), dimension(position%held) :: at, weight, missed
    real(wp) :: place
    integer :: there(position%held)
    integer :: k, first, round

    call choose_past(problem, span, s, position, at, first)
    call span%recall(at(first:), there(first:))
    do k = first, position%held
      missed(k) = position%h0(k) - span%recalled(there(k))%h0
    end do
    ! What it missed by says where the state is, and the place says what it misses by.
    place = s
    do round = 1, 2
      weight(first:) = polynomial_weights(at(first:), place)
      place = span%at_h0(h0 - dot_product(weight(first:), missed(first:)))
    end do
    state = span%guess(place)
    do k = first, position%held
      associate (past => position%past(k), guessed => span%recalled(there(k)))
        state%gap = state%gap + weight(k)*(past%gap - guessed%gap)
        state%scale = state%scale + weight(k)*(past%scale - guessed%scale)
      end associate
    end do
  end subroutine expect

  !> The first of the past states from which it can be extrapolated to the coordinate s by how much
  !> the span missed them; one more than there are: none. at: their coordinates.
  pure subroutine choose_past(problem, span, s, position, at, first)
    type(problem_t), intent(in) :: problem
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: s
    type(branch_point_t), intent(in) :: position
    real(wp), intent(out) :: at(:)
    integer, intent(out) :: first
    integer :: k

    first = position%held + 1
    if (position%mesh == span%mesh) first = 1
    do k = first, position%held
      at(k) = coordinate_of(problem, span%mesh, position%past(k))
    end do
    do first = first, position%held
      ! A span's polynomial is good for no more than its length; and states whose places differ in
      ! rounding alone tell nothing of a third.
      if (abs(at(first) - s) > abs(span%ends(2) - span%ends(1))) cycle
      if (any(abs(at(first + 1:) - at(first:position%held - 1)) <= 0)) cycle
      if (sum(abs(polynomial_weights(at(first:), s))) <= most_weight) exit
    end do
  end subroutine choose_past

end module path_prediction
