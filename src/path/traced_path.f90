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
  use contact_state, only: state_t
  use equilibrium, only: equations_t
  use solver_options, only: solver_options_t
  use edge_locked, only: approach
  use path_tangent, only: tangent_t, of_h0, of_load
  use arc, only: arc_t
  use path_extremum, only: extremum_t, find_extrema
  use continuation, only: continuation_t
  implicit none
  private
  public :: traced_path_t, path_point_t, extend, pass_on, collapsed, either_side

  !> One equilibrium of the path.
  type :: path_point_t
    type(state_t) :: state
    !> Its derivatives by the path's coordinate.
    type(tangent_t) :: tangent
    !> The mesh that it was solved on and its coordinate there (`path_coordinate`).
    integer :: mesh = approach
    real(wp) :: coordinate = 0
    !> Unstable modes from here to the next point.
    integer :: modes = 0
    !> Whether it is an extremum, of h0 or of the load.
    logical :: fold = .false., load_extremum = .false.
    !> The last two equilibria before the mesh changes, on the next mesh too: every piece of
    !> the path has both its ends on one mesh.
    type(state_t), allocatable :: twin
    type(tangent_t), allocatable :: twin_tangent
  end type path_point_t

  type :: traced_path_t
    integer :: held = 0
    type(path_point_t), allocatable :: point(:)
  contains
    procedure :: modes_at
    procedure :: add_to
    procedure :: seen_on
    procedure :: arc_about
    procedure, private :: is_behind
    procedure :: mesh_between
  end type traced_path_t

  !> Points on either side of a piece of the path that tell about it: of folds and extrema one may
  !> be too near to tell anything.
  integer, parameter :: either_side = 2

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

  !> Adds the i-th point to an arc, if it is known on the arc's mesh.
  pure subroutine add_to(self, i, arc)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i
    class(arc_t), intent(inout) :: arc

    associate (point => self%point(i))
      if (point%mesh == arc%mesh) then
        call arc%add(point%coordinate, point%state, point%tangent)
      else if (arc%mesh == point%mesh + 1 .and. allocated(point%twin)) then
        call arc%add(log(point%twin%scale), point%twin, point%twin_tangent)
      end if
    end associate
  end subroutine add_to

  !> The i-th point as a mesh has it; there = .false. if that does not know it.
  pure subroutine seen_on(self, i, mesh, state, coordinate, there)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i, mesh
    type(state_t), intent(out) :: state
    real(wp), intent(out) :: coordinate
    logical, intent(out) :: there
    type(arc_t) :: alone

    alone%mesh = mesh
    call self%add_to(i, alone)
    there = alone%held > 0
    if (there) state = alone%state(1)
    coordinate = alone%coordinate(1)
  end subroutine seen_on

  !> The arc of the points about s on a mesh.
  pure function arc_about(self, mesh, s) result(arc)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: mesh
    real(wp), intent(in) :: s
    type(arc_t) :: arc
    integer :: i, j

    do i = self%held, 1, -1
      if (self%point(i)%mesh <= mesh .and. .not. self%is_behind(i, mesh, s)) exit
    end do
    arc%mesh = mesh
    do j = max(1, i - either_side), min(self%held, i + 1 + either_side)
      call self%add_to(j, arc)
    end do
  end function arc_about

  !> Whether the i-th point is known on a mesh and lies farther along the path than s there.
  pure logical function is_behind(self, i, mesh, s)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i, mesh
    real(wp), intent(in) :: s

    is_behind = .false.
    associate (point => self%point(i))
      if (point%mesh == mesh) then
        is_behind = point%coordinate > s
      else if (mesh == point%mesh + 1 .and. allocated(point%twin)) then
        is_behind = log(point%twin%scale) > s
      end if
    end associate
  end function is_behind

  !> The mesh on which the piece from point i to point i + 1 is known.
  pure integer function mesh_between(self, i)
    class(traced_path_t), intent(in) :: self
    integer, intent(in) :: i

    mesh_between = max(self%point(i)%mesh, self%point(i + 1)%mesh)
  end function mesh_between

  !> Advances the tracer by a step and appends the new point. A new path begins with the tracer's
  !> own newest state. lost: no step, however small, converged.
  subroutine extend(path, walker, equations, options, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost

    if (path%held == 0) call append(path, walker)
    call walker%advance(equations, options, lost)
    if (.not. lost) call append(path, walker)
  end subroutine extend

  !> Lets the tracer pass to the next mesh if it has come there, and puts the extrema that have been
  !> passed before the newest point. lost: a solve failed.
  subroutine pass_on(path, walker, equations, options, lost)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(inout) :: walker
    type(equations_t), intent(inout) :: equations
    type(solver_options_t), intent(in) :: options
    logical, intent(out) :: lost
    type(extremum_t), allocatable :: extrema(:)
    logical :: folds
    integer :: pass, n, k

    call change_mesh(path, walker, equations, options, lost)
    do pass = 1, 2
      folds = pass == 1
      if (lost) return
      n = walker%held
      if (.not. folds .and. .not. any(abs(walker%state(max(1, n - 1):n)%load) > &
        no_load*equations%problem%law%adhesion)) cycle
      call find_extrema(equations, options, walker%arc_t, n - 1, merge(of_h0, of_load, folds), &
        extrema, lost)
      do k = 1, size(extrema)
        call put(path, walker, folds, extrema(k))
      end do
    end do
  end subroutine pass_on

  !> Makes the tracer's newest state the last point.
  subroutine append(path, walker)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    type(path_point_t) :: point

    if (path%held > 0) point%modes = path%point(path%held)%modes
    point%state = walker%state(walker%held)
    point%tangent = walker%tangent(walker%held)
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
    integer :: mesh, i, k

    mesh = walker%mesh
    before = walker%coordinate(walker%held - 1:walker%held)
    call walker%change_mesh(equations, options, lost)
    if (lost .or. walker%mesh == mesh) return
    do k = 1, 2
      do i = path%held, 1, -1
        associate (point => path%point(i))
          if (point%mesh < mesh - 1) cycle
          ! Where bands are narrow a state is taken along twice: its twin becomes the point.
          if (point%mesh == mesh - 1 .and. allocated(point%twin)) then
            if (abs(log(point%twin%scale) - before(k)) <= 0) call replace_by_twin(point, mesh)
          end if
          if (point%mesh == mesh .and. abs(point%coordinate - before(k)) <= 0) exit
        end associate
      end do
      if (i == 0) cycle
      path%point(i)%twin = walker%state(k)
      path%point(i)%twin_tangent = walker%tangent(k)
    end do
  end subroutine change_mesh

  !> Lets a point be what it is on the mesh of its twin.
  pure subroutine replace_by_twin(point, mesh)
    type(path_point_t), intent(inout) :: point
    integer, intent(in) :: mesh

    point%state = point%twin
    point%tangent = point%twin_tangent
    point%coordinate = log(point%state%scale)
    point%mesh = mesh
    deallocate (point%twin, point%twin_tangent)
  end subroutine replace_by_twin

  !> Puts an extremum, of h0 (a fold) or of the load, among the last points, by its coordinate on
  !> the walker's mesh.
  subroutine put(path, walker, fold, found)
    type(traced_path_t), intent(inout) :: path
    type(continuation_t), intent(in) :: walker
    logical, intent(in) :: fold
    type(extremum_t), intent(in) :: found
    type(path_point_t) :: point
    integer :: place, change

    place = path%held
    do while (place > 1)
      if (.not. path%is_behind(place - 1, walker%mesh, found%coordinate)) exit
      place = place - 1
    end do
    ! Before the first point of all nothing is known.
    if (place < 2) return
    point%state = found%state
    point%tangent = found%tangent
    point%mesh = walker%mesh
    point%coordinate = found%coordinate
    point%fold = fold
    point%load_extremum = .not. fold
    point%modes = path%point(place - 1)%modes
    call insert(path, place, point)
    if (.not. fold) return
    ! At a maximum of h0 its second derivative is negative.
    change = merge(-1, 1, -found%sense*found%tangent%load > 0)
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
