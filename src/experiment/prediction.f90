!> The prediction of the next state. On a mesh fixed in space it is extrapolated from earlier
!> states. Along the path it is the state of the path's polynomial, corrected by the extrapolated
!> errors of this polynomial at earlier states.
module prediction
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use discretisation, only: discretisation_t
  use interpolation, only: polynomial_weights
  use contact_state, only: state_t, radius_of_gap, too_near
  use solver, only: solver_t
  use arc, only: between
  use path_coordinate, only: coordinate_of
  use path_span, only: path_span_t
  use stepper, only: branch_point_t, memory
  implicit none
  private
  public :: extrapolated, moved_with_edge, missed_t, expect

  !> The errors of a span at the past states of an experiment. Number and h0 identify a state, since
  !> numbers alone repeat from branch to branch. For each state the type has its coordinate and the
  !> corrections of H0, scale and gaps (one column for each state). The errors depend only on the
  !> span and on the past states, and are computed anew when one of these changes.
  type :: missed_t
    private
    integer :: held = 0, number(memory) = 0
    real(wp), dimension(memory) :: state_h0 = 0, at = 0, h0 = 0, scale = 0
    real(wp), allocatable :: gap(:, :)
  contains
    procedure :: clear
    procedure, private :: follow
    procedure, private :: first_of_use
  end type missed_t

  !> The largest sum of absolute weights in the extrapolation of a span's errors: an extrapolation
  !> far beyond the past states is useless.
  real(wp), parameter :: most_weight = 100

contains

  !> The state at h0 extrapolated from a position's past, node by node.
  type(state_t) function extrapolated(position, h0) result(expected)
    type(branch_point_t), intent(in) :: position
    real(wp), intent(in) :: h0

    expected = between(position%h0(:position%held), position%past(:position%held), h0)
    if (position%held == 1) expected%gap = expected%gap + (h0 - position%state%h0)
    expected%h0 = h0
  end function extrapolated

  !> The extrapolated state. Contact radius, and deformation at a fixed ratio of radius to contact
  !> radius, are extrapolated, so that sharp features at the edge move with it. Without contact the
  !> extrapolation is node by node.
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
    if (too_near(expected%gap, position%state%gap)) expected = extrapolated(position, h0)
  end function moved_with_edge

  !> Removes the errors of another span.
  pure subroutine clear(self)
    class(missed_t), intent(inout) :: self

    self%held = 0
  end subroutine clear

  !> The predicted state at h0, where the span has the coordinate s: the state of the span,
  !> corrected by the extrapolated errors of the last states.
  subroutine expect(solver, span, missed, h0, s, position, state)
    class(solver_t), intent(in) :: solver
    type(path_span_t), intent(in) :: span
    type(missed_t), intent(inout) :: missed
    real(wp), intent(in) :: h0, s
    type(branch_point_t), intent(in) :: position
    type(state_t), intent(inout) :: state
    real(wp) :: weight(memory), place
    integer :: k, first, round

    call missed%follow(solver, span, position)
    first = missed%first_of_use(span, s)
    place = s
    ! The correction and the coordinate depend on each other; two rounds are enough for both.
    if (first <= missed%held) then
      do round = 1, 2
        weight(first:missed%held) = polynomial_weights(missed%at(first:missed%held), place)
        place = span%at_h0(h0 - dot_product(weight(first:missed%held), &
          missed%h0(first:missed%held)))
      end do
    end if
    call span%expected(solver, place, state)
    do k = first, missed%held
      state%gap = state%gap + weight(k)*missed%gap(:, k)
      state%scale = state%scale + weight(k)*missed%scale(k)
    end do
  end subroutine expect

  !> Computes the errors for the position's past; those of known states are kept.
  subroutine follow(self, solver, span, position)
    class(missed_t), intent(inout) :: self
    class(solver_t), intent(in) :: solver
    type(path_span_t), intent(in) :: span
    type(branch_point_t), intent(in) :: position
    type(state_t) :: guessed
    integer :: j, k, n

    if (position%mesh /= span%mesh .or. position%held == 0) then
      ! The errors of another branch say nothing about this one.
      self%held = 0
      return
    end if
    n = size(position%past(1)%gap)
    if (self%held == position%held) then
      if (all(self%number(:self%held) == position%past_number(:self%held) .and. &
        abs(self%state_h0(:self%held) - position%h0(:self%held)) <= 0)) return
    end if
    if (allocated(self%gap)) then
      if (size(self%gap, 1) /= n) deallocate (self%gap)
    end if
    if (.not. allocated(self%gap)) then
      allocate (self%gap(n, memory))
      self%held = 0
    end if
    ! States leave and enter the past in order, so no state moves to a later index.
    do k = 1, position%held
      j = findloc(self%number(:self%held), position%past_number(k), 1)
      if (j > 0) then
        if (abs(self%state_h0(j) - position%h0(k)) > 0) j = 0
      end if
      if (j == 0) then
        associate (past => position%past(k))
          self%at(k) = coordinate_of(solver%problem, solver%meshes, span%mesh, past)
          call span%expected(solver, self%at(k), guessed)
          self%h0(k) = past%h0 - guessed%h0
          self%scale(k) = past%scale - guessed%scale
          self%gap(:, k) = past%gap - guessed%gap
        end associate
      else if (j /= k) then
        self%at(k) = self%at(j)
        self%h0(k) = self%h0(j)
        self%scale(k) = self%scale(j)
        self%gap(:, k) = self%gap(:, j)
      end if
      self%number(k) = position%past_number(k)
      self%state_h0(k) = position%h0(k)
    end do
    self%held = position%held
  end subroutine follow

  !> The first past state from which the span's errors can be extrapolated to the coordinate s; the
  !> number of past states plus one if there is none.
  pure integer function first_of_use(self, span, s) result(first)
    class(missed_t), intent(in) :: self
    type(path_span_t), intent(in) :: span
    real(wp), intent(in) :: s

    associate (at => self%at(:self%held), last => self%held)
      do first = 1, last
        ! A span's polynomial is accurate within its own length only. States whose coordinates
        ! differ only by rounding are useless for an extrapolation.
        if (abs(at(first) - s) > abs(span%ends(2) - span%ends(1))) cycle
        if (any(abs(at(first + 1:) - at(first:last - 1)) <= 0)) cycle
        if (sum(abs(polynomial_weights(at(first:), s))) <= most_weight) exit
      end do
    end associate
  end function first_of_use

end module prediction
