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
  use path_point, only: path_point_t, h0_alone, load_alone
  use path_extrema, only: find_extrema
  use traced_path, only: traced_path_t
  implicit none
  private
  public :: append, add_extrema

  !> The load over the law's adhesion below which extrema of the load are neglected.
  real(wp), parameter :: no_load = 1.0e-16_wp

contains

  !> Appends a point of an arc, the newest or the one `before` states earlier, as the last point.
  subroutine append(path, arc, before)
    type(traced_path_t), intent(inout) :: path
    type(arc_t), intent(in) :: arc
    integer, intent(in), optional :: before
    type(path_point_t) :: point
    integer :: k

    k = arc%held
    if (present(before)) k = k - before
    point = arc%point(k)
    if (path%held > 0) then
      associate (last => path%point(path%held))
        last%leads_on = last%mesh == arc%mesh
        point%modes = last%modes
      end associate
    end if
    call path%insert(path%held + 1, point)
  end subroutine append

  !> Inserts the extrema between the last two states of an arc among the last points of the path.
  !> lost: a solve failed.
  subroutine add_extrema(path, arc, solver, lost)
    type(traced_path_t), intent(inout) :: path
    type(arc_t), intent(in) :: arc
    class(solver_t), intent(inout) :: solver
    logical, intent(out) :: lost
    type(path_point_t), allocatable :: extrema(:)
    logical :: folds, maximum
    integer :: pass, n, k

    lost = .false.
    do pass = 1, 2
      folds = pass == 1
      if (lost) return
      n = arc%held
      if (.not. folds .and. .not. any(abs(arc%point(max(1, n - 1):n)%state%load) > &
        no_load*solver%problem%law%adhesion)) cycle
      if (n < 2) return
      call find_extrema(solver, arc, arc%point(n - 1:n)%coordinate, &
        merge(h0_alone, load_alone, folds), extrema, lost)
      maximum = .not. arc%point(n - 1)%tangent%of(merge(h0_alone, load_alone, folds)) < 0
      do k = 1, size(extrema)
        call put(path, extrema(k), folds, maximum)
        maximum = .not. maximum
      end do
    end do
  end subroutine add_extrema

  !> Inserts an extremum of h0 (a fold) or of the load among the last points, by its coordinate.
  !> maximum: whether h0 or the load has a maximum there, along the path inward.
  subroutine put(path, extremum, fold, maximum)
    type(traced_path_t), intent(inout) :: path
    type(path_point_t), intent(in) :: extremum
    logical, intent(in) :: fold, maximum
    integer :: place, change

    place = path%held
    do while (place > 1)
      associate (before => path%point(place - 1))
        if (before%mesh /= extremum%mesh .or. .not. before%coordinate > extremum%coordinate) exit
      end associate
      place = place - 1
    end do
    ! The path before its first point is not known.
    if (place < 2) return
    call path%insert(place, extremum)
    associate (point => path%point(place))
      point%leads_on = .true.
      point%fold = fold
      point%load_extremum = .not. fold
      point%modes = path%point(place - 1)%modes
    end associate
    if (.not. fold) return
    ! At a maximum of h0 its second derivative is negative.
    change = merge(-1, 1, maximum .eqv. extremum%tangent%load < 0)
    path%point(place:path%held)%modes = path%point(place:path%held)%modes + change
  end subroutine put

end module path_growth
