!> The record of the traced equilibrium path: its points in order from afar inward, among them every
!> fold in h0 and every extremum of the load, and how many modes of the bodies are unstable between
!> one point and the next.
!>
!> A fold is an extremum of h0 along the path. Whether stability is lost or gained there follows
!> from the sense of turning in the plane of h0 and load (Maddocks, Arch. Rational Mech. Anal. 99,
!> 1987): with primes for derivatives along the path, an eigenvalue of the operator passes zero
!> upward where h0'' F' > 0. Far apart there are none below zero. Alternating signs would not do:
!> of the two folds that follow the jump into contact at large sigma, the first makes a second mode
!> unstable.
module traced_path
  use kinds, only: wp
  use dimensionless_problem, only: problem_t
  use equilibrium, only: state_t, equations_t
  use solver_options, only: solver_options_t, tightened
  use edge_locked, only: approach
  use reported, only: error_t, measure_t
  use path_extremum, only: extremum_t, polish_extremum, of_h0, of_load
  use continuation, only: continuation_t
  use hidden_folds, only: find_hidden_folds
  implicit none
  private
  public :: traced_path_t, path_point_t, extend, collapsed

  !> One equilibrium of the path.
  type :: path_point_t
    type(state_t) :: state
    !> The mesh that it was solved on and its coordinate there (`continuation`).
    integer :: mesh = approach
    real(wp) :: coordinate = 0
    !> Unstable modes from here to the next point.
    integer :: modes = 0
    !> Whether it is an extremum, of h0 or of the load.
    logical :: fold = .false., load_extremum = .false.
    !> The last two equilibria before the mesh changes, on the next mesh too: every piece of
    !> the path has both its ends on one mesh.
    type(state_t), allocatable :: twin
    !> What it is on a finer mesh, and its errors: once they were estimated.
    type(measure_t), allocatable :: fine
    type(error_t), allocatable :: error
  end type path_point_t

  type :: traced_path_t
    integer :: held = 0
    type(path_point_t), allocatable :: point(:)
  contains
    procedure :: modes_at
    procedure :: seen_on
    procedure :: mesh_between
  end type traced_path_t

  !> Without repulsion the bodies fall onto each other once they have jumped, and the path goes on
  !> to no gap at all. What is left of the gap at the first fold when it is followed no farther,
  !> and if there is no fold, how many of the law's lengths.
  real(wp), parameter :: collapse = 0.3_wp
  !> A load over the law's adhesion below which it is none: its extrema are of no consequence.
  real(wp), parameter :: no_load = 1.0e-16_wp

contains

  !> Whether the newest state of a path is one of collapse.
  pure logical function collapsed(problem, path)
    type(problem_t), intent(in) :: problem
    type(traced_path_t), intent(in) :: path
    real(wp) :: scale
    integer :: first

    collapsed = .false.
    if (problem%law%edge_gap > 0) return
    scale = 1
    first = findloc(path%point(:path%held)%fold, .true., 1)
    if (first > 0) scale = path%point(first)%state%axis_gap
    collapsed = path%point(path%held)%state%axis_gap < collapse*scale
  end function collapsed

  !> Unstable modes of the i-th point; a fold has those of its more unstable side.
  pure integer function modes_at(self, i)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i

    modes_at = self%point(i)%modes
    if (self%point(i)%fold .and. i > 1) modes_at = max(modes_at, self%point(i - 1)%modes)
  end function modes_at

  !> The i-th point on a mesh: its state and coordinate there. there = .false.: it has none.
  pure subroutine seen_on(self, i, mesh, state, coordinate, there)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i, mesh
    type(state_t), intent(out) :: state
    real(wp), intent(out) :: coordinate
    logical, intent(out) :: there

    coordinate = 0
    associate (point => self%point(i))
      there = point%mesh == mesh
      if (there) then
        state = point%state
        coordinate = point%coordinate
      else if (mesh == point%mesh + 1 .and. allocated(point%twin)) then
        there = .true.
        state = point%twin
        coordinate = log(point%twin%scale)
      end if
    end associate
  end subroutine seen_on

  !> The mesh on which the piece from point i to point i + 1 is known.
  pure integer function mesh_between(self, i)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i

    mesh_between = max(self%point(i)%mesh, self%point(i + 1)%mesh)
  end function mesh_between

  !> Advances the tracer by a step and appends the new point, and the extrema if some have been
  !> passed. An extremum between the two newest points is seen only with the next one, so what lies
  !> before the newest but one is final. A new path begins with the tracer's own newest state. lost:
  !> no step, however small, converged.
  subroutine extend(path, walker, equations, options, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    integer :: n

    if (path%held == 0) call append(path, walker)
    call walker%advance(equations, options, lost)
    if (lost) return
    call append(path, walker)
    n = walker%held
    if (n >= 3) then
      if (surrounded(walker%state(n - 2:n)%h0)) then
        call insert_extremum(path, walker, of_h0, equations, options, lost)
      else if (.not. any(path%point(max(1, path%held - 4):path%held)%fold)) then
        call insert_hidden(path, walker, equations, options)
      end if
      if (.not. lost .and. surrounded(walker%state(n - 2:n)%load) .and. &
        any(abs(walker%state(n - 2:n)%load) > no_load*equations%problem%law%adhesion)) &
        call insert_extremum(path, walker, of_load, equations, options, lost)
    end if
    if (.not. lost) call change_mesh(path, walker, equations, options, lost)
  end subroutine extend

  !> Whether the middle one of three values is an extremum.
  pure logical function surrounded(value)
    real(wp), intent(in) :: value(3)

    surrounded = (value(2) - value(1))*(value(3) - value(2)) < 0
  end function surrounded

  !> Makes the tracer's newest state the last point.
  subroutine append(path, walker)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    type(path_point_t) :: point

    if (path%held > 0) point%modes = path%point(path%held)%modes
    point%state = walker%state(walker%held)
    point%mesh = walker%mesh
    point%coordinate = walker%coordinate(walker%held)
    call insert(path, path%held + 1, point)
  end subroutine append

  !> Lets the tracer change its mesh, and keeps what it took along as twins.
  subroutine change_mesh(path, walker, equations, options, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    real(wp) :: before(2)
    integer :: mesh, n, i, k, taken

    mesh = walker%mesh
    n = walker%held
    before = walker%coordinate([max(1, n - 1), n])
    call walker%change_mesh(equations, options, lost)
    if (lost .or. walker%mesh == mesh) return
    ! One or both of the last two, the newest last.
    taken = walker%held
    do k = 3 - taken, 2
      do i = path%held, 1, -1
        if (path%point(i)%mesh == mesh .and. abs(path%point(i)%coordinate - before(k)) <= 0) exit
      end do
      if (i > 0) path%point(i)%twin = walker%state(k - 2 + taken)
    end do
  end subroutine change_mesh

  !> Polishes the extremum that the walker's last three states surround and puts it in its place.
  subroutine insert_extremum(path, walker, quantity, equations, options, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    integer, intent(in) :: quantity
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    type(extremum_t) :: found

    call polish_extremum(equations, tightened(options), walker%arc_t, quantity, found, lost)
    if (lost) return
    call put(path, walker, quantity, found)
  end subroutine insert_extremum

  !> Puts folds that the walker's last three states pass over in their places.
  subroutine insert_hidden(path, walker, equations, options)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    type(extremum_t), allocatable :: folds(:)
    integer :: i

    call find_hidden_folds(equations, tightened(options), walker%arc_t, folds)
    do i = 1, size(folds)
      call put(path, walker, of_h0, folds(i))
    end do
  end subroutine insert_hidden

  !> Puts an extremum among the last points, by its coordinate on the walker's mesh.
  subroutine put(path, walker, quantity, found)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    integer, intent(in) :: quantity
    type(extremum_t), intent(in) :: found
    type(path_point_t) :: point
    type(state_t) :: state
    real(wp) :: travel, coordinate
    integer :: place, change
    logical :: there

    travel = sign(1.0_wp, walker%coordinate(walker%held) - walker%coordinate(walker%held - 1))
    place = path%held
    do while (place > 1)
      call path%seen_on(place - 1, walker%mesh, state, coordinate, there)
      if (.not. there .or. (coordinate - found%coordinate)*travel <= 0) exit
      place = place - 1
    end do
    ! Before the first point of all nothing is known.
    if (place < 2) return
    point%state = found%state
    point%mesh = walker%mesh
    point%coordinate = found%coordinate
    point%fold = quantity == of_h0
    point%load_extremum = quantity == of_load
    point%modes = path%point(place - 1)%modes
    call insert(path, place, point)
    if (quantity /= of_h0) return
    ! At a maximum of h0 its second derivative is negative.
    change = merge(-1, 1, -found%sense*found%load_slope*travel > 0)
    path%point(place:path%held)%modes = path%point(place:path%held)%modes + change
  end subroutine put

  !> Puts a point in the given place, later ones move up.
  subroutine insert(path, place, point)
    type(traced_path_t), intent(inout) :: path
    integer, intent(in) :: place
    type(path_point_t), intent(in) :: point
    type(path_point_t), allocatable :: longer(:)
    integer :: j

    if (.not. allocated(path%point)) allocate (path%point(64))
    if (path%held == size(path%point)) then
      allocate (longer(2*path%held))
      longer(:path%held) = path%point
      call move_alloc(longer, path%point)
    end if
    do j = path%held, place, -1
      path%point(j + 1) = path%point(j)
    end do
    path%held = path%held + 1
    path%point(place) = point
  end subroutine insert

end module traced_path
