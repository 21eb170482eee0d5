!> Growth of a traced path: the states of an arc become points of the path, and the extrema between
!> these states are inserted.
!>
!> A fold is an extremum of h0 along the path. The change of stability at a fold follows from the
!> sense of turning in the plane of h0 and load (Maddocks, Arch. Rational Mech. Anal. 99, 1987).
!> With primes for derivatives along the path, an eigenvalue of the operator increases through zero
!> where h0'' F' > 0. At large separations no eigenvalue is negative. The changes need not
!> alternate: of the two folds after snap-in at large sigma, the first makes a second mode unstable.
module path_growth
  use kinds, only: wp
  use solver, only: solver_t
  use arc, only: arc_t
  use path_tangent, only: of_h0, of_load
  use path_extrema, only: find_extrema
  use path_search, only: found_t
  use traced_path, only: traced_path_t, path_point_t
  implicit none
  private
  public :: append, add_extrema

  !> The load over the law's adhesion below which extrema of the load are neglected.
  real(wp), parameter :: no_load = 1.0e-16_wp

contains

  !> Appends a state of an arc, the newest or the one `before` states earlier, as the last point.
  subroutine append(path, arc, before)
    type(traced_path_t), intent(inout) :: path
    type(arc_t), intent(in) :: arc
    integer, intent(in), optional :: before
    type(path_point_t) :: point
    integer :: k

    k = arc%held
    if (present(before)) k = k - before
    if (path%held > 0) then
      associate (last => path%point(path%held))
        last%leads_on = last%mesh == arc%mesh
        point%modes = last%modes
      end associate
    end if
    point%state = arc%state(k)
    point%tangent = arc%tangent(k)
    point%mesh = arc%mesh
    point%coordinate = arc%coordinate(k)
    call path%insert(path%held + 1, point)
  end subroutine append

  !> Inserts the extrema between the last two states of an arc among the last points of the path.
  !> lost: a solve failed.
  subroutine add_extrema(path, arc, solver, lost)
    type(traced_path_t), intent(inout) :: path
    type(arc_t), intent(in) :: arc
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(found_t), allocatable :: extrema(:)
    logical :: folds
    integer :: pass, n, k

    lost = .false.
    do pass = 1, 2
      folds = pass == 1
      if (lost) return
      n = arc%held
      if (.not. folds .and. .not. any(abs(arc%state(max(1, n - 1):n)%load) > &
        no_load*solver%problem%law%adhesion)) cycle
      if (n < 2) return
      call find_extrema(solver, arc, arc%coordinate(n - 1:n), &
        merge(of_h0, of_load, folds), extrema, lost)
      do k = 1, size(extrema)
        call put(path, arc, folds, extrema(k))
      end do
    end do
  end subroutine add_extrema

  !> Inserts an extremum of h0 (a fold) or of the load among the last points, by its coordinate on
  !> the arc's mesh.
  subroutine put(path, arc, fold, found)
    type(traced_path_t), intent(inout) :: path
    type(arc_t), intent(in) :: arc
    logical, intent(in) :: fold
    type(found_t), intent(in) :: found
    type(path_point_t) :: point
    integer :: place, change

    place = path%held
    do while (place > 1)
      associate (before => path%point(place - 1))
        if (before%mesh /= arc%mesh .or. .not. before%coordinate > found%coordinate) exit
      end associate
      place = place - 1
    end do
    ! The path before its first point is not known.
    if (place < 2) return
    point%state = found%state
    point%tangent = found%tangent
    point%mesh = arc%mesh
    point%coordinate = found%coordinate
    point%leads_on = .true.
    point%fold = fold
    point%load_extremum = .not. fold
    point%modes = path%point(place - 1)%modes
    call path%insert(place, point)
    if (.not. fold) return
    ! At a maximum of h0 its second derivative is negative.
    change = merge(-1, 1, -found%sense*found%tangent%load > 0)
    path%point(place:path%held)%modes = path%point(place:path%held)%modes + change
  end subroutine put

end module path_growth
